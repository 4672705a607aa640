n = 10; x = 2.3; y = 1.25; o = 0;
Include "disk.geo";
Physical Surface("two") = {1 : 5};
