angle = 17;
Include "block.geo";
Physical Surface("block") = {1};
