/* Support of points that each have a cloud of nodes: those near them, chosen by a rule. */
#pragma once
#include "grid/search/neighbours.h"
#include "support/support.h"

/* How clouds are chosen and what stands in them. */
typedef struct {
  CloudBasis basis;
  CloudSupport support;
  PetscReal h; /* m: unit of their lengths */
} CloudRule;

/* A cloud for each point, as a group of its own; nodes are numbered as in `nodes`, one for each velocity
 * field. Points without a node near have an empty group. Of the points their places count, their field, and F if they
 * have one. */
PetscErrorCode SupportFromClouds(Support *support, const Points *points, const Neighbours *nodes,
                                 const CloudRule *rule);
/* The cloud of one position: node and N have room for CLOUD_MAX_NODES, dN for dim times that;
 * returns the number of nodes. F: its deformation gradient, or NULL. */
PetscInt cloud_at(const Neighbours *nodes, const CloudRule *rule, const PetscReal *x, const PetscReal *F,
                  PetscInt *node, PetscReal *N, PetscReal *dN, CloudTally *tally);
