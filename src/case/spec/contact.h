/* Walls, and bodies that meet bodies. */
#pragma once
#include "case/spec/motion.h"

typedef enum { CONTACT_FRICTIONLESS, CONTACT_FRICTION, CONTACT_STICK, CONTACT_BONDED } ContactKind;

/* What moves a wall that has mass: what it touches, its weight, and a load at its centre. */
typedef struct {
  PetscBool has_density, has_total, has_centre, has_inertia, has_velocity, has_spin;
  PetscReal density;              /* kg/m3 */
  PetscReal total;                /* or the mass, kg, in the plane of a metre of depth */
  PetscReal centre[3];            /* of mass, at the start, m */
  PetscReal inertia[3];           /* about the centre and the axes, kg m2; in the plane [2] */
  PetscReal velocity[3], spin[3]; /* at the start, m/s, rad/s */
  PetscBool gravity;              /* does it weigh anything? */
  PetscBool free[4];              /* x y z, rotation; none given: all that the kinematics have */
  PetscReal force[3], torque[3];  /* at the centre, N, N m */
  Amplitude amplitude;            /* of force and torque */
} WallMassSpec;

/* A rigid body that material meets anywhere in the grid: it does not go into it. */
typedef struct {
  char *name;
  Shape shape;         /* where the wall is, */
  PetscBool inside;    /* or where it is not: a container */
  PetscReal thickness; /* of a shape without an inside, m */
  PetscInt n_motions;
  MotionSpec *motions; /* each moves what those before it have made; `on` is empty */
  PetscReal from;      /* s; the wall stands after it, if it is not 0, */
  PetscBool has_until;
  PetscReal until;   /* and up to this time */
  PetscInt n_bodies; /* 0: all */
  char **bodies;     /* that meet it */
  ContactKind contact;
  PetscReal friction; /* tangent of the angle of friction */
  PetscBool by_angle; /* was it given by the angle? */
  PetscReal adhesion; /* N/m2: tangential stress beside friction */
  PetscBool has_mass; /* does it move by what acts on it? */
  WallMassSpec mass;
  PetscInt since; /* stage whose words brought it: from and until count from its start; */
  PetscInt drawn; /* and the one whose words gave its shape: one with mass stands there as that begins */
  PetscBool absent;
  PetscBool waits; /* does a later stage bring a body that meets it? */
} WallSpec;

/* How bodies meet that do not stick to each other: the second is to the first what a wall is. */
typedef struct {
  char *name; /* NULL if it has none */
  PetscInt n_between;
  char **between; /* two bodies */
  ContactKind contact;
  PetscReal friction; /* tangent of the angle of friction */
  PetscBool by_angle; /* was it given by the angle? */
  PetscReal adhesion; /* N/m2: tangential stress beside friction */
} InterfaceSpec;
