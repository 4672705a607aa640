a = 5;
Include "column-1.geo";
