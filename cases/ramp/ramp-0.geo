angle = 0; x = 0.5; y = 3.0; L = 4; H = 0.5; n = 16; m = 2;
Include "brick.geo";
Physical Surface("ramp") = {1};
