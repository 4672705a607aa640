// The grains: a bin of 1 x 3 m turned by `angle` degrees about the middle of its floor, in cells of h of its own.
DefineConstant[ h = 0.1, angle = 0 ];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
Point(1) = {-0.5 * c, -0.5 * s, 0};
Point(2) = {0.5 * c, 0.5 * s, 0};
Point(3) = {0.5 * c - 3 * s, 0.5 * s + 3 * c, 0};
Point(4) = {-0.5 * c - 3 * s, -0.5 * s + 3 * c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Round(1 / h) + 1; Transfinite Curve {2, 4} = Round(3 / h) + 1;
Transfinite Surface {1}; Recombine Surface {1};
