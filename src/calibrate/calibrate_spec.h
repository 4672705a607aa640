/* What is to be calibrated: the language of the file is told in docs/calibrate.md. */
#pragma once
#include "calibrate/surrogate.h"
#include "input/settings.h"
#include "sweep/taken.h"

typedef struct {
  char *name;          /* $name in settings */
  PetscReal low, high; /* its range */
  char *unit, *label;  /* NULL: none, its name */
} Parameter;

/* What an experiment gave, and how far off a run may be. */
typedef struct {
  Taken taken;
  PetscReal value, uncertainty;
} Target;

/* An instrument: a case, and what is measured in it. */
typedef struct {
  char *name;
  char *folder; /* of the case, from that of the file; or the case file */
  SettingList set, quick;
  PetscInt n_targets;
  Target *targets;
  Taken *taken; /* shallow, side by side, for the members */
} Instrument;

typedef struct {
  char *title;
  PetscInt n_parameters;
  Parameter *parameters;
  SettingList set, quick; /* for all instruments */
  PetscInt n_instruments;
  Instrument *instruments;
  PetscInt points, batch, rounds; /* of parameters: at first, and in each of so many rounds */
  PetscReal resolve;              /* share of the uncertainty that the surrogate's error may be */
  YamlDocument *document;
} Calibration;

/* On a mistake *calibration stays NULL, and diag says file:line:column. */
PetscErrorCode CalibrationRead(const char *file, Diag *diag, Calibration **calibration);
PetscErrorCode CalibrationDestroy(Calibration **calibration);
