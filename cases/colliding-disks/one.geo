n = 10; x = 1.2; y = 1; o = 0;
Include "disk.geo";
Physical Surface("one") = {1 : 5};
