/* Pieces of material, and what they are made of. */
#pragma once
#include "case/spec/amplitude.h"
#include "case/spec/grid.h"
#include "case/spec/shape.h"

typedef enum { WEIGHTS_AUTO, WEIGHTS_EQUAL, WEIGHTS_GAUSS } PointWeights;
typedef enum { FILL_AUTO, FILL_CELLS, FILL_SHAPE } BodyFill;

typedef struct {
  char *name;
  Amplitude amplitude;
} NamedAmplitude;

typedef struct {
  char *name;
  char *law;
  PetscReal density;     /* kg/m3, of the undeformed body */
  PetscInt n_parameters; /* as the file gives them; the law resolves them */
  NamedValue *parameters;
  PetscInt n_amplitudes; /* factors on parameters, or on the density, over time */
  NamedAmplitude *amplitudes;
} MaterialSpec;

typedef struct {
  char *name, *material;
  PetscBool has_shape;
  Shape shape;
  char *region;         /* a physical group of the grid's mesh, or NULL */
  char *mesh;           /* a mesh of its own that only seeds points, or NULL */
  PetscReal mesh_scale; /* m for one unit of it; 0 stands for 1 */
  PetscInt points_per_cell;
  PointWeights weights;
  BodyFill fill;                     /* whole cells, or what of them lies in the shape */
  PetscReal velocity[3];             /* initial: v + spin x (x - centre) */
  PetscReal spin[3], spin_centre[3]; /* rad/s; 2D uses spin[2] */
  /* geostatic: sigma_v of the material above, sigma_h = k0 sigma_v */
  PetscBool has_k0;
  PetscReal k0;
  /* or given: formulas of x y z, depth and weight for xx yy zz xy yz zx; those not given are NULL: 0 */
  PetscBool has_stress;
  char *stress[6];
  PetscBool has_surface;
  /* height against gravity at which the user believes the material to end, m: only compared */
  PetscReal surface;
  PetscBool absent; /* not yet, or no more: a stage places and removes */
  PetscBool leaves; /* does a later stage take it away? */
  PetscBool begins; /* does its motion begin with this stage, another than the first: it comes, or has stood still? */
  PetscBool bears;  /* has it borne its weight at rest before: in statics, by an initial stress, in another run? */
} BodySpec;

/* Does the body start with a stress? */
PetscBool body_has_stress(const BodySpec *body);
