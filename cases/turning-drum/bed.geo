// A bed of sand in a drum of radius R: the segment below a line `depth` under its axis that is turned by `angle` degrees.
DefineConstant[ h = 0.01, R = 0.1, depth = 0.02, angle = 25 ];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180); w = Sqrt(R^2 - depth^2);
Point(1) = {0, 0, 0};
Point(2) = {-w * c - depth * s, w * s - depth * c, 0};
Point(3) = {w * c - depth * s, -w * s - depth * c, 0};
Point(4) = {-R * s, -R * c, 0};
Circle(1) = {2, 1, 4}; Circle(2) = {4, 1, 3}; Line(3) = {3, 2};
Curve Loop(1) = {1, 2, 3}; Plane Surface(1) = {1};
Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h;
Recombine Surface {1};
