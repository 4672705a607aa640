/* Reading a case file: YAML through one schema table, all mistakes reported with their place. */
#pragma once
#include <stdio.h>
#include "base/diag/diag.h"
#include "case/case.h"

/* Collective: rank 0 reads, every rank parses the same text. `set` holds n_set strings
 * "path.to.key=value" of --set, applied before validation. On any mistake *c stays NULL and diag
 * says what is wrong (its resolver is installed and lives until DiagDestroy). */
PetscErrorCode CaseRead(MPI_Comm comm, const char *file, PetscInt n_set, const char *const *set, Diag *diag, Case **c);
/* Collective. The case.yaml that a run has kept in its directory, without a word; NULL: there is none. */
PetscErrorCode CaseReadKept(MPI_Comm comm, const char *folder, Case **c);
/* Of this rank. The same of a case that is not run, one of whose materials is tested: what would have no effect in a
 * run is not told. */
PetscErrorCode CaseReadToTest(const char *file, PetscInt n_set, const char *const *set, Diag *diag, Case **c);
/* The same of a text that all ranks have: as if it stood in a file of this name, from whose folder
 * other files are looked for. */
PetscErrorCode CaseReadText(const char *file, size_t size, const char *text, PetscInt n_set, const char *const *set,
                            Diag *diag, Case **c);

/* The case file, that may be named by its folder. */
void case_file_path(const char *given, char file[PETSC_MAX_PATH_LEN]);

/* Collective. Rank 0 reads a file of text; every rank gets its bytes (PetscFree), or the reason why
 * there are none. */
PetscErrorCode FileReadEverywhere(MPI_Comm comm, const char *file, size_t *size, char **bytes, char reason[256]);

/* The resolved case as YAML: every key, defaults too, with units as comments. To be freed with
 * PetscFree. */
PetscErrorCode CaseToYaml(const Case *c, char **text);

/* Unit of the key at a path as in --set ("materials.sand.young": Pa); NULL if it has none, or there
 * is no such key. */
const char *schema_unit(const char *path);

/* The reference, printed from the schema table: plain text, Markdown (docs/case-file.md) or JSON
 * Schema. */
typedef enum { SCHEMA_TEXT, SCHEMA_MARKDOWN, SCHEMA_JSON } SchemaStyle;
PetscErrorCode SchemaPrint(FILE *out, SchemaStyle style);
