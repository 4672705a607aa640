/* Keys that have no effect in the case that they stand in, by one table, and materials of no body: whoever has
 * written one had something in mind, and is told. */
#include "input/idle_keys.h"
#include <math.h>
#include <string.h>
#include "input/defaults.h"
#include "input/schema/schema.h"
#include "method/method.h"
#include "method/time/time_scheme.h"
#include "method/transfer/transfer.h"

/* --- where a key has an effect; i: entry of the list that it stands in --- */
typedef PetscBool Works(const Case *c, PetscInt i);

static PetscBool has_inertia(const Case *c, PetscInt i) { return (void)i, !case_is_static(&c->analysis); }
/* Of a body, or a wall with mass: looked at in the stage with which it comes alone, since it has nothing left of it
 * later. */
static PetscBool starts(const Case *c, PetscInt i) { return has_inertia(c, i); }
static PetscBool is_explicit(const Case *c, PetscInt i) { return (void)i, c->analysis.type == ANALYSIS_EXPLICIT; }
static PetscBool has_springs(const Case *c, PetscInt i)
{
  return is_explicit(c, i) && c->n_walls + c->n_interfaces > 0;
}
static PetscBool iterates(const Case *c, PetscInt i) { return !is_explicit(c, i); }
static PetscBool grows(const Case *c, PetscInt i) { return !iterates(c, i) || !case_has_timed_factor(c); }
static PetscBool is_implicit(const Case *c, PetscInt i) { return has_inertia(c, i) && iterates(c, i); }
static PetscBool is_mixed(const Case *c, PetscInt i) { return (void)i, case_is_mixed(c); }
static PetscBool moves(const Case *c, PetscInt i) { return i < c->n_boundary && c->boundary[i].kind != MOTION_FIXED; }
static PetscBool settles(const Case *c, PetscInt i) { return (void)i, c->initial.equilibrium > EQUILIBRIUM_NONE; }

/* The midpoint rule looks back on no acceleration. */
static PetscBool is_newmark(const Case *c, PetscInt i)
{
  const TimeScheme *scheme = time_scheme_of(&c->analysis);
  return is_implicit(c, i) && (!scheme || !scheme->middle);
}

static const Method *method_of(const Case *c) { return c->method ? method_find(c->method) : NULL; }

static PetscBool has_grid(const Case *c, PetscInt i) { return (void)i, method_of(c) && method_of(c)->restores_grid; }

static PetscBool has_domains(const Case *c)
{
  const Basis *basis = c->basis.kind ? basis_find(c->basis.kind) : NULL;
  return basis && basis->domains;
}

/* Cells that are not full, by what hangs on a cell, or on a cloud. */
static PetscBool has_gaps(const Case *c, PetscInt i)
{
  return has_grid(c, i) || (method_of(c) && method_of(c)->clouds);
}
static PetscBool is_stiffened(const Case *c, PetscInt i) { return iterates(c, i) && has_gaps(c, i) && !has_domains(c); }
static PetscBool bends(const Case *c, PetscInt i) { return iterates(c, i) && has_grid(c, i) && has_domains(c); }
static PetscBool follows(const Case *c, PetscInt i)
{
  return bends(c, i) && c->grid.kind == GRID_BOX && !case_is_mixed(c);
}
static PetscBool is_lumped(const Case *c, PetscInt i)
{
  return is_implicit(c, i) && has_gaps(c, i) && c->analysis.mass != MASS_LUMPED;
}
static PetscBool is_tied(const Case *c, PetscInt i) { return is_implicit(c, i) && has_grid(c, i) && !has_domains(c); }

static PetscBool has_triangles(const Case *c, PetscInt i)
{
  return (void)i, c->grid.kind != GRID_BOX || c->grid.cell == CELL_TRIANGLE || c->grid.cell == CELL_TETRAHEDRON;
}

/* --- the table --- */
#define DYNAMIC "leave it out, or take `analysis: {type: dynamic}`"
#define NO_INERTIA "statics has no inertia", DYNAMIC
#define OF_SCHEMES "only implicit dynamics chooses a time scheme", DYNAMIC
#define OF_NEWMARK "only schemes newmark and bossak of implicit dynamics have it", DYNAMIC " and `scheme: newmark`"
#define OF_STEPS                                                                             \
  "explicit steps are divided by what waves take to cross a cell, not by how they converge", \
    "`analysis.courant` and `step` choose them"
#define NO_EQUATIONS "explicit steps solve no equations", DYNAMIC
#define OF_EXPLICIT "only explicit dynamics has it", "leave it out, or take `analysis: {type: explicit}`"

typedef struct {
  const char *list; /* of whose entries it is a key; NULL: of none */
  const char *key;
  Works *works;
  const char *why, *instead;
} IdleKey;

static const IdleKey keys[] = {
  {NULL, "analysis.damping", has_inertia, NO_INERTIA},
  {NULL, "analysis.transfer", has_inertia, NO_INERTIA},
  {NULL, "analysis.keep_velocity", has_inertia, NO_INERTIA},
  {NULL, "analysis.scheme", is_implicit, OF_SCHEMES},
  {NULL, "analysis.bossak", is_implicit, OF_SCHEMES},
  {NULL, "analysis.beta", is_newmark, OF_NEWMARK},
  {NULL, "analysis.gamma", is_newmark, OF_NEWMARK},
  {NULL, "analysis.mass", is_implicit, "only implicit dynamics chooses its mass matrix: explicit steps lump it",
   DYNAMIC},
  {NULL, "analysis.smallest", iterates, OF_STEPS},
  {NULL, "analysis.largest", iterates, OF_STEPS},
  {NULL, "analysis.largest", grows,
   "the `factor` of a load is a formula of t, and no step over it is longer than `step`",
   "an amplitude, at whose points steps end, in place of that formula, or leave it out"},
  {NULL, "analysis.travel", iterates, OF_STEPS},
  {NULL, "analysis.courant", is_explicit, OF_EXPLICIT},
  {NULL, "analysis.update", is_explicit, OF_EXPLICIT},
  {NULL, "analysis.contact_stiffness", has_springs, "only walls and interfaces of explicit dynamics are springs",
   "leave it out"},
  {NULL, "newton.residual", iterates, NO_EQUATIONS},
  {NULL, "newton.residual_absolute", iterates, NO_EQUATIONS},
  {NULL, "newton.increment", iterates, NO_EQUATIONS},
  {NULL, "newton.increment_absolute", iterates, NO_EQUATIONS},
  {NULL, "newton.max_iterations", iterates, NO_EQUATIONS},
  {NULL, "newton.ease", iterates, NO_EQUATIONS},
  {NULL, "linear", iterates, NO_EQUATIONS},
  {NULL, "mixed.stabilisation", is_mixed, "only `formulation: mixed` has it", "take that formulation, or leave it out"},
  {NULL, "stabilisation.stiffness", is_stiffened,
   "only implicit steps and statics of mpm with basis cell, and of gmm, have it",
   "with basis gimp and bspline `curvature` does the same; fem and explicit dynamics need nothing"},
  {NULL, "stabilisation.curvature", bends, "only implicit steps and statics of mpm with basis gimp or bspline have it",
   "with basis cell `stiffness` does the same; fem and explicit dynamics need nothing"},
  {NULL, "stabilisation.follow", follows,
   "only implicit steps and statics of mpm with basis gimp or bspline, displacements alone, have it",
   "with basis cell there is `stiffness`; fem and explicit dynamics need nothing"},
  {NULL, "stabilisation.mass", is_lumped, "only implicit dynamics of mpm and gmm with `mass: consistent` has it",
   "explicit steps, and `analysis: {mass: lumped}`, lump all of the mass; fem and statics need nothing"},
  {NULL, "stabilisation.inertia", is_tied, "only implicit dynamics of mpm with basis cell has it",
   "with basis gimp and bspline there is `curvature`; others need nothing"},
  {NULL, "grid.diagonal", has_triangles, "quadrilaterals and hexahedra are not cut",
   "`grid: {cell: triangle}` has diagonals"},
  {NULL, "grid.outside", has_grid, "only points of mpm can leave the grid",
   "the mesh of fem, or gmm's cloud, goes along"},
  {NULL, "initial.reset_displacement", settles, "nothing moves before the first step",
   "`initial: {equilibrium: direct}` looks for an equilibrium first"},
  {"boundary", "amplitude", moves, "`fix` holds at any time, whatever the factor",
   "`displacement`, `velocity` and `rotation` have an amplitude; stages let go (`absent: true`)"},
  {"bodies", "velocity", starts, NO_INERTIA},
  {"bodies", "spin", starts, NO_INERTIA},
  {"walls", "mass.velocity", starts, NO_INERTIA},
  {"walls", "mass.spin", starts, NO_INERTIA},
};

/* What chooses how a case is computed: a key that was there before somebody (--set, a series, a sweep) chose anew was
 * meant for what was chosen then. */
static const char *const choices[] = {
  "analysis",    "analysis.type",   "analysis.scheme",  "analysis.mass", "method",     "basis",   "formulation",
  "grid",        "grid.cell",       "grid.box",         "grid.mesh",     "kinematics", "initial", "initial.equilibrium",
  "initial.run", "analysis.bossak", "analysis.transfer"};

/* --- finding --- */
/* Where the key's value is in the Case, and in one that has the default; entry.key NULL: there is no such key. */
typedef struct {
  SchemaEntry entry;
  const char *value, *usual;
} Place;

static SchemaEntry entry_of(const SchemaTable *table, const char *key, size_t length)
{
  SchemaEntry e;
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i)
    if (strlen(e.key) == length && !strncmp(e.key, key, length)) break;
  return e;
}

static Place place_of(const SchemaTable *table, const char *path, const void *value, const void *usual)
{
  const size_t n = strcspn(path, ".");
  Place at = {entry_of(table, path, n), value, usual};
  at.value += at.entry.offset, at.usual += at.entry.offset;
  return path[n] && at.entry.key ? place_of(at.entry.table, path + n + 1, at.value, at.usual) : at;
}

static const YamlNode *node_at(const YamlNode *node, const char *path)
{
  char key[64];
  while (node && *path) {
    const size_t n = strcspn(path, ".");
    snprintf(key, sizeof key, "%.*s", (int)n, path);
    node = yaml_find(node, key);
    path += n + (path[n] == '.');
  }
  return node;
}

/* Numbers that the case would have without the keys of the table. */
static Case usual_of(const Case *c)
{
  Case usual = *c;
  AnalysisSpec *a = &usual.analysis;
  a->scheme = NULL;
  a->beta = analysis_usual_beta(a);
  a->gamma = analysis_usual_gamma(a);
  a->bossak = 0; /* where it is another one it has an effect */
  a->transfer = (char *)default_transfer(&usual, NULL);
  a->smallest = a->step / 1024;
  a->largest = a->step;
  a->courant = 0;
  a->courant = case_courant(a);
  usual.initial.reset = case_has_stress(c);
  default_stabilisation(NULL, &usual);
  return usual;
}

static PetscBool same_text(const char *a, const char *b) { return a == b || (a && b && !strcmp(a, b)); }

/* Does it say what is so anyway? A resolved case, which has all keys, does. */
static PetscBool says_usual(const YamlNode *node, const Place *at)
{
  const YamlNode fallback = {.kind = YAML_SCALAR, .plain = PETSC_TRUE, .text = (char *)at->entry.fallback};
  const PetscReal *number = (const PetscReal *)at->value, *usual = (const PetscReal *)at->usual;
  if (at->entry.fallback) return yaml_equal(node, &fallback);
  switch (at->entry.type) {
  case TYPE_NUMBER: return PetscAbsReal(*number - *usual) <= 1e-12 * PetscAbsReal(*usual);
  case TYPE_BOOLEAN: return *(const PetscBool *)at->value == *(const PetscBool *)at->usual;
  case TYPE_TEXT:
  case TYPE_WORD_TEXT: return same_text(*(char *const *)at->value, *(char *const *)at->usual);
  case TYPE_VECTOR:
  case TYPE_SPIN: return number[0] == 0 && number[1] == 0 && number[2] == 0;
  default: return PETSC_FALSE;
  }
}

static PetscBool chosen_later(const YamlNode *root, const YamlNode *node)
{
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(choices); ++k) {
    const YamlNode *choice = node_at(root, choices[k]);
    if (choice && choice->argument > node->argument) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* --- telling --- */
typedef struct {
  const YamlDocument *document;
  const Case *c;
  Diag *diag;
} Search;

static const YamlNode *root_of(const Search *s, PetscInt k)
{
  return s->c->n_stages ? s->document->stage[k] : s->document->root;
}

static const YamlNode *find(const Search *s, const IdleKey *key, PetscInt k, PetscInt i)
{
  const YamlNode *root = root_of(s, k), *list = key->list ? yaml_find(root, key->list) : NULL;
  if (!key->list) return node_at(root, key->key);
  return list && list->kind == YAML_SEQUENCE && i < list->n ? node_at(list->child[i], key->key) : NULL;
}

static PetscInt entries_of(const Case *c, const char *list)
{
  if (!list) return 1;
  if (!strcmp(list, "bodies")) return c->n_bodies;
  return !strcmp(list, "walls") ? c->n_walls : c->n_boundary;
}

static PetscBool is_there(const Case *c, const char *list, PetscInt i)
{
  if (i >= entries_of(c, list)) return PETSC_FALSE;
  return (PetscBool) !(strcmp(list, "walls") ? c->bodies[i].absent : c->walls[i].absent);
}

/* In the stage with which the entry comes, k or a later one. */
static PetscBool starts_moving(const Search *s, const char *list, PetscInt k, PetscInt i)
{
  for (PetscInt j = k; j < case_stages(s->c); ++j)
    if (is_there(case_stage(s->c, j), list, i)) return starts(case_stage(s->c, j), i);
  return PETSC_TRUE;
}

/* Has it an effect in the stage, or in a later one that still has it? */
static PetscBool works_from(const Search *s, const IdleKey *key, PetscInt k, PetscInt i)
{
  if (key->works == starts) return starts_moving(s, key->list, k, i);
  for (PetscInt j = k; j < case_stages(s->c); ++j) {
    const YamlNode *node = find(s, key, j, i);
    if (node && node->stage == k && key->works(case_stage(s->c, j), i)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

static void look_at(const Search *s, const IdleKey *key, PetscInt k, PetscInt i)
{
  const Case *c = case_stage(s->c, k), usual = usual_of(c);
  const YamlNode *node = find(s, key, k, i);
  const char *list = key->list;
  char path[128];
  if (!node || node->stage != k || works_from(s, key, k, i) || chosen_later(root_of(s, k), node)) return;
  Place at = {.entry = {.key = NULL}, .value = (const char *)c, .usual = (const char *)&usual};
  if (!list) at = place_of(&schema_case, key->key, at.value, at.usual);
  else {
    const Place all = place_of(&schema_case, list, at.value, at.usual);
    const size_t before = (size_t)i * all.entry.table->size;
    at = place_of(all.entry.table, key->key, *(char *const *)all.value + before, *(char *const *)all.usual + before);
  }
  if (!at.entry.key || says_usual(node, &at)) return;
  if (list) snprintf(path, sizeof path, "%s[%d].%s", list, (int)i, key->key);
  else snprintf(path, sizeof path, "%s", key->key);
  diag_warning(s->diag, path, "%s has no effect here: %s", path, key->why);
  diag_hint(s->diag, "%s", key->instead);
}

/* In any of the stages: one of a body that goes, or has not come, is of use. */
static PetscBool has_body(const Case *c, const char *material)
{
  for (PetscInt k = 0; k < case_stages(c); ++k)
    for (PetscInt b = 0; b < case_stage(c, k)->n_bodies; ++b)
      if (!strcmp(case_stage(c, k)->bodies[b].material, material)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void tell_materials(const Search *s, PetscInt k)
{
  const Case *stage = case_stage(s->c, k);
  const YamlNode *root = root_of(s, k), *materials = yaml_find(root, "materials");
  const PetscInt chosen = yaml_argument(yaml_find(root, "bodies"), PETSC_TRUE);
  char path[512];
  for (PetscInt i = 0; i < stage->n_materials; ++i) {
    const char *name = stage->materials[i].name;
    if (has_body(s->c, name) || chosen > yaml_argument(materials->child[i], PETSC_TRUE)) continue;
    snprintf(path, sizeof path, "materials.%s", name);
    diag_warning(s->diag, path, "%s has no effect here: no body is made of it", path);
    diag_hint(s->diag, "`bodies: [{material: %s, ..}]`, or leave it out", name);
  }
}

PetscErrorCode TellIdleKeys(const YamlDocument *document, const Case *c, Diag *diag)
{
  const Search s = {.document = document, .c = c, .diag = diag};

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < case_stages(c); ++k) {
    const Case *stage = case_stage(c, k);
    if (c->n_stages) diag_of_stage(diag, k, c->stages[k].name);
    for (size_t n = 0; n < PETSC_STATIC_ARRAY_LENGTH(keys); ++n) {
      const PetscInt entries = entries_of(stage, keys[n].list);
      for (PetscInt i = 0; i < entries; ++i) look_at(&s, keys + n, k, i);
    }
    tell_materials(&s, k);
  }
  diag_of_stage(diag, -1, NULL);
  PetscFunctionReturn(0);
}
