angle = 30; x = 0.966506350946; y = 3.30801270189; L = 1; H = 0.5; n = 4; m = 2;
Include "brick.geo";
Physical Surface("block") = {1};
