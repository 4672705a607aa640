/* State at t = 0: geostatic stress and the first acceleration. */
#include "material/pressure.h"
#include "model/model_private.h"

void gravity_at(const Case *c, PetscReal t, PetscReal g[3])
{
  const PetscReal factor =
    amplitude_value(&c->gravity_amplitude, t, c->analysis.type == ANALYSIS_STATIC ? t / c->analysis.end : 1);
  for (PetscInt d = 0; d < 3; ++d) g[d] = factor * c->gravity[d];
}

/* sigma_v = -density g (surface - height) along gravity, K0 times that across. */
static void geostatic(const Case *c, const BodySpec *body, PetscReal density, PetscInt dim, const PetscReal *x,
                      PetscReal sigma[6])
{
  PetscReal g = 0, height = 0, up[3] = {0, 0, 0};
  for (PetscInt d = 0; d < dim; ++d) g += c->gravity[d] * c->gravity[d];
  g = PetscSqrtReal(g);
  for (PetscInt d = 0; d < dim; ++d) {
    up[d] = g > 0 ? -c->gravity[d] / g : 0;
    height += up[d] * x[d];
  }
  const PetscReal vertical = -density * g * PetscMax(0, body->surface - height), across = body->k0 * vertical;
  for (int k = 0; k < 6; ++k) {
    const int i = voigt_row[k], j = voigt_column[k];
    sigma[k] = (i == j ? across : 0) + (vertical - across) * up[i] * up[j];
  }
}

/* The state's stress is tau = J sigma, with the J of its own compression: the point's F and undeformed volume take the same J, so that
 * it keeps the volume that it was seeded with. */
static void compress(Points *points, PetscInt p, const Material *material, const PetscReal sigma[6])
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscReal *old = point_real(points, POINT_STATE, p), state[LAW_MAX_STATE], tau[6], F[9], work = 0, norm2 = 0;
  material->law->update(material->parameters, 1, identity, old, state, tau, NULL);
  for (int k = 0; k < 6; ++k) {
    work += tau[k] * sigma[k];
    norm2 += sigma[k] * sigma[k];
  }
  if (norm2 == 0) return;
  if (points->components[POINT_PRESSURE]) points->real[POINT_PRESSURE][p] = pressure_of_state(material, old, tau);
  const PetscReal J = work / norm2, stretch = PetscPowReal(J, 1.0 / 3.0);
  for (int i = 0; i < 9; ++i) F[i] = stretch * identity[i];
  point_set_F(points, p, F);
  points->real[POINT_J][p] = J;
  points->real[POINT_VOLUME][p] /= J;
}

/* Shape alone carries the deviator, the pressure the mean: nothing is compressed. */
static PetscBool stress_incompressible(Points *points, PetscInt p, const Material *material, PetscReal sigma[6])
{
  const PetscReal mean = (sigma[0] + sigma[1] + sigma[2]) / 3;
  for (int k = 0; k < 3; ++k) sigma[k] -= mean;
  points->real[POINT_PRESSURE][p] = mean;
  return material->law->initial_stress(material->deviatoric, sigma, point_real(points, POINT_STATE, p));
}

static PetscBool stress_point(Points *points, PetscInt p, const Material *material, PetscReal sigma[6])
{
  if (!material->law->initial_stress) return PETSC_FALSE;
  if (points->components[POINT_PRESSURE] && material->compliance == 0)
    return stress_incompressible(points, p, material, sigma);
  if (!material->law->initial_stress(material->parameters, sigma, point_real(points, POINT_STATE, p)))
    return PETSC_FALSE;
  compress(points, p, material, sigma);
  return PETSC_TRUE;
}

PetscErrorCode InitialStress(Model *m, Diag *diag)
{
  PetscInt failed = -1;
  char path[64];

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const BodySpec *body = &m->c->bodies[m->points->body[p]];
    const Material *material = &m->materials[m->points->material[p]];
    PetscReal sigma[6];
    if (!body->has_k0) continue;
    geostatic(m->c, body, material->density, m->dim, point_real(m->points, POINT_X, p), sigma);
    if (!stress_point(m->points, p, material, sigma)) failed = m->points->body[p];
  }
  if (failed >= 0) {
    PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].k0", (int)failed));
    DiagError(diag, path, "the material's law cannot carry this initial stress");
  }
  PetscFunctionReturn(0);
}

PetscErrorCode InitialAcceleration(Model *m)
{
  const PetscInt dim = m->dim, dofs = m->grid->n_nodes * dim;
  Stage *s = m->stage;
  PetscReal g[3];

  PetscFunctionBeginUser;
  gravity_at(m->c, 0, g);
  PetscCall(PetscArrayzero(m->du, dofs));
  PetscCall(PetscArrayzero(m->external, dofs));
  for (PetscInt i = 0; i < dofs; ++i) m->history[i] = -g[i % dim];
  PetscCall(LoadsAdd(m->loads, m->grid, 0, s->filled, s->touched, m->external));
  PetscCall(AddBodyForce(m, 0, m->external));
  PetscCall(PetscArrayzero(m->force, dofs));
  pressure_guess(m);
  WeakFormInput in = weak_form_of(m, 0);
  WeakFormOutput out = {.force = m->force};
  PetscCall(m->formulation->assemble(&in, &out));
  PetscCall(GridSumToOwners(m->grid, dim, m->force));
  for (PetscInt i = 0; i < m->grid->n_owned * dim; ++i) {
    const PetscReal mass = s->mass[i / dim];
    const PetscReal free = m->external[i] - m->force[i];
    s->a[i] = mass > 1e-300 && !m->boundary->fixed[i] ? free / mass : 0;
    m->held[i] = m->rate[i] = m->boundary->fixed[i] ? -free : 0;
  }
  PetscCall(GridToGhosts(m->grid, dim, s->a));
  for (PetscInt q = 0; q < s->support->n_groups; ++q) {
    const PetscInt nn = support_nodes(s->support, q), *node = s->support->node + s->support->node_start[q];
    for (PetscInt p = s->support->point_start[q]; p < s->support->point_start[q + 1]; ++p)
      for (PetscInt i = 0; i < nn * dim; ++i)
        point_real(m->points, POINT_A, p)[i % dim] +=
          support_N(s->support, q, p)[i / dim] * s->a[node[i / dim] * dim + i % dim];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelSetBodyForce(Model *m, BodyForce force, void *context)
{
  PetscFunctionBeginUser;
  m->body_force = force;
  m->body_force_context = context;
  if (m->step > 0 || m->c->analysis.type != ANALYSIS_DYNAMIC) PetscFunctionReturn(0);
  PetscCall(PetscArrayzero(m->points->real[POINT_A], m->points->n * m->dim));
  PetscCall(InitialAcceleration(m));
  PetscFunctionReturn(0);
}
