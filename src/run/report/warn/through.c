/* Walls with mass that went where nothing stops them: walls meet material, and not each other. */
#include "run/report/warn/warn.h"

/* The first other wall that the centre of wall k lies in, or -1. */
static PetscInt wall_around(const Model *m, PetscInt k, const PetscReal *centre)
{
  WallPlace place;
  for (PetscInt other = 0; other < m->c->n_walls; ++other)
    if (other != k && !m->c->walls[other].absent &&
        wall_near(m->walls, other, m->time, centre, PETSC_MAX_REAL, 0, &place) && place.gap < 0)
      return other;
  return -1;
}

static void warn_of_wall(const Model *m, const RigidWall *b, Diag *diag)
{
  const Grid *grid = m->grid;
  PetscReal centre[3];
  PetscBool out = PETSC_FALSE;
  char path[32];
  for (int d = 0; d < 3; ++d) centre[d] = b->body.centre[d] + b->now.moved[d];
  for (PetscInt d = 0; d < m->dim; ++d) out |= centre[d] < grid->min[d] || centre[d] > grid->max[d];
  out = (PetscBool)(out && m->contact->wall[b->wall].area == 0); /* what reaches in and is touched may stand there */
  const PetscInt other = wall_around(m, b->wall, centre);
  snprintf(path, sizeof path, "walls[%d]", (int)b->wall);
  if (other >= 0)
    diag_warning(diag, path, "at the end wall '%s' stands in wall '%s': walls meet material, and not each other",
                 m->c->walls[b->wall].name, m->c->walls[other].name);
  else if (out && m->method->restores_grid)
    diag_warning(diag, path, "at the end the centre of wall '%s' is outside of the grid, where nothing meets it",
                 m->c->walls[b->wall].name);
  else return;
  diag_hint(diag,
            "what is to land on a wall is a body, as stiff as need be; `free` keeps a wall from moving along an axis");
}

void warn_of_walls_through(const Model *m, Diag *diag)
{
  for (PetscInt k = 0; m->contact && k < m->contact->n_rigid; ++k) warn_of_wall(m, m->contact->rigid + k, diag);
}
