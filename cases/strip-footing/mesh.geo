// Half of the soil, 5 m x 5 m, and 1 m of empty cells above into which it heaves: triangles of size h in squares around the
// footing (x < 2 m, y > -3 m), larger towards the far sides.
DefineConstant[ h = {0.05, Min 0, Name "cell size at the footing"} ];
growth = 1.2;
x[] = {0, 2, 5};
y[] = {-5, -3, 1};
For j In {0 : 2}
  For i In {0 : 2}
    Point(1 + i + 3 * j) = {x[i], y[j], 0};
  EndFor
EndFor
nx = Ceil(Log(1 + (growth - 1) * 3 / h) / Log(growth)); // cells over 3 m whose first is about h
ny = Ceil(Log(1 + (growth - 1) * 2 / h) / Log(growth));
For j In {0 : 2}
  Line(1 + 2 * j) = {1 + 3 * j, 2 + 3 * j};
  Line(2 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
  Transfinite Curve {1 + 2 * j} = 2 / h + 1;
  Transfinite Curve {2 + 2 * j} = nx + 1 Using Progression growth;
EndFor
For i In {0 : 2}
  Line(11 + i) = {1 + i, 4 + i};
  Line(21 + i) = {4 + i, 7 + i};
  Transfinite Curve {11 + i} = ny + 1 Using Progression 1 / growth;
  Transfinite Curve {21 + i} = 4 / h + 1;
EndFor
For i In {0 : 1}
  Curve Loop(1 + i) = {1 + i, 12 + i, -3 - i, -11 - i};
  Curve Loop(3 + i) = {3 + i, 22 + i, -5 - i, -21 - i};
EndFor
For k In {1 : 4}
  Plane Surface(k) = {k};
  Transfinite Surface {k} Alternate;
EndFor
Physical Surface("room") = {1 : 4};
