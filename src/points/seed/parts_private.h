/* A cell that a body's surface cuts, being measured: for parts.c and faces.c only. */
#pragma once
#include "points/seed/seed.h"

typedef struct {
  PetscReal volume, moment[3], second[3]; /* of the reference cell, times det dx/dxi */
  PetscReal face[3];                      /* the body's surface as a vector outwards, m2, */
  SeedPlanes planes;                      /* likewise, what looks the same way together, */
  PetscReal side[CELL_MOST_SIDES];        /* but for that along the sides of the cell: which share of each */
} Sum;

typedef struct {
  const Seeding *seeding;
  const Shape *shape;
  const SeedRule *rule;
  CellType type;
  PetscInt dim;
  const PetscReal *x; /* nodes of the cell */
  PetscBool straight; /* is it a rectangle along the axes, with this middle and half of these sides? */
  PetscReal middle[3], half[3];
  PetscInt owner;  /* whose part is measured; -1: pieces go to the nearest point of the rule */
  PetscBool faces; /* is the surface asked for? */
  PetscReal normal[CELL_MOST_SIDES][3],
    place[CELL_MOST_SIDES];          /* planes of the reference cell's sides, n . xi = place, */
  PetscReal size[CELL_MOST_SIDES];   /* how large these are there, */
  PetscReal out[CELL_MOST_SIDES][3]; /* and vectors out of the cell, m2 */
  PetscReal slack;                   /* m: corners on the surface shall be inside, whatever round-off says */
  Sum whole[SEED_MAX_RULE], fine[SEED_MAX_RULE], coarse[SEED_MAX_RULE]; /* coarse: edges twice as long */
} Measure;

typedef struct {
  PetscReal xi[4][3];
  PetscBool inside[4];
} Simplex;

/* Position of a place in the cell. */
void measure_place(const Measure *m, const PetscReal *xi, PetscReal *position);
/* Where the surface crosses an edge from inside to outside. */
void measure_cross(const Measure *m, const PetscReal *inside, const PetscReal *outside, PetscReal *at);
/* faces.c. Before sides are asked for: what is known of them. */
void measure_begin_sides(Measure *m);
/* faces.c. Adds the part of the surface in a simplex that it crosses, as a vector outwards, but for what lies at a body
 * that this one sticks to. */
void measure_face(const Measure *m, const Simplex *s, Sum *sum);
/* faces.c. Adds which share of each side of the cell is a side of the simplex, and inside the body. */
void measure_sides(const Measure *m, const Simplex *s, PetscReal *side);
