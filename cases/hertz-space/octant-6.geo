n = 6; r = 1.6;
Include "octant.geo";
Physical Volume("sphere") = {1 : 4};
