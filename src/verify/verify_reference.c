/* The language of reference.yaml, read through the same tables as a case file. */
#include "verify/verify_reference.h"
#include "input/case_file.h"
#include "input/schema/keys/schema_keys.h"

const char *const confidence_words[] = {"", "given", "recovered", "verified", "assumed"};
const char *const report_numbers[] = {"iterations", "iterations-per-step", "steps", "halvings", "seconds", NULL};

static const SchemaWord confidences[] = {
  {"given", CONFIDENCE_GIVEN, "printed in the source"},
  {"recovered", CONFIDENCE_RECOVERED, "found in another public source of the same authors"},
  {"verified", CONFIDENCE_VERIFIED, "inferred, and confirmed by independent programs"},
  {"assumed", CONFIDENCE_ASSUMED, "chosen where the source is silent"},
  {NULL, 0, NULL},
};
static const SchemaWord figures[] = {
  {"none", VERIFY_FIGURE_NONE, "no figure"},
  {"convergence", VERIFY_FIGURE_CONVERGENCE, "relative error, both axes logarithmic"},
  {"cost", VERIFY_FIGURE_COST, "the same over the seconds that a run took"},
  {"values", VERIFY_FIGURE_VALUES, "values and references over the variable"},
  {"history", VERIFY_FIGURE_HISTORY, "the measure over time, a curve for each row"},
  {"normal-history", VERIFY_FIGURE_NORMAL_HISTORY, "the same over its value at the end"},
  {NULL, 0, NULL},
};

#define SOURCE_KEYS(owner)                                                          \
  KEY("source", TEXT, NULL, "where the numbers come from", AT(owner, source.text)), \
    KEY("confidence", WORD, NULL, "how sure they are", .words = confidences, AT(owner, source.confidence))

static const SchemaEntry sweep_entries[] = {
  KEY("name", TEXT, NULL, "what varies from row to row, in words", REQUIRED, AT(SweepSpec, name)),
  KEY("symbol", NAME, NULL, "its symbol; $symbol stands for the value in `set`", REQUIRED, AT(SweepSpec, symbol)),
  KEY("unit", TEXT, NULL, "its unit", AT(SweepSpec, unit)),
  SET_KEY("set", "values of the case file to change", SweepSpec, set),
  {.key = NULL},
};
static const SchemaTable sweep_table = {
  .name = "sweep", .help = "The variable of the rows.", .entries = sweep_entries, .size = sizeof(SweepSpec)};

static const SchemaEntry series_entries[] = {
  KEY("title", TEXT, NULL, "in pictures; default: its name", AT(SeriesSpec, title)),
  SET_KEY("set", "values of the case file to change", SeriesSpec, set),
  KEY("full", BOOLEAN, NULL, "only with --full", .fallback = "false", AT(SeriesSpec, full)),
  KEY("time-scale", NUMBER, NULL, "unit of time in a picture of its history, s", .fallback = "1", ABOVE(0),
      AT(SeriesSpec, time_scale)),
  KEY("tolerance", NUMBER, NULL, "relative", AT_LEAST(0), AT(SeriesSpec, tolerance), GIVEN(SeriesSpec, has_tolerance)),
  SOURCE_KEYS(SeriesSpec),
  {.key = NULL},
};
static const SchemaTable series_table = {
  .name = "series", .help = "One column of results.", .entries = series_entries, .size = sizeof(SeriesSpec)};

static PetscErrorCode CheckRow(SchemaReader *r, const YamlNode *mapping, void *target)
{
  RowSpec *row = target;

  PetscFunctionBeginUser;
  (void)r;
  row->node = mapping;
  if (!schema_parse_number(yaml_find(mapping, "at"), &row->x)) row->x = NAN;
  PetscFunctionReturn(0);
}

static const SchemaEntry row_entries[] = {
  KEY("at", TEXT, NULL, "value of the variable", REQUIRED, AT(RowSpec, at)),
  KEY("full", BOOLEAN, NULL, "only with --full", .fallback = "false", AT(RowSpec, full)),
  SET_KEY("set", "values of the case file to change", RowSpec, set),
  KEY("sets", NAMED, NULL, "values of the case file to change for one series alone", .table = &schema_settings,
      AT(RowSpec, sets), .count = offsetof(RowSpec, n_sets)),
  KEY("reference", NUMBER, NULL, "what every series must give", AT(RowSpec, reference), GIVEN(RowSpec, has_reference)),
  KEY("references", NUMBERS, NULL, "what each series must give", AT(RowSpec, references),
      .count = offsetof(RowSpec, n_references)),
  KEY("tolerance", NUMBER, NULL, "relative", AT_LEAST(0), AT(RowSpec, tolerance), GIVEN(RowSpec, has_tolerance)),
  SOURCE_KEYS(RowSpec),
  {.key = NULL},
};
static const SchemaGroup row_groups[] = {{GROUP_AT_MOST_ONE, {"reference", "references", NULL}}, {GROUP_NONE, {NULL}}};
static const SchemaTable row_table = {.name = "row",
                                      .help = "One row of the table.",
                                      .entries = row_entries,
                                      .groups = row_groups,
                                      .check = CheckRow,
                                      .size = sizeof(RowSpec)};

static const SchemaEntry exact_entries[] = {
  KEY("value", NUMBER, NULL, "the limit of every series", AT(ExactSpec, value), GIVEN(ExactSpec, has_value)),
  KEY("values", NUMBERS, NULL, "the limit of each series", AT(ExactSpec, values),
      .count = offsetof(ExactSpec, n_values)),
  SOURCE_KEYS(ExactSpec),
  KEY("order", NUMBER, NULL, "order of convergence expected", ABOVE(0), .with = "between", AT(ExactSpec, order)),
  KEY("order-tolerance", NUMBER, NULL, "how far the observed order may be off", .fallback = "0.1", ABOVE(0),
      AT(ExactSpec, order_tolerance)),
  KEY("between", INTERVAL, NULL, "rows [smallest, largest] between which the order is asked for", .with = "order",
      AT(ExactSpec, from), .second = offsetof(ExactSpec, to)),
  {.key = NULL},
};
static const SchemaGroup exact_groups[] = {{GROUP_ONE, {"value", "values", NULL}}, {GROUP_NONE, {NULL}}};
static const SchemaTable exact_table = {.name = "exact",
                                        .help = "What the values tend to.",
                                        .entries = exact_entries,
                                        .groups = exact_groups,
                                        .size = sizeof(ExactSpec)};

static const SchemaEntry agree_entries[] = {
  KEY("series", NAME, NULL, "the series compared", REQUIRED, AT(AgreeSpec, series)),
  KEY("with", NAME, NULL, "an earlier series", REQUIRED, AT(AgreeSpec, with)),
  KEY("tolerance", NUMBER, NULL, "relative", REQUIRED, ABOVE(0), AT(AgreeSpec, tolerance)),
  KEY("absolute", NUMBER, NULL, "added to it, in the unit of the measure", .fallback = "0", AT_LEAST(0),
      AT(AgreeSpec, absolute)),
  {.key = NULL},
};
static const SchemaEntry power_entries[] = {
  KEY("between", INTERVAL, NULL, "rows [smallest, largest] that it is fitted to", REQUIRED, AT(PowerSpec, from),
      .second = offsetof(PowerSpec, to)),
  KEY("offset", NUMBER, NULL, "what is taken from the measure, in its unit", .fallback = "0", AT(PowerSpec, offset)),
  KEY("exponent", NUMBER, NULL, "what it must be", .with = "within", AT(PowerSpec, exponent),
      GIVEN(PowerSpec, has_exponent)),
  KEY("within", NUMBER, NULL, "how far it may be off", .with = "exponent", ABOVE(0), AT(PowerSpec, within)),
  KEY("series", NAME, NULL, "the series that must have this exponent; default: all", AT(PowerSpec, series)),
  {.key = NULL},
};
static const SchemaTable power_table = {
  .name = "power", .help = "A power law of the rows.", .entries = power_entries, .size = sizeof(PowerSpec)};

static const SchemaTable agree_table = {
  .name = "agree", .help = "Two series that must agree.", .entries = agree_entries, .size = sizeof(AgreeSpec)};

/* A name that must be one of the study's series. */
static PetscInt series_named(SchemaReader *r, const StudySpec *study, const YamlNode *node, const char *name,
                             PetscBool key)
{
  const char *words[33] = {NULL};
  const PetscInt index = reference_series(study, name), n = PetscMin(study->n_series, 32);
  if (index >= 0) return index;
  for (PetscInt s = 0; s < n; ++s) words[s] = study->series[s].name;
  yaml_error(r->document, r->diag, node, key, "there is no series '%s' in this study", name);
  schema_hint_words(r, name, n, words);
  return -1;
}

static void check_series_names(SchemaReader *r, const StudySpec *study, const YamlNode *numbers)
{
  for (PetscInt i = 0; numbers && i < numbers->n; ++i)
    series_named(r, study, numbers->child[i], numbers->child[i]->key, PETSC_TRUE);
}

static void check_agree(SchemaReader *r, const StudySpec *study, const YamlNode *list)
{
  for (PetscInt k = 0; k < study->n_agree; ++k) {
    const YamlNode *series = yaml_find(list->child[k], "series"), *with = yaml_find(list->child[k], "with");
    const PetscInt a = series_named(r, study, series, study->agree[k].series, PETSC_FALSE);
    const PetscInt b = series_named(r, study, with, study->agree[k].with, PETSC_FALSE);
    if (a < 0 || b < 0 || b < a) continue;
    SchemaError(r, with, "'%s' must stand before '%s' among the series", study->agree[k].with, study->agree[k].series);
  }
}

static void check_powers(SchemaReader *r, const StudySpec *study, const YamlNode *list)
{
  for (PetscInt k = 0; k < study->n_powers; ++k) {
    const YamlNode *series = yaml_find(list->child[k], "series");
    PetscInt n = 0;
    if (series) series_named(r, study, series, study->powers[k].series, PETSC_FALSE);
    for (PetscInt i = 0; i < study->n_rows; ++i) n += power_takes(&study->powers[k], &study->rows[i]);
    if (n < 2) SchemaError(r, yaml_find(list->child[k], "between"), "a power law needs two rows above 0 between these");
  }
}

/* The series that sets the pace is the first one: its seconds are known when the others have
 * run. */
static void check_pace(SchemaReader *r, const StudySpec *study, const YamlNode *pace)
{
  if (!pace) return;
  if (series_named(r, study, pace, study->pace, PETSC_FALSE) > 0)
    SchemaError(r, pace, "'%s' must stand before all other series", study->pace);
}

static void check_limits(SchemaReader *r, const YamlNode *limits)
{
  PetscInt n = 0, found;
  while (report_numbers[n]) ++n;
  for (PetscInt i = 0; limits && i < limits->n; ++i) {
    for (found = 0; found < n && strcmp(report_numbers[found], limits->child[i]->key);) ++found;
    if (found < n) continue;
    SchemaKeyError(r, limits->child[i], "a run reports no '%s'", limits->child[i]->key);
    schema_hint_words(r, limits->child[i]->key, n, report_numbers);
  }
}

/* Every number has a source, and a place where a variable is a number has one. */
static void check_rows(SchemaReader *r, const StudySpec *study, PetscBool numeric)
{
  for (PetscInt i = 0; i < study->n_rows; ++i) {
    const RowSpec *row = &study->rows[i];
    check_series_names(r, study, yaml_find(row->node, "references"));
    check_series_names(r, study, yaml_find(row->node, "sets"));
    if (study->moments && !(row->x >= 0)) SchemaError(r, yaml_find(row->node, "at"), "a moment is a time in s");
    if (numeric && !(row->x > 0))
      SchemaError(r, yaml_find(row->node, "at"), "an order or a figure of convergence needs numbers above 0 here");
    for (PetscInt s = 0; s < study->n_series; ++s) {
      if (PetscIsNanReal(reference_value(row, &study->series[s])) || reference_source(study, row, &study->series[s]))
        continue;
      SchemaError(r, row->node, "this reference has no source");
      diag_hint(r->diag, "give source and confidence in the row, its series or the study");
      break;
    }
    for (PetscInt k = 0; k < i; ++k)
      if (!strcmp(study->rows[k].at, row->at))
        SchemaError(r, yaml_find(row->node, "at"), "there is a row at %s already", row->at);
  }
}

static PetscErrorCode CheckStudy(SchemaReader *r, const YamlNode *mapping, void *target)
{
  StudySpec *study = target;
  const YamlNode *exact = yaml_find(mapping, "exact");

  PetscFunctionBeginUser;
  study->node = mapping;
  if (study->moments && study->has_course)
    SchemaError(r, yaml_find(mapping, "moments"), "the distance from a course belongs to the whole run");
  check_rows(r, study, study->exact.order > 0 || study->figure == VERIFY_FIGURE_CONVERGENCE);
  if (study->has_exact) {
    check_series_names(r, study, yaml_find(exact, "values"));
    if (!study->exact.source.text && !study->source.text) SchemaKeyError(r, exact, "the exact value has no source");
  } else if (verify_draws_errors(study))
    SchemaError(r, yaml_find(mapping, "figure"), "a figure of convergence or cost needs `exact`");
  check_agree(r, study, yaml_find(mapping, "agree"));
  check_powers(r, study, yaml_find(mapping, "powers"));
  check_pace(r, study, yaml_find(mapping, "pace"));
  check_limits(r, yaml_find(mapping, "limits"));
  PetscFunctionReturn(0);
}

static const SchemaEntry course_entries[] = {
  KEY("constant", NUMBER, NULL, "at t = 0", .fallback = "0", AT(CourseSpec, constant)),
  KEY("linear", NUMBER, NULL, "times t", .fallback = "0", AT(CourseSpec, linear)),
  KEY("quadratic", NUMBER, NULL, "times t^2", .fallback = "0", AT(CourseSpec, quadratic)),
  KEY("start", NUMBER, NULL, "t counts from here, s; what is before does not count", .fallback = "0", AT_LEAST(0),
      AT(CourseSpec, start)),
  KEY("every", NUMBER, NULL, "compare at multiples of this time, s; 0: at every row of the history", .fallback = "0",
      AT_LEAST(0), AT(CourseSpec, every)),
  KEY("factor", NUMBER, NULL, "times the distance", .fallback = "1", AT(CourseSpec, factor)),
  {.key = NULL},
};
static const SchemaTable course_table = {
  .name = "course", .help = "A course in time.", .entries = course_entries, .size = sizeof(CourseSpec)};

static const SchemaEntry study_entries[] = {
  KEY("title", TEXT, NULL, "what the study shows", REQUIRED, AT(StudySpec, title)),
  KEY("measure", NAME, NULL, "the measure of the case that is compared, at the end of the run", REQUIRED,
      AT(StudySpec, measure)),
  KEY("course", TABLE, NULL, "the value is the root of the sum of squared distances of the history from this course",
      .table = &course_table, AT(StudySpec, course), GIVEN(StudySpec, has_course)),
  KEY("moments", BOOLEAN, NULL, "the rows are moments, in s, of one run: the value is the measure then",
      .fallback = "false", AT(StudySpec, moments)),
  KEY("sweep", TABLE, NULL, "the variable of the rows", .table = &sweep_table, REQUIRED, AT(StudySpec, sweep)),
  KEY("series", NAMED, NULL, "the columns of results", .table = &series_table, REQUIRED, AT(StudySpec, series),
      .count = offsetof(StudySpec, n_series)),
  KEY("rows", LIST, NULL, "the rows", .table = &row_table, REQUIRED, AT(StudySpec, rows),
      .count = offsetof(StudySpec, n_rows)),
  KEY("tolerance", NUMBER, NULL, "of the references, relative", REQUIRED, AT_LEAST(0), AT(StudySpec, tolerance)),
  KEY("absolute", NUMBER, NULL, "added to it, in the unit of the measure", .fallback = "0", AT_LEAST(0),
      AT(StudySpec, absolute)),
  KEY("at-most", BOOLEAN, NULL, "the references are upper bounds", .fallback = "false", AT(StudySpec, at_most)),
  KEY("pace", NAME, NULL, "the series with whose run time that of the others is compared", AT(StudySpec, pace)),
  SOURCE_KEYS(StudySpec),
  KEY("exact", TABLE, NULL, "what the values tend to", .table = &exact_table, AT(StudySpec, exact),
      GIVEN(StudySpec, has_exact)),
  KEY("agree", LIST, NULL, "series that must agree", .table = &agree_table, AT(StudySpec, agree),
      .count = offsetof(StudySpec, n_agree)),
  KEY("powers", LIST, NULL, "power laws of the rows", .table = &power_table, AT(StudySpec, powers),
      .count = offsetof(StudySpec, n_powers)),
  KEY("limits", NUMBERS, NULL, "what the numbers of a run may not exceed", AT(StudySpec, limits),
      .count = offsetof(StudySpec, n_limits)),
  KEY("figure", WORD, NULL, "picture of the study", .words = figures, .fallback = "none", AT(StudySpec, figure)),
  {.key = NULL},
};
static const SchemaTable study_table = {.name = "study",
                                        .help = "One table of results.",
                                        .entries = study_entries,
                                        .check = CheckStudy,
                                        .size = sizeof(StudySpec)};

static const SchemaEntry reference_entries[] = {
  KEY("title", TEXT, NULL, "the benchmark", REQUIRED, AT(Reference, title)),
  KEY("studies", NAMED, NULL, "tables by name", .table = &study_table, REQUIRED, AT(Reference, studies),
      .count = offsetof(Reference, n_studies)),
  {.key = NULL},
};
static const SchemaTable reference_table = {
  .name = "reference", .help = "Reference values of a case.", .entries = reference_entries, .size = sizeof(Reference)};

PetscErrorCode ReferenceRead(MPI_Comm comm, const char *file, Diag *diag, Reference **reference)
{
  const PetscInt before = diag_errors(diag);

  PetscFunctionBeginUser;
  PetscCall(PetscNew(reference));
  PetscCall(SchemaReadDocument(comm, file, &reference_table, diag, &(*reference)->document, *reference));
  if (diag_errors(diag) > before) PetscCall(ReferenceDestroy(reference));
  PetscFunctionReturn(0);
}

PetscErrorCode ReferenceDestroy(Reference **reference)
{
  PetscFunctionBeginUser;
  if (!*reference) PetscFunctionReturn(0);
  PetscCall(SchemaClear(&reference_table, *reference));
  PetscCall(YamlDestroy(&(*reference)->document));
  PetscCall(PetscFree(*reference));
  PetscFunctionReturn(0);
}
