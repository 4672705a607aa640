// A quarter of a disk of radius 0.5 m about (0, 0.5): its lower right, 2 n cells around.
DefineConstant[n = 64, growth = 1.015];
R = 0.5; q = 0.25; d = R / Sqrt(2); e = 0.22;
Point(1) = {0, R, 0}; Point(2) = {q, R, 0}; Point(3) = {e, R - e, 0}; Point(4) = {0, R - q, 0};
Point(5) = {R, R, 0}; Point(6) = {d, R - d, 0}; Point(7) = {0, 0, 0};
Line(1) = {4, 3}; Line(2) = {3, 2}; Line(3) = {2, 1}; Line(4) = {1, 4};
Circle(5) = {7, 1, 6}; Circle(6) = {6, 1, 5};
Line(7) = {7, 4}; Line(8) = {6, 3}; Line(9) = {5, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {5, 8, -1, -7}; Plane Surface(2) = {2};
Curve Loop(3) = {6, 9, -2, -8}; Plane Surface(3) = {3};
Transfinite Curve{1, 3, 5} = n + 1;
Transfinite Curve{2, 4, 6} = n / 2 + 1;
Transfinite Curve{7, 8, 9} = n / 2 + 1 Using Progression growth; // cells at the rim are square
Transfinite Surface{1:3}; Recombine Surface{1:3};
