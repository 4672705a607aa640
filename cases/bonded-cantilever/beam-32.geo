n = 32;
Include "beam.geo";
Physical Surface("beam") = {1};
