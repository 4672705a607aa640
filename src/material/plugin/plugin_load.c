/* From NAME=FILE.so of the command line to a law: the library is opened, asked for its one symbol,
 * and what it says of itself is checked. */
#include <ctype.h>
#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "case/fields.h"
#include "material/elasticity.h"
#include "material/plugin/plugin.h"

static PetscInt n_plugins;
static const char *words[PLUGIN_MOST + 1];

const char *const *plugin_words(void) { return words; }

/* A key of a case file, or a law's name (with '-'). */
static PetscBool is_name(const char *name, PetscBool dashes)
{
  if (!name || !islower((unsigned char)name[0]) || strlen(name) > 48) return PETSC_FALSE;
  for (; *name; ++name)
    if (!islower((unsigned char)*name) && !isdigit((unsigned char)*name) && *name != '_' && !(dashes && *name == '-'))
      return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Is the parameter one that the case file can have? */
static PetscBool check_parameter(const Plugin *g, const TalusLawParameter *p, Diag *diag)
{
  const PetscBool taken = !strcmp(p->name, "law") || !strcmp(p->name, "density") || elastic_index(p->name) >= 0;
  const char *wrong = NULL;
  if (!is_name(p->name, PETSC_FALSE)) wrong = "is no key: lower-case letters, digits and underscores";
  else if (taken) wrong = "is a key of every material (TALUS_LAW_ELASTIC gives bulk and shear modulus to the law)";
  else if (!p->unit || !p->help) wrong = "has no unit or no help (\"\" is a unit)";
  else if (!(p->min <= p->max)) wrong = "has no range: min is not below max";
  else if (!isnan(p->fallback) && (p->fallback < p->min || p->fallback > p->max))
    wrong = "has a default out of its range";
  for (const TalusLawParameter *q = g->user.parameters; q != p && !wrong; ++q)
    if (!strcmp(q->name, p->name)) wrong = "is there twice";
  if (wrong) diag_error(diag, NULL, "%s: the parameter '%s' of the law %s", g->file, p->name, wrong);
  return !wrong;
}

static PetscBool take_parameters(Plugin *g, Diag *diag)
{
  PetscInt n = 0;
  for (const TalusLawParameter *p = g->user.parameters; p && p->name; ++p, ++n) {
    if (n == TALUS_LAW_MAX_PARAMETERS) {
      diag_error(diag, NULL, "%s: the law has more than %d parameters", g->file, TALUS_LAW_MAX_PARAMETERS);
      return PETSC_FALSE;
    }
    if (!check_parameter(g, p, diag)) return PETSC_FALSE;
    g->parameters[n] = (LawParameter){.name = p->name,
                                      .unit = p->unit,
                                      .help = p->help,
                                      .min = p->min,
                                      .max = p->max,
                                      .min_open = p->open & TALUS_LAW_OPEN_MIN ? PETSC_TRUE : PETSC_FALSE,
                                      .max_open = p->open & TALUS_LAW_OPEN_MAX ? PETSC_TRUE : PETSC_FALSE,
                                      .fallback = p->fallback};
  }
  g->given = n;
  return PETSC_TRUE;
}

/* Behind what talus keeps itself. */
static PetscBool take_state(Plugin *g, Diag *diag)
{
  const PetscBool strains = g->user.update_strain != NULL;
  PetscInt n = 0;
  if (strains)
    g->fields[n++] = (LawField){"elastic_strain", "", "elastic left Cauchy-Green tensor b", 6, {1, 1, 1, 0, 0, 0}};
  g->kept = strains ? 6 : 0;
  for (const TalusLawState *s = g->user.state; s && s->name; ++s) {
    const char *wrong = NULL;
    if (!is_name(s->name, PETSC_FALSE)) wrong = "has a name that is none: lower-case letters, digits and underscores";
    else if (!s->unit || !s->help) wrong = "has no unit or no help (\"\" is a unit)";
    else if (s->components != 1 && s->components != 6) wrong = "has neither 1 nor 6 components";
    else if (s->components != 1 && strains)
      wrong = "is a tensor, which a law of strains cannot keep: it would have to turn";
    else if (g->own + s->components > TALUS_LAW_MAX_STATE) wrong = "is one too many: there is room for 32 numbers";
    for (PetscInt k = 0; k < n && !wrong; ++k)
      if (!strcmp(g->fields[k].name, s->name)) wrong = "is there twice";
    if (wrong) {
      diag_error(diag, NULL, "%s: the state '%s' of the law %s", g->file, s->name, wrong);
      return PETSC_FALSE;
    }
    g->fields[n] = (LawField){.name = s->name, .unit = s->unit, .help = s->help, .components = s->components};
    memcpy(g->fields[n++].initial, s->initial, sizeof s->initial);
    g->own += s->components;
  }
  return PETSC_TRUE;
}

/* What the library says of itself, as far as this version knows it. */
static PetscBool take_law(Plugin *g, const TalusLaw *law, Diag *diag)
{
  const char *wrong = NULL;
  if (law && law->version != TALUS_LAW_VERSION) {
    diag_error(diag, NULL, "%s was built for version %d of talus/law.h, and this talus knows version %d", g->file,
               law->version, TALUS_LAW_VERSION);
    diag_hint(diag, "compile it anew with the talus/law.h of this talus");
    return PETSC_FALSE;
  }
  if (law && law->size >= offsetof(TalusLaw, energy)) memcpy(&g->user, law, PetscMin(law->size, sizeof g->user));
  if (!law) wrong = "talus_law() returns NULL";
  else if (law->size < offsetof(TalusLaw, energy)) wrong = "size is not sizeof(TalusLaw)";
  else if (!law->help || !*law->help) wrong = "help is missing";
  else if (!law->update && !law->update_strain) wrong = "update is missing (or update_strain)";
  else if (law->update && law->update_strain) wrong = "there are both update and update_strain: which is it?";
  if (wrong) diag_error(diag, NULL, "%s: %s", g->file, wrong);
  return !wrong && take_parameters(g, diag) && take_state(g, diag);
}

/* The address of a function; the way around a cast that C does not know. */
static PetscBool find(void *library, const char *symbol, void *function)
{
  void *address = dlsym(library, symbol);
  memcpy(function, &address, sizeof address);
  return address != NULL;
}

static void *open_library(const Plugin *g, Diag *diag)
{
  void *library = dlopen(g->file, RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    diag_error(diag, NULL, "%s cannot be loaded: %s", g->file, dlerror());
    diag_hint(diag, "a shared library: cc -shared -fPIC -o law.so law.c, or gfortran");
  }
  return library;
}

static PetscBool open_law(Plugin *g, Diag *diag)
{
  const TalusLaw *(*law)(void) = NULL;
  void *umat = NULL, *library = open_library(g, diag);
  if (!library) return PETSC_FALSE;
  if (find(library, "talus_law", &law)) return take_law(g, law(), diag);
  diag_error(diag, NULL, "%s has no function talus_law", g->file);
  if (find(library, "umat_", &umat))
    diag_hint(diag, "it has a subroutine UMAT: --umat %s=%s,NPROPS,NSTATV", g->name, g->file);
  else diag_hint(diag, "talus/law.h declares it; in C++ it must be extern \"C\"");
  return PETSC_FALSE;
}

/* prop_1 ..., and the fields of a umat. */
static void fill_umat(Plugin *g)
{
  static const char *const axes = "xyz";
  PetscInt n = 0, w = 0;
  for (; g->given < g->umat.n_props; ++g->given) {
    char *name = g->words[w++];
    snprintf(name, sizeof g->words[0], "prop_%u", (unsigned)g->given % 100 + 1);
    g->parameters[g->given] = (LawParameter){
      .name = name, .unit = "", .help = "of PROPS", .min = -PETSC_MAX_REAL, .max = PETSC_MAX_REAL, .fallback = NAN};
  }
  g->fields[n++] = (LawField){"umat_stress", "Pa", "Cauchy stress", 6, {0}};
  g->fields[n++] = (LawField){"umat_strain", "", "sum of the logarithmic strains of the steps", 6, {0}};
  for (int k = 0; k < 9; ++k) {
    char *name = g->words[w++];
    snprintf(name, sizeof g->words[0], "umat_f_%c%c", axes[k / 3], axes[k % 3]);
    g->fields[n++] = (LawField){name, "", "deformation gradient", 1, {k % 4 == 0}};
  }
  for (int k = 0; k < 3; ++k) {
    char *name = g->words[w++];
    snprintf(name, sizeof g->words[0], "umat_%c", axes[k]);
    g->fields[n++] = (LawField){name, "m", "where the point is at the start of the step", 1, {0}};
  }
  for (int k = 0; k < g->umat.n_statev; ++k) {
    char *name = g->words[w++];
    snprintf(name, sizeof g->words[0], "statev_%u", (unsigned)k % 100 + 1);
    g->fields[n++] = (LawField){name, "", "of STATEV", 1, {0}};
  }
  g->kept = UMAT_KEPT;
  g->own = g->umat.n_statev;
  g->user.flags = TALUS_LAW_TANGENT | TALUS_LAW_YIELDS;
  g->user.help = "a subroutine UMAT";
}

static PetscBool open_umat(Plugin *g, Diag *diag)
{
  void *library = open_library(g, diag);
  if (!library) return PETSC_FALSE;
  if (!find(library, "umat_", &g->umat.call)) {
    diag_error(diag, NULL, "%s has no subroutine UMAT (symbol umat_)", g->file);
    diag_hint(diag, "a law of talus/law.h is loaded by --law %s=%s", g->name, g->file);
    return PETSC_FALSE;
  }
  if (!find(library, "sdvini_", &g->umat.begin)) g->umat.begin = NULL;
  memset(g->umat.name, ' ', sizeof g->umat.name);
  for (size_t k = 0; g->name[k] && k < sizeof g->umat.name; ++k)
    g->umat.name[k] = (char)toupper((unsigned char)g->name[k]);
  fill_umat(g);
  return PETSC_TRUE;
}

/* A whole number from 0 to most; -1: the text is none. */
static int count_of(const char *text, int most)
{
  char *end;
  const long value = strtol(text, &end, 10);
  return isdigit((unsigned char)text[0]) && !*end && value <= most ? (int)value : -1;
}

/* ",NPROPS,NSTATV" behind the file's name; cut off there. */
static PetscBool take_counts(Plugin *g, char *file, Diag *diag)
{
  char *statev = strrchr(file, ','), *props;
  if (statev) *statev++ = '\0';
  props = statev ? strrchr(file, ',') : NULL;
  if (props) *props++ = '\0';
  g->umat.n_props = props ? count_of(props, TALUS_LAW_MAX_PARAMETERS) : -1;
  g->umat.n_statev = props ? count_of(statev, UMAT_MOST_STATEV) : -1;
  if (g->umat.n_props >= 0 && g->umat.n_statev >= 0) return PETSC_TRUE;
  diag_error(diag, NULL, "--umat %s: behind the file stand NPROPS (at most %d) and NSTATV (at most %d)", g->spec,
             TALUS_LAW_MAX_PARAMETERS, UMAT_MOST_STATEV);
  diag_hint(diag, "--umat clay=./clay.so,6,3");
  return PETSC_FALSE;
}

static PetscBool take_name(Plugin *g, const char *spec, const char *equals, Diag *diag)
{
  snprintf(g->name, sizeof g->name, "%.*s", (int)PetscMin(equals - spec, 60), spec);
  if (!is_name(g->name, PETSC_TRUE)) {
    diag_error(diag, NULL, "'%s' cannot be the name of a law: lower-case letters, digits, '-' and '_'", g->name);
    return PETSC_FALSE;
  }
  if (!law_find(g->name)) return PETSC_TRUE;
  diag_error(diag, NULL, "there is a law '%s' already", g->name);
  diag_hint(diag, "--law my-%s=...", g->name);
  return PETSC_FALSE;
}

/* The file as the system knows it, so that nothing is searched for elsewhere. */
static PetscBool take_file(Plugin *g, const char *file, Diag *diag)
{
  char *path = realpath(file, NULL);
  if (path) snprintf(g->file, sizeof g->file, "%s", path);
  else diag_error(diag, NULL, "the library '%s' of the law %s cannot be read: %s", file, g->name, strerror(errno));
  free(path);
  return g->file[0] != '\0';
}

/* What its points keep can be written by its name. */
static PetscBool offer_fields(const Plugin *g, Diag *diag)
{
  PetscInt k = 0;
  for (const LawField *f = g->fields; f->name; k += f++->components) {
    const OutputField field = {f->name, f->unit, f->help, f->components, PETSC_TRUE, PETSC_FALSE};
    if (k < g->kept || output_field_add(&field)) continue;
    diag_error(diag, NULL, "%s: the state '%s' of the law has %d numbers, and that of another law does not", g->file,
               f->name, (int)f->components);
    diag_hint(diag, "fields of the output have one size for all laws: call it otherwise");
    return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool load(Plugin *g, const char *spec, PetscBool umat, Diag *diag)
{
  const char *equals = strchr(spec, '=');
  char file[PETSC_MAX_PATH_LEN];
  snprintf(g->spec, sizeof g->spec, "%s", spec);
  if (!equals || equals == spec || !equals[1]) {
    diag_error(diag, NULL, "'%s' is not NAME=FILE.so: the name by which the case calls the law, and its library", spec);
    return PETSC_FALSE;
  }
  snprintf(file, sizeof file, "%s", equals + 1);
  if (!take_name(g, spec, equals, diag)) return PETSC_FALSE;
  if (umat && !take_counts(g, file, diag)) return PETSC_FALSE;
  if (!take_file(g, file, diag)) return PETSC_FALSE;
  if (umat)
    snprintf(g->spec, sizeof g->spec, "--umat=%.60s=%.3900s,%d,%d", g->name, g->file, g->umat.n_props,
             g->umat.n_statev);
  else snprintf(g->spec, sizeof g->spec, "--law=%.60s=%.3900s", g->name, g->file);
  return umat ? open_umat(g, diag) : open_law(g, diag);
}

PetscErrorCode PluginLoad(const char *spec, PetscBool umat, Diag *diag)
{
  PetscFunctionBeginUser;
  if (n_plugins == PLUGIN_MOST) {
    diag_error(diag, NULL, "there are more than %d laws from libraries", PLUGIN_MOST);
    PetscFunctionReturn(0);
  }
  Plugin *g = &plugins[n_plugins];
  PetscCall(PetscMemzero(g, sizeof *g));
  if (!load(g, spec, umat, diag) || !offer_fields(g, diag)) PetscFunctionReturn(0);
  plugin_fill(n_plugins);
  plugin_watch();
  law_register(&g->law);
  words[n_plugins++] = g->spec;
  PetscFunctionReturn(0);
}
