/* One body being seeded, for this room only. */
#pragma once
#include "points/points.h"

#define SEED_MAX_RULE 64
#define SEED_NOTHING 1e-6 /* of a cell */
#define SEED_BEYOND 4e-3  /* of half a cell: so far beyond a surface another body is looked for */

/* Where points stand in a cell. */
typedef struct {
  PetscInt n;
  PetscInt side; /* of points with domains: a lattice of so many a direction; 0: it is none */
  PetscReal xi[3 * SEED_MAX_RULE], weight[SEED_MAX_RULE];
} SeedRule;

#define SEED_PLANES 6 /* most of a part that are told apart */

/* What of a body's surface is plane in a part, as vectors outwards, m2. */
typedef struct {
  PetscInt n;
  PetscReal area[SEED_PLANES][3];
} SeedPlanes;

/* What of a point's part of its cell lies in the body: its share of the cell, and where the
 * middle of that is. */
typedef struct {
  PetscReal share, xi[3], spread[3]; /* spread: mean square of xi about that */
  PetscReal face[3];                 /* the body's surface in it, where that is asked for, as a vector outwards, m2, */
  SeedPlanes planes;                 /* of which this is the sum, */
  PetscReal side[CELL_MOST_SIDES];   /* and along the sides of the cell, should these be surface: which share of each */
  PetscBool whole;                   /* all of the part does */
} SeedPart;

typedef enum { SEED_NONE, SEED_CUT, SEED_WHOLE } SeedFill;
/* Shared: another body that this one sticks to has some of the cell beyond; its shape tells where. */
typedef enum { SIDE_INNER, SIDE_OUTER, SIDE_SHARED } SeedSide;

typedef struct Seeding {
  const Case *c;
  const Grid *grid; /* where the points live */
  PetscBool ready;  /* are its cells known? */
  Diag *diag;
  PetscInt b, field; /* the body, and its velocity field */
  const BodySpec *body;
  PetscInt material;
  const Grid *source;       /* whose cells give the points: the grid, or the body's own mesh, */
  Grid *own;                /* if it has one */
  PetscInt n_cells, *cells; /* local cells of the source that belong to the body */
  PetscInt *cut;            /* n_cells: of one that the body's surface cuts, where its parts begin; else -1 */
  PetscInt n_parts, capacity;
  PetscReal volume;     /* of these cells, or parts, on all ranks */
  SeedPart *part;       /* n_parts */
  unsigned char *outer; /* n_cells x CELL_MOST_SIDES: is it the body's surface? A SeedSide; NULL: nobody asks */
  PetscInt n_mates;     /* shapes of bodies that this one sticks to where they touch: those that fill theirs */
  const Shape **mate;
  SeedRule rule, first_rule; /* for cells of the source's type, and of its first_type */
  PetscBool domains;         /* do the points have some? */
  PetscBool faces;           /* are they to know the part of the body's surface that they stand for? */
  PetscBool equal;           /* `weights: auto` shares cells equally */
  PetscInt64 first_id;
  Outline *outline; /* gets the surface of these cells; NULL: nobody wants it */
} Seeding;

/* Where the points of this cell of the source stand. */
const SeedRule *seed_rule(const Seeding *s, PetscInt cell);
/* Volume that a cell stands for: area times unit thickness, or the full circle. */
PetscReal seed_cell_volume(const Seeding *s, PetscInt cell);

/* --- parts.c, of bodies that fill their shape --- */
SeedFill seed_fill(const Seeding *s, PetscInt cell);
/* Parts of a cell, one for each point of the rule; those without a share have no point. Once
 * measured, the cell may turn out to be whole, or empty. */
SeedFill seed_parts(const Seeding *s, PetscInt cell, const SeedRule *rule, SeedPart *part);

/* --- seams.c: bodies that stick to each other, sharing nodes, have no surface where they touch --- */
/* Finds the shapes of those that it sticks to. */
PetscErrorCode SeedFindMates(Seeding *s);
/* Does one of these hold this position? */
PetscBool seed_is_held(const Seeding *s, const PetscReal *position);
/* Does the body, or one of these? */
PetscBool seed_is_inside(const Seeding *s, const PetscReal *position);
/* Which share of a side of a brick in the reference cell, at its high or low end along axis d, none of these is
 * beyond. */
PetscReal seed_bare(const Seeding *s, CellType type, const PetscReal *x, const PetscReal *low, const PetscReal *high,
                    PetscInt d, PetscBool at_high);
/* Collective. The sides of the cells of all n bodies that are ready which are their surface. */
PetscErrorCode SeedFindSides(Seeding *all, PetscInt n);
/* Those of the k-th cell, with nodes at x, as its point at xi sees them: inner or outer. */
void seed_sides_at(const Seeding *s, PetscInt k, const PetscReal *x, const PetscReal *xi, unsigned char *outer);
/* reach.c. Where the surface cuts a cell, how deep a place is below it: what the shape says of it. Beyond what a whole
 * part has (usual) only who was given the surface that is so near knows it, which comes nearer towards that, or whose
 * whole part, a square or cube, ends there: nobody else stands before it. side: of a whole part. */
PetscReal seed_depth(const Seeding *s, const SeedPart *part, const PetscReal *position, PetscReal usual,
                     PetscReal side);
/* reach.c. The place straight before xi at this side of the cell, `beyond` of the way farther. */
void seed_place_at_side(CellType type, const PetscReal *x, PetscInt side, const PetscReal *xi, PetscReal beyond,
                        PetscReal *position);

/* slivers.c. Points that are next to nothing go to those beside them, or, where a cell has no others, are one: whatever
 * comes first, so that a body and its image in a mirror have the same points. walls: but not those whose surface walls
 * would then press aside of where it is. */
void seed_join_slivers(SeedPart *part, PetscInt n, PetscInt dim, PetscBool walls);
/* planes.c. Adds a piece of surface to that which looks the same way. What there is no room for is bent. */
void seed_add_plane(SeedPlanes *planes, PetscInt dim, const PetscReal *area);
void seed_add_planes(SeedPlanes *planes, PetscInt dim, PetscReal share, const SeedPlanes *more);
/* planes.c. The corner or edge at which planes of the part meet at right angles, from a place in it; PETSC_FALSE: they
 * do not. */
PetscBool seed_corner_of_planes(const Seeding *s, const SeedPlanes *planes, const PetscReal *position, PetscReal most,
                                PetscReal *corner);
/* reach.c. From a place in the body to where it, and bodies that it sticks to, end along a unit vector; `most` at
 * most. */
PetscReal seed_way_out(const Seeding *s, const PetscReal *position, const PetscReal *along, PetscReal most);
/* A surface along the line between two parts is found in the one beyond it, which has nothing of the body: it is that
 * of the nearest one that has. */
void seed_hand_on_faces(SeedPart *part, const SeedRule *rule, PetscInt dim);

/* Half lengths l of the domain of a point at xi, in a cell with nodes at x whose lattice has `side`
 * points a direction; 0: it stands for this part of the section, or of the volume in space. */
void seed_domain(CellType type, const PetscReal *x, const PetscReal *xi, PetscInt side, const PetscReal *spread,
                 PetscReal section, PetscReal *l);

/* Distance of the q-th point of the rule, at `position` in a cell with nodes at x, from the
 * body's surface: of points next to sides that are `outer` (faces of the cell) the nearest of
 * these, but (in no simplex) not more than its part of the cell is wide: beside a far side of a flat cell it is not as
 * near to others. Of points inside that from the nearest side, at most half the side of a square or cube of its part of
 * the section, or of the volume in space. */
PetscReal seed_reach(CellType type, const PetscReal *x, const PetscReal *position, PetscReal section,
                     const SeedRule *rule, PetscInt q, const unsigned char *outer);

/* Half of the sides of a cell along the axes; PETSC_FALSE: it is no rectangle or brick along them. */
PetscBool seed_half_sides(CellType type, const PetscReal *x, PetscReal *half);
/* bricks.c. The side of a quadrilateral or hexahedron that looks along its axis d or against it. */
PetscInt seed_side_of(CellType type, PetscInt d, PetscBool at_high);
/* bricks.c. Is there anything of a body's box in a cell, but for `within` of its sides? PETSC_FALSE: they are no
 * bricks. */
PetscBool seed_box_fill(const Seeding *s, CellType type, const PetscReal *x, PetscReal within, SeedFill *fill);
/* bricks.c. Parts of a cell that a body's box cuts, to round-off; PETSC_FALSE: cell, points and body are no bricks. */
PetscBool seed_box_parts(const Seeding *s, CellType type, const PetscReal *x, const SeedRule *rule, SeedPart *part);
/* Of a part of a rectangle or brick that the surface cuts: to the sides of the body that are its ends along the axes,
 * or to the corner or edge between them; 0 where none is farther than the nearest surface. */
void seed_corner_of_part(const Seeding *s, CellType type, const PetscReal *x, const SeedPart *part,
                         const PetscReal *position, PetscReal reach, const unsigned char *outer, PetscReal *corner);
/* From the same point to these sides, or to the corner or edge where several of them meet at right angles; of others to
 * the nearest; 0 inside. beside: gets the sum of the unit normals of these; NULL: nobody asks. */
void seed_corner(CellType type, const PetscReal *x, const PetscReal *position, const SeedRule *rule, PetscInt q,
                 const unsigned char *outer, PetscReal *corner, PetscReal *beside);

/* The surface of the q-th point of the cell's rule, with nodes at x: that of its part, and what of the sides that are
 * `outer` is that; of one that has all of its part (NULL) the sides that it lies along. */
void seed_face(const Seeding *s, PetscInt cell, const PetscReal *x, PetscInt q, const SeedPart *part,
               const unsigned char *outer, PetscReal *face);

/* Collective. After the cells were chosen: errors for a body without a cell, warnings where whole
 * cells represent the shape badly, or have a single point that leaves them soft. */
PetscErrorCode SeedCheckVolume(Seeding *s);
/* Collective. Can every rank count the numbers of its points with those of this body? An error if
 * not. */
PetscErrorCode SeedCheckRoom(const Seeding *s, const Points *points, PetscBool *fits);
/* overlap.c. Collective. Complains where the body, one of `all` and made of cells of the grid, and one before it have
 * the same place. place: -1 for each local cell of the grid, before and after. */
PetscErrorCode SeedCheckOverlap(const Seeding *all, const Seeding *s, PetscInt *place);
/* Collective. After points of own meshes were located: errors for bodies that reach beyond the
 * grid. */
PetscErrorCode SeedCheckLocated(const Points *points, const Grid *grid, const Case *c, Diag *diag);

/* The path of a key of body number `body`; of the body itself if key is "". */
void seed_path(PetscInt body, const char *key, size_t size, char *path);
/* A mistake that all ranks know is told by one: is it this one? */
PetscBool seed_tells(const Grid *grid);
