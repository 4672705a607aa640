/* The reference as text and as Markdown. */
#include <math.h>
#include <string.h>
#include "case/fields.h"
#include "input/case_file.h"
#include "input/write/schema_print.h"
#include "material/law.h"

static void collect(SchemaTables *all, const SchemaTable *table)
{
  SchemaEntry e;
  for (PetscInt i = 0; i < all->n; ++i)
    if (all->table[i] == table) return;
  if (all->n == SCHEMA_MAX_TABLES) return;
  all->table[all->n++] = table;
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i)
    if (e.table) collect(all, e.table);
}

void schema_collect(SchemaTables *all)
{
  all->n = 0;
  collect(all, &schema_case);
}

const char *schema_default(const SchemaEntry *e, char *buffer, size_t size)
{
  if (e->required) snprintf(buffer, size, "required");
  else if (e->note) snprintf(buffer, size, "%s", e->note);
  else if (e->fallback && e->fallback[0]) snprintf(buffer, size, "%s", e->fallback);
  else buffer[0] = '\0';
  return buffer;
}

/* "number > 0", "word", "list of `body`" */
static const char *print_kind(const SchemaEntry *e, PetscBool markdown, char *buffer, size_t size)
{
  char range[80];
  schema_range(e, range, sizeof(range));
  snprintf(buffer, size, "%s%s%s%s", e->spelled ? "word or " : "", schema_types[e->type].short_name,
           range[0] && e->type != TYPE_SIZE && e->type != TYPE_COUNTS ? " " : "",
           e->type != TYPE_SIZE && e->type != TYPE_COUNTS ? range : "");
  const size_t used = strlen(buffer);
  if (e->table && markdown) snprintf(buffer + used, size - used, " [%s](#%s)", e->table->name, e->table->name);
  else if (e->table) snprintf(buffer + used, size - used, " '%s'", e->table->name);
  for (char *p = buffer + used; markdown && e->table && (p = strstr(p, "](#"));)
    for (p += 3; *p; ++p)
      if (*p == ' ') *p = '-';
  return buffer;
}

static const char *print_where(const SchemaEntry *e)
{
  return e->turns ? " (not in axisymmetry)" : e->only_2d ? " (2D)" : e->only_3d ? " (3D)" : "";
}

/* --- text --- */
static void text_entry(FILE *out, const SchemaEntry *e)
{
  char left[120], fallback[200], kind[160];
  snprintf(left, sizeof(left), "%s%s%s%s", e->key, e->unit && e->unit[0] ? " [" : "",
           e->unit && e->unit[0] ? e->unit : "", e->unit && e->unit[0] ? "]" : "");
  schema_default(e, fallback, sizeof(fallback));
  fprintf(out, "  %-28s %s%s\n", left, e->help, print_where(e));
  fprintf(out, "  %-28s   %s%s%s\n", "", print_kind(e, PETSC_FALSE, kind, sizeof(kind)),
          !fallback[0]  ? ""
          : e->required ? "; "
                        : "; default: ",
          fallback);
  for (int k = 0; schema_word(e, k).word; ++k)
    fprintf(out, "  %-28s   %-18s %s\n", "", schema_word(e, k).word, schema_word(e, k).help);
}

static const char *const group_rules[] = {"", "Exactly one of", "At most one of", "At least one of"};

static void text_group(FILE *out, const SchemaTable *table, const SchemaGroup *group)
{
  const char *key;
  fprintf(out, "  %s:", group_rules[group->kind]);
  for (PetscInt k = 0; (key = schema_group_key(table, group, k)); ++k) fprintf(out, " %s", key);
  fputc('\n', out);
}

static void text_table(FILE *out, const SchemaTable *table)
{
  SchemaEntry e;
  fprintf(out, "%s\n  %s\n", table->name, table->help);
  for (const SchemaGroup *group = table->groups; group && group->kind != GROUP_NONE; ++group)
    text_group(out, table, group);
  fputc('\n', out);
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) text_entry(out, &e);
  fputc('\n', out);
}

static SchemaEntry law_entry(const LawParameter *p, char *note, size_t size)
{
  SchemaEntry entry = schema_law_entry(p);
  if (!entry.required && !p->absent) {
    if (p->words) snprintf(note, size, "%s", p->words[(int)p->fallback]->word);
    else snprintf(note, size, "%g", (double)p->fallback);
    entry.note = note;
  }
  return entry;
}

static void text_laws(FILE *out)
{
  SchemaEntry e;
  char note[40];
  fprintf(
    out,
    "elastic constants\n  Any two of these belong to every material, unless its law has an elasticity of its own.\n\n");
  for (PetscInt i = 0; (e = schema_elastic(i)).key; ++i) text_entry(out, &e);
  for (const Law *const *law = laws; *law; ++law) {
    fprintf(out, "\nlaw %s\n  %s\n\n", (*law)->name, (*law)->help);
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = law_entry(p, note, sizeof(note));
      text_entry(out, &entry);
    }
  }
}

static void print_text(FILE *out)
{
  SchemaTables all;
  schema_collect(&all);
  for (PetscInt i = 0; i < all.n; ++i) text_table(out, all.table[i]);
  text_laws(out);
}

/* --- Markdown --- */
static void markdown_text(FILE *out, const char *text)
{
  for (const char *p = text; *p; ++p) {
    if (*p == '|') fputc('\\', out);
    fputc(*p, out);
  }
}

static void markdown_entry(FILE *out, const SchemaEntry *e)
{
  char fallback[200], kind[160];
  fprintf(out, "| `%s` | ", e->key);
  markdown_text(out, print_kind(e, PETSC_TRUE, kind, sizeof(kind)));
  fprintf(out, " | %s | ", e->unit ? e->unit : "");
  markdown_text(out, schema_default(e, fallback, sizeof(fallback)));
  fputs(" | ", out);
  markdown_text(out, e->help);
  fputs(print_where(e), out);
  for (int k = 0; schema_word(e, k).word; ++k)
    fprintf(out, "%s`%s`: %s", k ? "; " : "<br>", schema_word(e, k).word, schema_word(e, k).help);
  fputs(" |\n", out);
}

static void markdown_head(FILE *out)
{
  fputs("| key | value | unit | default | meaning |\n|---|---|---|---|---|\n", out);
}

static void markdown_table(FILE *out, const SchemaTable *table)
{
  SchemaEntry e;
  const char *key;
  fprintf(out, "\n## %s\n\n%s\n", table->name, table->help);
  for (const SchemaGroup *group = table->groups; group && group->kind != GROUP_NONE; ++group) {
    fprintf(out, "\n%s:", group_rules[group->kind]);
    for (PetscInt k = 0; (key = schema_group_key(table, group, k)); ++k) fprintf(out, "%s `%s`", k ? "," : "", key);
    fputs(".\n", out);
  }
  fputc('\n', out);
  markdown_head(out);
  for (PetscInt i = 0; (e = schema_entry(table, i)).key; ++i) markdown_entry(out, &e);
}

static void markdown_laws(FILE *out)
{
  SchemaEntry e;
  char note[40];
  fputs(
    "\n## elastic constants\n\nExactly two of these belong to every material, unless its law has an elasticity of its "
    "own (modified-cam-clay).\n\n",
    out);
  markdown_head(out);
  for (PetscInt i = 0; (e = schema_elastic(i)).key; ++i) markdown_entry(out, &e);
  for (const Law *const *law = laws; *law; ++law) {
    fprintf(out, "\n## law: %s\n\n%s.\n", (*law)->name, (*law)->help);
    if (!(*law)->parameters || !(*law)->parameters->name)
      fputs("\nNo parameters beyond density and two elastic constants.\n", out);
    else {
      fputc('\n', out);
      markdown_head(out);
    }
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = law_entry(p, note, sizeof(note));
      markdown_entry(out, &entry);
    }
  }
}

static void markdown_magnitudes(FILE *out)
{
  fputs(
    "\n## magnitudes\n\nNumbers larger than their unit can mean are refused, and smaller ones other than 0. In "
    "dynamics\n"
    "waves (the root of the P-wave modulus over the density) may not run faster than light, 3e8 m/s.\n\n"
    "| unit | at least | at most |\n|---|---|---|\n",
    out);
  for (const SchemaMagnitude *m = schema_magnitudes; m->unit; ++m) {
    fprintf(out, "| %s |", m->unit);
    if (m->least > 0) fprintf(out, " %g |", (double)m->least);
    else fputs("  |", out);
    fprintf(out, " %g |\n", (double)m->most);
  }
  fprintf(out, "| (factors of an amplitude) |  | %g |\n", SCHEMA_LARGEST_FACTOR);
}

static void markdown_fields(FILE *out)
{
  markdown_magnitudes(out);
  fputs("\n## fields\n\n| field | unit | components | where | meaning |\n|---|---|---|---|---|\n", out);
  for (const OutputField *f = output_fields; f->name; ++f)
    fprintf(out, "| `%s` | %s | %d | %s | %s |\n", f->name, f->unit, (int)f->components,
            f->points && f->grid ? "points, grid"
            : f->grid            ? "grid"
                                 : "points",
            f->help);
}

static void print_markdown(FILE *out)
{
  SchemaTables all;
  schema_collect(&all);
  fputs(
    "# The case file\n\n"
    "This reference is the output of `talus schema --markdown`. A case file is YAML; SI units, angles in degrees; "
    "tension positive.\n"
    "Vectors are `[x, y]` in two dimensions and `[x, y, z]` in three. Any value can be changed on the command line:\n"
    "`talus run case.yaml --set grid.size=0.25 --set 'bodies[0].points_per_cell=9'`.\n\n"
    "A case from somebody else computes and does nothing more. Its `petsc` block may choose solvers, set tolerances "
    "and "
    "print on the\nterminal; all other options of PETSc belong on the command line. A `.geo` that runs programs or "
    "writes "
    "files (`SystemCall`, `Save`,\n`Print`, `Printf > file`, `OnelabRun`, ...), also through `Include` and `Merge`, is "
    "refused unless `talus run`, `check` or `verify`\ngets `--trust`; that is said on the command line only and stands "
    "in "
    "no file.\n",
    out);
  for (PetscInt i = 0; i < all.n; ++i) markdown_table(out, all.table[i]);
  markdown_laws(out);
  markdown_fields(out);
}

PetscErrorCode SchemaPrint(FILE *out, SchemaStyle style)
{
  PetscFunctionBeginUser;
  if (style == SCHEMA_JSON) PetscCall(SchemaPrintJson(out));
  else if (style == SCHEMA_MARKDOWN) print_markdown(out);
  else print_text(out);
  fflush(out);
  PetscFunctionReturn(0);
}
