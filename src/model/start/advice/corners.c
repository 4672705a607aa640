/* Material in a corner of a wall: each point meets one place of each wall, so that the body's own corner is held by one
 * of both sides there, and what is near bears too little. Walls of their own for the sides do not know this. */
#include "base/text.h"
#include "model/model_private.h"
#include "solve/contact/contact.h"

#define TURNS 0.7    /* cosine between normals: sides that meet at more than 45 degrees */
#define STEP 0.5     /* of a point's reach: as far beside it the other side must be the nearer one */
#define TOUCHES 1.05 /* of its reach: so near to a side it ends there */

/* Does the surface of p end at another side, which is what a place beside it along the first side is nearest to? */
static PetscBool meets_side(const Model *m, PetscInt k, PetscInt p, const WallPlace *place, const PetscReal along[3])
{
  const PetscReal *x = point_real(m->points, POINT_X, p), reach = contact_reach_of(m->points, p, place->normal);
  const PetscReal step = STEP * reach;
  PetscReal beside[3] = {0, 0, 0}, turn = 0, way = 0;
  WallPlace other;
  for (PetscInt d = 0; d < m->dim; ++d) beside[d] = x[d] + step * along[d];
  const int side = wall_side(m->walls, k, m->time, beside);
  if (!wall_near(m->walls, k, m->time, beside, 2 * reach, side, &other)) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) turn += other.normal[d] * place->normal[d], way -= step * along[d] * other.normal[d];
  if (turn > TURNS || other.gap > place->gap * (1 - 1e-6)) return PETSC_FALSE;
  return (PetscBool)(other.gap + way <= TOUCHES * contact_reach_of(m->points, p, other.normal));
}

static PetscBool is_in_corner(const Model *m, PetscInt k, PetscInt p)
{
  const PetscReal *x = point_real(m->points, POINT_X, p);
  const int side = wall_side(m->walls, k, m->time, x);
  WallPlace place;
  if (!wall_near(m->walls, k, m->time, x, contact_farthest(m->points, p), side, &place)) return PETSC_FALSE;
  if (place.gap > TOUCHES * contact_reach_of(m->points, p, place.normal)) return PETSC_FALSE;
  for (PetscInt d = 0; d < m->dim; ++d)
    for (int sign = -1; sign <= 1; sign += 2) {
      PetscReal along[3] = {0, 0, 0}, square = 0;
      for (int i = 0; i < 3; ++i) {
        along[i] = sign * ((i == d) - place.normal[d] * place.normal[i]);
        square += along[i] * along[i];
      }
      if (square < 0.25) continue; /* next to the normal */
      for (int i = 0; i < 3; ++i) along[i] /= PetscSqrtReal(square);
      if (meets_side(m, k, p, &place, along)) return PETSC_TRUE;
    }
  return PETSC_FALSE;
}

/* Collective. The first elastic point in a corner of wall k, on the first rank that has one. */
static PetscErrorCode FindInCorner(const Model *m, PetscInt k, PetscBool *found, PetscReal x[3])
{
  PetscMPIInt rank, owner;
  PetscInt p = 0;

  PetscFunctionBeginUser;
  while (p < m->points->n && (m->materials[m->points->material[p]].law->yields || !is_in_corner(m, k, p))) ++p;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  owner = p < m->points->n ? rank : PETSC_MPI_INT_MAX;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &owner, 1, MPI_INT, MPI_MIN, m->comm));
  *found = (PetscBool)(owner < PETSC_MPI_INT_MAX);
  if (rank == owner) point_place(m->points, p, x);
  if (*found) PetscCallMPI(MPI_Bcast(x, 3, MPIU_REAL, owner, m->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseCorners(const Model *m, Diag *diag)
{
  char path[64], where[80];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < m->c->n_walls; ++k) {
    PetscReal x[3] = {0, 0, 0};
    PetscBool found = PETSC_FALSE;
    if (!m->c->walls[k].absent) PetscCall(FindInCorner(m, k, &found, x));
    if (!found) continue;
    PetscCall(PetscSNPrintf(path, sizeof path, "walls[%d]", (int)k));
    diag_warning(diag, path,
                 "a body fills a corner of wall '%s', at %s m: there it meets one of the two sides only, and stresses "
                 "within a cell or two are too small by a third and more",
                 m->c->walls[k].name, text_position(m->dim, x, where));
    diag_hint(diag, "sides that are walls of their own (half-spaces) both hold it");
  }
  PetscFunctionReturn(0);
}
