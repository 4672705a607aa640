/* Rows that several ranks assemble: a rank's groups fill rows of nodes that another rank owns; their pairs go to the
 * owner, where they may meet columns that its own groups do not couple, or nodes that its part of the grid does not
 * even hold. */
#pragma once
#include <petscsf.h>
#include "solve/system/system.h"

typedef struct {
  PetscSF pairs;       /* roots: incoming pairs; leaves: pairs of this rank's ghost rows, from row_start[n_active] on */
  PetscInt *start;     /* n_active + 1: which incoming pairs belong to each owned row */
  PetscInt *number;    /* global number of each incoming pair's column node */
  PetscInt n_incoming; /* start[n_active] */
} SharedRows;

/* Collective. Of the system's pattern, which must live on. `ghost`: n_rows - n_active global numbers of the nodes of
 * the ghost rows, for the caller to free; NULL: not wanted. */
PetscErrorCode SharedRowsCreate(const System *system, SharedRows *shared, PetscInt **ghost);
PetscErrorCode SharedRowsDestroy(SharedRows *shared);

/* Collective. From the owned rows (roots) to this rank's ghost rows (leaves, from 0 on); NULL on one rank. */
PetscErrorCode GhostRows(const System *system, PetscSF *rows);
