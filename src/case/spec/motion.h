/* What is prescribed, and where. */
#pragma once
#include "case/spec/amplitude.h"
#include "case/spec/shape.h"

/* Where something acts: every condition given must hold. */
typedef struct {
  PetscBool has[3];
  PetscReal min[3], max[3]; /* m; x: 0 gives min = max */
  /* a physical group of the mesh, or left right bottom top front back of a box */
  char *boundary;
  char *body; /* for loads on a body: its boundary */
  PetscBool has_shape;
  Shape shape;
} Selector;

typedef enum { MOTION_FIXED, MOTION_DISPLACEMENT, MOTION_VELOCITY, MOTION_ROTATION } MotionKind;

/* The normal of a wall, beside the axes 0 1 2. */
#define NORMAL 3

/* Prescribed motion of the nodes selected. Components not in `component` stay free. */
typedef struct {
  Selector on;
  PetscBool moves; /* does the place `on` take part in the motion, on a grid that is restored? */
  MotionKind kind;
  PetscBool component[4];             /* x y z; NORMAL: nodes slide along the wall that they stand in */
  PetscReal value[3];                 /* m or m/s, times the amplitude */
  PetscReal centre[3], axis[3], rate; /* rotation, rad/s (times the amplitude) */
  Amplitude amplitude;
  char *name;        /* for measures and messages; NULL if it has none */
  PetscInt n_bodies; /* 0: all */
  char **bodies;     /* whose nodes it takes */
  PetscBool absent;
} MotionSpec;
