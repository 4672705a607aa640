/* From what the case says about a material to a law with its packed parameters. */
#include "material/elasticity.h"
#include <math.h>
#include <string.h>

#define MAX_PATH 256
#define MAX_NAMES 64

typedef struct {
  const MaterialSpec *spec;
  Diag *diag;
  PetscBool mixed; /* is the pressure an unknown of its own? */
} Resolver;

/* "materials.rubber.young"; key NULL: the material itself. */
static const char *path_of(const Resolver *r, const char *key, char path[MAX_PATH])
{
  snprintf(path, MAX_PATH, "materials.%s%s%s", r->spec->name, key ? "." : "", key ? key : "");
  return path;
}

static const NamedValue *find_value(const MaterialSpec *spec, const char *key)
{
  for (PetscInt i = 0; i < spec->n_parameters; ++i)
    if (!strcmp(spec->parameters[i].name, key)) return &spec->parameters[i];
  return NULL;
}

static const Law *find_law(const Resolver *r)
{
  const char *names[MAX_NAMES] = {NULL}, *nearest;
  char path[MAX_PATH];
  const Law *law = law_find(r->spec->law);
  if (law) return law;
  for (int i = 0; laws[i] && i < MAX_NAMES - 1; ++i) names[i] = laws[i]->name;
  diag_error(r->diag, path_of(r, "law", path), "there is no law '%s'", r->spec->law ? r->spec->law : "");
  nearest = r->spec->law ? diag_nearest(r->spec->law, names) : NULL;
  if (nearest) diag_hint(r->diag, "did you mean '%s'?", nearest);
  else
    diag_hint(r->diag, "`talus list laws` shows all laws; one of your own is loaded by --law %s=FILE.so",
              r->spec->law ? r->spec->law : "NAME");
  return NULL;
}

static int law_parameter_index(const Law *law, const char *key)
{
  for (int i = 0; law->parameters[i].name; ++i)
    if (!strcmp(law->parameters[i].name, key)) return i;
  return -1;
}

/* Keys that this law has no use for. */
static void refuse_unknown(const Resolver *r, const Law *law)
{
  const char *names[ELASTIC_CONSTANTS + LAW_MAX_PARAMETERS + 1] = {NULL};
  char path[MAX_PATH];
  int n = 0;
  for (int i = 0; !law->elastic && i < ELASTIC_CONSTANTS; ++i) names[n++] = elastic_constants[i].name;
  for (int i = 0; law->parameters[i].name; ++i) names[n++] = law->parameters[i].name;
  for (PetscInt i = 0; i < r->spec->n_parameters; ++i) {
    const char *key = r->spec->parameters[i].name;
    if ((!law->elastic && elastic_index(key) >= 0) || law_parameter_index(law, key) >= 0) continue;
    diag_error(r->diag, path_of(r, key, path), "the law %s has no parameter '%s'", law->name, key);
    const char *nearest = diag_nearest(key, names);
    if (nearest) diag_hint(r->diag, "did you mean '%s'?", nearest);
  }
}

static const char *unit_of(const char *unit) { return unit && unit[0] ? unit : "no unit"; }

/* Is the constant usable by itself? */
static PetscBool check_constant(const Resolver *r, int index, PetscReal value)
{
  const ElasticConstant *constant = &elastic_constants[index];
  char path[MAX_PATH];
  if (isfinite(value) && value > constant->min && value < constant->max) return PETSC_TRUE;
  path_of(r, constant->name, path);
  if (!isfinite(value)) diag_error(r->diag, path, "%s must be a finite number, not %g", constant->help, value);
  else if (isfinite(constant->max))
    diag_error(r->diag, path, "%s must lie between %g and %g (both excluded), not %g", constant->help, constant->min,
               constant->max, value);
  else diag_error(r->diag, path, "%s must be positive (%s), not %g", constant->help, unit_of(constant->unit), value);
  if ((!strcmp(constant->name, "poisson") && value == 0.5) || (!strcmp(constant->name, "bulk") && value == INFINITY))
    diag_hint(r->diag, "an incompressible solid has no finite bulk modulus: it needs `formulation: mixed`");
  return PETSC_FALSE;
}

/* Exactly two constants, each in its range, together a stable solid. */
static PetscBool resolve_elastic(const Resolver *r, Elasticity *elastic)
{
  PetscReal value[ELASTIC_CONSTANTS] = {0};
  PetscBool good = PETSC_TRUE;
  unsigned given = 0;
  int n = 0;
  char path[MAX_PATH], names[128];
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k) {
    const NamedValue *found = find_value(r->spec, elastic_constants[k].name);
    if (!found) continue;
    given |= 1u << k;
    value[k] = found->value;
    ++n;
  }
  if (r->mixed && n == 2 && elasticity_incompressible(given, value, elastic)) return PETSC_TRUE;
  for (int k = 0; k < ELASTIC_CONSTANTS; ++k)
    if (given >> k & 1 && !check_constant(r, k, value[k])) good = PETSC_FALSE;
  elastic_list(given, names, sizeof names);
  if (n != 2) {
    diag_error(r->diag, path_of(r, NULL, path), "needs exactly two elastic constants, has %d%s%s%s", n, n ? " (" : "",
               names, n ? ")" : "");
    diag_hint(r->diag, "give any two of %s: they define the others", elastic_list(ELASTIC_ALL, names, sizeof names));
    return PETSC_FALSE;
  }
  if (!good) return PETSC_FALSE;
  if (elasticity_from_two(given, value, elastic)) return PETSC_TRUE;
  diag_error(r->diag, path_of(r, NULL, path),
             "these %s give a bulk modulus of %g Pa and a shear modulus of %g Pa: not a stable solid", names,
             elastic->bulk, elastic->shear);
  return PETSC_FALSE;
}

static PetscBool in_range(const LawParameter *p, PetscReal value)
{
  const PetscBool low = p->min_open ? value > p->min : value >= p->min;
  const PetscBool high = p->max_open ? value < p->max : value <= p->max;
  return isfinite(value) && low && high;
}

/* One parameter of the law in SI units, angles in radians. */
static void resolve_parameter(const Resolver *r, const Law *law, const LawParameter *p, PetscReal *value)
{
  const NamedValue *given = find_value(r->spec, p->name);
  char path[MAX_PATH];
  *value = given ? given->value : p->fallback;
  if (!given && p->absent) return;
  if (!given && isnan(p->fallback)) {
    diag_error(r->diag, path_of(r, NULL, path), "the law %s needs '%s': %s (%s)", law->name, p->name, p->help,
               unit_of(p->unit));
    return;
  }
  if (given && !in_range(p, *value))
    diag_error(r->diag, path_of(r, p->name, path), "%s must lie in %c%g, %g%c (%s), not %g", p->help,
               p->min_open ? '(' : '[', p->min, p->max, p->max_open ? ')' : ']', unit_of(p->unit), *value);
  if (r->mixed && p->not_mixed && *value != p->fallback) {
    diag_error(r->diag, path_of(r, p->name, path), "`formulation: mixed` cannot take %s: only %g", p->name,
               p->fallback);
    diag_hint(
      r->diag,
      "take `formulation: displacement` or `mean-dilatation`: pressures at nodes would spread it over the neighbours");
  }
  if (p->unit && !strcmp(p->unit, "deg")) *value *= PETSC_PI / 180.0;
}

/* Of a law that is stiff by its own parameters. */
static void own_elastic(const Law *law, const PetscReal *given, Elasticity *elastic)
{
  PetscReal value[ELASTIC_CONSTANTS] = {0}, two[2];
  law->elastic(given, two);
  value[elastic_index("bulk")] = two[0];
  value[elastic_index("shear")] = two[1];
  (void)elasticity_from_two(1u << elastic_index("bulk") | 1u << elastic_index("shear"), value, elastic);
}

static void check_together(const Resolver *r, const Law *law, const PetscReal *given)
{
  const char *complaint = law->check ? law->check(given) : NULL;
  char path[MAX_PATH];
  if (complaint) diag_error(r->diag, path_of(r, NULL, path), "%s", complaint);
}

static void check_density(const Resolver *r)
{
  char path[MAX_PATH];
  if (isfinite(r->spec->density) && r->spec->density > 0.0) return;
  diag_error(r->diag, path_of(r, "density", path), "density must be positive and finite (kg/m3), not %g",
             r->spec->density);
}

/* Parameters of the deviatoric part: those of the law with K = G. */
static void prepare_deviatoric(const PetscReal *given, Material *m)
{
  Elasticity middle = m->elastic;
  middle.bulk = middle.shear;
  middle.lame = middle.shear / 3.0;
  m->law->prepare(&middle, given, m->deviatoric);
}

/* What the mixed formulation needs, and whether this law can give it. An incompressible material
 * has no other parameters. */
static void prepare_mixed(const Resolver *r, const PetscReal *given, Material *m)
{
  char path[MAX_PATH];
  if (!m->law->volume) {
    diag_error(r->diag, path_of(r, "law", path), "the law %s has no mixed form", m->law->name);
    return;
  }
  prepare_deviatoric(given, m);
  m->volume = m->law->volume_law(m->deviatoric);
  m->compliance = 1.0 / m->elastic.bulk;
  if (isfinite(m->elastic.bulk)) return;
  memcpy(m->parameters, m->deviatoric, sizeof m->parameters);
  if (m->volume != VOLUME_COUPLED) return;
  diag_error(r->diag, path_of(r, NULL, path),
             "the law %s cannot be exactly incompressible here: it couples volume and shape", m->law->name);
  diag_hint(r->diag, "%s",
            "give a finite bulk modulus (poisson: 0.4999), or take a law that keeps them apart: neo-hookean-split, j2, "
            "mohr-coulomb without friction and cut-off");
}

/* The P-wave modulus; of a mixed formulation no larger than with poisson 0.3, since what it scales
 * is shear. */
static PetscReal wave_modulus(const Elasticity *elastic, PetscBool mixed)
{
  const PetscReal limit = 13.0 / 6.0 * elastic->shear;
  return (mixed ? PetscMin(elastic->bulk, limit) : elastic->bulk) + 4.0 / 3.0 * elastic->shear;
}

PetscReal material_passed(const Material *m, const PetscReal *before, const PetscReal *state)
{
  return m->law->passed ? m->law->passed(m->parameters, before, state) : 0.0;
}

PetscReal material_sheared(const Material *m) { return wave_modulus(&m->elastic, PETSC_TRUE); }

PetscReal material_confined(const Material *m) { return m->elastic.bulk + 4.0 / 3.0 * m->elastic.shear; }

PetscBool material_symmetric(const Material *m, PetscBool strength_varies)
{
  const Law *law = m->law;
  if (law->symmetric || !law->associated) return law->symmetric;
  return law->associated(m->parameters) && (!strength_varies || law->volume_law(m->parameters) == VOLUME_LOG);
}

PetscBool specs_yield(PetscInt n, const MaterialSpec *specs)
{
  for (PetscInt i = 0; i < n; ++i) {
    const Law *law = specs[i].law ? law_find(specs[i].law) : NULL;
    if (law && law->yields) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool materials_yield(PetscInt n, const Material *materials)
{
  for (PetscInt i = 0; i < n; ++i)
    if (materials[i].law->yields) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Points of mpm move through cells, and by what they flow their pressures are held less (material/pressure.h); where
 * flow moves the volume, too, it is the law that says what becomes of a strain that the pressure does not explain. */
static PetscInt find_flow(const Case *c, const Material *m)
{
  PetscInt n = 1;
  if (!m->mixed || m->volume == VOLUME_COUPLED || !c->method || strcmp(c->method, "mpm")) return 0;
  for (const LawField *f = m->law->fields; f->name; n += f++->components)
    if (!strcmp(f->name, "equivalent_plastic_strain")) return n;
  return 0;
}

static PetscErrorCode Resolve(const Case *c, const MaterialSpec *spec, Diag *diag, Material *material)
{
  const Resolver r = {spec, diag, case_is_mixed(c)};
  PetscReal *given = material->given;
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(material, sizeof *material));
  material->name = r.spec->name;
  material->density = r.spec->density;
  material->mixed = r.mixed;
  check_density(&r);
  material->law = find_law(&r);
  const PetscBool own = material->law && material->law->elastic;
  const PetscBool elastic = own || resolve_elastic(&r, &material->elastic);
  if (!material->law) PetscFunctionReturn(0);
  refuse_unknown(&r, material->law);
  for (int i = 0; material->law->parameters[i].name; ++i)
    resolve_parameter(&r, material->law, &material->law->parameters[i], &given[i]);
  if (diag_errors(diag) == before) check_together(&r, material->law, given);
  if (!elastic || diag_errors(diag) > before) PetscFunctionReturn(0);
  if (own) own_elastic(material->law, given, &material->elastic);
  material->wave_modulus = wave_modulus(&material->elastic, r.mixed);
  material->law->prepare(&material->elastic, given, material->parameters);
  if (r.mixed) prepare_mixed(&r, given, material);
  material->flow = find_flow(c, material);
  PetscFunctionReturn(0);
}

PetscErrorCode MaterialAt(const Case *c, PetscInt index, PetscReal t, Diag *diag, Material *material)
{
  MaterialSpec spec = c->materials[index];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(spec.n_parameters, &spec.parameters));
  PetscCall(PetscArraycpy(spec.parameters, c->materials[index].parameters, spec.n_parameters));
  for (PetscInt k = 0; k < spec.n_parameters; ++k)
    spec.parameters[k].value *= case_material_factor(c, index, spec.parameters[k].name, t);
  spec.density *= case_material_factor(c, index, "density", t);
  PetscCall(Resolve(c, &spec, diag, material));
  PetscCall(PetscFree(spec.parameters));
  PetscFunctionReturn(0);
}

/* Amplitudes are of numbers that are there. */
static void check_amplitudes(const Case *c, PetscInt index, const Material *material, Diag *diag)
{
  const MaterialSpec *spec = &c->materials[index];
  const char *names[ELASTIC_CONSTANTS + LAW_MAX_PARAMETERS + 2] = {"density"};
  const Resolver r = {spec, diag, PETSC_FALSE};
  char key[96], path[MAX_PATH];
  for (PetscInt k = 0, n = 1; k < spec->n_parameters && n < ELASTIC_CONSTANTS + LAW_MAX_PARAMETERS + 1; ++k)
    names[n++] = spec->parameters[k].name;
  for (PetscInt k = 0; k < spec->n_amplitudes; ++k) {
    const char *name = spec->amplitudes[k].name;
    const int parameter = law_parameter_index(material->law, name);
    snprintf(key, sizeof key, "amplitude.%s", name);
    path_of(&r, key, path);
    if (parameter >= 0 && material->law->parameters[parameter].words)
      diag_error(diag, path, "%s of the law %s is a word, and no number that could change", name, material->law->name);
    else if (parameter >= 0 && material->law->parameters[parameter].at_start)
      diag_error(diag, path, "%s says how points of the law %s begin, and cannot change with time", name,
                 material->law->name);
    else if (strcmp(name, "density") && !find_value(spec, name)) {
      diag_error(diag, path, "the material '%s' has no '%s' that could change with time", spec->name, name);
      diag_hint_names(diag, name, names);
    }
  }
}

PetscErrorCode MaterialResolve(const Case *c, PetscInt index, Diag *diag, Material *material)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCheck(index >= 0 && index < c->n_materials, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "no material %" PetscInt_FMT, index);
  const MaterialSpec *spec = &c->materials[index];
  PetscCall(Resolve(c, spec, diag, material));
  if (material->law) check_amplitudes(c, index, material, diag);
  for (PetscInt k = 0; k < spec->n_amplitudes; ++k) { /* between these times numbers are between those of them */
    const Amplitude *a = &spec->amplitudes[k].amplitude;
    for (PetscInt i = 0; i < a->n && diag_errors(diag) == before; ++i) {
      PetscCall(MaterialAt(c, index, a->origin + a->time[i], diag, material));
      if (diag_errors(diag) > before) diag_hint(diag, "so it is at t = %g s, with its amplitudes", (double)a->time[i]);
    }
  }
  if (spec->n_amplitudes && diag_errors(diag) == before) PetscCall(MaterialAt(c, index, c->start, diag, material));
  PetscFunctionReturn(0);
}

/* The constants that the law works with, of other ones that the user could have given. */
static void prepare_again(Material *m, const PetscReal *given)
{
  m->law->prepare(&m->elastic, given, m->parameters);
  if (!m->mixed) return;
  prepare_deviatoric(given, m);
  if (isfinite(m->elastic.bulk)) return;
  memcpy(m->parameters, m->deviatoric, sizeof m->parameters);
}

void materials_step(PetscInt n, Material *materials, PetscReal time, PetscReal dt, PetscBool inertia)
{
  for (PetscInt i = 0; i < n; ++i) {
    Material *m = &materials[i];
    if (!m->law->step) continue;
    const PetscReal passes = m->law->rate && !inertia && dt > 0 ? PETSC_INFINITY : dt;
    m->law->step(time, passes, m->parameters);
    if (m->mixed) m->law->step(time, passes, m->deviatoric);
  }
}

void material_reduce(Material *m, PetscReal factor)
{
  PetscReal reduced[LAW_MAX_PARAMETERS];
  m->law->reduce(m->given, factor, reduced);
  prepare_again(m, reduced);
}

/* Is parameter k of a law that says itself how stiff it is one by which it does? Of any other law none is. */
static PetscBool stiffens(const Material *m, int k, PetscReal value)
{
  PetscReal given[LAW_MAX_PARAMETERS], before[2], after[2];
  if (!m->law->elastic || value == m->given[k]) return PETSC_FALSE;
  memcpy(given, m->given, sizeof given);
  given[k] = value;
  m->law->elastic(m->given, before);
  m->law->elastic(given, after);
  return (PetscBool)(before[0] != after[0] || before[1] != after[1]);
}

void material_take_strength(Material *m, const Material *other)
{
  PetscReal given[LAW_MAX_PARAMETERS];
  memcpy(given, m->given, sizeof given);
  for (int k = 0; m->law->parameters[k].name; ++k)
    if (!stiffens(m, k, other->given[k])) given[k] = other->given[k];
  memcpy(m->given, given, sizeof given);
  prepare_again(m, m->given);
}

/* Constants that are found from others, or between two times, have no more digits. */
#define SAME_CONSTANT (8 * PETSC_MACHINE_EPSILON)

static PetscBool same_constant(PetscReal a, PetscReal b)
{
  return (PetscBool)(a == b || PetscAbsReal(a - b) <= SAME_CONSTANT * PetscMin(PetscAbsReal(a), PetscAbsReal(b)));
}

PetscBool material_as_stiff(const Material *a, const Material *b)
{
  if (a->law != b->law) return PETSC_FALSE;
  for (int k = 0; a->law->parameters[k].name; ++k) /* two that change may leave the moduli what they were */
    if (!same_constant(a->given[k], b->given[k]) && stiffens(a, k, b->given[k])) return PETSC_FALSE;
  return (PetscBool)(same_constant(a->elastic.bulk, b->elastic.bulk) &&
                     same_constant(a->elastic.shear, b->elastic.shear));
}
