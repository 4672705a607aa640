/* Stress at t = 0: that of the weight of the material really above each point, under the gravity of
 * t = 0, or one that formulas give. */
#include "base/formula.h"
#include "model/model_private.h"
#include "model/start/initial_stress.h"

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
  if (u.g == 0) u.up[1] = 1;
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

/* What the formulas of a stress may name. */
typedef struct {
  PetscInt dim;
  const PetscReal *x;
  PetscReal depth, weight;
} Place;

static PetscErrorCode PlaceValue(void *context, const char *name, PetscBool *known, PetscReal *value)
{
  const Place *place = context;

  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  if (!strcmp(name, "depth")) *value = place->depth;
  else if (!strcmp(name, "weight")) *value = place->weight;
  else if (name[0] >= 'x' && name[0] < 'x' + place->dim && !name[1]) *value = place->x[name[0] - 'x'];
  else *known = PETSC_FALSE;
  PetscFunctionReturn(0);
}

/* Cauchy stress of the formulas of a body. */
static PetscErrorCode StressOfFormulas(const BodySpec *body, Place *place, PetscReal sigma[6])
{
  PetscFunctionBeginUser;
  for (int k = 0; k < 6; ++k) {
    Formula formula = {.value = PlaceValue, .context = place, .at = body->stress[k]};
    sigma[k] = 0;
    if (body->stress[k]) PetscCall(FormulaValue(&formula, &sigma[k]));
  }
  PetscFunctionReturn(0);
}

/* Is each of them a formula, of names that are known? */
static PetscErrorCode CheckFormulas(const Case *c, PetscInt b, Diag *diag)
{
  static const char *const names[] = {"depth", "weight", "x", "y", "z", NULL};
  static const char *const component[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  const PetscReal origin[3] = {0, 0, 0};
  Place place = {.dim = kinematics_dim(c->kinematics), .x = origin};
  PetscReal value;
  char path[64];

  PetscFunctionBeginUser;
  for (int k = 0; k < 6; ++k) {
    Formula formula = {.value = PlaceValue, .context = &place, .at = c->bodies[b].stress[k]};
    if (!formula.at) continue;
    PetscCall(FormulaValue(&formula, &value));
    if (!formula.wrong) continue;
    PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].stress.%s", (int)b, component[k]));
    if (formula.name[0]) {
      diag_error(diag, path, "there is no '%s' of a place; depth, weight and coordinates are", formula.name);
      diag_hint_names(diag, formula.name, names);
    } else if (formula.wrong[0]) diag_error(diag, path, "'%s' makes no sense here", formula.wrong);
    else diag_error(diag, path, "something is missing at the end of '%s'", c->bodies[b].stress[k]);
  }
  PetscFunctionReturn(0);
}

/* A stress of weight needs weight, from the start on. */
static PetscBool check_gravity(const Case *c, const Upwards *u, Diag *diag)
{
  const PetscBool any = c->gravity[0] != 0 || c->gravity[1] != 0 || c->gravity[2] != 0;
  char path[64];
  PetscInt b = 0;
  while (b < c->n_bodies && !c->bodies[b].has_k0) ++b;
  if (u->g > 0 || b == c->n_bodies) return PETSC_TRUE;
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

/* Materials of a search for a factor of safety, which do not yield as it begins, with the strength that the case gives
 * them; else NULL. */
static PetscErrorCode WholeStrength(const Model *m, Material **whole)
{
  PetscFunctionBeginUser;
  *whole = NULL;
  if (m->c->analysis.type != ANALYSIS_FACTOR) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(m->c->n_materials, whole));
  PetscCall(PetscArraycpy(*whole, m->materials, m->c->n_materials));
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if ((*whole)[i].law->reduce) material_reduce(&(*whole)[i], 1);
  PetscFunctionReturn(0);
}

/* All points of bodies that have one; *failed: a body whose law cannot carry it. */
static PetscErrorCode StressPoints(Model *m, const Upwards *u, Overburden *overburden, PetscReal *highest,
                                   PetscInt *failed)
{
  PetscReal sigma[6], above, top;
  Material *whole;

  PetscFunctionBeginUser;
  PetscCall(WholeStrength(m, &whole));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt b = m->points->body[p];
    const BodySpec *body = &m->c->bodies[b];
    const PetscReal *x = point_real(m->points, POINT_X, p);
    if (!body_has_stress(body)) continue;
    PetscCall(OverburdenAt(overburden, b, x, &above, &top));
    highest[b] = PetscMax(highest[b], top);
    Place place = {.dim = m->dim, .x = x, .depth = top, .weight = u->g * above};
    for (PetscInt d = 0; d < m->dim; ++d) place.depth -= u->up[d] * x[d];
    if (body->has_k0) geostatic(u, body->k0, above, sigma);
    else PetscCall(StressOfFormulas(body, &place, sigma));
    const PetscInt i = m->points->material[p];
    const StressOutcome outcome = stress_point(m->points, p, &m->materials[i], sigma);
    if (outcome == STRESS_REFUSED) *failed = b;
    else if (outcome == STRESS_BEYOND || (whole && stress_is_beyond(m->points, p, &whole[i], sigma)))
      m->initial.beyond += 1;
  }
  PetscCall(PetscFree(whole));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &m->initial.beyond, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, failed, 1, MPIU_INT, MPI_MAX, m->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode CheckStress(const Case *c, const Upwards *u, Diag *diag, PetscBool *fine)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < c->n_bodies; ++b) PetscCall(CheckFormulas(c, b, diag));
  const PetscBool carried = check_gravity(c, u, diag);
  *fine = carried && diag_errors(diag) == before;
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
  PetscBool fine = PETSC_FALSE;
  char path[64];

  PetscFunctionBeginUser;
  if (!case_has_stress(m->c)) PetscFunctionReturn(0);
  PetscCall(CheckStress(m->c, &u, diag, &fine));
  if (!fine) PetscFunctionReturn(0);
  PetscCall(OverburdenCreate(m->comm, m->dim, u.up, 0.5 * m->grid->smallest, m->c->n_bodies, outline, &overburden));
  PetscCall(PetscMalloc1(m->c->n_bodies, &highest));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) highest[b] = -PETSC_MAX_REAL;
  PetscCall(StressPoints(m, &u, overburden, highest, &failed));
  PetscCall(CheckSurface(m, highest, diag));
  PetscCall(PetscFree(highest));
  PetscCall(OverburdenDestroy(&overburden));
  if (failed >= 0) {
    PetscCall(
      PetscSNPrintf(path, sizeof path, "bodies[%d].%s", (int)failed, m->c->bodies[failed].has_k0 ? "k0" : "stress"));
    diag_error(diag, path, "the material's law cannot carry this initial stress");
    hint_pressure(m, failed, diag);
  }
  PetscFunctionReturn(0);
}
