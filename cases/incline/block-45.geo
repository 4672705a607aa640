angle = 45;
Include "block.geo";
Physical Surface("block") = {1};
