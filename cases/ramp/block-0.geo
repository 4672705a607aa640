angle = 0; x = 0.75; y = 3.5; L = 1; H = 0.5; n = 4; m = 2;
Include "brick.geo";
Physical Surface("block") = {1};
