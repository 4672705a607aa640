h = 0.05;
Include "mesh.geo";
