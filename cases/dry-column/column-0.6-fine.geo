h = 0.003; a = 0.6;
Include "column-1.geo";
