n = 12; r = 1.265;
Include "octant.geo";
Physical Volume("sphere") = {1 : 4};
