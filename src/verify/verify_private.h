/* What the files of a verification share. */
#pragma once
#include "run/run.h"
#include "verify/verify.h"
#include "verify/verify_settings.h"

/* One run, and what was found. Numbers that there are none of are NaN. */
typedef struct {
  const StudySpec *study;
  const SeriesSpec *series;
  const RowSpec *row;
  char folder[PETSC_MAX_PATH_LEN]; /* its run directory */
  char unit[32];                   /* of the measure */
  SettingList set;
  PetscInt measure, n_measures; /* which one is compared */
  PetscReal *measures;          /* all of them, at the end of the run */
  PetscBool ran, shared;        /* shared: by an earlier study, no run of its own */
  PetscBool taken;              /* over from a run that was there already */
  /* what git said of the program that made that run, empty if nothing */
  char sources[64];
  RunResult result;
  RunSummary summary;
  PetscReal seconds; /* of the whole run, building the model included */
  PetscReal value;   /* what is compared */
  PetscReal reference;
  PetscReal deviation;  /* relative, from the reference */
  PetscReal error;      /* relative, from the exact value */
  PetscReal order;      /* observed, from the row before in this series */
  PetscReal difference; /* relative, the largest from a series it must agree with */
  PetscReal pace;       /* its seconds over those of the series that sets the pace */
  PetscBool pass;
  char why[512]; /* if it does not */
} VerifyRow;

typedef struct {
  MPI_Comm comm;
  PetscMPIInt rank, size;
  const VerifyOptions *options;
  char name[256];                /* of the case */
  char file[PETSC_MAX_PATH_LEN]; /* case.yaml... */
  PetscBool element;             /* ...or element.yaml, of one material point */
  char out[PETSC_MAX_PATH_LEN];
  Reference *reference;
  PetscInt n;
  VerifyRow *rows; /* by study, series, row */
} Verification;

/* verify_plan.c: the rows to be run, each tried by reading its case. */
PetscErrorCode VerifyPlan(Verification *v, Diag *diag);
/* Its two halves: all rows by name, and one of them by its case (to be destroyed; NULL and a
 * message if it cannot be read). */
PetscErrorCode VerifyPlanAll(Verification *v, Diag *diag);
PetscErrorCode VerifyPlanRow(Verification *v, VerifyRow *r, Diag *diag, Case **read);
PetscErrorCode VerifyPlanClear(Verification *v);
PetscErrorCode VerifyRowClear(VerifyRow *r);

/* verify_element.c: the same of a path of one material point, and its run. */
PetscErrorCode VerifyElementPlan(Verification *v, VerifyRow *r, Diag *diag);
PetscErrorCode VerifyElementRun(Verification *v, VerifyRow *r, Diag *diag);

/* verify_value.c: Collective. The value of a row that has run: the measure at the end, or the
 * distance of its history from a course, or the measure at a moment. */
PetscErrorCode VerifyValue(const Verification *v, VerifyRow *r, Diag *diag);

/* verify_found.c: Collective. Take the results of the row over from its folder, or from that of a
 * row with the same settings, if a run of this case has come to its end there on as many ranks. */
PetscErrorCode VerifyTakeOver(const Verification *v, VerifyRow *r, const Case *c, PetscBool *found);

/* Collective. What rank 0 has read of the run, to all. */
PetscErrorCode VerifyShareRow(const Verification *v, VerifyRow *r);

/* verify_judge.c: compare rows[k], which has run, with its reference and with the rows before
 * it. */
void verify_judge(VerifyRow *rows, PetscInt k);
/* Does the study's sweep have a direction in which errors should fall: are errors and orders to be
 * shown? */
PetscBool verify_has_errors(const StudySpec *study);

/* verify_power.c: the exponent of the power law in the series of rows[k], from its rows up to this
 * one; NaN before all rows that it is fitted to have run. */
PetscReal verify_exponent(const VerifyRow *rows, PetscInt k, const PowerSpec *power);
/* Its line below a table, without an end; "" if it is known of no series. */
void verify_power_text(const VerifyRow *rows, PetscInt first, PetscInt last, const PowerSpec *power, char text[512]);

/* verify_table.c: rows [first, last) are of one study. */
void verify_table_head(FILE *out, const Verification *v, PetscInt first);
void verify_table_row(FILE *out, const VerifyRow *r);
void verify_table_foot(FILE *out, const Verification *v, PetscInt first, PetscInt last);
/* All rows, of one run. */
void verify_table_run(FILE *out, const Verification *v);

/* verify_markdown.c: all studies that were run, in one of three ways. */
typedef enum {
  VERIFY_WITH_FIGURES, /* with the names of the figures beside it */
  VERIFY_SECTION,      /* without */
  VERIFY_STUDY_ALONE   /* without the section's heading; the study says when it was recorded */
} VerifyMarkdownPart;
PetscErrorCode VerifyMarkdown(const Verification *v, VerifyMarkdownPart part, char **text);
/* Is the verification.md in the folder such tables? For folders of versions that did not sign
 * them. */
PetscBool verify_is_table(const char *folder);

/* verify_history.c: curves of the measure over time, of rows [first, last), into DIR/<study>.png.
 * Of one rank. */
PetscErrorCode VerifyHistoryDraw(const Verification *v, PetscInt first, PetscInt last, Diag *diag, PetscBool *done);

/* verify_figure.c: DIR/<study>.png, if the study asks for one. Of one rank. */
PetscErrorCode VerifyFigureDraw(const Verification *v, PetscInt first, PetscInt last, Diag *diag, PetscBool *done);

/* What is recorded of a case. */
typedef struct {
  const char *all;   /* all that was run, with its heading */
  const char *study; /* run alone, NULL: the whole section is new */
  const char *alone; /* the study's part, which says itself when it was recorded */
} VerifySection;

/* verify_record.c: put the section of that name into the file in place of the one there, or at its end; of a study
 * run alone no more than its part, so that the others stay. 0 or an errno. */
PetscErrorCode VerifyRecord(const char *file, const char *name, const VerifySection *section, int *error);
/* docs/verification.md of the tree that holds the case. */
void verify_record_file(const char *folder, char file[PETSC_MAX_PATH_LEN]);
