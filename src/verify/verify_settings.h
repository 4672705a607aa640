/* Settings of a study as arguments of --set. */
#pragma once
#include "verify/verify_reference.h"

/* All that one row of one series changes: of the series, of the sweep ($symbol replaced by the
 * row's value), of the row, of the row for this series. */
PetscErrorCode SettingListCreate(const StudySpec *study, const SeriesSpec *series, const RowSpec *row,
                                 SettingList *list);
