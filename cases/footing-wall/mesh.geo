// Soil, 3 x 2 m: squares of h around the footing (x < 1 m, y > -0.6 m), larger ones towards the far sides.
DefineConstant[ h = 0.1, growth = 1.1 ];
x[] = {0, 1, 3}; y[] = {0, -0.6, -2};
For j In {0 : 2}
  For i In {0 : 2}
    Point(1 + i + 3 * j) = {x[i], y[j], 0};
  EndFor
EndFor
nx = Ceil(Log(1 + (growth - 1) * 2 / h) / Log(growth)); ny = Ceil(Log(1 + (growth - 1) * 1.4 / h) / Log(growth));
For j In {0 : 2}
  Line(1 + 2 * j) = {1 + 3 * j, 2 + 3 * j}; Line(2 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
  Transfinite Curve {1 + 2 * j} = Round(1 / h) + 1; Transfinite Curve {2 + 2 * j} = nx + 1 Using Progression growth;
EndFor
For i In {0 : 2}
  Line(11 + i) = {1 + i, 4 + i}; Line(21 + i) = {4 + i, 7 + i};
  Transfinite Curve {11 + i} = Round(0.6 / h) + 1; Transfinite Curve {21 + i} = ny + 1 Using Progression growth;
EndFor
For i In {0 : 1}
  Curve Loop(1 + i) = {1 + i, 12 + i, -3 - i, -11 - i}; Curve Loop(3 + i) = {3 + i, 22 + i, -5 - i, -21 - i};
EndFor
For k In {1 : 4}
  Plane Surface(k) = {-k}; Transfinite Surface {k}; Recombine Surface {k};
EndFor
Physical Surface("soil") = {1 : 4};
