/* A run directory that is there: is it of this case, and what came out of it?
 *
 * A row's case is known in full (every key with its value), and so is that of a run, which keeps it
 * as case.yaml. Where both say the same, whatever was typed to get there, the run is a run of that
 * row. Keys that came later have their defaults in an older run. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "output/directory/run_dir_files.h"
#include "input/case_file.h"
#include "output/history.h"
#include "run/summary.h"
#include "verify/verify_private.h"

/* Top-level keys on which no result depends, but for round-off. */
static PetscBool is_idle(const char *line)
{
  static const char *const keys[] = {"title:", "output:", "checkpoint:", "linear:", "petsc:", NULL};
  for (int k = 0; keys[k]; ++k)
    if (!strncmp(line, keys[k], strlen(keys[k]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Take these keys, with the lines that belong to them, out of a resolved case. */
static void drop_idle(char *text)
{
  char *to = text;
  PetscBool idle = PETSC_FALSE;
  for (const char *line = text; *line;) {
    const size_t n = strcspn(line, "\n"), length = line[n] ? n + 1 : n;
    if (line[0] != ' ' && line[0] != '-') idle = is_idle(line);
    if (!idle) memmove(to, line, length), to += length;
    line += length;
  }
  *to = '\0';
}

PetscErrorCode VerifyFoundCase(MPI_Comm comm, const char *folder, char **text, char reason[256])
{
  char file[PETSC_MAX_PATH_LEN];
  size_t size;
  Diag *ignored;
  Case *c = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(file, sizeof file, "%s/case.yaml", folder));
  PetscCall(FileReadEverywhere(comm, file, &size, text, reason));
  PetscCall(PetscFree(*text));
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(DiagCreate(&ignored));
  PetscCall(CaseRead(comm, file, 0, NULL, ignored, &c));
  if (c) {
    PetscCall(CaseToYaml(c, text));
    drop_idle(*text);
  } else PetscCall(PetscStrncpy(reason, "is no case", 256));
  PetscCall(CaseDestroy(&c));
  PetscCall(DiagDestroy(&ignored));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyIsCase(const Case *c, const char *text, PetscBool *is)
{
  char *own;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(c, &own));
  drop_idle(own);
  *is = !strcmp(own, text);
  PetscCall(PetscFree(own));
  PetscFunctionReturn(0);
}

/* The value of `key = value` in a file of the run; empty if there is none. */
static void read_word(const char *folder, const char *name, const char *key, char word[64])
{
  char path[PETSC_MAX_PATH_LEN], line[256];
  const size_t n = strlen(key);
  word[0] = '\0';
  PetscSNPrintf(path, sizeof path, "%s/%s", folder, name);
  FILE *in = file_open_read(path);
  while (in && !word[0] && fgets(line, sizeof line, in)) {
    if (strncmp(line, key, n) || strncmp(line + n, " = ", 3)) continue;
    line[strcspn(line, "\n")] = '\0';
    PetscStrncpy(word, line + n + 3, 64);
  }
  if (in) fclose(in);
}

/* Of one rank: did the run come to its end, on as many ranks as now, and with which numbers? */
static PetscErrorCode ReadFinished(const Verification *v, const char *folder, VerifyRow *r, const Case *c,
                                   PetscBool *finished)
{
  char path[PETSC_MAX_PATH_LEN], reason[256], outcome[64], ranks[64];
  History history;

  PetscFunctionBeginUser;
  *finished = PETSC_FALSE;
  read_word(folder, "timings.txt", "outcome", outcome);
  read_word(folder, "version.txt", "ranks", ranks);
  read_word(folder, "version.txt", "sources", r->sources);
  if (strcmp(outcome, "done") || strtol(ranks, NULL, 10) != v->size) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/history.csv", folder));
  if (HistoryRead(path, &history, reason)) PetscFunctionReturn(0);
  const PetscReal *last = history.n_rows ? history.values + (history.n_rows - 1) * history.n_columns : NULL;
  summary_read(folder, &r->summary);
  *finished = last && (r->summary.ended[0] || last[0] >= c->analysis.end * (1 - 1e-9));
  for (PetscInt k = 0; k < r->n_measures && *finished; ++k) {
    const PetscInt column = history_column(&history, c->measures[k].name);
    r->measures[k] = column < 0 ? NAN : last[column];
  }
  PetscCall(HistoryFree(&history));
  PetscFunctionReturn(0);
}

/* From one folder; read by rank 0 for all. */
static PetscErrorCode TakeFrom(const Verification *v, const char *folder, VerifyRow *r, const Case *c, PetscBool *found)
{
  char *text, reason[256];

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(VerifyFoundCase(v->comm, folder, &text, reason));
  if (text) PetscCall(VerifyIsCase(c, text, found));
  PetscCall(PetscFree(text));
  if (*found && v->rank == 0) PetscCall(ReadFinished(v, folder, r, c, found));
  PetscCallMPI(MPI_Bcast(found, 1, MPIU_BOOL, 0, v->comm));
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyShareRow(const Verification *v, VerifyRow *r)
{
  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(r->measures, (PetscMPIInt)r->n_measures, MPIU_REAL, 0, v->comm));
  PetscCallMPI(MPI_Bcast(&r->summary, sizeof r->summary, MPI_BYTE, 0, v->comm));
  PetscCallMPI(MPI_Bcast(r->sources, sizeof r->sources, MPI_CHAR, 0, v->comm));
  r->seconds = r->summary.seconds;
  PetscFunctionReturn(0);
}

PetscErrorCode VerifyTakeOver(const Verification *v, VerifyRow *r, const Case *c, PetscBool *found)
{
  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  for (const VerifyRow *other = v->rows; other < v->rows + v->n && !*found; ++other) {
    if (!setting_lists_equal(&other->set, &r->set)) continue;
    PetscCall(TakeFrom(v, other->folder, r, c, found));
    if (*found && other != r) PetscCall(PetscStrncpy(r->folder, other->folder, sizeof r->folder));
  }
  if (!*found) PetscFunctionReturn(0);
  PetscCall(VerifyShareRow(v, r));
  r->result = RUN_DONE;
  r->ran = r->taken = PETSC_TRUE;
  PetscFunctionReturn(0);
}
