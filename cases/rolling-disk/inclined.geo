// A disk 1.4 spacings above a plane of 30 degrees, whose nodes are a turned row.
DefineConstant[ h = {0.04, Min 0.001, Name "spacing"} ];
a = 30 * Pi / 180; R = 0.5;
t[] = {Cos(a), -Sin(a)}; n[] = {Sin(a), Cos(a)};
// disk, clear of the plane, along its normal
cx = n[0] * (R + 1.4 * h); cy = n[1] * (R + 1.4 * h);
Point(1) = {cx, cy, 0, h}; Point(2) = {cx + R, cy, 0, h}; Point(3) = {cx, cy + R, 0, h}; Point(4) = {cx - R, cy, 0, h}; Point(5) = {cx, cy - R, 0, h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Circle(3) = {4, 1, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
// a strip whose upper side is the plane
s0 = -0.8; s1 = 3.2;
Point(11) = {s0*t[0] - h*n[0], s0*t[1] - h*n[1], 0, h}; Point(12) = {s1*t[0] - h*n[0], s1*t[1] - h*n[1], 0, h};
Point(13) = {s1*t[0], s1*t[1], 0, h}; Point(14) = {s0*t[0], s0*t[1], 0, h};
Line(11) = {11, 12}; Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};
Curve Loop(2) = {11, 12, 13, 14}; Plane Surface(2) = {2};
Transfinite Curve {11, 13} = Round((s1 - s0) / h) + 1; Transfinite Curve {12, 14} = 2; Transfinite Surface {2};
Physical Surface("disk") = {1}; Physical Surface("strip") = {2}; Physical Curve("plane") = {13};
