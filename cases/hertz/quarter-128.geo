n = 128; growth = 1.0074;
Include "quarter.geo";
Physical Surface("disk") = {1:3};
