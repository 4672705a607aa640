// A disk of radius 0.5 m about (0.6, 0.6): a square in its middle and four sectors, 4 n cells around.
DefineConstant[n = 10];
R = 0.5; q = 0.22; x = 0.6; y = 0.6; d = R / Sqrt(2);
Point(9) = {x, y, 0};
Point(1) = {x - q, y - q, 0}; Point(2) = {x + q, y - q, 0}; Point(3) = {x + q, y + q, 0}; Point(4) = {x - q, y + q, 0};
Point(5) = {x - d, y - d, 0}; Point(6) = {x + d, y - d, 0}; Point(7) = {x + d, y + d, 0}; Point(8) = {x - d, y + d, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Circle(5) = {5, 9, 6}; Circle(6) = {6, 9, 7}; Circle(7) = {7, 9, 8}; Circle(8) = {8, 9, 5};
Line(9) = {1, 5}; Line(10) = {2, 6}; Line(11) = {3, 7}; Line(12) = {4, 8};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Curve Loop(2) = {9, 5, -10, -1}; Plane Surface(2) = {2};
Curve Loop(3) = {10, 6, -11, -2}; Plane Surface(3) = {3};
Curve Loop(4) = {11, 7, -12, -3}; Plane Surface(4) = {4};
Curve Loop(5) = {12, 8, -9, -4}; Plane Surface(5) = {5};
Transfinite Curve{1:8} = n + 1; Transfinite Curve{9:12} = n / 2 + 1;
Transfinite Surface{1:5}; Recombine Surface{1:5};
