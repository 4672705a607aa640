/* Whole files in memory. */
#pragma once
#include <petscsys.h>

/* The bytes of a plain file and a 0 behind them, to be freed with PetscFree. Not collective. If it
 * cannot be read, *data is NULL and `why` says the reason; pipes and devices are no files. */
PetscErrorCode FileLoad(const char *path, char **data, size_t *length, const char **why);
