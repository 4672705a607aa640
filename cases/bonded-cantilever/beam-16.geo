n = 16;
Include "beam.geo";
Physical Surface("beam") = {1};
