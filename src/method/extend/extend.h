/* Nodes that domains of points all but miss follow those inside the body (docs/theory.md, "Nodes that follow"), in a
 * box whose points are groups of their own. */
#pragma once
#include "grid/partition/partition.h"
#include "method/discretisation.h"

/* Of nodes beside one: how many steps along each axis, downwards and upwards. */
typedef struct {
  signed char low[3], high[3];
  signed char unknown; /* not all of them are known to this rank */
} Extent;

typedef struct Extension {
  /* n_nodes: volume of the material around the node, of half its share of the cells; by_mass: mass over that share, to
   * be compared with the nodes around */
  PetscReal *fill;
  PetscBool by_mass;
  PetscReal *lean;            /* n_nodes, by_mass: see row_add_way */
  PetscReal *loaded;          /* n_nodes: does a piece of a loaded surface see it? */
  PetscReal *leads;           /* n_nodes: bits of leads_bit */
  PetscReal *ways;            /* n_nodes: bits of the ways on which the node follows; 0: it does not */
  PetscInt (*place)[LATTICE]; /* n_nodes: in the box */
  Extent *extent;             /* n_nodes: of what has its place once followers are gone */
  Support *spare;             /* the support as the basis left it, in the last step in which nodes followed */
  Support *carried;           /* what carriers of loads see, where they push by the basis's functions, */
  Support *spare_carried;     /* and the same as the basis left it */
  Support *traced;            /* what tracers see, of a basis whose functions are those of places; followers among it */
  PetscBool any;              /* does a node follow, on any rank, so that points and carriers do not see it any more? */
  PetscInt n_followers, *follower;     /* nodes with ways */
  PetscInt n_listed, *listed, *beside; /* by_mass: nodes that loads act on, and those around them */
} Extension;

PetscErrorCode ExtensionDestroy(Extension **extension);
/* May nodes vanish from what points see? Not in the mixed formulation and in explicit dynamics (ExtensionByMass); where
 * nobody asks for it (stabilisation.follow), those alone that loads on a surface act on. */
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
/* Collective. fold.c: explicit dynamics. Among the nodes that points can reach (active, ghosts too, those around the
 * same on all ranks) those that pieces of a loaded surface see and that have next to no mass follow; mass: with
 * `stride` numbers a node, on all copies. *any: on any rank. */
PetscErrorCode ExtensionByMass(Discretisation *space, PetscInt n, const PetscInt *active, PetscInt stride,
                               const PetscReal *mass, PetscBool *any);
/* Collective. Takes the ways of followers that would leave a node behind next to no volume, and so no mass, of its own:
 * the opposite corners of two cells' width have as much as each other. */
PetscErrorCode ExtensionSpare(const Discretisation *space);
/* Collective. n numbers a node, on all copies before and after: those of followers go to the nodes that they follow,
 * and are 0; followers take what these have. */
PetscErrorCode ExtensionGive(const Discretisation *space, PetscInt n, PetscReal *sum);
PetscErrorCode ExtensionTake(const Discretisation *space, PetscInt n, PetscReal *field);
/* Collective. Lists nodes with ways, of n nodes (NULL: the first). *any: is there one, on any rank? */
PetscErrorCode ExtensionList(const Discretisation *space, PetscInt n, const PetscInt *among, PetscBool *any);
/* Collective. The nodes that pieces of a loaded surface see; ghosts too. */
PetscErrorCode ExtensionLoaded(const Discretisation *space);
/* The functions by which the field moves these: tracers or carriers, of such a basis; NULL: those of their cells. */
const Support *followers_see(const Discretisation *space, const Points *followers);
/* Collective. du, v1 and a1 of nodes that follow, for tracers. */
PetscErrorCode DiscretisationFollow(Discretisation *space);
