// A disk of radius 0.5 m about (x, y): a square in its middle and four sectors, 4 n cells around; its numbers begin at o.
R = 0.5; q = 0.22; d = R / Sqrt(2);
Point(o + 9) = {x, y, 0};
Point(o + 1) = {x - q, y - q, 0}; Point(o + 2) = {x + q, y - q, 0}; Point(o + 3) = {x + q, y + q, 0}; Point(o + 4) = {x - q, y + q, 0};
Point(o + 5) = {x - d, y - d, 0}; Point(o + 6) = {x + d, y - d, 0}; Point(o + 7) = {x + d, y + d, 0}; Point(o + 8) = {x - d, y + d, 0};
Line(o + 1) = {o + 1, o + 2}; Line(o + 2) = {o + 2, o + 3}; Line(o + 3) = {o + 3, o + 4}; Line(o + 4) = {o + 4, o + 1};
Circle(o + 5) = {o + 5, o + 9, o + 6}; Circle(o + 6) = {o + 6, o + 9, o + 7}; Circle(o + 7) = {o + 7, o + 9, o + 8}; Circle(o + 8) = {o + 8, o + 9, o + 5};
Line(o + 9) = {o + 1, o + 5}; Line(o + 10) = {o + 2, o + 6}; Line(o + 11) = {o + 3, o + 7}; Line(o + 12) = {o + 4, o + 8};
Curve Loop(o + 1) = {o + 1, o + 2, o + 3, o + 4}; Plane Surface(o + 1) = {o + 1};
Curve Loop(o + 2) = {o + 9, o + 5, -(o + 10), -(o + 1)}; Plane Surface(o + 2) = {o + 2};
Curve Loop(o + 3) = {o + 10, o + 6, -(o + 11), -(o + 2)}; Plane Surface(o + 3) = {o + 3};
Curve Loop(o + 4) = {o + 11, o + 7, -(o + 12), -(o + 3)}; Plane Surface(o + 4) = {o + 4};
Curve Loop(o + 5) = {o + 12, o + 8, -(o + 9), -(o + 4)}; Plane Surface(o + 5) = {o + 5};
Transfinite Curve{o + 1 : o + 8} = n + 1; Transfinite Curve{o + 9 : o + 12} = n / 2 + 1;
Transfinite Surface{o + 1 : o + 5}; Recombine Surface{o + 1 : o + 5};
