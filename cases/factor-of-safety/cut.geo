// A vertical cut of 1 m: cells of h along the slip, twelve times as large far away.
DefineConstant[h = 0.02];
Point(1) = {-3, -1, 0}; Point(2) = {2, -1, 0}; Point(3) = {2, 0, 0}; Point(4) = {0, 0, 0}; Point(5) = {0, 1, 0};
Point(6) = {-1, 1, 0}; Point(7) = {-3, 1, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};
Line(7) = {7, 1}; Line(8) = {4, 6}; // the last one is in the field of sizes alone
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7}; Plane Surface(1) = {1};
Field[1] = Distance; Field[1].CurvesList = {8}; Field[1].NumPointsPerCurve = 200;
Field[2] = Threshold; Field[2].InField = 1; Field[2].SizeMin = 2 * h; Field[2].SizeMax = 24 * h; // halved below
Field[2].DistMin = 0.2; Field[2].DistMax = 1.2;
Background Field = 2; Mesh.MeshSizeExtendFromBoundary = 0; Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6; Mesh.RecombineAll = 1; Mesh.RecombinationAlgorithm = 1; Mesh.SubdivisionAlgorithm = 1; Mesh.Smoothing = 5;
Physical Curve("bottom") = {1}; Physical Curve("left") = {7}; Physical Curve("right") = {2}; Physical Surface("clay") = {1};
