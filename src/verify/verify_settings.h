/* Settings of a study as arguments of --set. */
#pragma once
#include "verify/verify_reference.h"

/* Read a mapping {path: value, ...}; values may be lists and mappings. Paths with dots are keys
 * here. */
PetscErrorCode SettingListRead(const YamlNode *mapping, SettingList *list);
PetscErrorCode SettingListClear(SettingList *list);

/* All that one row of one series changes: of the series, of the sweep ($symbol replaced by the
 * row's value), of the row, of the row for this series. */
PetscErrorCode SettingListCreate(const StudySpec *study, const SeriesSpec *series, const RowSpec *row,
                                 SettingList *list);
PetscBool setting_lists_equal(const SettingList *a, const SettingList *b);
