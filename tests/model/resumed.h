/* A run that is put away and taken up again gives the same bits. */
#pragma once
#include "case_builder.h"
#include "model/state/state.h"

/* `again`, a model of the same case, goes on from where m is. */
static inline void model_take_up(Model *m, Model *again)
{
  char reason[256] = "";
  Tables *tables;
  CALL(TablesCreate(&tables));
  CALL(ModelToTables(m, tables));
  CALL(ModelFromTables(again, tables, reason));
  CHECK(!reason[0], "%s", reason);
  CALL(TablesDestroy(&tables));
}

/* Both go so many steps, and are alike to the last bit in all fields of their points. */
static inline void models_go_on(Model *m, Model *again, int steps)
{
  for (int s = 0; s < steps; ++s) {
    model_step(m, PETSC_MAX_REAL);
    model_step(again, PETSC_MAX_REAL);
  }
  CHECK(m->points->n == again->points->n, "points differ");
  for (int f = 0; f < POINT_N_REAL; ++f)
    for (PetscInt i = 0; i < m->points->n * m->points->components[f]; ++i)
      CHECK(m->points->real[f][i] == again->points->real[f][i], "field %d is off by %g", f,
            (double)(m->points->real[f][i] - again->points->real[f][i]));
  CHECK(m->transfer_energy == again->transfer_energy, "accounts differ");
}
