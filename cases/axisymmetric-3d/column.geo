// A quarter of a solid cylinder in space: hexahedra that place points.
DefineConstant[ radius = {0.1, Name "radius"}, height = {0.08, Name "height"}, h = {0.01, Name "cell size"} ];
Point(1) = {0, 0, 0, h}; Point(2) = {radius, 0, 0, h}; Point(3) = {0, 0, radius, h};
Line(1) = {1, 2}; Circle(2) = {2, 1, 3}; Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Mesh.RecombinationAlgorithm = 2; Mesh.SubdivisionAlgorithm = 1;
Recombine Surface {1};
made[] = Extrude {0, height, 0} { Surface{1}; Layers{Round(height / h)}; Recombine; };
Physical Volume("column") = {made[1]};
