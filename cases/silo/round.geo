// The grains: half a section of a bin of 1 m in diameter and 3 m high, in cells of h of its own.
DefineConstant[ h = 0.1 ];
Point(1) = {0, 0, 0}; Point(2) = {0.5, 0, 0}; Point(3) = {0.5, 3, 0}; Point(4) = {0, 3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve {1, 3} = Round(0.5 / h) + 1; Transfinite Curve {2, 4} = Round(3 / h) + 1;
Transfinite Surface {1}; Recombine Surface {1};
