// The column as a mesh of its own, in 64 squares over its height, for a grid that has its lines elsewhere.
h = 50 / 64;
Point(1) = {0, 0, 0};
Point(2) = {4 * h, 0, 0};
Point(3) = {4 * h, 50, 0};
Point(4) = {0, 50, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 5;
Transfinite Curve {2, 4} = 65;
Transfinite Surface {1};
Recombine Surface {1};
Physical Surface("column") = {1};
