#include <stdio.h>
#include <string.h>
#include "basis/cell.h"
#include "case/fields.h"
#include "cli/cli.h"
#include "input/schema/schema.h"
#include "material/law.h"

static const CliUsage usage = {
  .usage = "talus list laws|methods|cells|measures|fields",
  .help = "Prints what a case file can name.",
  .min_words = 1,
  .max_words = 1,
};

static void PrintParameter(const SchemaEntry *e, PetscReal fallback)
{
  char range[80], left[80];
  SchemaRange(e, range, sizeof(range));
  snprintf(left, sizeof(left), "%s%s%s%s", e->key, e->unit && e->unit[0] ? " [" : "",
           e->unit && e->unit[0] ? e->unit : "", e->unit && e->unit[0] ? "]" : "");
  printf("    %-28s %s", left, e->help);
  if (range[0]) printf("; %s", range);
  if (!PetscIsNanReal(fallback)) printf("; default %g", (double)fallback);
  putchar('\n');
}

static void ListLaws(void)
{
  for (const Law *const *law = laws; *law; ++law) {
    printf("%s\n  %s\n", (*law)->name, (*law)->help);
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p) {
      const SchemaEntry entry = SchemaLawEntry(p);
      PrintParameter(&entry, p->fallback);
    }
  }
  printf("\nEvery law takes density [kg/m3] and two elastic constants:\n");
  for (const SchemaEntry *e = schema_elastic; e->key; ++e) PrintParameter(e, NAN);
}

static void ListMethods(void)
{
  for (const SchemaWord *w = schema_methods; w->word; ++w) printf("%-6s %s\n", w->word, w->help);
}

static void ListCells(void)
{
  for (int type = 0; type < 4; ++type) {
    printf("%-14s %s; points per cell:", cells[type].name, cells[type].help);
    for (const PetscInt *rule = cell_rules((CellType)type); *rule; ++rule) printf(" %d", (int)*rule);
    putchar('\n');
  }
}

static void ListMeasures(void)
{
  for (const SchemaEntry *e = schema_measure.entries; e->key; ++e) {
    if (!e->unit || e->with) continue; /* `of` and `at` are no measures */
    printf("%-18s [%s] %s", e->key, e->unit, e->help);
    for (const SchemaWord *w = e->words; w && w->word; ++w) printf("%s%s", w == e->words ? ": " : ", ", w->word);
    putchar('\n');
  }
}

static void ListFields(void)
{
  for (const OutputField *f = output_fields; f->name; ++f)
    printf("%-26s [%s] %s; %d component%s; %s\n", f->name, f->unit, f->help, (int)f->components,
           f->components > 1 ? "s" : "",
           f->points && f->grid ? "points and grid"
           : f->grid            ? "grid"
                                : "points");
}

static const struct {
  const char *name;
  void (*print)(void);
} lists[] = {{"laws", ListLaws},         {"methods", ListMethods}, {"cells", ListCells},
             {"measures", ListMeasures}, {"fields", ListFields},   {NULL, NULL}};

PetscErrorCode CliList(int argc, char **argv, int *exit_code)
{
  const char *names[8] = {NULL}, *nearest;
  CliArguments arguments;
  PetscBool go_on;
  char hint[80] = "laws, methods, cells, measures or fields";

  PetscFunctionBeginUser;
  PetscCall(CliParse(&usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  for (int i = 0; lists[i].name; ++i) {
    names[i] = lists[i].name;
    if (strcmp(lists[i].name, arguments.words[0])) continue;
    if (CliPrints()) lists[i].print();
    fflush(stdout);
    PetscFunctionReturn(0);
  }
  nearest = DiagNearest(arguments.words[0], names);
  if (nearest) snprintf(hint, sizeof(hint), "did you mean '%s'?", nearest);
  PetscCall(CliUsageError(exit_code, hint, "there is no list of '%s'", arguments.words[0]));
  PetscFunctionReturn(0);
}
