n = 64; growth = 1.015;
Include "quarter.geo";
Physical Surface("disk") = {1:3};
