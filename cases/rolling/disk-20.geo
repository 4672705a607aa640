n = 20;
Include "disk.geo";
Physical Surface("disk") = {1:5};
