If (0)
 a = "x"; E" EndIf; SystemCall 'touch x'; "
EndIf
For i In {0:1}
 /* Include "a.geo"; */ Merge 'b.step';
EndFor
General.TmpFileName = "x"