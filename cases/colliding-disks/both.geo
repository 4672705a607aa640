n = 16; x = 1.2; y = 1; o = 0;
Include "disk.geo";
Physical Surface("one") = {1 : 5};
x = 2.3; y = 1.25; o = 100;
Include "disk.geo";
Physical Surface("two") = {101 : 105};
