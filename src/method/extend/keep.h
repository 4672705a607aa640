/* Nodes that cannot follow, since a point that sees them would see others too far away. */
#pragma once
#include "method/extend/extend.h"

/* Points, or carriers of loads, and what they see. */
typedef struct {
  const Points *points;
  const Support *support;
  PetscInt slopes; /* numbers of dN a node */
} Seen;

Seen seen_by_points(const Discretisation *space);
Seen seen_by_carriers(const Discretisation *space);
PetscBool sees_follower(const Discretisation *space, const Support *support, PetscInt p);
/* Collective. Takes the ways of those that cannot follow, until all points can do without the others. */
PetscErrorCode ExtensionKeep(const Discretisation *space);
