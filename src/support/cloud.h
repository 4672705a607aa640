/* Support of points that each have a cloud of nodes: those near them, chosen by a rule. */
#pragma once
#include "grid/cloud/matter.h"
#include "grid/search/neighbours.h"
#include "support/support.h"

/* How clouds are chosen and what stands in them. */
typedef struct {
  CloudBasis basis;
  CloudSupport support;
  PetscReal h;               /* m: unit of their lengths, where a point has none of its own (POINT_SPACING) */
  PetscBool follows;         /* the stretch of the material? */
  const CloudMatter *matter; /* what joins nodes to a point; NULL: that they are near */
  const PetscReal *start;    /* with it: where nodes were at the start, dim each */
} CloudRule;

/* Where a position's material was at the start. */
typedef struct {
  const PetscReal *from;
  PetscInt field;
} CloudOrigin;

/* Spacing of the nodes around point p at the start, m: its own, or that of all. */
static inline PetscReal cloud_spacing_of(const Points *points, PetscInt p, PetscReal all)
{
  const PetscReal own = points->components[POINT_SPACING] ? points->real[POINT_SPACING][p] : 0;
  return own > 0 ? own : all;
}

/* How clouds follow a point's stretch: along a principal direction of its F in which the material is drawn out by more
 * than a fifth, lengths count by as much less, so that the cloud keeps its nodes (docs/theory.md, "Meshfree bases").
 * NULL where there is none; else `room`, filled. */
const NeighboursMap *cloud_stretch(PetscInt dim, const PetscReal *F, NeighboursMap *room);
/* That of point p; NULL, too, where points have no F, or clouds do not follow. */
const NeighboursMap *cloud_stretch_of(PetscBool follows, const Points *points, PetscInt p, NeighboursMap *room);

/* A cloud for each point, as a group of its own; nodes are numbered as in `nodes`, one for each velocity
 * field. Points without a node near have an empty group. Of the points their places count, their field, and F if they
 * have one. */
PetscErrorCode SupportFromClouds(Support *support, const Points *points, const Neighbours *nodes,
                                 const CloudRule *rule);
/* The cloud of one position: node and N have room for CLOUD_MAX_NODES, dN for dim times that;
 * returns the number of nodes. F: its deformation gradient, or NULL. origin: NULL where nothing tells. */
PetscInt cloud_at(const Neighbours *nodes, const CloudRule *rule, const PetscReal *x, const PetscReal *F,
                  const CloudOrigin *origin, PetscInt *node, PetscReal *N, PetscReal *dN, CloudTally *tally);
