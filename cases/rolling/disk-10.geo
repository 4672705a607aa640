n = 10;
Include "disk.geo";
Physical Surface("disk") = {1:5};
