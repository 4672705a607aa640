/* Ids of sets of nodes (cells, faces), whatever their order. */
#pragma once
#include <petscsys.h>

#define TUPLE_MAX_WIDTH 8

typedef struct TupleTable TupleTable;

PetscErrorCode TupleTableCreate(PetscInt width, PetscInt capacity, TupleTable **table);
PetscErrorCode TupleTableDestroy(TupleTable **table);
/* The id of a tuple, which is new if it equals the number of those before. */
PetscInt tuple_add(TupleTable *table, const PetscInt *nodes);
/* -1: unknown. */
PetscInt tuple_find(const TupleTable *table, const PetscInt *nodes);
PetscInt tuple_count(const TupleTable *table);
