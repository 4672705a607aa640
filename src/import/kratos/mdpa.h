/* A model part file of Kratos (.mdpa): nodes, elements, conditions, and sub model parts that name
 * some of them. */
#pragma once
#include <petscsys.h>
#include "base/diag/diag.h"

#define MDPA_MAX_NODES 8

/* An element or a condition; nodes as indices into the model's. */
typedef struct {
  PetscInt id, n, node[MDPA_MAX_NODES];
  PetscInt type; /* index into `types` */
} MdpaEntity;

typedef struct {
  PetscInt n, capacity;
  MdpaEntity *entity;
} MdpaEntities;

typedef struct {
  PetscInt n, capacity, *id;
} MdpaIds;

typedef struct {
  char *name; /* "Outer.Inner" of a nested one */
  MdpaIds nodes, elements, conditions;
} MdpaPart;

typedef struct {
  char *file;
  PetscInt n_nodes, node_capacity, *node_id;
  PetscReal (*x)[3];
  PetscInt most;   /* largest id of a node */
  PetscInt *index; /* of node id, or -1; most + 1 long */
  MdpaEntities elements, conditions;
  PetscInt n_types;
  char **types; /* names of element and condition types: "UpdatedLagrangian2D4N" */
  PetscInt n_parts;
  MdpaPart *parts;
} Mdpa;

/* Not collective. Mistakes go to diag with file and line, and *model is NULL. */
PetscErrorCode MdpaRead(const char *file, Diag *diag, Mdpa **model);
PetscErrorCode MdpaDestroy(Mdpa **model);
/* NULL if there is none. */
const MdpaPart *mdpa_part(const Mdpa *model, const char *name);
/* Index of the node with this id, -1 if there is none. */
PetscInt mdpa_node(const Mdpa *model, PetscInt id);
/* Index of the entity with this id, -1 if there is none; entities are in the order of their ids. */
PetscInt mdpa_find(const MdpaEntities *entities, PetscInt id);
