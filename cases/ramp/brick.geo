// A brick of length L and height H in n x m cells: its lower side begins at (x, y) and falls by `angle` degrees.
c = Cos(angle * Pi / 180); s = -Sin(angle * Pi / 180);
Point(1) = {x, y, 0}; Point(2) = {x + L * c, y + L * s, 0};
Point(3) = {x + L * c - H * s, y + L * s + H * c, 0}; Point(4) = {x - H * s, y + H * c, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1; Transfinite Curve{2, 4} = m + 1;
Transfinite Surface{1}; Recombine Surface{1};
