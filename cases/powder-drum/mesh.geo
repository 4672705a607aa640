// The inside of a drum of 100 mm: an unstructured mesh whose outer nodes lie on the circle, of triangles or, by pairs of them, of
// quadrilaterals (quads: 1).
DefineConstant[ h = {0.002, Min 0.0005, Name "cell size"}, quads = {0, Min 0, Max 1, Name "quadrilaterals"} ];
R = 0.05;
Point(1) = {0, 0, 0};
Point(2) = {R, 0, 0}; Point(3) = {0, R, 0}; Point(4) = {-R, 0, 0}; Point(5) = {0, -R, 0};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Transfinite Curve {1 : 4} = Ceil(Pi * R / 2 / h) + 1;
Curve Loop(1) = {1 : 4}; Plane Surface(1) = {1};
Mesh.MeshSizeExtendFromBoundary = 1;
If (quads)
  Recombine Surface {1};
EndIf
Physical Surface("inside") = {1}; Physical Curve("rim") = {1 : 4};
