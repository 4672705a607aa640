angle = 17;
Include "mesh.geo";
