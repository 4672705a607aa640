/* Pressures that follow the surface they act on. A carrier holds the force f on its part of the surface as
 * that is when the step begins; increments turn and stretch it (Nanson),
 *
 *   f(du) = J dF^-T f,    dF = 1 + sum_I du_I dN_I,
 *
 * of which only motion along the surface counts. Moved by a variation d it changes by
 * f div d - (grad d)^T f: a tangent that is not symmetric. */
#include "base/math/tensor.h"
#include "solve/forces/nodal_force.h"

/* Of one carrier in this step. */
typedef struct {
  PetscInt carrier;
  PetscInt first, n; /* its nodes, of the list below */
  PetscInt slot;     /* and the first of their n x n pairs */
} Pushed;

typedef struct {
  const Loads *loads;
  PetscBool hoop;
  PetscInt n, n_nodes, n_slots;
  PetscInt capacity, capacity_nodes, capacity_slots;
  Pushed *pushed;
  PetscInt *node, *slot;
  PetscReal *N, *M, *dN; /* n_nodes, n_nodes x 3: those of CarrierShape */
  PetscBool asked;       /* for factors in this step */
  PetscReal t;           /* when, s */
  PetscReal *factor;     /* those that a caller gives, a carrier 3, the first counts; NULL: none */
} Pressures;

static PetscErrorCode Reserve(Pressures *s, PetscInt nodes)
{
  PetscFunctionBeginUser;
  if (s->n == s->capacity) {
    s->capacity += s->capacity / 2 + 64;
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->pushed, &s->pushed));
  }
  if (s->n_nodes + nodes > s->capacity_nodes) {
    s->capacity_nodes += s->capacity_nodes / 2 + nodes + 256;
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->node, &s->node));
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->N, &s->N));
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->M, &s->M));
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * 3 * sizeof *s->dN, &s->dN));
  }
  if (s->n_slots + nodes * nodes > s->capacity_slots) {
    s->capacity_slots += s->capacity_slots / 2 + nodes * nodes + 1024;
    PetscCall(PetscRealloc((size_t)s->capacity_slots * sizeof *s->slot, &s->slot));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Add(Pressures *s, const NodalScene *scene, PetscInt p)
{
  CarrierShape shape;

  PetscFunctionBeginUser;
  carrier_shape(s->loads, scene->grid, p, scene->touched, &shape);
  const PetscInt nn = shape.n;
  if (!nn) PetscFunctionReturn(0);
  PetscCall(Reserve(s, nn));
  s->pushed[s->n++] = (Pushed){.carrier = p, .first = s->n_nodes, .n = nn, .slot = s->n_slots};
  for (PetscInt I = 0, e = s->n_nodes; I < nn; ++I, ++e) {
    s->node[e] = shape.node[I];
    s->N[e] = shape.N[I];
    s->M[e] = shape.M[I];
    for (PetscInt d = 0; d < 3; ++d) s->dN[3 * e + d] = shape.dN[3 * I + d];
  }
  s->n_nodes += nn;
  s->n_slots += nn * nn;
  PetscFunctionReturn(0);
}

static PetscErrorCode Begin(void *data, const NodalScene *scene)
{
  Pressures *s = data;
  const Points *carriers = s->loads->carriers;

  PetscFunctionBeginUser;
  s->n = s->n_nodes = s->n_slots = 0;
  s->asked = PETSC_FALSE;
  for (PetscInt p = 0; p < carriers->n; ++p)
    if (scene->c->loads[carriers->body[p]].kind == LOAD_PRESSURE && carrier_pushes(s->loads, p))
      PetscCall(Add(s, scene, p));
  PetscFunctionReturn(0);
}

/* Those that wait for a later stage have to know their surface by then. */
static PetscBool any_is_carried(const Loads *loads)
{
  for (PetscInt k = 0; k < loads->c->n_loads; ++k)
    if (loads->c->loads[k].kind == LOAD_PRESSURE) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The first acceleration comes before the first step. */
static PetscErrorCode Create(const NodalScene *scene, Diag *diag, void **data)
{
  Pressures *s;

  (void)diag;
  PetscFunctionBeginUser;
  if (!any_is_carried(scene->loads)) PetscFunctionReturn(0);
  PetscCall(PetscNew(&s));
  s->loads = scene->loads;
  s->hoop = scene->c->kinematics->hoop;
  *data = s;
  PetscCall(Begin(s, scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode Destroy(void **data)
{
  Pressures *s = *data;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->pushed));
  PetscCall(PetscFree(s->node));
  PetscCall(PetscFree(s->slot));
  PetscCall(PetscFree(s->N));
  PetscCall(PetscFree(s->M));
  PetscCall(PetscFree(s->dN));
  PetscCall(PetscFree(s->factor));
  PetscCall(PetscFree(*data));
  PetscFunctionReturn(0);
}

static PetscErrorCode Couple(const void *data, const NodalScene *scene, NodeGroups *groups)
{
  const Pressures *s = data;

  (void)scene;
  PetscFunctionBeginUser;
  for (const Pushed *c = s->pushed; c < s->pushed + s->n; ++c)
    PetscCall(NodeGroupsAdd(groups, c->n, s->node + c->first));
  PetscFunctionReturn(0);
}

static PetscBool find_slots(void *data, const System *system)
{
  Pressures *s = data;
  PetscInt missing = 0;
  for (const Pushed *c = s->pushed; c < s->pushed + s->n; ++c)
    missing += !nodal_find_slots(system, c->n, s->node + c->first, s->slot + c->slot);
  return !missing;
}

/* Force on the carrier's surface after the increments, and dF^-1; *radius: of the ring by then. */
static void follow(const Pressures *s, const Pushed *c, const PetscReal *du, PetscReal f[3], PetscReal inverse[9],
                   PetscReal *radius)
{
  const PetscInt dim = s->loads->dim;
  const PetscReal *held = point_real(s->loads->carriers, POINT_FORCE, c->carrier);
  PetscReal F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, x[3];
  point_place(s->loads->carriers, c->carrier, x);
  *radius = x[0];
  for (PetscInt e = c->first; e < c->first + c->n; ++e) {
    const PetscReal *u = du + s->node[e] * dim;
    for (PetscInt i = 0; i < dim; ++i)
      for (PetscInt j = 0; j < dim; ++j) F[3 * i + j] += u[i] * s->dN[3 * e + j];
    *radius += s->M[e] * u[0];
  }
  if (s->hoop) F[8] = *radius / x[0];
  const PetscReal J = tensor_inverse(F, inverse);
  for (int i = 0; i < 3; ++i) {
    f[i] = 0;
    for (PetscInt j = 0; j < dim; ++j) f[i] += J * inverse[3 * j + i] * held[j];
  }
}

static void add_tangent(const Pressures *s, const Pushed *c, const PetscReal f[3], const PetscReal inverse[9],
                        PetscReal radius, const NodalOutput *out)
{
  const PetscInt dim = s->loads->dim;
  for (PetscInt J = 0; J < c->n; ++J) {
    const PetscReal *dN = s->dN + 3 * (c->first + J);
    PetscReal g[3], K[9], ring[3] = {s->hoop ? s->M[c->first + J] / radius : 0, 0, 0};
    for (int i = 0; i < 3; ++i) g[i] = inverse[i] * dN[0] + inverse[3 + i] * dN[1] + inverse[6 + i] * dN[2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) K[3 * i + j] = f[i] * (g[j] + ring[j]) - g[i] * f[j];
    for (PetscInt I = 0; I < c->n; ++I)
      nodal_add_tangents(out, dim, s->slot[c->slot + I * c->n + J], -s->N[c->first + I], K);
  }
}

/* Carriers stay where they are until the step is committed: once for each time is enough. */
static PetscErrorCode AskFactors(Pressures *s, PetscReal t)
{
  PetscFunctionBeginUser;
  if (s->asked && s->t == t) PetscFunctionReturn(0);
  PetscCall(PetscFree(s->factor));
  PetscCall(LoadFactorsOfCarriers(s->loads, PETSC_TRUE, t, &s->factor));
  s->asked = PETSC_TRUE;
  s->t = t;
  PetscFunctionReturn(0);
}

static PetscErrorCode Assemble(void *data, const NodalScene *scene, const NodalOutput *out)
{
  Pressures *s = data;
  const PetscInt dim = s->loads->dim;
  PetscReal f[3], inverse[9], radius;

  PetscFunctionBeginUser;
  PetscCall(AskFactors(s, scene->t));
  for (const Pushed *c = s->pushed; c < s->pushed + s->n; ++c) {
    const LoadSpec *load = scene->c->loads + s->loads->carriers->body[c->carrier];
    const PetscReal factor =
      case_factor(scene->c, &load->amplitude, scene->t) * (s->factor ? s->factor[3 * c->carrier] : 1);
    follow(s, c, scene->du, f, inverse, &radius);
    for (int d = 0; d < 3; ++d) f[d] *= factor;
    for (PetscInt e = c->first; e < c->first + c->n; ++e)
      for (PetscInt d = 0; d < dim; ++d) out->force[s->node[e] * dim + d] -= s->N[e] * f[d];
    if (out->system) add_tangent(s, c, f, inverse, radius, out);
  }
  PetscFunctionReturn(0);
}

/* Carriers take the force on the surface of the step's end along, if this is where the next step finds it. */
static PetscErrorCode Commit(void *data, const NodalScene *scene)
{
  const Pressures *s = data;
  PetscReal f[3], inverse[9], radius;

  PetscFunctionBeginUser;
  if (scene->stays) PetscFunctionReturn(0);
  for (const Pushed *c = s->pushed; c < s->pushed + s->n; ++c) {
    follow(s, c, scene->du, f, inverse, &radius);
    for (PetscInt d = 0; d < s->loads->dim; ++d) point_real(s->loads->carriers, POINT_FORCE, c->carrier)[d] = f[d];
  }
  PetscFunctionReturn(0);
}

const NodalForce nodal_force_pressures = {
  .name = "pressures",
  .help = "pressures along the present normal of a surface",
  .create = Create,
  .destroy = Destroy,
  .begin = Begin,
  .couple = Couple,
  .find_slots = find_slots,
  .assemble = Assemble,
  .commit = Commit,
};
