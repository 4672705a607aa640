// A column 0.09 m wide and a times as high, in cells of h of its own.
DefineConstant[ h = 0.006, a = 1 ];
Point(1) = {0, 0, 0}; Point(2) = {0.09, 0, 0}; Point(3) = {0.09, 0.09 * a, 0}; Point(4) = {0, 0.09 * a, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Round(0.09 / h) + 1; Transfinite Curve {2, 4} = Round(0.09 * a / h) + 1;
Transfinite Surface {1}; Recombine Surface {1};
