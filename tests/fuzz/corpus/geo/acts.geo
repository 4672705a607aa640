h = 1; // SystemCall "x";
SystemCall "touch x"; Save View[0] "y"; Plugin(Bubbles).Run;
Printf("a %g", 1) >> "z"; Field[1] = ExternalProcess; S2N[StrCat("System", "Call")] "x";
