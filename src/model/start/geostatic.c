/* Geostatic stress at t = 0: that of the material really above each point, under the gravity of t =
 * 0. */
#include "material/pressure.h"
#include "model/model_private.h"

/* Gravity at the start: its size, and the direction against it. */
typedef struct {
  PetscReal g, up[3];
} Upwards;

static Upwards upwards(const Case *c)
{
  Upwards u = {0};
  PetscReal g[3];
  gravity_at(c, 0, g);
  u.g = PetscSqrtReal(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  for (int d = 0; d < 3 && u.g > 0; ++d) u.up[d] = -g[d] / u.g;
  return u;
}

/* sigma_v = -g times the mass above per area, along gravity, K0 times that across. */
static void geostatic(const Upwards *u, PetscReal k0, PetscReal above, PetscReal sigma[6])
{
  const PetscReal vertical = -u->g * above, across = k0 * vertical;
  for (int k = 0; k < 6; ++k) {
    const int i = voigt_row[k], j = voigt_column[k];
    sigma[k] = (i == j ? across : 0) + (vertical - across) * u->up[i] * u->up[j];
  }
}

/* The state's stress is tau = J sigma, with the J of its own compression: the point's F and
 * undeformed volume take the same J, so that it keeps the volume that it was seeded with. */
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

PetscBool point_carry_stress(Points *points, PetscInt p, const Material *material, PetscReal sigma[6])
{
  if (!material->law->initial_stress) return PETSC_FALSE;
  if (points->components[POINT_PRESSURE] && material->compliance == 0)
    return stress_incompressible(points, p, material, sigma);
  if (!material->law->initial_stress(material->parameters, sigma, point_real(points, POINT_STATE, p)))
    return PETSC_FALSE;
  compress(points, p, material, sigma);
  return PETSC_TRUE;
}

/* A stress of weight needs weight, from the start on. */
static PetscBool check_gravity(const Case *c, const Upwards *u, Diag *diag)
{
  const PetscBool any = c->gravity[0] != 0 || c->gravity[1] != 0 || c->gravity[2] != 0;
  char path[64];
  PetscInt b = 0;
  if (u->g > 0) return PETSC_TRUE;
  while (!c->bodies[b].has_k0) ++b;
  PetscSNPrintf(path, sizeof path, "bodies[%d].k0", (int)b);
  diag_error(diag, any ? "loads.gravity_amplitude" : path,
             any ? "gravity is 0 at the start, but k0 of '%s' gives the stress that carries it: the body would heave"
                 : "k0 gives '%s' the stress that carries its weight, but there is no gravity",
             c->bodies[b].name);
  if (any) diag_hint(diag, "leave gravity_amplitude out: with k0 gravity acts from the start; or begin it with [0, 1]");
  else diag_hint(diag, "give loads.gravity, or leave k0 out");
  return PETSC_FALSE;
}

/* `surface` says what the user believes: is it where the material ends? It changes nothing. */
static PetscErrorCode CheckSurface(const Model *m, const PetscReal *highest, Diag *diag)
{
  PetscReal *top;
  PetscMPIInt rank;
  char path[64];

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
  PetscCall(PetscMalloc1(m->c->n_bodies, &top));
  PetscCallMPI(MPI_Allreduce(highest, top, (PetscMPIInt)m->c->n_bodies, MPIU_REAL, MPIU_MAX, m->comm));
  for (PetscInt b = 0; b < m->c->n_bodies && !rank; ++b) {
    const BodySpec *body = &m->c->bodies[b];
    if (!body->has_k0 || !body->has_surface || top[b] == -PETSC_MAX_REAL) continue;
    if (PetscAbsReal(body->surface - top[b]) <= m->grid->smallest) continue;
    PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].surface", (int)b));
    diag_warning(diag, path,
                 "the highest material above '%s' ends at a height of %g m, not at %g m; its initial stress is that "
                 "of the material that is there",
                 body->name, (double)top[b], (double)body->surface);
    diag_hint(diag, "what lies above and is not part of the model is a load: loads.tractions");
  }
  PetscCall(PetscFree(top));
  PetscFunctionReturn(0);
}

/* All points of bodies with k0; *failed: a body whose law cannot carry it. */
static PetscErrorCode StressPoints(Model *m, const Upwards *u, Overburden *overburden, PetscReal *highest,
                                   PetscInt *failed)
{
  PetscReal sigma[6], above, top;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt b = m->points->body[p];
    if (!m->c->bodies[b].has_k0) continue;
    PetscCall(OverburdenAt(overburden, b, point_real(m->points, POINT_X, p), &above, &top));
    highest[b] = PetscMax(highest[b], top);
    geostatic(u, m->c->bodies[b].k0, above, sigma);
    if (!point_carry_stress(m->points, p, &m->materials[m->points->material[p]], sigma)) *failed = b;
  }
  PetscFunctionReturn(0);
}

/* What most likely is wrong where a law has no state without stress. */
static void hint_pressure(const Model *m, PetscInt b, Diag *diag)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (!strcmp(m->c->materials[i].name, m->c->bodies[b].material) && m->materials[i].law->needs_stress)
      diag_hint(diag, "the law %s needs a pressure at every point, within the yield surface of its preconsolidation",
                m->materials[i].law->name);
}

PetscErrorCode InitialStress(Model *m, const Outline *outline, Diag *diag)
{
  const Upwards u = upwards(m->c);
  Overburden *overburden;
  PetscReal *highest;
  PetscInt failed = -1;
  char path[64];

  PetscFunctionBeginUser;
  if (!case_has_k0(m->c) || !check_gravity(m->c, &u, diag)) PetscFunctionReturn(0);
  PetscCall(OverburdenCreate(m->comm, m->dim, u.up, 0.5 * m->grid->smallest, m->c->n_bodies, outline, &overburden));
  PetscCall(PetscMalloc1(m->c->n_bodies, &highest));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) highest[b] = -PETSC_MAX_REAL;
  PetscCall(StressPoints(m, &u, overburden, highest, &failed));
  PetscCall(CheckSurface(m, highest, diag));
  PetscCall(PetscFree(highest));
  PetscCall(OverburdenDestroy(&overburden));
  if (failed >= 0) {
    PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].k0", (int)failed));
    diag_error(diag, path, "the material's law cannot carry this initial stress");
    hint_pressure(m, failed, diag);
  }
  PetscFunctionReturn(0);
}
