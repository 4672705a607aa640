h = 0.05;
Include "round.geo";
