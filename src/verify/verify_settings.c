#include "verify/verify_settings.h"
#include <string.h>

PetscErrorCode SettingListCreate(const StudySpec *study, const SeriesSpec *series, const RowSpec *row,
                                 SettingList *list)
{
  const char *symbol = study->sweep.symbol;

  PetscFunctionBeginUser;
  *list = (SettingList){0};
  PetscCall(SettingListAppend(list, &series->set, symbol, row->at));
  PetscCall(SettingListAppend(list, &study->sweep.set, symbol, row->at));
  PetscCall(SettingListAppend(list, &row->set, symbol, row->at));
  for (PetscInt k = 0; k < row->n_sets; ++k)
    if (!strcmp(row->sets[k].name, series->name)) PetscCall(SettingListAppend(list, &row->sets[k], symbol, row->at));
  PetscFunctionReturn(0);
}
