/* PETSc options of the case's `petsc:` block. The command line wins; they last as long as the
 * model. */
#include "model/model_private.h"

/* "-name value" -> name (with its dash) and value: NULL if there is none, or it is `true`, which
 * switches on flags and viewers alike. */
static PetscErrorCode Split(const char *option, char name[256], const char **value)
{
  const char *blank = strchr(option, ' ');

  PetscFunctionBeginUser;
  PetscCall(PetscStrncpy(name, option, blank ? PetscMin((size_t)(blank - option) + 1, 256) : 256));
  *value = blank && strcmp(blank, " true") ? blank + 1 : NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsApply(Model *m)
{
  char name[256];
  const char *value = NULL;
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_petsc, &m->option_set));
  for (PetscInt k = 0; k < m->c->n_petsc; ++k) {
    PetscCall(Split(m->c->petsc[k], name, &value));
    PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
    if (given) continue;
    PetscCall(PetscOptionsSetValue(NULL, name, value));
    m->option_set[k] = PETSC_TRUE;
  }
  PetscFunctionReturn(0);
}

/* What SNES, KSP and PC make of the options, tried on solvers that are thrown away: PETSc's own
 * error is an internal one, with a trace. */
PetscErrorCode OptionsCheck(const Model *m, Diag *diag)
{
  SNES snes;
  const char *text;
  char *detail;

  PetscFunctionBeginUser;
  PetscCall(SNESCreate(m->comm, &snes));
  PetscCall(PetscPushErrorHandler(PetscReturnErrorHandler, NULL));
  const PetscErrorCode code = SNESSetFromOptions(snes);
  PetscCall(PetscPopErrorHandler());
  if (code <= PETSC_ERR_MEM) PetscCall(code); /* no memory; 1 where an object could not be made */
  if (code) {
    PetscCall(PetscErrorMessage(code, &text, &detail));
    diag_error(diag, "petsc", "PETSc refuses an option of this block or of the command line: %s",
               detail && detail[0] ? detail : text);
  }
  PetscCall(SNESDestroy(&snes));
  PetscFunctionReturn(0);
}

/* PETSc reads these when it ends, so none of them was used yet. */
static PetscBool is_for_the_end(const char *name)
{
  static const char *const words[] = {"log_",   "malloc",          "options_",      "mpidump", "objects_dump",
                                      "memory", "get_total_flops", "petsc_options", "saws",    NULL};
  for (int k = 0; words[k]; ++k)
    if (!strncmp(name, words[k], strlen(words[k]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does the option stand in the case's own block? */
static PetscErrorCode IsOfCase(const Model *m, const char *option, PetscBool *is)
{
  char name[256];
  const char *value;

  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  for (PetscInt k = 0; k < m->c->n_petsc && !*is; ++k) {
    PetscCall(Split(m->c->petsc[k], name, &value));
    *is = !strcmp(name + 1, option) && m->option_set[k];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ModelUnusedOptions(const Model *m, Diag *diag)
{
  PetscInt n;
  PetscBool of_case;
  char **names, **values, path[300];

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsLeftGet(NULL, &n, &names, &values));
  for (PetscInt k = 0; k < n; ++k) {
    if (is_for_the_end(names[k])) continue;
    PetscCall(IsOfCase(m, names[k], &of_case));
    PetscCall(PetscSNPrintf(path, sizeof path, "petsc.%s", names[k]));
    diag_warning(diag, of_case ? path : NULL, "nothing in this run asked for the PETSc option -%s", names[k]);
    diag_hint(diag, "it is misspelled, or belongs to a solver that was not used (-snes_view tells which were)");
  }
  PetscCall(PetscOptionsLeftRestore(NULL, &n, &names, &values));
  PetscFunctionReturn(0);
}

PetscErrorCode OptionsForget(Model *m)
{
  char name[256];
  const char *value = NULL;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; m->option_set && k < m->c->n_petsc; ++k) {
    if (!m->option_set[k]) continue;
    PetscCall(Split(m->c->petsc[k], name, &value));
    PetscCall(PetscOptionsClearValue(NULL, name));
  }
  PetscCall(PetscFree(m->option_set));
  PetscFunctionReturn(0);
}
