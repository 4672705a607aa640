angle = 17;
Include "block.geo";
b[] = Extrude {0, 0, 0.5} { Surface{1}; Layers{2}; Recombine; };
Physical Volume("block") = {b[1]};
