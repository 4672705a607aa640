/* Nodes that loads act on and that have next to no mass follow those inside the body, since nobody else can bear the
 * force: what they have goes to those, which give them their motion (docs/theory.md, "Loads beside the points"). */
#include "method/extend/extend.h"
#include "model/explicit/explicit.h"

PetscErrorCode Lead(Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  e->led = PETSC_FALSE;
  if (!loads_have_pieces(m->loads) || !m->loads->support) PetscFunctionReturn(0);
  PetscCall(ExtensionByMass(m->space, e->n_active, e->active, e->width, e->sum, &e->led));
  for (PetscInt k = 0; e->led && k < e->n_active; ++k) e->bare[e->active[k]] = e->sum[e->active[k] * e->width];
  PetscFunctionReturn(0);
}

PetscBool is_led(const Model *m, const Explicit *e, PetscInt node)
{
  return (PetscBool)(e->led && m->space->extension->ways[node] > 0);
}

PetscErrorCode NodesGive(const Model *m, const Explicit *e, PetscInt components, PetscReal *sum)
{
  PetscFunctionBeginUser;
  if (e->led) PetscCall(ExtensionGive(m->space, components, sum));
  PetscFunctionReturn(0);
}

PetscErrorCode NodesTake(const Model *m, const Explicit *e, PetscInt components, PetscReal *field)
{
  PetscFunctionBeginUser;
  if (e->led) PetscCall(ExtensionTake(m->space, components, field));
  PetscFunctionReturn(0);
}

static PetscReal velocity(const Explicit *e, PetscInt node, PetscReal momentum)
{
  return e->bare[node] > 1e-300 ? momentum / e->bare[node] : 0;
}

/* Where points lean, a node's velocity is that of its place, and mass that is handed to a node comes with that of its
 * new place: of a linear field no node's velocity changes. All that a follower's is beside it goes to them with its
 * mass, so that momentum stays. */
static PetscErrorCode GiveLeaning(const Model *m, const Explicit *e, PetscReal *momentum)
{
  const PetscInt dim = m->dim;
  PetscReal *v = e->apart + m->grid->n_nodes * dim, *of = v + m->grid->n_nodes * dim;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < e->n_active; ++k)
    for (PetscInt d = 0, i = e->active[k] * dim; d < dim; ++d, ++i) of[i] = v[i] = velocity(e, i / dim, momentum[i]);
  PetscCall(ExtensionTake(m->space, dim, of));
  for (PetscInt k = 0; k < e->n_active; ++k)
    for (PetscInt d = 0, i = e->active[k] * dim; d < dim; ++d, ++i)
      if (is_led(m, e, i / dim)) momentum[i] -= e->bare[i / dim] * of[i];
  PetscCall(ExtensionGive(m->space, dim, momentum));
  for (PetscInt k = 0; k < e->n_active; ++k)
    for (PetscInt d = 0, i = e->active[k] * dim; d < dim; ++d, ++i)
      if (!is_led(m, e, i / dim)) momentum[i] += (e->sum[i / dim * e->width] - e->bare[i / dim]) * v[i];
  PetscFunctionReturn(0);
}

PetscErrorCode MomentumGive(const Model *m, const Explicit *e, PetscReal *momentum)
{
  PetscFunctionBeginUser;
  if (e->led && e->slopes) PetscCall(GiveLeaning(m, e, momentum));
  else PetscCall(NodesGive(m, e, m->dim, momentum));
  PetscFunctionReturn(0);
}

/* Momentum of `sum` to `apart` (n_nodes x dim), or back. */
static void part(const Model *m, const Explicit *e, PetscBool back, PetscReal *apart)
{
  for (PetscInt k = 0; k < e->n_active; ++k)
    for (PetscInt d = 0; d < m->dim; ++d) {
      PetscReal *one = apart + e->active[k] * m->dim + d, *all = e->sum + e->active[k] * e->width + 1 + d;
      *(back ? all : one) = *(back ? one : all);
    }
}

PetscErrorCode SumsGive(const Model *m, Explicit *e)
{
  PetscFunctionBeginUser;
  if (!e->led) PetscFunctionReturn(0);
  part(m, e, PETSC_FALSE, e->apart);
  PetscCall(NodesGive(m, e, e->width, e->sum));
  PetscCall(MomentumGive(m, e, e->apart));
  part(m, e, PETSC_TRUE, e->apart);
  PetscFunctionReturn(0);
}
