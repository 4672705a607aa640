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

/* A roll as heavy_ball's that comes at 0.02 s, and another one that vanishes at 0.03 s, both pushed down by 1 kN, far
 * from everything: motion counts while they are there, work stays, and the account closes at every time. The rest of
 * the model does not move. */
static inline void heavy_comes_and_goes(Bench *b, const WallSpec *ball)
{
  const PetscReal mass = 2000 * PETSC_PI * 0.09, spinning = 0.5 * mass * 0.045 * 4, from = 0.02, until = 0.03;
  WallSpec wall[2] = {*ball, *ball};
  for (int k = 0; k < 2; ++k) {
    wall[k].shape.centre[1] += 10;
    wall[k].mass.force[1] = -1e3;
    wall[k].mass.gravity = PETSC_FALSE;
  }
  wall[0].from = from;
  wall[1].name = (char *)"gone", wall[1].has_until = PETSC_TRUE, wall[1].until = until;
  b->c.n_walls = 2, b->c.walls = wall;
  Model *m = bench_model(b, PETSC_COMM_WORLD);
  for (int k = 0; k <= 8; ++k) {
    const PetscReal acts[2] = {PetscMax(0, m->time - from), PetscMin(until, m->time)};
    PetscReal motion = 0, work = 0;
    Energies e;
    for (int w = 0; w < 2; ++w) {
      const PetscReal down = 2 + 1e3 * acts[w] / mass, own = 0.5 * mass * (0.25 + down * down) + spinning;
      motion += (w == 0 ? m->time > from - 1e-9 : m->time < until + 1e-9) * own;
      work += 1e3 * acts[w] * (2 + down) / 2;
    }
    CALL(ModelEnergies(m, &e));
    CHECK_CLOSE(e.kinetic, motion, 1e-9 * motion);
    CHECK_CLOSE(model_sum(m, "energy: kinetic", 0), motion, 1e-9 * motion);
    CHECK_CLOSE(e.external, work, 1e-9 * motion);
    CHECK(PetscAbsReal(model_sum(m, "energy: balance", 0)) < 1e-9, "open at %g s", (double)m->time);
    CHECK(m->most_energy < 1.1 * 2 * (0.5 * mass * (0.25 + 4.5) + spinning), "%g J came in", (double)m->most_energy);
    model_step(m, 5e-3);
  }
  CHECK(m->time > 0.04, "it ends at %g s", (double)m->time);
  CALL(ModelDestroy(&m));
}
