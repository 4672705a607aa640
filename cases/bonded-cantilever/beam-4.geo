n = 4;
Include "beam.geo";
Physical Surface("beam") = {1};
