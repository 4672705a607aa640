/* Numbers that are no matter's in kg, m, s and Pa: angles in radians, kPa for Pa, mm for m. Hardly ever meant, and
 * said. */
#include "model/model_private.h"

#define NO_ANGLE 1.6         /* degrees, pi / 2 in radians: less is no angle of friction of anything */
#define NO_COEFFICIENT 3     /* of friction: 72 degrees */
#define FASTEST 3e4          /* m/s, of waves: diamond has 1.8e4 */
#define PRESSED_TO_NOTHING 4 /* of its modulus, by its own weight */
#define STRONGEST 1000       /* m/s2, of gravity: a centrifuge has some hundred times that of the earth */
#define LIGHTEST 20          /* kg/m3, of what yields under the earth's gravity: foam */
#define LEANING 4            /* k0: passive pressure at 37 degrees */
#define DEGREES (180 / PETSC_PI)

static void advise_angle(const char *path, PetscReal angle, Diag *diag)
{
  if (angle <= 0 || angle >= NO_ANGLE) return;
  diag_warning(diag, path, "an angle of friction of %.6g degrees holds next to nothing", (double)angle);
  diag_hint(diag, "angles are in degrees: %.6g radians are %.4g", (double)angle, (double)(angle * DEGREES));
}

static void advise_material(const Model *m, PetscInt i, Diag *diag)
{
  const MaterialSpec *spec = m->c->materials + i;
  const PetscReal speed = PetscSqrtReal(m->materials[i].wave_modulus / spec->density);
  char path[128];
  for (PetscInt k = 0; k < spec->n_parameters; ++k) {
    if (strcmp(spec->parameters[k].name, "friction_angle") != 0) continue;
    snprintf(path, sizeof path, "materials.%s.friction_angle", spec->name);
    advise_angle(path, spec->parameters[k].value, diag);
  }
  if (speed <= FASTEST) return;
  snprintf(path, sizeof path, "materials.%s.density", spec->name);
  diag_warning(diag, path, "waves would run at %.3g m/s in '%s', faster than in anything", (double)speed, spec->name);
  diag_hint(diag, "densities are in kg/m3, moduli in Pa, lengths in m");
}

static void advise_friction(const char *list, PetscInt k, PetscReal friction, PetscBool by_angle, Diag *diag)
{
  char path[64];
  snprintf(path, sizeof path, "%s[%d].friction_angle", list, (int)k);
  if (by_angle) advise_angle(path, PetscAtanReal(friction) * DEGREES, diag);
  if (friction <= NO_COEFFICIENT) return;
  snprintf(path, sizeof path, "%s[%d].friction", list, (int)k);
  diag_warning(diag, path, "a coefficient of friction of %g is an angle of %.3g degrees", (double)friction,
               (double)(PetscAtanReal(friction) * DEGREES));
  diag_hint(diag, "an angle is `friction_angle`, in degrees; what must not slide is `contact: stick`");
}

static void advise_k0(const Model *m, PetscInt b, Diag *diag)
{
  const BodySpec *body = m->c->bodies + b;
  char path[64];
  if (!body->has_k0 || body->k0 <= LEANING) return;
  snprintf(path, sizeof path, "bodies[%d].k0", (int)b);
  diag_warning(diag, path, "k0 of %g: the ground would press sideways %g times as much as it weighs", (double)body->k0,
               (double)body->k0);
  diag_hint(diag, "0.4 to 1 is usual, 1 to 3 what was much loaded once");
}

/* Heights of bodies along gravity, m, over all ranks: 0 of a body without points. */
static PetscErrorCode Heights(const Model *m, PetscReal g, PetscReal *height)
{
  const PetscInt n = m->c->n_bodies;
  PetscReal *ends; /* -lowest, highest */

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(2 * n, &ends));
  for (PetscInt k = 0; k < 2 * n; ++k) ends[k] = -PETSC_MAX_REAL / 4;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p);
    PetscReal up = 0, *end = ends + 2 * m->points->body[p];
    for (PetscInt d = 0; d < m->dim; ++d) up -= x[d] * m->c->gravity[d] / g;
    end[0] = PetscMax(end[0], -up), end[1] = PetscMax(end[1], up);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, ends, (PetscMPIInt)(2 * n), MPIU_REAL, MPIU_MAX, m->comm));
  for (PetscInt b = 0; b < n; ++b) height[b] = PetscMax(0, ends[2 * b] + ends[2 * b + 1]);
  PetscCall(PetscFree(ends));
  PetscFunctionReturn(0);
}

/* t/m3 and mm/s2. */
static void advise_gravity(const Model *m, PetscReal g, Diag *diag)
{
  char path[128];
  if (g > STRONGEST) {
    diag_warning(diag, "loads.gravity", "gravity of %g m/s2 is %.3g times that of the earth", (double)g,
                 (double)(g / 9.81));
    diag_hint(diag, "lengths are in m: 9.81 m/s2");
  }
  for (PetscInt i = 0; i < m->c->n_materials && g > 9 && g < 11; ++i) {
    const MaterialSpec *spec = m->c->materials + i;
    if (!m->materials[i].law->yields || spec->density >= LIGHTEST) continue;
    snprintf(path, sizeof path, "materials.%s.density", spec->name);
    diag_warning(diag, path, "'%s' weighs %g kg a cubic metre, less than any soil", spec->name, (double)spec->density);
    diag_hint(diag, "densities are in kg/m3: soils have 1500 to 2200");
  }
}

static PetscErrorCode AdviseWeight(const Model *m, Diag *diag)
{
  const PetscReal *gravity = m->c->gravity;
  const PetscReal g = PetscSqrtReal(PetscSqr(gravity[0]) + PetscSqr(gravity[1]) + PetscSqr(gravity[2]));
  PetscReal *height;
  char path[64];

  PetscFunctionBeginUser;
  if (g == 0) PetscFunctionReturn(0);
  advise_gravity(m, g, diag);
  PetscCall(PetscMalloc1(m->c->n_bodies, &height));
  PetscCall(Heights(m, g, height));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    for (PetscInt i = 0; i < m->c->n_materials; ++i) {
      const PetscReal pressure = m->c->materials[i].density * g * height[b];
      if (strcmp(m->c->bodies[b].material, m->c->materials[i].name) != 0) continue;
      if (pressure <= PRESSED_TO_NOTHING * m->materials[i].wave_modulus) continue;
      snprintf(path, sizeof path, "bodies[%d]", (int)b);
      diag_warning(
        diag, path,
        "the weight of '%s' is %.3g times what its stiffness bears: density g height %.3g Pa, modulus %.3g Pa",
        m->c->bodies[b].name, (double)(pressure / m->materials[i].wave_modulus), (double)pressure,
        (double)m->materials[i].wave_modulus);
      diag_hint(diag, "densities are in kg/m3, moduli in Pa, lengths in m, gravity in m/s2");
    }
  PetscCall(PetscFree(height));
  PetscFunctionReturn(0);
}

PetscErrorCode AdviseUnits(const Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < m->c->n_materials; ++i) advise_material(m, i, diag);
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    if (m->c->walls[k].contact == CONTACT_FRICTION)
      advise_friction("walls", k, m->c->walls[k].friction, m->c->walls[k].by_angle, diag);
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k)
    if (m->c->interfaces[k].contact == CONTACT_FRICTION)
      advise_friction("interfaces", k, m->c->interfaces[k].friction, m->c->interfaces[k].by_angle, diag);
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) advise_k0(m, b, diag);
  PetscCall(AdviseWeight(m, diag));
  PetscFunctionReturn(0);
}
