// An eighth of a sphere of radius 0.5 m about (0, 0.5, 0), below its middle, of hexahedra: a core and three bent blocks, n cells
// along each edge, which grow by the factor r away from the lowest point.
DefineConstant[ n = 6, r = 1.6, q = 0.22 ];
R = 0.5; a = R / Sqrt(2); b = R / Sqrt(3); s = 0.8 * q; t = 0.7 * q;
// Corners k of the core, along x (1), z (2) and down (4) from the middle, and of the sphere
For k In {0 : 7}
  x = k % 2; z = Floor(k / 2) % 2; y = Floor(k / 4);
  e = x + y + z;
  c = (e == 1) ? q : (e == 2) ? s : t;
  d = (e == 1) ? R : (e == 2) ? a : b;
  Point(1 + k) = {c * x, R - c * y, c * z};
  Point(11 + k) = {d * x, R - d * y, d * z};
EndFor
// Between both, from the surface inwards
For k In {1 : 7}
  Line(300 + k) = {11 + k, 1 + k};
  Transfinite Curve{300 + k} = n + 1 Using Progression r;
EndFor
// Edges along axis e from corner k: those along x and z grow away from the axis
For e In {0 : 2}
  b = 2 ^ e;
  For k In {0 : 7}
    If (Floor(k / b) % 2 == 0)
      Line(100 + 10 * e + k) = {1 + k, 1 + k + b};
      Transfinite Curve{100 + 10 * e + k} = n + 1 Using Progression (e < 2 ? r : 1);
      If (k > 0)
        Circle(200 + 10 * e + k) = {11 + k, 1, 11 + k + b};
        Transfinite Curve{200 + 10 * e + k} = n + 1 Using Progression (e < 2 ? r : 1);
        Curve Loop(600 + 10 * e + k) = {100 + 10 * e + k, -(300 + k + b), -(200 + 10 * e + k), 300 + k};
        Plane Surface(600 + 10 * e + k) = {600 + 10 * e + k};
        Transfinite Surface{600 + 10 * e + k}; Recombine Surface{600 + 10 * e + k};
      EndIf
    EndIf
  EndFor
EndFor
// Faces across axis d, with edges e and f, and the block between core and sphere
For d In {0 : 2}
  e = (d + 1) % 3; f = (d + 2) % 3; ae = 10 * e; af = 10 * f;
  For s In {0 : 1}
    k = s * 2 ^ d; ke = k + 2 ^ e; kf = k + 2 ^ f;
    Curve Loop(400 + 10 * d + s) = {100 + ae + k, 100 + af + ke, -(100 + ae + kf), -(100 + af + k)};
    Plane Surface(400 + 10 * d + s) = {400 + 10 * d + s};
    Transfinite Surface{400 + 10 * d + s}; Recombine Surface{400 + 10 * d + s};
  EndFor
  Curve Loop(500 + d) = {200 + ae + k, 200 + af + ke, -(200 + ae + kf), -(200 + af + k)};
  Surface(500 + d) = {500 + d} In Sphere {1};
  Transfinite Surface{500 + d}; Recombine Surface{500 + d};
  Surface Loop(2 + d) = {401 + 10 * d, 500 + d, 600 + ae + k, 600 + af + k, 600 + ae + kf, 600 + af + ke};
  Volume(2 + d) = {2 + d};
EndFor
Surface Loop(1) = {400, 401, 410, 411, 420, 421};
Volume(1) = {1};
Transfinite Volume{1 : 4};
