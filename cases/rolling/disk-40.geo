n = 40;
Include "disk.geo";
Physical Surface("disk") = {1:5};
