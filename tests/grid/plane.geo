// Two unequal regions with a common line: triangles, or quadrilaterals if quads is 1, or some of each if it is 2.
DefineConstant[ h = 0.2, quads = 0, order = 1 ];
Point(1) = {0, 0, 0, h};
Point(2) = {2, 0, 0, h};
Point(3) = {3, 0.5, 0, h / 2};
Point(4) = {3, 1.5, 0, h / 2};
Point(5) = {2, 1, 0, h};
Point(6) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {2, 5};
Curve Loop(1) = {1, 7, 5, 6};
// This one runs clockwise.
Curve Loop(2) = {7, -4, -3, -2};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
If (quads == 2)
  Recombine Surface {2};
ElseIf (quads)
  Mesh.SubdivisionAlgorithm = 1;
  Recombine Surface {1, 2};
EndIf
Mesh.ElementOrder = order;
Physical Surface("beam") = {1};
Physical Surface("tip") = {2};
Physical Surface("all of it") = {1, 2};
Physical Curve("wall") = {6};
Physical Curve("seam") = {7};
Physical Curve("shore") = {1, 2, 3};
Physical Point("corner") = {1};
Physical Curve(77) = {5};
