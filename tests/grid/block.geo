// A block in two layers of different height: tetrahedra, or hexahedra if bricks is 1.
DefineConstant[ n = 4, bricks = 0 ];
Point(1) = {0, 0, 0};
Point(2) = {2, 0, 0};
Point(3) = {2, 1.5, 0};
Point(4) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3, 4} = n + 1;
Transfinite Surface {1};
If (bricks)
  Recombine Surface {1};
  low[] = Extrude {0, 0, 1} { Surface{1}; Layers{2}; Recombine; };
  high[] = Extrude {0.2, 0, 0.5} { Surface{low[0]}; Layers{2}; Recombine; };
Else
  low[] = Extrude {0, 0, 1} { Surface{1}; Layers{2}; };
  high[] = Extrude {0.2, 0, 0.5} { Surface{low[0]}; Layers{2}; };
EndIf
Physical Volume("low") = {low[1]};
Physical Volume("high") = {high[1]};
Physical Surface("floor") = {1};
Physical Surface("roof") = {high[0]};
Physical Curve("edge") = {1};
