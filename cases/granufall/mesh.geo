// Half the section of a tube with an orifice in its bottom plate, x the radius and y the axis: cells of size h. Powder stands in the tube up
// to `fill`, with 2 mm of free space on it, and is followed to 15 mm below the plate.
DefineConstant[ h = {0.001, Min 0, Name "cell size"} ];
DefineConstant[ fill = {0.19325, Min 0, Name "height of the powder at the start"} ];
DefineConstant[ orifice = {0.018, Min 0, Name "diameter of the orifice"} ];
DefineConstant[ tube = {0.0363, Min 0, Name "inner diameter of the tube"} ];
DefineConstant[ squares = {0, Choices{0, 1}, Name "quadrilaterals along the axes in place of triangles"} ];
DefineConstant[ below = {0.015, Min 0, Name "length below the plate"} ];
above = 0.002;

// Columns 0, 1, 2 stand on the axis, the orifice's edge and the wall, rows 0 to 3 on the lower end, the plate and the ends of powder and tube.
x[] = {0, orifice / 2, tube / 2};
y[] = {-below, 0, fill, fill + above};
For j In {0:3}
  For i In {0:2}
    Point(3 * j + i + 1) = {x[i], y[j], 0, h};
  EndFor
EndFor

Line(1) = {1, 2};
Line(2) = {4, 5};
Line(3) = {5, 6};
Line(4) = {1, 4};
Line(5) = {4, 7};
Line(6) = {7, 10};
Line(7) = {2, 5};
Line(8) = {6, 9};
Line(9) = {9, 12};
Line(10) = {7, 8};
Line(11) = {8, 9};
Line(12) = {10, 11};
Line(13) = {11, 12};
Curve Loop(1) = {1, 7, -2, -4};
Plane Surface(1) = {1};
If (squares)
  Line(14) = {5, 8};
  Line(15) = {8, 11};
  Curve Loop(2) = {2, 14, -10, -5};
  Plane Surface(2) = {2};
  Curve Loop(3) = {3, 8, -11, -14};
  Plane Surface(3) = {3};
  Curve Loop(4) = {10, 15, -12, -6};
  Plane Surface(4) = {4};
  Curve Loop(5) = {11, 9, -13, -15};
  Plane Surface(5) = {5};
  Transfinite Curve{:} = 2;
  Transfinite Curve{1, 2, 10, 12} = Round(x[1] / h) + 1;
  Transfinite Curve{3, 11, 13} = Round((x[2] - x[1]) / h) + 1;
  Transfinite Curve{4, 7} = Round(below / h) + 1;
  Transfinite Curve{5, 8, 14} = Round(fill / h) + 1;
  Transfinite Curve{6, 9, 15} = Round(above / h) + 1;
  Transfinite Surface{:};
  Recombine Surface{:};
  Physical Surface("powder") = {2, 3};
  Physical Surface("free") = {1, 4, 5};
Else
  Curve Loop(2) = {2, 3, 8, -11, -10, -5};
  Plane Surface(2) = {2};
  Curve Loop(3) = {10, 11, 9, -13, -12, -6};
  Plane Surface(3) = {3};
  Physical Surface("powder") = {2};
  Physical Surface("free") = {1, 3};
EndIf
Physical Curve("axis") = {4, 5, 6};
Physical Curve("plate") = {3};
Physical Curve("wall") = {8, 9};
