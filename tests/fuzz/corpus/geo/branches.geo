// Cook's membrane: n x n trapezoids, in a margin of empty cells into which material points may move. Each is cut by its diagonal from
// bottom left to top right (cut = 0, as in the thesis), by the other one (1), or by both in turn (2).
// quads = 1: whole cells and no margin, for finite elements.
DefineConstant[ n = {16, Min 1, Name "cells a side"}, quads = {0, Choices {0, 1}, Name "whole cells"},
                cut = {0, Choices {0, 1, 2}, Name "diagonals"} ];
Point(1) = {0, 0, 0};
Point(2) = {48, 44, 0};
Point(3) = {48, 60, 0};
Point(4) = {0, 44, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve {1, 2, 3, 4} = n + 1;
If (cut == 0)
  Transfinite Surface {1} = {1, 2, 3, 4} Right;
ElseIf (cut == 1)
  Transfinite Surface {1} = {1, 2, 3, 4} Left;
Else
  Transfinite Surface {1} = {1, 2, 3, 4} Alternate;
EndIf
Physical Surface("membrane") = {1};
If (quads)
  Recombine Surface {1};
Else
  margin = 2;
  Point(5) = {0, -margin, 0};
  Point(6) = {48 + margin, 44 - margin, 0};
  Point(7) = {48 + margin, 60 + margin, 0};
  Point(8) = {0, 44 + margin, 0};
  Line(5) = {5, 6};
  Line(6) = {6, 7};
  Line(7) = {7, 8};
  Line(8) = {8, 4};
  Line(9) = {1, 5};
  Transfinite Curve {5, 6, 7} = n + 1;
  Curve Loop(2) = {5, 6, 7, 8, -3, -2, -1, 9};
  Plane Surface(2) = {2};
  Physical Surface("margin") = {2};
EndIf
