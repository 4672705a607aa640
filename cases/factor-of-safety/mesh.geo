// Crest and slope in quadrilaterals: the triangle below the slope is three of them, each cut in n x n.
DefineConstant[h = 0.5];
n = Round(5 / h);
Point(1) = {0, 0, 0}; Point(2) = {12, 0, 0}; Point(3) = {22, 0, 0}; Point(4) = {32, 0, 0};
Point(5) = {22, 5, 0}; Point(6) = {12, 10, 0}; Point(7) = {0, 10, 0};
Point(8) = {0, 5, 0}; Point(9) = {12, 5, 0}; Point(10) = {56 / 3, 10 / 3, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 1}; Line(9) = {2, 9}; Line(10) = {9, 6}; Line(11) = {8, 9};
Line(12) = {9, 10}; Line(13) = {3, 10}; Line(14) = {5, 10};
Curve Loop(1) = {1, 9, -11, 8}; Curve Loop(2) = {11, 10, 6, 7};
Curve Loop(3) = {2, 13, -12, -9}; Curve Loop(4) = {3, 4, 14, -13}; Curve Loop(5) = {12, -14, 5, -10};
For k In {1:5}
  Plane Surface(k) = {k};
EndFor
Transfinite Curve{2:5, 7:10, 12:14} = n + 1;
Transfinite Curve{1, 6, 11} = Round(12 / h / 2) + 1;
Transfinite Surface{1:5};
Recombine Surface{1:5};
Physical Curve("base") = {1, 2, 3}; Physical Curve("left") = {7, 8}; Physical Surface("slope") = {1:5};
