// Ground below and beside half of a footing 1 m wide, whose edge is at x = 0.5: squares of size h, which shrink to a quarter towards
// the edge, and below the surface, by equal ratios in five steps.
DefineConstant[h = 0.0625, width = 2, depth = 0.75];

fine = 4;
n = 5;
g = fine^(1 / n);
s = h / fine * (fine - 1) / (g - 1);

x[] = {0, 0.5 - s, 0.5, 0.5 + s, width};
y[] = {0, -s, -depth};
For j In {0 : 2}
  For i In {0 : 4}
    Point(10 * j + i) = {x[i], y[j], 0};
  EndFor
EndFor

across[] = {Ceil((0.5 - s) / h - 1e-6), n, n, Ceil((width - 0.5 - s) / h - 1e-6)};
ratio[] = {1, 1 / g, g, 1};
down[] = {n, Ceil((depth - s) / h - 1e-6)};
For j In {0 : 2}
  For i In {0 : 3}
    Line(100 + 10 * j + i) = {10 * j + i, 10 * j + i + 1};
    Transfinite Curve {100 + 10 * j + i} = across[i] + 1 Using Progression ratio[i];
  EndFor
EndFor
For j In {0 : 1}
  For i In {0 : 4}
    Line(200 + 10 * j + i) = {10 * j + i, 10 * (j + 1) + i};
    Transfinite Curve {200 + 10 * j + i} = down[j] + 1 Using Progression (j == 0 ? g : 1);
  EndFor
EndFor
For j In {0 : 1}
  For i In {0 : 3}
    Curve Loop(300 + 10 * j + i) = {200 + 10 * j + i, 110 + 10 * j + i, -(200 + 10 * j + i + 1), -(100 + 10 * j + i)};
    Plane Surface(300 + 10 * j + i) = {300 + 10 * j + i};
    Transfinite Surface {300 + 10 * j + i};
    Recombine Surface {300 + 10 * j + i};
  EndFor
EndFor

Physical Surface("ground") = Surface{:};
Physical Curve("base") = {120, 121, 122, 123};
Physical Curve("middle") = {200, 210};
Physical Curve("side") = {204, 214};
