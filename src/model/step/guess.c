/* First guesses of a step: what inertia alone would bring, the increments of the step before, and
 * rest.
 *
 * Where a flow comes to rest the second is nearer: velocities that points give to the nodes of a
 * restored grid are not those that the last solution had there. Where motion only begins the first
 * is. Whichever would have been nearer to the last solution is tried first; if Newton fails from
 * it, the other one, and then rest.
 *
 * What is pressed down until the ground gives way goes on as it came: points yield on the sides
 * that they yielded on. From rest all of them would begin elastic again. */
#include "grid/cloud/cloud.h"
#include "model/model_private.h"

PetscBool node_moves(const Model *m, PetscInt node)
{
  return (PetscBool)(m->nodes->touched[node] && !(m->method->clouds && cloud_is_twin(m->grid, node)));
}

/* Only nodes that stay where they are have increments that mean something one step later; those of
 * a mesh know their own velocity. */
PetscBool guess_follows(const Model *m)
{
  return (m->scheme->inertia && m->method->restores_grid) || model_is_pressed(m);
}

/* Has it been pressed already? */
static PetscBool goes_on(const Model *m)
{
  return model_is_pressed(m) && m->guess.step > 0 && m->time > m->c->analysis.end;
}

/* Grains that rub along walls: their stress is what inertia alone knows nothing of, and by what it leaves the last
 * increments are better in 97 of 100 steps, also where they are farther away (docs/theory.md 50). */
static PetscBool stress_decides(const Model *m)
{
  return m->contact && contact_rubs(m->c) && materials_yield(m->c->n_materials, m->materials);
}

PetscInt guess_order(const Model *m, FirstGuess order[GUESS_N])
{
  PetscInt n = 0;
  if (goes_on(m)) order[n++] = GUESS_PREVIOUS;
  if (m->scheme->inertia) {
    const PetscBool known = guess_follows(m) && m->guess.step > 0;
    const PetscBool previous = m->guess.previous || stress_decides(m);
    if (known && previous) order[n++] = GUESS_PREVIOUS;
    order[n++] = GUESS_INERTIA;
    if (known && !previous) order[n++] = GUESS_PREVIOUS;
  }
  order[n++] = GUESS_REST;
  if (!m->scheme->inertia && m->contact) order[n++] = GUESS_GRIPPED;
  return n;
}

/* Acceleration stays. Where nodes take their velocity from points by a mass matrix, those hardly
 * reached may have any, which Newton's method does not always come back from: the mean of points
 * is smooth. */
static PetscReal inertia_alone(const Model *m, PetscReal dt, PetscInt i)
{
  const NodalFields *n = m->nodes;
  return dt * ((guess_follows(m) ? n->v_mean[i] : n->v[i]) + 0.5 * dt * n->a[i]);
}

static void guess_inertia(const Model *m, PetscReal dt, PetscReal *du)
{
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    const PetscBool moves = node_moves(m, node);
    for (PetscInt d = 0, i = node * m->dim; d < m->dim; ++d, ++i) du[i] = moves ? inertia_alone(m, dt, i) : 0;
  }
}

/* Along an axis: all of them where the node slides in a frame of its own. */
static PetscBool has_increment(const Model *m, PetscInt i)
{
  if (!m->nodes->fixed[i]) return PETSC_TRUE;
  return frame_of(&m->boundary->frames, i / m->dim) && !m->nodes->idle[i / m->dim];
}

/* What presses moves as it is told from the first guess on. */
static void put_prescribed(const Model *m, PetscReal *du)
{
  frames_turn(&m->boundary->frames, m->dim, du);
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i)
    if (m->nodes->fixed[i]) du[i] = m->nodes->prescribed[i];
  frames_turn(&m->boundary->frames, m->dim, du);
}

void guess_make(const Model *m, FirstGuess guess, PetscReal dt, PetscReal *du)
{
  const NodalFields *n = m->nodes;
  const PetscInt dofs = m->grid->n_nodes * m->dim;
  for (PetscInt k = 0; m->contact && k < m->contact->n_rigid; ++k)
    rigid_guess(m->contact->rigid + k, m->walls, guess == GUESS_PREVIOUS);
  if (guess == GUESS_REST || guess == GUESS_GRIPPED) {
    for (PetscInt i = 0; i < dofs; ++i) du[i] = 0;
    return;
  }
  guess_inertia(m, dt, du); /* nodes that the last step did not move know no other */
  for (PetscInt i = 0; guess == GUESS_PREVIOUS && i < dofs; ++i)
    if (n->previous[i] != 0 && has_increment(m, i)) du[i] = dt / m->guess.step * n->previous[i];
  if (guess == GUESS_PREVIOUS && model_is_pressed(m)) put_prescribed(m, du);
}

PetscErrorCode GuessLearn(Model *m, PetscReal dt)
{
  NodalFields *n = m->nodes;
  const PetscReal ratio = m->guess.step > 0 ? dt / m->guess.step : 0;
  /* squares of what was missing: from inertia, from the step before */
  PetscReal local[2] = {0, 0}, sum[2];

  PetscFunctionBeginUser;
  if (!guess_follows(m)) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m->system->n_active; ++k)
    for (PetscInt d = 0, i = m->system->active[k] * m->dim; d < m->dim; ++d, ++i) {
      if (n->previous[i] == 0 || !has_increment(m, i)) continue;
      const PetscReal inertia = n->du[i] - inertia_alone(m, dt, i);
      const PetscReal before = n->du[i] - ratio * n->previous[i];
      local[0] += inertia * inertia;
      local[1] += before * before;
    }
  PetscCall(MPIU_Allreduce(local, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  m->guess = (Guess){.step = dt, .previous = sum[1] < sum[0]};
  for (PetscInt i = 0; i < m->grid->n_nodes * m->dim; ++i) n->previous[i] = has_increment(m, i) ? n->du[i] : 0;
  PetscFunctionReturn(0);
}

/* Increments stand with the nodal fields. */
PetscErrorCode GuessToTables(Model *m, Tables *tables)
{
  Table *table;
  Column *column;

  PetscFunctionBeginUser;
  if (!guess_follows(m)) PetscFunctionReturn(0);
  PetscCall(TablesAdd(tables, "guess", PETSC_TRUE, 1, &table));
  PetscCall(TableAdd(table, "step", "s", COLUMN_REAL, 1, &m->guess.step, NULL));
  PetscCall(TableAdd(table, "previous", NULL, COLUMN_INT64, 1, NULL, &column));
  *(PetscInt64 *)column->data = m->guess.previous;
  PetscFunctionReturn(0);
}

/* Checkpoints that lack this table let the next step start from inertia. */
void guess_from_tables(Model *m, const Tables *tables, char reason[256])
{
  const Table *table = tables_find(tables, "guess");
  if (!guess_follows(m) || !table) return;
  const PetscReal *step = table_data(table, "step", COLUMN_REAL, 1, reason);
  const PetscInt64 *previous = table_data(table, "previous", COLUMN_INT64, 1, reason);
  if (!step || !previous || reason[0]) return;
  if (table->rows != 1 || !(*step >= 0 && *step <= PETSC_MAX_REAL) || (*previous != 0 && *previous != 1))
    snprintf(reason, 256, "guess makes no sense");
  else m->guess = (Guess){.step = *step, .previous = *previous};
}
