// Half a section of an angle of repose stand: powder in a conical funnel, whose outlet is `fall` above a round support that stands
// on a floor. x is the radius, y the axis; the origin is the middle of the support's surface. Lengths in m.
DefineConstant[ h = {0.0015, Min 0.0002, Name "size of triangles"}, outlet = {0.016, Name "diameter of the outlet"},
                half = {30, Name "angle of the wall from the axis, deg"}, volume = {150e-6, Name "powder, m3"},
                fall = {0.085, Name "outlet above the support"}, base = {0.1, Name "diameter of the support"},
                stand = {0.025, Name "height of the support"}, rim = {0.07, Name "radius of the floor"},
                quads = {0, Min 0, Max 1, Name "quadrilaterals, by pairs of triangles"} ];
If (outlet < 2 * h)
  Error("the outlet is narrower than two triangles: nothing could flow through it");
  Abort;
EndIf
r = outlet / 2;
slope = Tan(half * Pi / 180);
apex = r / slope; // of the cone, below the outlet
fill = (3 * volume / (Pi * slope^2) + apex^3)^(1 / 3) - apex;
top = fill + 4 * h;
splash = 0.05;       // the stage is wide up to here,
neck = 0.01 + 2 * r; // and as narrow as the falling powder above it
Point(1) = {0, 0, 0};
Point(2) = {base / 2, 0, 0};
Point(3) = {base / 2, -stand, 0};
Point(4) = {rim, -stand, 0};
Point(5) = {rim, splash, 0};
Point(6) = {neck, splash, 0};
Point(7) = {neck, fall, 0};
Point(8) = {r, fall, 0};
Point(9) = {r + fill * slope, fall + fill, 0};
Point(10) = {r + top * slope, fall + top, 0};
Point(11) = {0, fall + top, 0};
Point(12) = {0, fall + fill, 0};
Point(13) = {0, fall, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 9};
Line(9) = {9, 10};
Line(10) = {10, 11};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 1};
Line(14) = {8, 13};
Line(15) = {9, 12};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 14, 13};
Curve Loop(2) = {8, 15, 12, -14};
Curve Loop(3) = {9, 10, 11, -15};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Plane Surface(3) = {3};
If (quads)
  Recombine Surface {1, 2, 3};
EndIf
Physical Surface("air") = {1, 3};
Physical Surface("powder") = {2};
Physical Curve("support") = {1};
Physical Curve("pedestal") = {2};
Physical Curve("floor") = {3};
Physical Curve("funnel") = {8, 9};
Physical Curve("axis") = {11, 12, 13};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
