/* An entry of the boundary that holds one of two bodies at an interface where the other stands, and nowhere else: its
 * place was drawn for the other one, whose surface is its end. What should slide there hangs on its own nodes. */
#include "base/gather.h"
#include "model/model_private.h"

#define ONE_PLACE 1e-6 /* of a cell */

/* A node that the entry takes and a body of the interface touches. */
typedef struct {
  PetscReal along; /* a line that hardly any two nodes share a plane across, m */
  PetscReal x[3];
  int of; /* 0: the first body, 1: the second */
} HeldNode;

static int compare_along(const void *a, const void *b)
{
  const HeldNode *p = a, *q = b;
  return p->along < q->along ? -1 : p->along > q->along;
}

static HeldNode held_node(const Grid *grid, PetscInt node, int of)
{
  static const PetscReal line[3] = {0.7548776662, 0.5698402910, 0.3247179572};
  HeldNode held = {.of = of};
  for (PetscInt d = 0; d < grid->dim; ++d) {
    held.x[d] = grid->x[node * grid->dim + d];
    held.along += line[d] * held.x[d];
  }
  return held;
}

static PetscBool at_one_place(const HeldNode *a, const HeldNode *b, PetscReal reach)
{
  for (int d = 0; d < 3; ++d)
    if (PetscAbsReal(a->x[d] - b->x[d]) > reach) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* count: how many nodes each body has; alone: of them those where the other one has none. */
static void count_alone(PetscInt n, const HeldNode *held, PetscReal reach, PetscInt count[2], PetscInt alone[2])
{
  for (PetscInt k = 0; k < n; ++k) {
    PetscBool other = PETSC_FALSE;
    for (int way = -1; way <= 1; way += 2)
      for (PetscInt j = k + way; j >= 0 && j < n && PetscAbsReal(held[j].along - held[k].along) <= 3 * reach; j += way)
        other |= held[j].of != held[k].of && at_one_place(held + j, held + k, reach);
    ++count[held[k].of];
    alone[held[k].of] += !other;
  }
}

static void tell(PetscInt entry, const InterfaceSpec *s, int of, PetscInt n, Diag *diag)
{
  const char *body = s->between[of], *other = s->between[1 - of];
  char path[64];
  snprintf(path, sizeof path, "boundary[%d]", (int)entry);
  diag_warning(diag, path,
               "boundary[%d] takes nodes of '%s' (%d), all of them where it takes '%s', which '%s' meets at interface "
               "'%s': '%s' hangs on them",
               (int)entry, body, (int)n, other, body, s->name, body);
  diag_hint(diag, "bodies: [%s] takes '%s' alone, and '%s' slides", other, other, body);
}

/* touched: by each body of the interface. */
static PetscErrorCode LookAt(Model *m, PetscInt entry, const InterfaceSpec *s, PetscReal *const touched[2], Diag *diag)
{
  const MotionNodes *nodes = m->boundary->motion + entry;
  PetscInt n = 0, n_all, count[2] = {0, 0}, alone[2] = {0, 0};
  HeldNode *mine, *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * nodes->n, &mine));
  for (PetscInt k = 0; k < 2 * nodes->n; ++k) {
    const PetscInt node = nodes->node[k / 2];
    if (node < m->grid->n_owned && touched[k % 2][node] > 0) mine[n++] = held_node(m->grid, node, k % 2);
  }
  PetscCall(GatherAll(m->comm, sizeof *mine, n, mine, &n_all, &all));
  qsort(all, (size_t)n_all, sizeof *all, compare_along);
  count_alone(n_all, all, ONE_PLACE * m->grid->smallest, count, alone);
  for (int of = 0; of < 2; ++of)
    if (count[of] && !alone[of] && alone[1 - of]) {
      tell(entry, s, of, count[of], diag);
      m->hangs = PETSC_TRUE;
    }
  PetscCall(PetscFree(mine));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseHangs(Model *m, Diag *diag)
{
  PetscReal *touched[2];

  PetscFunctionBeginUser;
  if (!m->c->n_interfaces || !m->c->n_boundary || m->hangs) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(m->grid->n_nodes, &touched[0], m->grid->n_nodes, &touched[1]));
  for (PetscInt i = 0; i < m->c->n_interfaces; ++i) {
    const InterfaceSpec *s = m->c->interfaces + i;
    if (s->contact == CONTACT_BONDED) continue; /* what holds one holds the other */
    for (int of = 0; of < 2; ++of) PetscCall(BodyTouches(m, case_body(m->c, s->between[of]), touched[of]));
    for (PetscInt k = 0; k < m->c->n_boundary; ++k)
      if (!m->c->boundary[k].n_bodies) PetscCall(LookAt(m, k, s, touched, diag));
  }
  PetscCall(PetscFree2(touched[0], touched[1]));
  PetscFunctionReturn(0);
}
