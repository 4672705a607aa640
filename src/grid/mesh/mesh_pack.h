/* The message that carries one rank's part of a mesh. */
#pragma once
#include "grid/gmsh/msh.h"

enum { HEAD_CELLS, HEAD_OWNED, HEAD_NODES, HEAD_INTEGERS, HEAD_N };

/* A buffer of integers that grows as it is written. */
typedef struct {
  PetscInt n, capacity, read, *data;
} Integers;

/* The whole partition, on rank 0. */
typedef struct {
  const SerialMesh *mesh;
  const PetscInt *owner;             /* of cells */
  PetscInt *node_owner, *node_index; /* rank and local number there */
  PetscInt *first_node;              /* per rank */
  PetscInt *first_cell, *order;      /* cells in the order of their ranks */
  PetscInt *local_cell;              /* number of each cell on its own rank */
  PetscInt *local_node;              /* of the rank that is being packed; -1: not there */
  GridSet outer;                     /* faces without a neighbour and their nodes */
  PetscInt *nodes, n_nodes;          /* of that rank: serial numbers, owned first */
} Plan;

PetscErrorCode PlanCreate(Plan *plan, const SerialMesh *mesh, const PetscInt *owner, PetscMPIInt size);
PetscErrorCode PlanDestroy(Plan *plan);
/* The part of a rank: sizes, integers in the order in which GridDistribute takes them, and node
 * positions (to be freed). */
PetscErrorCode PlanPack(Plan *plan, PetscMPIInt rank, PetscInt head[HEAD_N], Integers *buffer, PetscReal **x);
