Include "block.geo";
Physical Surface("block") = {1};
