n = 8;
Include "beam.geo";
Physical Surface("beam") = {1};
