/* Nodes that cannot follow, since a point that sees them would see others too far away. */
#pragma once
#include "method/extend/extend.h"

/* Points, or carriers of loads, and what they see. */
typedef struct {
  const Points *points;
  const Support *support;
  PetscInt slopes;    /* numbers of dN a node */
  const Loads *loads; /* of carriers; NULL: points */
} Seen;

Seen seen_by_points(const Discretisation *space);
Seen seen_by_carriers(const Discretisation *space);
/* Does it see followers, so that it has to do with those that lead? Carriers that push nothing go on to see them: they
 * only move, and followers move as those that lead them say. */
PetscBool changes_row(const Discretisation *space, const Seen *seen, PetscInt p);
/* Collective. Takes the ways of those that cannot follow, until all points can do without the others. */
PetscErrorCode ExtensionKeep(const Discretisation *space);
