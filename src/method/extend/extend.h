/* Nodes that domains of points all but miss follow those inside the body (docs/theory.md, "Nodes that follow"), in a
 * box whose points are groups of their own. */
#pragma once
#include "method/discretisation.h"

typedef struct Extension {
  PetscReal *fill;        /* n_nodes: volume of the material around the node, of half its share of the cells */
  PetscReal *loaded;      /* n_nodes: does a piece of a loaded surface see it? */
  PetscReal *leads;       /* n_nodes: bits of leads_bit */
  PetscReal *ways;        /* n_nodes: bits of the ways on which the node follows; 0: it does not */
  PetscInt *place;        /* n_nodes: in the block of the nodes that this rank knows */
  Support *spare;         /* the support as the basis left it, in the last step in which nodes followed */
  Support *carried;       /* what carriers of loads see, where they push by the basis's functions, */
  Support *spare_carried; /* and the same as the basis left it */
  Support *traced;        /* what tracers see, of a basis whose functions are those of places; followers among it */
  PetscBool any;          /* does a node follow, on any rank? */
} Extension;

PetscErrorCode ExtensionDestroy(Extension **extension);
/* May nodes follow? Not in the mixed formulation and in explicit dynamics; where nobody asks for it
 * (stabilisation.follow), those alone that loads on a surface act on. */
PetscBool extension_works(const Discretisation *space);
/* Collective. Of a support that the basis has just filled, with `in`: what each node has; those with less than
 * stabilisation.follow (a tenth where loads act) follow others, if these stand near enough, and vanish from it. */
PetscErrorCode DiscretisationExtend(Discretisation *space, const BasisInput *in);
/* What carriers of loads and tracers see where they are now, of a basis whose functions are theirs, too; nothing of
 * others. Once points have been extended. */
PetscErrorCode DiscretisationCarry(Discretisation *space, const BasisInput *in);
/* Basis.bends of a point on the n nodes that it sees, n x dim; PETSC_FALSE: its functions do not bend. space: a
 * Discretisation. */
PetscBool extension_bends(const void *space, PetscInt p, PetscInt n, PetscReal *bend);
/* The functions by which the field moves these: tracers or carriers, of such a basis; NULL: those of their cells. */
const Support *followers_see(const Discretisation *space, const Points *followers);
/* Collective. du, v1 and a1 of nodes that follow, for tracers. */
PetscErrorCode DiscretisationFollow(Discretisation *space);
