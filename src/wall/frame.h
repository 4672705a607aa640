/* Where the matter of a wall is: x = R X + T for what stood at X at the start. */
#pragma once
#include "case/case.h"

typedef struct {
  PetscReal R[9], T[3];
} Frame;

/* All motions of the wall in their order, up to time t. */
void frame_at(const Case *c, const WallSpec *wall, PetscReal t, Frame *frame);
/* X = R^T (x - T) */
void frame_origin(const Frame *frame, const PetscReal x[3], PetscReal X[3]);
/* v = R V */
void frame_turn(const Frame *frame, const PetscReal V[3], PetscReal v[3]);
/* a = R A R^T */
void frame_turn_tensor(const Frame *frame, const PetscReal A[9], PetscReal a[9]);
/* What the matter that is at x at t0 moves by until t1: sums small increments, so that little
 * motion keeps its digits. */
void frame_increment(const Case *c, const WallSpec *wall, PetscReal t0, PetscReal t1, const PetscReal x[3],
                     PetscReal increment[3]);
