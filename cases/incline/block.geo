// A block of 1 x 0.5 m in cells of 0.25 m: its lower side begins at (1, 0.7) and rises by `angle` degrees, as the wall does.
DefineConstant[angle = 0];
c = Cos(angle * Pi / 180); s = Sin(angle * Pi / 180);
Point(1) = {1, 0.7, 0}; Point(2) = {1 + c, 0.7 + s, 0};
Point(3) = {1 + c - 0.5 * s, 0.7 + s + 0.5 * c, 0}; Point(4) = {1 - 0.5 * s, 0.7 + 0.5 * c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 5; Transfinite Curve{2, 4} = 3;
Transfinite Surface{1}; Recombine Surface{1};
