n = 16; m = 2; q = 0.25;
Include "sphere.geo";
Physical Volume("sphere") = {1 : 7};
