/* reference.yaml: what a case must give, with the source of every number.
 * The language is told in docs/verification.md. */
#pragma once
#include "case/case.h"
#include "input/settings.h"

/* Where a number comes from; the words stand in reference.yaml. */
typedef enum {
  CONFIDENCE_NONE,
  CONFIDENCE_GIVEN,
  CONFIDENCE_RECOVERED,
  CONFIDENCE_VERIFIED,
  CONFIDENCE_ASSUMED
} Confidence;
extern const char *const confidence_words[];

typedef struct {
  char *text; /* NULL: see the series, then the study */
  Confidence confidence;
} Source;

typedef struct {
  char *name;
  char *title; /* in pictures; NULL: the name */
  SettingList set;
  PetscBool full;       /* only with --full */
  PetscReal time_scale; /* s, unit of time in a picture of its history */
  PetscBool has_tolerance;
  PetscReal tolerance;
  Source source;
} SeriesSpec;

typedef struct {
  char *at;    /* value of the sweep's variable, as written */
  PetscReal x; /* the same as a number, NaN if it is none */
  SettingList set;
  PetscInt n_sets;   /* by series */
  SettingList *sets; /* their names are those of series */
  PetscBool full;
  PetscBool has_reference; /* for every series */
  PetscReal reference;
  PetscInt n_references; /* by series */
  NamedValue *references;
  PetscBool has_tolerance;
  PetscReal tolerance;
  Source source;
  const YamlNode *node;
} RowSpec;

typedef struct {
  PetscBool has_value;
  PetscReal value;
  PetscInt n_values; /* by series */
  NamedValue *values;
  Source source;
  PetscReal order, order_tolerance; /* 0: not asked for */
  PetscReal from, to;               /* rows of the sweep between which the order must hold */
} ExactSpec;

typedef struct {
  char *series, *with;
  PetscReal tolerance; /* relative, */
  PetscReal absolute;  /* and what is added to it, in the unit of the measure */
} AgreeSpec;

/* A power law: how value - offset grows with the variable, by least squares of the logarithms. */
typedef struct {
  PetscReal from, to; /* rows of the sweep that it is fitted to */
  PetscReal offset;   /* of the measure */
  PetscBool has_exponent;
  PetscReal exponent, within;
  char *series; /* the one that must have the exponent; NULL: all */
} PowerSpec;

typedef struct {
  char *name, *symbol, *unit;
  SettingList set; /* $symbol stands for the value */
} SweepSpec;

/* A course in time, constant + linear t + quadratic t^2, from which the history of a measure is
 * compared: at its rows or, if every > 0, at multiples of that time. t counts from `start`. */
typedef struct {
  PetscReal constant, linear, quadratic, start, every, factor;
} CourseSpec;

typedef enum {
  VERIFY_FIGURE_NONE,
  VERIFY_FIGURE_CONVERGENCE,
  VERIFY_FIGURE_COST,
  VERIFY_FIGURE_VALUES,
  VERIFY_FIGURE_HISTORY,
  VERIFY_FIGURE_NORMAL_HISTORY
} VerifyFigure;

typedef struct {
  char *name, *title, *measure;
  SweepSpec sweep;
  PetscBool has_course; /* the value is the distance from it, not the measure at the end */
  CourseSpec course;
  PetscBool moments; /* the rows are times of the history, s */
  PetscInt n_series;
  SeriesSpec *series;
  PetscInt n_rows;
  RowSpec *rows;
  PetscReal tolerance, absolute;
  PetscBool at_most; /* references are upper bounds */
  char *pace;        /* series with whose time that of the others is compared; may be NULL */
  Source source;
  PetscBool has_exact;
  ExactSpec exact;
  PetscInt n_agree;
  AgreeSpec *agree;
  PetscInt n_powers;
  PowerSpec *powers;
  PetscInt n_limits;
  NamedValue *limits; /* of report_numbers */
  VerifyFigure figure;
  const YamlNode *node;
} StudySpec;

typedef struct {
  char *title;
  PetscInt n_studies;
  StudySpec *studies;
  YamlDocument *document; /* for the places of messages */
} Reference;

/* Does its figure show errors? */
static inline PetscBool verify_draws_errors(const StudySpec *study)
{
  return study->figure == VERIFY_FIGURE_CONVERGENCE || study->figure == VERIFY_FIGURE_COST;
}

/* What `limits` may bound. */
extern const char *const report_numbers[];

/* Collective. On a mistake *reference stays NULL and diag says file:line:column. */
PetscErrorCode ReferenceRead(MPI_Comm comm, const char *file, Diag *diag, Reference **reference);
PetscErrorCode ReferenceDestroy(Reference **reference);

/* What a row must give in a series; NaN if nothing is said. */
PetscReal reference_value(const RowSpec *row, const SeriesSpec *series);
PetscReal reference_exact(const StudySpec *study, const SeriesSpec *series);
PetscReal reference_tolerance(const StudySpec *study, const RowSpec *row, const SeriesSpec *series);
/* The nearest source: the row's, the series', the study's; NULL if there is none. */
const Source *reference_source(const StudySpec *study, const RowSpec *row, const SeriesSpec *series);
/* Is the power law fitted to this row? */
PetscBool power_takes(const PowerSpec *power, const RowSpec *row);
PetscInt reference_series(const StudySpec *study, const char *name); /* index, -1: none */
