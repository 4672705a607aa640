/* Nodes beyond a face that a boundary holds are no obstacles of gmm unless they are held as that face is: material
 * never comes there, and a node that may move would be one more in the clouds of the face, which would move with it. */
#include "model/model_private.h"

#define ASIDE 1e-6 /* of a cell: nodes farther apart along an axis are not beside each other */

/* Of each node: is it on a held face that looks that way (-x x -y y -z z), or beyond one; and which axes that face
 * holds. */
enum { SIDES = 6, HOLDS = SIDES, NUMBERS = SIDES + 3 };

typedef struct {
  const Model *m;
  const PetscReal *body; /* n_nodes: > 0 where it is a body's */
  PetscReal *at;         /* n_nodes x NUMBERS, on all copies */
} Faces;

static PetscErrorCode Share(const Grid *mesh, PetscReal *numbers)
{
  PetscFunctionBeginUser;
  PetscCall(GridSumToOwners(mesh, NUMBERS, numbers));
  PetscCall(GridToGhosts(mesh, NUMBERS, numbers));
  PetscFunctionReturn(0);
}

/* Faces of bodies: sides of held nodes on which no cell has material. */
static PetscErrorCode FindFaces(const Faces *f)
{
  const Model *m = f->m;
  const Grid *mesh = m->grid;
  PetscReal centre[3];
  PetscInt last = -1;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt cell = m->points->cell[p];
    if (cell == last) continue;
    last = cell;
    grid_cell_centre(mesh, cell, centre);
    for (PetscInt I = 0; I < mesh->nodes_per_cell; ++I) {
      const PetscInt node = mesh->cell_node[cell * mesh->nodes_per_cell + I];
      for (PetscInt d = 0; d < m->dim; ++d)
        f->at[node * NUMBERS + 2 * d + (centre[d] > mesh->x[node * m->dim + d])] = 1;
    }
  }
  PetscCall(Share(mesh, f->at));
  for (PetscInt node = 0; node < mesh->n_nodes; ++node) {
    PetscReal *at = f->at + node * NUMBERS;
    for (PetscInt d = 0; d < m->dim; ++d) {
      const PetscBool held = (PetscBool)(f->body[node] > 0 && m->boundary->fixed[node * m->dim + d]);
      for (PetscInt k = 2 * d; k < 2 * d + 2; ++k) at[k] = held && !(at[k] > 0);
      at[HOLDS + d] = held;
    }
  }
  PetscFunctionReturn(0);
}

/* Is what a face holds held here, too? */
static PetscBool is_held_as(const Model *m, const PetscReal *face, PetscInt node)
{
  for (PetscInt d = 0; d < m->dim; ++d)
    if (face[HOLDS + d] > 0 && !m->boundary->fixed[node * m->dim + d]) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* What node `from` of a cell is to another one: a face before it, or another one beyond the same face. */
static void look(const Faces *f, PetscInt from, PetscInt to, PetscReal *next)
{
  const PetscInt dim = f->m->dim;
  const PetscReal *face = f->at + from * NUMBERS, *x = f->m->grid->x;
  PetscReal *beyond = next + to * NUMBERS;
  if (f->body[to] > 0 || is_held_as(f->m, face, to)) return;
  for (PetscInt d = 0; d < dim; ++d) {
    const PetscReal off = x[to * dim + d] - x[from * dim + d];
    const PetscInt side = 2 * d + (off > 0);
    if (PetscAbsReal(off) < ASIDE * f->m->grid->smallest || !(face[side] > 0)) continue;
    beyond[side] = 1;
    for (PetscInt k = 0; k < dim; ++k) beyond[HOLDS + k] += face[HOLDS + k];
  }
}

/* One more layer of nodes beyond the faces. */
static PetscErrorCode GoOn(const Faces *f)
{
  const Grid *mesh = f->m->grid;
  const PetscInt nn = mesh->nodes_per_cell;
  PetscReal *next;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * NUMBERS, &next));
  for (PetscInt cell = 0; cell < mesh->n_cells; ++cell)
    for (PetscInt i = 0; i < nn * nn; ++i)
      look(f, mesh->cell_node[cell * nn + i / nn], mesh->cell_node[cell * nn + i % nn], next);
  PetscCall(Share(mesh, next));
  for (PetscInt i = 0; i < mesh->n_nodes * NUMBERS; ++i)
    if (next[i] > 0) f->at[i] = 1;
  PetscCall(PetscFree(next));
  PetscFunctionReturn(0);
}

PetscErrorCode CloudBeyondFaces(const Model *m, const PetscReal *body, unsigned char *beyond)
{
  const Grid *mesh = m->grid;
  const PetscInt layers = 1 + (PetscInt)PetscCeilReal(m->c->basis.radius);
  Faces f = {.m = m, .body = body};

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(mesh->n_nodes * NUMBERS, &f.at));
  PetscCall(FindFaces(&f));
  for (PetscInt k = 0; k < layers; ++k) PetscCall(GoOn(&f));
  for (PetscInt i = 0; i < mesh->n_owned; ++i) {
    beyond[i] = 0;
    for (PetscInt k = 0; k < SIDES && !(body[i] > 0); ++k) beyond[i] |= f.at[i * NUMBERS + k] > 0;
  }
  PetscCall(PetscFree(f.at));
  PetscFunctionReturn(0);
}
