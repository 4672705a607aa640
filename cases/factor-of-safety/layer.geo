// A slope of clay with a thin weak layer: the layer in rows of quadrilaterals, eight across in cells of 1 m, and the clay around it,
// both halved into quadrilaterals (a triangle among them would lock).
DefineConstant[h = 1]; l = h / 2; H = 2 * h; // halved below
Point(1) = {0, 0, 0}; Point(2) = {60, 0, 0}; Point(3) = {60, 10, 0}; Point(4) = {52.8, 10, 0};
Point(5) = {50, 10, 0}; Point(6) = {40, 10, 0}; Point(7) = {20, 20, 0}; Point(8) = {14, 20, 0};
Point(9) = {10, 20, 0}; Point(10) = {0, 20, 0};
Point(11) = {42, 6, 0}; Point(12) = {46, 6, 0}; Point(13) = {42, 4, 0}; Point(14) = {46.8, 4, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 8}; Line(8) = {8, 9}; Line(9) = {9, 10}; Line(10) = {10, 1};
Line(11) = {8, 11}; Line(12) = {11, 12}; Line(13) = {12, 5};
Line(14) = {9, 13}; Line(15) = {13, 14}; Line(16) = {14, 4};
Curve Loop(1) = {5, 6, 7, 11, 12, 13}; Plane Surface(1) = {1};
Curve Loop(2) = {4, -13, -12, -11, 8, 14, 15, 16}; Plane Surface(2) = {2};
Curve Loop(3) = {1, 2, 3, -16, -15, -14, 9, 10}; Plane Surface(3) = {3};
// fine in the layer, and coarser with the distance from it
Mesh.MeshSizeFromPoints = 0; Mesh.MeshSizeExtendFromBoundary = 0;
Field[1] = Distance; Field[1].CurvesList = {11, 12, 13, 14, 15, 16}; Field[1].NumPointsPerCurve = 300;
Field[2] = Threshold; Field[2].InField = 1; Field[2].SizeMin = l; Field[2].SizeMax = H; Field[2].DistMin = 0; Field[2].DistMax = 6 * h;
Background Field = 2;
Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1; Mesh.Smoothing = 5;
Physical Curve("base") = {1}; Physical Curve("sides") = {2, 10};
Physical Surface("clay") = {1, 3}; Physical Surface("weak") = {2};
