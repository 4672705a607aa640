a = 2;
Include "column-1.geo";
