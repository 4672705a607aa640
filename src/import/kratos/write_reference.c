/* What the project compares itself with becomes measures of the case and rows of its
 * reference.yaml: of each component that is checked, the node or material point that has the most of it at the
 * end; of stresses the mean over all material points. */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "import/kratos/project.h"
#include "input/schema/schema.h"

#define NEGLIGIBLE 1e-9 /* of the largest component: rounding */

typedef struct {
  const KratosProject *project;
  const KratosCheck *check;
  const KratosFile *file;
  const YamlNode *times;
  FILE *measures, *reference;
  PetscInt n;
} Writer;

static const struct {
  const char *variable, *measure;
} followed[] = {{"DISPLACEMENT", "displacement"},
                {"MP_DISPLACEMENT", "displacement"},
                {"VELOCITY", "velocity"},
                {"MP_VELOCITY", "velocity"},
                {NULL, NULL}};

/* Number of "NODE_12", "PARTICLE_12", "MP_12"; -1: another key. */
static long entry_number(const char *key)
{
  static const char *const begins[] = {"NODE_", "PARTICLE_", "MP_", NULL};
  for (int i = 0; begins[i]; ++i) {
    const size_t n = strlen(begins[i]);
    if (!strncmp(key, begins[i], n) && isdigit((unsigned char)key[n])) return strtol(key + n, NULL, 10);
  }
  return -1;
}

/* Points that Kratos places in a cell, and in which order, by shape functions of its nodes; 0: not
 * known here. */
static PetscInt cell_points(PetscInt nodes, PetscInt dim, PetscInt points, PetscInt q, PetscReal N[MDPA_MAX_NODES])
{
  static const PetscReal xi[4] = {-1, 1, 1, -1}, eta[4] = {-1, -1, 1, 1};
  const PetscReal g = 1 / sqrt(3.);
  if (points == 1)
    for (PetscInt i = 0; i < nodes; ++i) N[i] = 1. / (PetscReal)nodes;
  else if (dim == 2 && nodes == 3 && points == 3)
    for (PetscInt i = 0; i < 3; ++i) N[i] = i == q ? 2. / 3 : 1. / 6;
  else if (dim == 2 && nodes == 4 && points == 4)
    for (PetscInt i = 0; i < 4; ++i) N[i] = 0.25 * (1 + xi[i] * xi[q] * g) * (1 + eta[i] * eta[q] * g);
  else return 0;
  return points;
}

/* Where material point k of the project begins; PETSC_FALSE: it is not known how Kratos counts. */
static PetscBool point_position(const KratosProject *p, PetscInt k, PetscReal x[3])
{
  PetscReal N[MDPA_MAX_NODES];
  for (PetscInt b = 0; b < p->n_bodies; ++b) {
    const MdpaIds *ids = &mdpa_part(p->body, p->bodies[b].part)->elements;
    const PetscInt points = p->bodies[b].points, n = points * ids->n;
    if (k >= n) {
      k -= n;
      continue;
    }
    const PetscInt e = mdpa_find(&p->body->elements, ids->id[k / points]);
    const MdpaEntity *cell = e < 0 ? NULL : &p->body->elements.entity[e];
    if (!cell || !cell_points(cell->n, p->dim, points, k % points, N)) return PETSC_FALSE;
    for (int d = 0; d < 3; ++d) {
      x[d] = 0;
      for (PetscInt i = 0; i < cell->n; ++i) x[d] += N[i] * p->body->x[cell->node[i]][d];
    }
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The values of a variable in time, a list; NULL if it is not there. */
static const YamlNode *history_of(const YamlNode *entry, const char *variable)
{
  const YamlNode *values = yaml_find(entry, variable);
  return values && values->kind == YAML_SEQUENCE && values->n ? values : NULL;
}

static PetscReal real(const YamlNode *node) { return node && node->kind == YAML_SCALAR ? strtod(node->text, NULL) : 0; }

static void begin_study(const Writer *w, const char *name, const char *title)
{
  fprintf(
    w->reference,
    "  %s:\n    title: %s\n    measure: %s\n    moments: true\n    sweep: {name: time, symbol: t, unit: s, set: {}}\n"
    "    series: {talus: {}}\n    tolerance: 0.01\n    source: what Kratos has stored with its project, %s\n    "
    "confidence: given\n"
    "    rows:\n",
    name, title, name,
    strrchr(w->file->document->file, '/') ? strrchr(w->file->document->file, '/') + 1 : w->file->document->file);
}

/* Kratos adds up steps: 0.30000000000000004. The case's time begins with 0. */
static void write_row(const Writer *w, PetscInt i, PetscReal value)
{
  const PetscReal time = real(w->times->child[i]) - w->project->start;
  fprintf(w->reference, "      - {at: %.12g, reference: %.12g}\n", (double)time, (double)value);
}

/* The entry that has the most of a component at the end, NULL if all is rounding beside `scale`. */
static const YamlNode *largest_entry(const YamlNode *root, const char *variable, PetscReal scale, PetscReal *most)
{
  const YamlNode *found = NULL;
  *most = NEGLIGIBLE * scale;
  for (PetscInt i = 0; i < root->n; ++i) {
    const YamlNode *values = entry_number(root->child[i]->key) >= 0 ? history_of(root->child[i], variable) : NULL;
    const PetscReal last = values ? PetscAbsReal(real(values->child[values->n - 1])) : 0;
    if (!values || last <= *most) continue;
    *most = last;
    found = root->child[i];
  }
  return found;
}

/* Where an entry begins. `first`: the smallest number of all. */
static PetscBool entry_position(const KratosProject *p, const YamlNode *entry, long first, PetscReal x[3])
{
  const long number = entry_number(entry->key);
  if (strncmp(entry->key, "NODE_", 5)) return point_position(p, (PetscInt)(number - first), x);
  const PetscInt node = number > p->grid->most ? -1 : mdpa_node(p->grid, (PetscInt)number);
  if (node < 0) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) x[d] = p->grid->x[node][d];
  return PETSC_TRUE;
}

static void follow(Writer *w, const YamlNode *entry, const char *measure, int d, const char *variable,
                   const PetscReal x[3])
{
  char name[160], title[200];
  snprintf(name, sizeof name, "%s_%c_%s_%ld", measure, "xyz"[d], w -> check -> points ? "point" : "node",
           entry_number(entry->key));
  snprintf(title, sizeof title, "%s along %c of the %s %ld", measure, "xyz"[d],
           w -> check -> points ? "material point" : "node", entry_number(entry->key));
  fprintf(w->measures, "  %s: {%s: %c, of: {tracer: [", name, measure, "xyz"[d]);
  for (PetscInt k = 0; k < w->project->dim; ++k) fprintf(w->measures, "%s%.12g", k ? ", " : "", (double)x[k]);
  fputs("]}}\n", w->measures);
  begin_study(w, name, title);
  const YamlNode *values = history_of(entry, variable);
  for (PetscInt i = 0; i < PetscMin(values->n, w->times->n); ++i) write_row(w, i, real(values->child[i]));
  ++w->n;
}

static PetscBool write_vector(Writer *w, const YamlNode *root, const char *variable, const char *measure)
{
  char component[KRATOS_NAME];
  PetscReal x[3], most[3], scale = 0;
  PetscBool known = PETSC_TRUE;
  long first = 2147483647;
  for (PetscInt i = 0; i < root->n; ++i)
    if (entry_number(root->child[i]->key) >= 0) first = PetscMin(first, entry_number(root->child[i]->key));
  for (int d = 0; d < w->project->dim; ++d) {
    snprintf(component, sizeof component, "%.200s_%c", variable, "XYZ"[d]);
    (void)largest_entry(root, component, 0, &most[d]);
    scale = PetscMax(scale, most[d]);
  }
  for (int d = 0; d < w->project->dim; ++d) {
    snprintf(component, sizeof component, "%.200s_%c", variable, "XYZ"[d]);
    const YamlNode *entry = largest_entry(root, component, scale, &most[d]);
    if (!entry) continue;
    known = entry_position(w->project, entry, first, x);
    if (known) follow(w, entry, measure, d, component, x);
  }
  return known;
}

/* Mean of component c of a stress over all material points at moment i. */
static PetscReal mean_stress(const YamlNode *root, const char *variable, PetscInt i, PetscInt c)
{
  PetscReal sum = 0;
  PetscInt n = 0;
  for (PetscInt k = 0; k < root->n; ++k) {
    const YamlNode *values = entry_number(root->child[k]->key) >= 0 ? history_of(root->child[k], variable) : NULL;
    if (!values || i >= values->n || values->child[i]->kind != YAML_SEQUENCE || c >= values->child[i]->n) continue;
    sum += real(values->child[i]->child[c]);
    ++n;
  }
  return n ? sum / n : 0;
}

static void write_stress(Writer *w, const YamlNode *root, const char *variable)
{
  static const char *const plane[] = {"xx", "yy", "xy"}, *const space[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  const PetscInt n = w->project->dim == 2 ? 3 : 6, last = w->times->n - 1;
  PetscReal scale = 0;
  for (PetscInt c = 0; c < n; ++c) scale = PetscMax(scale, PetscAbsReal(mean_stress(root, variable, last, c)));
  for (PetscInt c = 0; c < n; ++c) {
    const char *word = n == 3 ? plane[c] : space[c];
    char name[40], title[80];
    if (PetscAbsReal(mean_stress(root, variable, last, c)) <= NEGLIGIBLE * scale) continue;
    snprintf(name, sizeof name, "stress_%s", word);
    snprintf(title, sizeof title, "mean stress %s of all material points", word);
    fprintf(w->measures, "  %s: {stress: %s}\n", name, word);
    begin_study(w, name, title);
    for (PetscInt i = 0; i <= last; ++i) write_row(w, i, mean_stress(root, variable, i, c));
    ++w->n;
  }
}

static void write_variable(Writer *w, const YamlNode *root, const char *variable)
{
  PetscBool known = PETSC_TRUE;
  int i = 0;
  while (followed[i].variable && strcmp(followed[i].variable, variable)) ++i;
  if (followed[i].variable) known = write_vector(w, root, variable, followed[i].measure);
  else if (!strcmp(variable, "MP_CAUCHY_STRESS_VECTOR")) write_stress(w, root, variable);
  else diag_warning(w->project->diag, NULL, "%s is not compared: talus has no measure for it", variable);
  if (!known)
    diag_warning(w->project->diag, NULL, "%s is not compared: where its material points begin is not known", variable);
}

PetscErrorCode KratosWriteReference(const KratosProject *p, FILE *measures, FILE *reference, PetscInt *n)
{
  Writer w = {.project = p, .measures = measures, .reference = reference};
  KratosFile file;

  PetscFunctionBeginUser;
  fprintf(reference,
          "# Written by talus import kratos from the results that the project compares itself with.\ntitle: ");
  schema_write_text(reference, p->name);
  fputs("\nstudies:\n", reference);
  for (PetscInt i = 0; i < p->n_checks; ++i) {
    const YamlNode *variables = p->checks[i].variables;
    PetscCall(KratosOpen(p->diag, p->checks[i].file, &file));
    const YamlNode *root = file.document ? file.document->root : NULL;
    w.check = &p->checks[i];
    w.file = &file;
    w.times = root ? yaml_find(root, "TIME") : NULL;
    for (PetscInt k = 0; variables && w.times && w.times->kind == YAML_SEQUENCE && w.times->n && k < variables->n; ++k)
      if (variables->child[k]->text) write_variable(&w, root, variables->child[k]->text);
    PetscCall(YamlDestroy(&file.document));
  }
  *n = w.n;
  PetscFunctionReturn(0);
}
