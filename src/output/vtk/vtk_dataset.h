/* Datasets of an HDF5 file that was damaged, or made by somebody else: what it says of itself is
 * not believed. */
#pragma once
#include <hdf5.h>
#include <petscsys.h>

/* Its rows, and how many numbers each has. -1: not there, or not what talus writes: numbers in a
 * list or a table, in one piece, within the
 * `bytes` that the file has. */
PetscInt64 dataset_rows(hid_t root, const char *name, PetscInt64 bytes, PetscInt *components);
/* Exactly n numbers. */
PetscBool dataset_read(hid_t root, const char *name, hid_t type, PetscInt64 n, void *values);
/* A string attribute of fixed length; "" if there is none. */
void dataset_string(hid_t object, const char *name, char *text, size_t n);
