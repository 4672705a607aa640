a = 3;
Include "column-1.geo";
