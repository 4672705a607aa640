// Sand, 6 m long and 1.5 m deep: the upper 1 m against the wall, 0.5 m below its toe. Cells of h at the toe, where the sand is torn, grow away from it.
DefineConstant[ h = 0.02, growth = 1.12 ];
x[] = {0, 6}; y[] = {0, 0.5, 1.5};
For j In {0 : 2}
  Point(1 + 2 * j) = {0, y[j], 0}; Point(2 + 2 * j) = {6, y[j], 0};
  Line(1 + j) = {1 + 2 * j, 2 + 2 * j};
  Transfinite Curve {1 + j} = Ceil(Log(1 + (growth - 1) * 6 / h) / Log(growth)) + 1 Using Progression growth;
EndFor
For j In {0 : 1}
  For i In {0 : 1}
    k = 11 + i + 2 * j;
    Line(k) = {1 + i + 2 * j, 3 + i + 2 * j};
    Transfinite Curve {k} = Ceil(Log(1 + (growth - 1) * (y[j + 1] - y[j]) / h) / Log(growth)) + 1 Using Progression growth ^ (2 * j - 1);
  EndFor
  Curve Loop(1 + j) = {1 + j, 12 + 2 * j, -(2 + j), -(11 + 2 * j)};
  Plane Surface(1 + j) = {1 + j};
  Transfinite Surface {1 + j}; Recombine Surface {1 + j};
EndFor
Physical Surface("sand") = {1, 2};
