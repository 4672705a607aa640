n = 32; growth = 1.030;
Include "quarter.geo";
Physical Surface("disk") = {1:3};
