#include <stdio.h>
#include <string.h>
#include "base/text.h"
#include "basis/cell.h"
#include "case/fields.h"
#include "cli/cli.h"
#include "input/schema/schema.h"
#include "material/law.h"
#include "method/transfer/transfer.h"
#include "model/measure/measure.h"
#include "support/basis.h"

const CliUsage cli_list_usage = {
  .usage = "talus list laws|methods|transfers|bases|cells|measures|fields",
  .help = "Prints what a case file can name.",
  .examples = "talus list laws\ntalus list fields",
  .min_words = 1,
  .max_words = 1,
};

static void print_parameter(const SchemaEntry *e, PetscReal fallback)
{
  char range[80], left[TEXT_LABEL];
  schema_range(e, range, sizeof(range));
  printf("    %-28s %s", text_with_unit(e->key, e->unit, left), e->help);
  if (range[0]) printf("; %s", range);
  for (int k = 0; schema_word(e, k).word; ++k) printf("%s%s", k ? ", " : ": ", schema_word(e, k).word);
  if (e->type == TYPE_WORD) printf("; default %s", schema_word(e, (int)fallback).word);
  else if (!PetscIsNanReal(fallback)) printf("; default %g", (double)fallback);
  else if (e->note) printf("; default: %s", e->note);
  putchar('\n');
}

static void list_laws(void)
{
  for (const Law *const *law = laws; *law; ++law) {
    printf("%s\n  %s\n", (*law)->name, (*law)->help);
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = schema_law_entry(p);
      print_parameter(&entry, p->fallback);
    }
  }
  printf("\nEvery law takes density [kg/m3] and two elastic constants (modified-cam-clay has its own):\n");
  SchemaEntry e;
  for (PetscInt i = 0; (e = schema_elastic(i)).key; ++i) print_parameter(&e, NAN);
}

static void list_methods(void)
{
  for (const Method *const *method = methods; *method; ++method) printf("%-6s %s\n", (*method)->name, (*method)->help);
}

static void list_transfers(void)
{
  for (const Transfer *const *t = transfers; *t; ++t) printf("%-10s %s\n", (*t)->name, (*t)->help);
}

static void list_bases(void)
{
  for (const BasisName *b = basis_names; b->name; ++b) printf("%-6s %s\n", b->name, b->help);
}

static void list_cells(void)
{
  for (int type = 0; type < 4; ++type) {
    printf("%-14s %s; points per cell:", cells[type].name, cells[type].help);
    for (const PetscInt *rule = cell_rules((CellType)type); *rule; ++rule) printf(" %d", (int)*rule);
    putchar('\n');
  }
}

static void list_measures(void)
{
  for (const Measure *const *m = measures; *m; ++m) {
    const char *unit = (*m)->number.unit;
    printf("%-18s ", (*m)->key);
    if (unit) printf("[%s] ", unit);
    printf("%s", (*m)->number.help);
    for (const MeasureNumber *const *w = (*m)->words; w && *w; ++w) {
      printf("%s%s", w == (*m)->words ? ": " : ", ", (*w)->word);
      if (!unit && (*w)->unit[0]) printf(" [%s]", (*w)->unit);
    }
    putchar('\n');
  }
}

static void list_fields(void)
{
  for (const OutputField *f = output_fields; f->name; ++f)
    printf("%-26s [%s] %s; %d component%s; %s\n", f->name, f->unit, f->help, (int)f->components,
           f->components > 1 ? "s" : "",
           f->points && f->grid ? "points and grid"
           : f->grid            ? "grid"
                                : "points");
}

static const char *law_word(int i) { return laws[i] ? laws[i]->name : NULL; }
static const char *method_word(int i) { return methods[i] ? methods[i]->name : NULL; }
static const char *transfer_word(int i) { return transfers[i] ? transfers[i]->name : NULL; }
static const char *basis_word(int i) { return basis_names[i].name; }
static const char *cell_word(int i) { return i < 4 ? cells[i].name : NULL; }
static const char *measure_word(int i) { return measures[i] ? measures[i]->key : NULL; }
static const char *field_word(int i) { return output_fields[i].name; }

static const struct {
  const char *name;
  void (*print)(void);
  const char *(*word)(int i);
} lists[] = {{"laws", list_laws, law_word},
             {"methods", list_methods, method_word},
             {"transfers", list_transfers, transfer_word},
             {"bases", list_bases, basis_word},
             {"cells", list_cells, cell_word},
             {"measures", list_measures, measure_word},
             {"fields", list_fields, field_word},
             {NULL, NULL, NULL}};

const char *cli_list_word(const char *list, int i)
{
  for (int k = 0; lists[k].name; ++k)
    if (!strcmp(lists[k].name, list)) return lists[k].word(i);
  return NULL;
}

PetscErrorCode CliList(int argc, char **argv, int *exit_code)
{
  const char *names[9] = {NULL}, *nearest;
  CliArguments arguments;
  PetscBool go_on;
  char hint[80] = "laws, methods, transfers, bases, cells, measures or fields";

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_list_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  for (int i = 0; lists[i].name; ++i) {
    names[i] = lists[i].name;
    if (strcmp(lists[i].name, arguments.words[0])) continue;
    if (cli_prints()) lists[i].print();
    fflush(stdout);
    PetscFunctionReturn(0);
  }
  nearest = diag_nearest(arguments.words[0], names);
  if (nearest) snprintf(hint, sizeof(hint), "did you mean '%s'?", nearest);
  PetscCall(CliUsageError(exit_code, hint, "there is no list of '%s'", arguments.words[0]));
  PetscFunctionReturn(0);
}
