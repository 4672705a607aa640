// Half the section of a round plate, 10 m in radius and 1 m thick: triangles without structure.
DefineConstant[ h = {0.2, Min 0.01, Name "cell size"} ];
Point(1) = {0, 0, 0, h}; Point(2) = {10, 0, 0, h}; Point(3) = {10, 1, 0, h}; Point(4) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Surface("plate") = {1}; Physical Curve("top") = {3};
