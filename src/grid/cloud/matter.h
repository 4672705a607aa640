/* Where bodies had material at the start, as every rank knows it.
 *
 * A cloud has no cells, and its nodes may come near each other across a slot, or from body to body. What was joined
 * through material then is joined for life: a straight way that does not leave what the cells filled, or one round a
 * corner that is hardly longer. */
#pragma once
#include "grid/grid.h"

/* In place of a position at the start: a node that belongs to whatever comes near it, an obstacle. */
#define MATTER_ANYWHERE PETSC_MAX_REAL

typedef struct {
  PetscInt dim, n_fields;
  PetscReal low[3], size; /* voxels: the corner of the first, and their edge, m */
  PetscInt counts[3];
  unsigned char *bits; /* a bit for each voxel, field by field: do cells of this velocity field fill it? */
  /* of blocks of voxels, as wide as a cell: how many layers of blocks that are full lie around, with itself */
  PetscInt blocks[3];
  unsigned char *depth;
  PetscReal *centre; /* of each cell of the mesh, by its number in the file: dim */
} CloudMatter;

/* Collective. What the cells listed fill, each for its velocity field (NULL: there is one); spacing: of the cloud. NULL
 * for *matter where that would be too much to remember. */
PetscErrorCode CloudMatterCreate(const Grid *mesh, PetscReal spacing, PetscInt n_fields, PetscInt n,
                                 const PetscInt *cell, const PetscReal *field, CloudMatter **matter);
PetscErrorCode CloudMatterDestroy(CloudMatter **matter);

/* Is there material of the field at x? */
PetscBool matter_holds(const CloudMatter *matter, PetscInt field, const PetscReal *x);
/* And all along the straight way from a to b? */
PetscBool matter_joins(const CloudMatter *matter, PetscInt field, const PetscReal *a, const PetscReal *b);
/* Which of n nodes, at X (n x dim) at the start, no more than a cloud may have, are joined to a place? PETSC_FALSE: all
 * are, or it is not in the material. */
PetscBool matter_find_joined(const CloudMatter *matter, PetscInt field, const PetscReal *from, PetscInt n,
                             const PetscReal *X, PetscBool *joined);
