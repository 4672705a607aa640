/* Files about cases (references, sweeps), read through tables as cases are; and the values of a case
 * that they change ({path: value, ...}): arguments of --set. */
#pragma once
#include "input/schema/schema.h"

/* Collective. Read a file through its table into `target`. Mistakes go to diag, with their place;
 * *document is then what could be read (YamlDestroy), for places of later ones. */
PetscErrorCode SchemaReadDocument(MPI_Comm comm, const char *file, const SchemaTable *table, Diag *diag,
                                  YamlDocument **document, void *target);

typedef struct {
  char *name; /* in a mapping of several by name; else NULL */
  PetscInt n;
  char **text; /* "path=value" */
} SettingList;

/* A mapping {path: value, ...} of a file that is read by tables; paths with dots are keys here, and
 * values may be lists and mappings. */
extern const SchemaTable schema_settings;
#define SET_KEY(name, help, owner, member) KEY(name, TABLE, NULL, help, .table = &schema_settings, AT(owner, member))

PetscErrorCode SettingListAdd(SettingList *list, const char *text);
/* Add what `settings` change, with value instead of $symbol (NULL: as they are). */
PetscErrorCode SettingListAppend(SettingList *list, const SettingList *settings, const char *symbol, const char *value);
PetscErrorCode SettingListClear(SettingList *list);
PetscBool setting_lists_equal(const SettingList *a, const SettingList *b);
