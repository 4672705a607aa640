// A beam of 8 x 1 m from (1, 1), rising by `angle` degrees, in cells of 1 / n m.
DefineConstant[ n = 8, angle = 27 ];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
Point(1) = {1, 1, 0}; Point(2) = {1 + 8 * c, 1 + 8 * s, 0};
Point(3) = {1 + 8 * c - s, 1 + 8 * s + c, 0}; Point(4) = {1 - s, 1 + c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = 8 * n + 1; Transfinite Curve {2, 4} = n + 1;
Transfinite Surface {1}; Recombine Surface {1};
