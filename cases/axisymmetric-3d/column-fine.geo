h = 1 / 150;
Include "column.geo";
