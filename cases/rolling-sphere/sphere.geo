// A sphere of radius 0.5 m about (0.6, 0.6, 0.6): a cube of hexahedra in six bent blocks, 4 n cells around, m between cube and surface.
DefineConstant[ n = 6, m = 3, q = 0.24 ];
R = 0.5; c = 0.6;
Point(99) = {c, c, c};
For k In {0 : 7}
  x = 2 * (k % 2) - 1; y = 2 * (Floor(k / 2) % 2) - 1; z = 2 * Floor(k / 4) - 1;
  Point(1 + k) = {c + q * x, c + q * y, c + q * z};
  Point(11 + k) = {c + R * x / Sqrt(3), c + R * y / Sqrt(3), c + R * z / Sqrt(3)};
  Line(300 + k) = {1 + k, 11 + k};
  Transfinite Curve{300 + k} = m + 1;
EndFor
// Edges along axis e from corner k, of the cube and of the sphere, and what stands between them.
For e In {0 : 2}
  b = 2 ^ e;
  For k In {0 : 7}
    If (Floor(k / b) % 2 == 0)
      Line(100 + 10 * e + k) = {1 + k, 1 + k + b};
      Circle(200 + 10 * e + k) = {11 + k, 99, 11 + k + b};
      Transfinite Curve{100 + 10 * e + k, 200 + 10 * e + k} = n + 1;
      Curve Loop(600 + 10 * e + k) = {100 + 10 * e + k, 300 + k + b, -(200 + 10 * e + k), -(300 + k)};
      Plane Surface(600 + 10 * e + k) = {600 + 10 * e + k};
      Transfinite Surface{600 + 10 * e + k}; Recombine Surface{600 + 10 * e + k};
    EndIf
  EndFor
EndFor
// Faces across axis d, with edges e and f, from corner k; and the block between them.
For d In {0 : 2}
  e = (d + 1) % 3; f = (d + 2) % 3;
  For s In {0 : 1}
    k = s * 2 ^ d; a = 10 * e; b = 10 * f; ke = k + 2 ^ e; kf = k + 2 ^ f;
    Curve Loop(400 + 10 * d + s) = {100 + a + k, 100 + b + ke, -(100 + a + kf), -(100 + b + k)};
    Plane Surface(400 + 10 * d + s) = {400 + 10 * d + s};
    Curve Loop(500 + 10 * d + s) = {200 + a + k, 200 + b + ke, -(200 + a + kf), -(200 + b + k)};
    Surface(500 + 10 * d + s) = {500 + 10 * d + s} In Sphere {99};
    Transfinite Surface{400 + 10 * d + s, 500 + 10 * d + s}; Recombine Surface{400 + 10 * d + s, 500 + 10 * d + s};
    Surface Loop(2 + 2 * d + s) = {400 + 10 * d + s, 500 + 10 * d + s, 600 + a + k, 600 + b + ke, 600 + a + kf, 600 + b + k};
    Volume(2 + 2 * d + s) = {2 + 2 * d + s};
  EndFor
EndFor
Surface Loop(1) = {400, 401, 410, 411, 420, 421};
Volume(1) = {1};
Transfinite Volume{1 : 7};
