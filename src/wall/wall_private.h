/* What the files of this room that know a wall share. */
#pragma once
#include "wall/form.h"
#include "wall/frame.h"

typedef struct {
  const WallSpec *spec;
  Form *form;
  /* where it was when somebody asked last: most questions are of one time; of a wall with mass where it was put */
  PetscReal asked;
  Frame frame;
  PetscBool corners; /* wall_has_corners */
} Wall;

struct Walls {
  const Case *c;
  PetscInt dim;
  Wall *wall;
};

/* x in the frame of wall k at time t, which is looked up. */
void wall_origin(const Walls *walls, PetscInt k, PetscReal t, const PetscReal *x, PetscReal X[3]);
/* Directions of a place in that frame become those in space, and back. */
void wall_turn(const Wall *wall, WallPlace *place);
void wall_turn_back(const Wall *wall, WallPlace *place);
