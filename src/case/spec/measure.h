/* Numbers that a run is asked for, and what they end. */
#pragma once
#include "case/spec/shape.h"

typedef enum { FRONT_POINTS, FRONT_SURFACE } FrontKind;

/* When a powder slides: more energy of motion, relative to its container, than a threshold. */
typedef struct {
  PetscBool has_container;
  PetscInt container; /* index into boundary[]: the prescribed motion that carries the powder */
  /* over the energy while it creeps, or of moving with the container if that is more; 0: not given */
  PetscReal times;
  PetscReal kinetic; /* or J */
  PetscReal creep;   /* s over which the energy while it creeps is averaged */
  PetscReal ends;    /* low threshold over the high one */
  PetscReal fades;   /* share of its peak below which an event may be over, too */
  PetscReal calm;    /* s that it must stay there */
  PetscReal from;    /* no event before, s */
  PetscReal carried; /* what moved farther than this has taken part, m; 0: one cell */
  PetscReal least;   /* kg that must have taken part */
} AvalancheSpec;

typedef struct {
  char *name;
  char *kind;         /* a measure's key, "energy" (model/measure) */
  char *word;         /* and one of its words, "kinetic"; NULL if it has none */
  PetscInt component; /* 0 1 2 */
  PetscBool maximum;  /* extent, run-out time: max, else min */
  PetscReal beyond;   /* extent: share of the mass that is left out */
  PetscBool advance;  /* extent: from where it was at the start, outwards */
  PetscBool has_tracer;
  PetscReal tracer[3]; /* material position of the tracer at the start */
  char *body;          /* NULL: all */
  PetscInt boundary;   /* reaction: index into boundary[] of the case */
  char *wall;          /* by its name */
  char *interface;     /* likewise */
  PetscBool has_at;
  PetscReal at;    /* x, m */
  PetscReal speed; /* run-out time: a slower front has come to rest, m/s */
  FrontKind front; /* run-out time: whose front */
  PetscBool has_in;
  Shape in; /* only what lies in it */
  PetscBool has_about;
  PetscReal about[3]; /* centre of a container, m */
  PetscReal middle;   /* share of the chord of a free surface that a line is fitted to; 0: usual */
  /* change per time, or mean: over the last window[0] s, or with window[0] < window[1] between two times */
  PetscBool has_rate, has_mean;
  PetscReal window[2];
  AvalancheSpec avalanche;
  PetscInt since; /* stage whose words brought it: it begins there */
} MeasureSpec;

typedef enum { UNTIL_BELOW, UNTIL_ABOVE, UNTIL_COUNT } UntilKind;

/* What ends a run before its end. */
typedef struct {
  UntilKind kind;
  char *measure;      /* by its name */
  PetscReal value;    /* of the measure, in its unit: below, above */
  PetscInt count;     /* of its events */
  PetscReal duration; /* s for which that must hold */
  PetscReal after;    /* s before which it does not matter */
} UntilSpec;
