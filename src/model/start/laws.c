/* What laws ask of the start (docs/theory.md, "Laws"): those that soften are told the size of the
 * cell in which each of their points starts, and those that need a stress must have one. */
#include <math.h>
#include "basis/cell.h"
#include "model/model_private.h"

/* That of the square or cube of the same measure; of a simplex, of which two fill a square and
 * six a cube, that of the square or cube that it is a part of. */
static PetscReal cell_size(const Grid *grid, PetscInt cell)
{
  const CellType type = grid_cell_type(grid, cell);
  PetscReal x[CELL_MAX_NODES * 3];
  grid_cell_x(grid, cell, x);
  const PetscReal parts = cells[type].nodes == grid->dim + 1 ? (grid->dim == 2 ? 2.0 : 6.0) : 1.0;
  return pow(parts * cell_volume(type, x), 1.0 / (PetscReal)grid->dim);
}

static void place_of(const Model *m, PetscInt p, PetscReal x[3])
{
  for (PetscInt d = 0; d < 3; ++d) x[d] = d < m->dim ? point_real(m->points, POINT_X, p)[d] : 0;
}

void places_start(const Model *m)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const Law *law = m->materials[m->points->material[p]].law;
    PetscReal x[3];
    if (!law->place) continue;
    place_of(m, p, x);
    law->place(x, point_real(m->points, POINT_STATE, p));
  }
}

void places_step(const Model *m)
{
  PetscBool asked = PETSC_FALSE;
  for (PetscInt i = 0; i < m->c->n_materials; ++i) asked |= m->materials[i].law->moved != NULL;
  for (PetscInt p = 0; p < m->points->n && asked; ++p) {
    const Law *law = m->materials[m->points->material[p]].law;
    PetscReal x[3];
    if (!law->moved) continue;
    place_of(m, p, x);
    law->moved(x, point_real(m->points, POINT_STATE, p));
  }
}

/* Of the cell in which point p starts, m. */
static PetscReal size_of(const Model *m, PetscInt p)
{
  const PetscInt cell = m->points->cell[p];
  return m->grid->cloud || cell < 0 ? m->grid->smallest : cell_size(m->grid, cell);
}

void sizes_of_bodies(const Model *m, PetscReal *range)
{
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal size = size_of(m, p);
    PetscReal *r = range + 2 * m->points->body[p];
    r[0] = r[1] > 0 ? PetscMin(r[0], size) : size;
    r[1] = PetscMax(r[1], size);
  }
}

void size_start(const Model *m, PetscInt p)
{
  const Material *material = &m->materials[m->points->material[p]];
  if (material->law->size)
    material->law->size(material->parameters, size_of(m, p), point_real(m->points, POINT_STATE, p));
}

/* Does the state of a point bear no update, not even one at rest? */
static PetscBool has_no_stress(const Model *m, PetscInt p)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Material *material = &m->materials[m->points->material[p]];
  PetscReal state[LAW_MAX_STATE], tau[6];
  if (!material->law->needs_stress) return PETSC_FALSE;
  return material->law->update(material->parameters, 1, identity, point_real(m->points, POINT_STATE, p), state, tau,
                               NULL) != LAW_OK;
}

void room_check(const Model *m, Diag *diag)
{
  if (!m->c->stabilisation.room) return;
  if (!m->method->restores_grid) {
    diag_error(diag, "stabilisation.room", "nodes of method %s go with the material: the room of points is theirs",
               m->method->name);
    diag_hint(diag, "leave it out; mpm needs it where grains flow on for long");
  } else if (m->formulation->pressure) {
    diag_error(diag, "stabilisation.room", "the mixed formulation has the volume of what flows from its pressures");
    diag_hint(diag, "leave it out, or `formulation: displacement`");
  } else if (!specs_yield(m->c->n_materials, m->c->materials)) {
    diag_error(diag, "stabilisation.room", "no material of the case yields: what cannot flow keeps its room");
    diag_hint(diag, "leave it out");
  }
}

void stress_tell_none(const Case *c, PetscInt b, const Law *law, Diag *diag)
{
  char path[64];
  PetscSNPrintf(path, sizeof path, "bodies[%d].material", (int)b);
  diag_error(diag, path, "'%s' is of %s, which has no state without stress: it must begin under a pressure",
             c->bodies[b].name, law->name);
  diag_hint(diag, "`k0` gives the body the stress of its weight, for example k0: 0.5");
}

void stresses_check(const Model *m, Diag *diag)
{
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    for (PetscInt p = 0; p < m->points->n; ++p) {
      if (m->points->body[p] != b || !has_no_stress(m, p)) continue;
      stress_tell_none(m->c, b, m->materials[m->points->material[p]].law, diag);
      break;
    }
}
