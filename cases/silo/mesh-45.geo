angle = 45;
Include "mesh.geo";
