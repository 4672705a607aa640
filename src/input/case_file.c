#include "input/case_file.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "input/defaults.h"
#include "input/idle_keys.h"
#include "input/schema/schema.h"
#include "input/stages.h"
#include "method/method.h"
#include "method/time/time_scheme.h"
#include "model/model.h"
#include "model/stage/stage.h"

/* Of the time at which a stage begins, what its steps may be: rounded by a few millionths, or ten-thousandths. */
#define TOLD_WELL 1e-9
#define TOLD_AT_ALL 1e-11

static void destroy_document(void *document)
{
  YamlDocument *d = document;
  PetscCallAbort(PETSC_COMM_SELF, YamlDestroy(&d));
}

void case_file_path(const char *given, char file[PETSC_MAX_PATH_LEN])
{
  struct stat info;
  const PetscBool folder = !stat(given, &info) && S_ISDIR(info.st_mode);
  PetscSNPrintf(file, PETSC_MAX_PATH_LEN, folder ? "%s/case.yaml" : "%s", given);
}

/* Why a file cannot be read, in words; NULL if it can. */
static const char *unreadable(const char *file, size_t *size)
{
  struct stat info;
  if (stat(file, &info)) return errno == ENOENT ? "there is no such file" : strerror(errno);
  if (S_ISDIR(info.st_mode)) return "this is a directory; the case is a file in it, case.yaml as a rule";
  if (!S_ISREG(info.st_mode)) return "this is no plain file";
  if (info.st_size > YAML_MAX_BYTES) return "this file is too large for a case (more than 256 MiB)";
  *size = (size_t)info.st_size;
  return NULL;
}

static PetscErrorCode ReadBytes(const char *file, size_t *size, char **bytes, const char **reason)
{
  PetscFunctionBeginUser;
  *size = 0;
  *bytes = NULL;
  *reason = unreadable(file, size);
  if (*reason) PetscFunctionReturn(0);
  FILE *in = fopen(file, "rb");
  if (!in) *reason = strerror(errno);
  else {
    PetscCall(PetscMalloc1(*size + 1, bytes));
    *size = fread(*bytes, 1, *size, in);
    if (ferror(in)) *reason = strerror(errno);
    fclose(in);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FileReadEverywhere(MPI_Comm comm, const char *file, size_t *size, char **bytes, char reason[256])
{
  unsigned long long n = 0;
  const char *why = NULL;
  PetscMPIInt rank;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  memset(reason, 0, 256);
  *bytes = NULL;
  if (rank == 0) {
    PetscCall(ReadBytes(file, size, bytes, &why));
    n = *size;
    if (why) snprintf(reason, 256, "%s", why);
  }
  PetscCallMPI(MPI_Bcast(reason, 256, MPI_CHAR, 0, comm));
  PetscCallMPI(MPI_Bcast(&n, 1, MPI_UNSIGNED_LONG_LONG, 0, comm));
  *size = (size_t)n;
  if (reason[0]) PetscFunctionReturn(0);
  if (rank > 0) PetscCall(PetscMalloc1(*size + 1, bytes));
  PetscCallMPI(MPI_Bcast(*bytes, (PetscMPIInt)*size, MPI_CHAR, 0, comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode FolderOf(const char *file, char **folder)
{
  const char *slash = strrchr(file, '/');

  PetscFunctionBeginUser;
  PetscCall(PetscStrallocpy(slash == file ? "/" : slash ? file : ".", folder));
  if (slash && slash != file) (*folder)[slash - file] = '\0';
  PetscFunctionReturn(0);
}

/* The kinematics decide how long vectors are and which keys mean something: they are read ahead of
 * everything else. */
static void peek_kinematics(const YamlNode *root, SchemaReader *r)
{
  const YamlNode *node = yaml_find(root, "kinematics");
  const Kinematics *kinematics = node && node->kind == YAML_SCALAR ? kinematics_find(node->text) : NULL;
  r->dim = kinematics ? kinematics->dim : 0;
  r->hoop = kinematics ? kinematics->hoop : PETSC_FALSE;
}

/* Could the points of each cell share its change of volume? The cells of a mesh are not known yet. */
static PetscBool cells_share(const Case *c)
{
  const PetscBool several = c->grid.cell == CELL_QUADRILATERAL || c->grid.cell == CELL_HEXAHEDRON;
  const Basis *basis = basis_find(c->basis.kind);
  return (PetscBool)(c->grid.kind == GRID_BOX && several && (c->basis.by_default || basis->nodes == BASIS_OF_CELLS));
}

/* Are any of the stages an analysis of one of these types, NULL behind the last? */
static PetscBool stages_have(const YamlNode *stages, const char *const *types)
{
  for (PetscInt k = 0; stages && stages->kind == YAML_SEQUENCE && k < stages->n; ++k) {
    const YamlNode *type = yaml_find(yaml_find(stages->child[k], "analysis"), "type");
    for (const char *const *one = types; type && type->kind == YAML_SCALAR && *one; ++one)
      if (!strcmp(type->text, *one)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Does any of the stages seek something? Formulations are of all of them. */
static PetscBool stages_seek(const YamlNode *stages)
{
  return stages_have(stages, (const char *const[]){"factor-of-safety", "limit-load", NULL});
}

/* What yields without a change of volume locks with displacements alone, and nothing fails: who asks
 * for a factor of safety or a limit load and names no formulation gets one that does not. Where cells can share their
 * change of volume that is nearer to what is known, and several times cheaper (docs/decisions.md, 349); with dilatancy
 * Newton's method loses its way in the mixed one long before anything fails (263), and explicit dynamics has none.
 * Stages have that of the whole. */
static PetscErrorCode ResolveFormulation(const YamlNode *root, const Case *whole, Case *c)
{
  const Method *method = c->method ? method_find(c->method) : NULL;
  const PetscBool seeks = case_seeks(&c->analysis) || c->seeks;
  const PetscBool runs_explicit = c->analysis.type == ANALYSIS_EXPLICIT ||
                                  stages_have(yaml_find(root, "stages"), (const char *const[]){"explicit", NULL});

  PetscFunctionBeginUser;
  if (yaml_find(root, "formulation") || !seeks || !method || !method->takes_pressure) PetscFunctionReturn(0);
  const PetscBool shared = whole ? !strcmp(whole->formulation, "mean-dilatation") : cells_share(c);
  if (whole ? !case_is_mixed(whole) && !shared : !shared && runs_explicit) PetscFunctionReturn(0);
  PetscCall(PetscFree(c->formulation));
  PetscCall(PetscStrallocpy(shared ? "mean-dilatation" : "mixed", &c->formulation));
  if (shared && c->basis.by_default) c->basis.kind = method_basis(method, c);
  PetscFunctionReturn(0);
}

/* Statics begin in equilibrium: what the initial stress lacks of it is no part of the first step. So does what has
 * pressures of its own, whose nodes do not know them yet. */
static void resolve_equilibrium(const YamlNode *given, Case *c)
{
  const Method *method = c->method ? method_find(c->method) : NULL;
  if (!yaml_find(given, "reset_displacement")) c->initial.reset = case_has_stress(c);
  if (c->initial.equilibrium != EQUILIBRIUM_AUTO) return;
  const PetscBool sought = (PetscBool)(case_is_static(&c->analysis) || case_is_mixed(c));
  const PetscBool due = sought && case_has_stress(c) && !c->initial.run && method && !method->clouds;
  c->initial.equilibrium = due ? EQUILIBRIUM_DIRECT : EQUILIBRIUM_NONE;
}

/* What is out of balance at the start of statics fades over all of it. */
static void resolve_release(Case *c, const StageSpec *stage)
{
  const PetscReal usual = case_is_static(&c->analysis) ? c->analysis.end : 0;
  if (!case_goes_on(c)) return;
  if (c->stage > 0) c->release = stage->has_release ? stage->release : usual;
  else c->release = c->initial.has_release ? c->initial.release : usual;
}

/* Where something that may be raised stands in the case. */
static const char *raised_path(const Case *c, RaiseKind kind, PetscInt index, char path[64])
{
  switch (kind) {
  case RAISE_GRAVITY: snprintf(path, 64, "loads.gravity"); break;
  case RAISE_LOAD: return case_load_path(c, index, path);
  case RAISE_BOUNDARY: snprintf(path, 64, "boundary[%d]", (int)index); break;
  case RAISE_WALL: snprintf(path, 64, "walls[%d]", (int)index); break;
  case RAISE_NOTHING: path[0] = 0; break;
  }
  return path;
}

/* Are two of what may be raised entries of one list, which may not have a name twice anyway? */
static PetscBool same_list(const Case *c, RaiseKind a, PetscInt i, RaiseKind b, PetscInt k)
{
  return (PetscBool)(a == b && (a != RAISE_LOAD || c->loads[i].kind == c->loads[k].kind));
}

/* Who bears the name that is raised is meant, unless another one may be. */
static void ask_name(Case *c, RaiseKind kind, PetscInt index, const char *name, Diag *diag)
{
  LimitSpec *limit = &c->analysis.limit;
  char first[64], second[64], path[80];
  if (!name || strcmp(name, limit->raise)) return;
  if (limit->kind && same_list(c, limit->kind, limit->index, kind, index)) return;
  if (limit->kind) {
    snprintf(path, sizeof path, "%s.name", raised_path(c, kind, index, second));
    diag_error(diag, path, "the name '%s' is taken by %s, and analysis.limit.raise says it: which of them is raised?",
               name, raised_path(c, limit->kind, limit->index, first));
    diag_hint(diag, "let one of them have a name of its own");
    return;
  }
  limit->kind = kind;
  limit->index = index;
}

/* Which of the loads, of the boundary or of the walls bears the name? */
static void find_raised(Case *c, Diag *diag)
{
  ask_name(c, RAISE_GRAVITY, 0, "gravity", diag);
  for (PetscInt k = 0; k < c->n_loads; ++k) ask_name(c, RAISE_LOAD, k, c->loads[k].name, diag);
  for (PetscInt k = 0; k < c->n_boundary; ++k) ask_name(c, RAISE_BOUNDARY, k, c->boundary[k].name, diag);
  for (PetscInt k = 0; k < c->n_walls; ++k) ask_name(c, RAISE_WALL, k, c->walls[k].name, diag);
}

/* A displacement that is raised must be one, alone. */
static void check_raised(const Case *c, Diag *diag)
{
  const LimitSpec *limit = &c->analysis.limit;
  const WallSpec *wall = limit->kind == RAISE_WALL ? &c->walls[limit->index] : NULL;
  if (!case_raises_displacement(c)) return;
  if (wall && wall->absent) diag_error(diag, "analysis.limit.raise", "the wall '%s' is not there", limit->raise);
  else if (wall && (wall->n_motions != 1 || wall->motions[0].kind != MOTION_DISPLACEMENT)) {
    diag_error(diag, "analysis.limit.raise", "the motion of wall '%s' is not one `displacement` that could be raised",
               limit->raise);
    diag_hint(diag, "motion: [{displacement: {x: 0, y: -0.01}}]");
  } else if (!wall && c->boundary[limit->index].kind != MOTION_DISPLACEMENT)
    diag_error(diag, "analysis.limit.raise", "'%s' has no `displacement` that could be raised", limit->raise);
}

static PetscErrorCode ResolveRaised(const YamlNode *given, Diag *diag, Case *c)
{
  LimitSpec *limit = &c->analysis.limit;
  const char **names;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  if (c->analysis.type != ANALYSIS_LIMIT || !limit->raise) PetscFunctionReturn(0);
  find_raised(c, diag);
  if (!yaml_find(given, "most")) limit->most = case_raises_displacement(c) ? 1 : 1000;
  check_raised(c, diag);
  if (limit->kind) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(c->n_loads + c->n_boundary + c->n_walls + 2, &names));
  names[n++] = "gravity";
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (c->loads[k].name) names[n++] = c->loads[k].name;
  for (PetscInt k = 0; k < c->n_boundary; ++k)
    if (c->boundary[k].name) names[n++] = c->boundary[k].name;
  for (PetscInt k = 0; k < c->n_walls; ++k) names[n++] = c->walls[k].name;
  diag_error(diag, "analysis.limit.raise", "there is no load, no entry of the boundary and no wall '%s'", limit->raise);
  diag_hint_names(diag, limit->raise, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* Of schemes that know beta and gamma. */
static void check_newmark(const Case *c, Diag *diag)
{
  const AnalysisSpec *a = &c->analysis;
  const TimeScheme *scheme = time_scheme_of(a);
  if (a->type != ANALYSIS_DYNAMIC || !scheme || scheme->middle) return;
  if (a->gamma < 0.5 - a->bossak - 1e-12)
    diag_warning(diag, "analysis.gamma", "gamma < 0.5 - bossak: the time integration gains energy and is not stable");
  else if (a->beta < 0.5 * a->gamma - 1e-12)
    diag_warning(diag, "analysis.beta", "beta < gamma / 2: stable for small enough steps only");
}

/* whole: NULL, or the case of which it is stage k. */
/* Bodies that begin in balance with their weight. */
static void find_bearing(Case *c)
{
  const EquilibriumKind kind = c->initial.equilibrium;
  const PetscBool all = c->initial.run || kind == EQUILIBRIUM_DIRECT || kind == EQUILIBRIUM_ELASTIC_FIRST;
  for (PetscInt b = 0; b < c->n_bodies; ++b) c->bodies[b].bears = (PetscBool)(all || body_has_stress(c->bodies + b));
}

/* Those that have come into it in the stages before. */
static void bear_on(const Case *before, Case *c)
{
  const PetscBool rests = case_is_static(&before->analysis);
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    for (PetscInt k = 0; k < before->n_bodies; ++k) {
      const BodySpec *was = before->bodies + k;
      if (!strcmp(was->name, c->bodies[b].name)) c->bodies[b].bears |= was->bears || (rests && !was->absent);
    }
}

static PetscErrorCode ReadDocument(const char *file, YamlDocument *document, Diag *diag, const Case *whole, PetscInt k,
                                   Case **c)
{
  SchemaReader reader = {.document = document, .diag = diag};
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(PetscNew(c));
  (*c)->stage = k;
  (*c)->spec = whole ? whole->stages + k : NULL;
  (*c)->seeks = whole ? whole->seeks : stages_seek(yaml_find(document->root, "stages"));
  (*c)->staged = whole || yaml_find(document->root, "stages") ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(PetscStrallocpy(file, &(*c)->file));
  PetscCall(FolderOf(file, &(*c)->folder));
  reader.c = *c;
  peek_kinematics(document->root, &reader);
  PetscCall(SchemaReadTable(&reader, &schema_case, document->root, *c));
  PetscCall(DefaultTransfer(*c));
  PetscCall(ResolveFormulation(document->root, whole, *c));
  default_stabilisation(yaml_find(document->root, "stabilisation"), *c);
  const YamlNode *analysis = yaml_find(document->root, "analysis");
  PetscCall(DefaultScheme(analysis, *c));
  if (diag_errors(diag) == before) check_newmark(*c, diag); /* what was not read has no numbers yet */
  resolve_equilibrium(yaml_find(document->root, "initial"), *c);
  find_bearing(*c);
  PetscCall(ResolveRaised(analysis ? yaml_find(analysis, "limit") : NULL, diag, *c));
  resolve_release(*c, (*c)->spec);
  PetscFunctionReturn(0);
}

/* Since when an amplitude is there, and whether this stage has said it again. */
static void tell_age(const YamlNode *node, Amplitude *amplitude)
{
  amplitude->since = node->stage;
  amplitude->repeated = node->repeated;
}

/* Since when each thing of a stage is there. */
static void tell_ages(const YamlNode *root, Case *c)
{
  static const char *const lists[] = {"tractions", "pressures", "points"};
  const YamlNode *boundary = yaml_find(root, "boundary"), *walls = yaml_find(root, "walls"),
                 *loads = yaml_find(root, "loads");
  const YamlNode *measures = yaml_find(root, "measures");
  const YamlNode *gravity = yaml_find(loads, "gravity_amplitude");
  if (!gravity) gravity = yaml_find(loads, "gravity");
  if (gravity) tell_age(gravity, &c->gravity_amplitude);
  for (PetscInt i = 0; i < c->n_boundary; ++i) tell_age(boundary->child[i], &c->boundary[i].amplitude);
  for (PetscInt i = 0; i < c->n_measures; ++i) c->measures[i].since = measures->child[i]->stage;
  for (PetscInt i = 0; i < c->n_walls; ++i) {
    const YamlNode *shape = yaml_find(walls->child[i], "shape"), *mass = yaml_find(walls->child[i], "mass");
    c->walls[i].since = walls->child[i]->stage;
    if (shape) c->walls[i].drawn = shape->stage;
    if (mass) tell_age(mass, &c->walls[i].mass.amplitude);
    for (PetscInt k = 0; k < c->walls[i].n_motions; ++k) tell_age(walls->child[i], &c->walls[i].motions[k].amplitude);
  }
  for (PetscInt l = 0, n = 0; l < 3; ++l) {
    const YamlNode *list = yaml_find(loads, lists[l]);
    for (PetscInt i = 0; list && i < list->n; ++i) tell_age(list->child[i], &c->loads[n++].amplitude);
  }
}

/* Loads on what is not there. */
static void check_gone(const Case *c, Diag *diag)
{
  char path[64], on[96];
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    if (!c->loads[k].on.body || !c->bodies[case_body(c, c->loads[k].on.body)].absent) continue;
    snprintf(on, sizeof on, "%s.on.body", case_load_path(c, k, path));
    diag_error(diag, on, "the load acts on '%s', which is not there", c->loads[k].on.body);
    diag_hint(diag, "give it in the stage that brings '%s'", c->loads[k].on.body);
  }
}

/* Only a search knows what fails. */
static void check_beyond(const Case *before, const Case *c, Diag *diag)
{
  if (c->strength.beyond_failure == 0) return;
  if (before && (before->analysis.type == ANALYSIS_FACTOR || before->strength.beyond_failure > 0)) return;
  diag_error(diag, "strength.beyond_failure", "no search for a factor of safety comes before: there is no failure yet");
}

/* A column of the history has one unit. */
static void check_units(const Case *whole, PetscInt k, Diag *diag)
{
  const Case *c = whole->stage_case[k];
  char path[512];
  diag_of_stage(diag, k, whole->stages[k].name);
  for (PetscInt i = 0; i < c->n_measures; ++i) {
    const MeasureSpec *now = &c->measures[i], *column = case_column(whole, case_column_of(whole, now->name));
    if (!strcmp(measure_unit(now), measure_unit(column))) continue;
    snprintf(path, sizeof path, "measures.%s", now->name);
    diag_error(diag, path,
               "'%s' was a number in '%s' in the stages before, and would be one in '%s' in the same column", now->name,
               measure_unit(column), measure_unit(now));
    diag_hint(diag, "give it another name");
  }
  diag_of_stage(diag, -1, NULL);
}

/* Windows count from the start of the stage that brings their measure, which may go on through all later ones. */
static void check_windows(const Case *whole, PetscInt k, Diag *diag)
{
  const Case *c = whole->stage_case[k];
  PetscReal left = 0;
  char path[512];
  for (PetscInt j = k; j < whole->n_stages; ++j) left += whole->stage_case[j]->analysis.end;
  diag_of_stage(diag, k, whole->stages[k].name);
  for (PetscInt i = 0; i < c->n_measures; ++i) {
    const MeasureSpec *m = &c->measures[i];
    if (m->since != k || m->window[0] >= m->window[1] || m->window[0] < left) continue;
    snprintf(path, sizeof path, "measures.%s.%s.window", m->name, m->has_rate ? "rate" : "mean");
    diag_error(diag, path, "the window of '%s' begins when the run is over, %g s after the stage began", m->name,
               (double)left);
  }
  diag_of_stage(diag, -1, NULL);
}

/* The clock of a run goes on through its stages, and has 16 digits: after a stage of 1e9 s a step of 1e-4 s is a
 * thousandth off. */
static void check_clock(const Case *whole, PetscInt k, Diag *diag)
{
  const PetscReal step = whole->stage_case[k]->analysis.step;
  PetscReal begins = 0;
  PetscInt longest = 0;
  for (PetscInt j = 0; j < k; ++j) {
    begins += whole->stage_case[j]->analysis.end;
    if (whole->stage_case[j]->analysis.end > whole->stage_case[longest]->analysis.end) longest = j;
  }
  if (step >= TOLD_WELL * begins) return;
  diag_of_stage(diag, k, whole->stages[k].name);
  (step < TOLD_AT_ALL * begins ? diag_error : diag_warning)(
    diag, "analysis.step", "steps of %g s after %g s: the clock's 16 digits tell times there no better than %.1g s",
    (double)step, (double)begins, (double)(PETSC_MACHINE_EPSILON * begins));
  diag_hint(diag,
            "a smaller `end` of stage '%s' (of statics without rates it is no time that passes), or a case of its own "
            "with `initial: {run: ...}`, whose clock begins with 0",
            whole->stages[longest].name);
  diag_of_stage(diag, -1, NULL);
}

/* What a stage reads, the run reads. */
static PetscErrorCode TakeFiles(const Case *stage, Case *whole)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < stage->n_files; ++k)
    PetscCall(CaseAddFile(whole, stage->files[k].key, stage->files[k].path));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadStages(const char *file, YamlDocument *document, Diag *diag, Case *whole)
{
  YamlNode *root = document->root;

  PetscFunctionBeginUser;
  const PetscInt before = diag_errors(diag);
  PetscCall(PetscCalloc1(whole->n_stages, &whole->stage_case));
  for (PetscInt k = 0; k < whole->n_stages; ++k) {
    document->root = root;
    diag_of_stage(diag, -1, NULL);
    PetscCall(StageLay(document, k, diag));
    if (diag_errors(diag) > before) break; /* what later stages lack because of it is no mistake of theirs */
    document->root = document->stage[k];
    diag_of_stage(diag, k, whole->stages[k].name);
    PetscCall(ReadDocument(file, document, diag, whole, k, &whole->stage_case[k]));
    if (diag_errors(diag) > before) break;
    PetscCall(TakeFiles(whole->stage_case[k], whole));
    tell_ages(document->root, whole->stage_case[k]);
    check_gone(whole->stage_case[k], diag);
    check_beyond(k ? whole->stage_case[k - 1] : NULL, whole->stage_case[k], diag);
    if (k) bear_on(whole->stage_case[k - 1], whole->stage_case[k]);
    PetscCall(StageText(k ? whole->stage_case[k - 1] : whole, whole->stage_case[k], &whole->stages[k].text));
  }
  document->root = root;
  diag_of_stage(diag, -1, NULL);
  if (diag_errors(diag) > before) PetscFunctionReturn(0);
  PetscCall(CaseCollectColumns(whole));
  case_tell_changes(whole);
  for (PetscInt k = 0; k < whole->n_stages; ++k) {
    check_units(whole, k, diag);
    check_windows(whole, k, diag);
    check_clock(whole, k, diag);
    stage_advise_repeated(whole, k, diag);
  }
  for (PetscInt k = whole->n_stages - 1; k > 0; --k)
    PetscCall(LoadsWait(whole->stage_case[k], whole->stage_case[k - 1]));
  PetscFunctionReturn(0);
}

/* Words that stand for a mapping: before anything looks into it. */
static PetscErrorCode SpellOut(YamlDocument *document)
{
  PetscFunctionBeginUser;
  for (const SchemaEntry *e = schema_case.entries; e->key; ++e) {
    YamlNode *node = e->spelled ? yaml_find(document->root, e->key) : NULL;
    if (node) PetscCall(YamlSpellOut(document, node));
  }
  PetscFunctionReturn(0);
}

/* idle: is it told what has no effect in a run? */
static PetscErrorCode ReadText(const char *file, size_t size, const char *text, PetscInt n_set, const char *const *set,
                               PetscBool idle, Diag *diag, Case **c)
{
  const PetscInt before = diag_errors(diag);
  YamlDocument *document;

  PetscFunctionBeginUser;
  *c = NULL;
  PetscCall(YamlCreate(file, text, size, diag, &document));
  PetscCall(DiagSetResolver(diag, yaml_resolve, document));
  PetscCall(DiagOwnContext(diag, destroy_document));
  PetscCall(SpellOut(document));
  for (PetscInt i = 0; i < n_set; ++i) {
    PetscCall(YamlSet(document, set[i], diag));
    PetscCall(SpellOut(document));
  }
  if (document->root) PetscCall(ReadDocument(file, document, diag, NULL, 0, c));
  if (*c) check_beyond(NULL, *c, diag);
  if (diag_errors(diag) == before && *c && (*c)->n_stages) PetscCall(ReadStages(file, document, diag, *c));
  if (idle && diag_errors(diag) == before && *c) PetscCall(TellIdleKeys(document, *c, diag));
  if (diag_errors(diag) > before) PetscCall(CaseDestroy(c));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadFile(MPI_Comm comm, const char *file, PetscInt n_set, const char *const *set, PetscBool idle,
                               Diag *diag, Case **c)
{
  char *bytes, reason[256];
  size_t size = 0;

  PetscFunctionBeginUser;
  *c = NULL;
  PetscCall(FileReadEverywhere(comm, file, &size, &bytes, reason));
  if (reason[0]) {
    const DiagPlace place = {.file = file, .width = 1};
    diag_at(diag, DIAG_ERROR, &place, "%s", reason);
  } else PetscCall(ReadText(file, size, bytes, n_set, set, idle, diag, c));
  PetscCall(PetscFree(bytes));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseReadText(const char *file, size_t size, const char *text, PetscInt n_set, const char *const *set,
                            Diag *diag, Case **c)
{
  PetscFunctionBeginUser;
  PetscCall(ReadText(file, size, text, n_set, set, PETSC_TRUE, diag, c));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseRead(MPI_Comm comm, const char *file, PetscInt n_set, const char *const *set, Diag *diag, Case **c)
{
  PetscFunctionBeginUser;
  PetscCall(ReadFile(comm, file, n_set, set, PETSC_TRUE, diag, c));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseReadKept(MPI_Comm comm, const char *folder, Case **c)
{
  char file[PETSC_MAX_PATH_LEN];
  Diag *unheard;

  PetscFunctionBeginUser;
  *c = NULL;
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/case.yaml", folder));
  PetscCall(DiagCreate(&unheard));
  PetscCall(CaseRead(comm, file, 0, NULL, unheard, c));
  PetscCall(DiagDestroy(&unheard));
  PetscFunctionReturn(0);
}

PetscErrorCode CaseReadToTest(const char *file, PetscInt n_set, const char *const *set, Diag *diag, Case **c)
{
  PetscFunctionBeginUser;
  PetscCall(ReadFile(PETSC_COMM_SELF, file, n_set, set, PETSC_FALSE, diag, c));
  PetscFunctionReturn(0);
}
