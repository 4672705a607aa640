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
} Wall;

struct Walls {
  const Case *c;
  PetscInt dim;
  Wall *wall;
};
