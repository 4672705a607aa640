angle = 17; x = 0.885262041352; y = 3.4050594518; L = 1; H = 0.5; n = 4; m = 2;
Include "brick.geo";
Physical Surface("block") = {1};
