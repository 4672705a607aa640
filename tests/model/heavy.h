/* Walls with mass for tests: a ball above a block, and a box that spins in free flight. */
#pragma once
#include "case_builder.h"

static inline PetscReal of_ball(Model *m, const char *kind, PetscInt component)
{
  return model_wall(m, "ball", kind, NULL, component);
}

/* A ball (in the plane a roll) of 0.3 m that comes down on what has its top at 0.5 m, 0.01 m above it. */
static inline void heavy_ball(Bench *b, PetscBool space, PetscReal density, PetscReal friction, WallSpec *wall)
{
  const int up = space ? 2 : 1;
  *wall = (WallSpec){.name = (char *)"ball",
                     .shape = {.kind = SHAPE_BALL, .radius = 0.3, .centre = {0.93, space ? 0.27 : 0, 0}},
                     .contact = friction > 0 ? CONTACT_FRICTION : CONTACT_FRICTIONLESS,
                     .friction = friction,
                     .has_mass = PETSC_TRUE};
  wall->shape.centre[up] = 0.81;
  wall->mass = (WallMassSpec){.has_density = PETSC_TRUE,
                              .density = density,
                              .gravity = PETSC_TRUE,
                              .free = {PETSC_TRUE, PETSC_TRUE, space, PETSC_TRUE},
                              .velocity = {0.5, 0, 0},
                              .spin = {0, 0, space ? 0 : 2}};
  wall->mass.velocity[up] = -2;
  b->c.n_walls = 1;
  b->c.walls = wall;
}

#define BOX_MASS (2000 * 0.2 * 0.4 * 0.7) /* of density 2000, kg */

/* Its sides along the axes at first, about the place (2, 2, 3), far from everything. L: its angular
 * momentum; returns its kinetic energy. */
static inline PetscReal spinning_box(WallSpec *wall, PetscReal L[3])
{
  const PetscReal spin[3] = {1, 5, 0.3}, side[3] = {0.2, 0.4, 0.7};
  PetscReal energy = 0;
  wall->shape = (Shape){.kind = SHAPE_BOX};
  for (int d = 0; d < 3; ++d) {
    wall->shape.min[d] = 2 - side[d] / 2 + (d == 2), wall->shape.max[d] = 2 + side[d] / 2 + (d == 2);
    wall->mass.spin[d] = spin[d];
    L[d] = BOX_MASS / 12 * spin[d] * (PetscSqr(side[(d + 1) % 3]) + PetscSqr(side[(d + 2) % 3]));
    energy += 0.5 * (L[d] * spin[d] + BOX_MASS * PetscSqr(wall->mass.velocity[d]));
  }
  return energy;
}
