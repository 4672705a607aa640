#include <string.h>
#include "boundary/bodies.h"

/* Nodes of cell `cell` are of a velocity field; sums are taken over all ranks. */
static void add_field(const Grid *grid, PetscInt cell, PetscInt field, PetscReal *sum)
{
  for (PetscInt I = 0; I < grid->nodes_per_cell; ++I) {
    PetscReal *at = sum + 2 * grid->cell_node[cell * grid->nodes_per_cell + I];
    at[0] += 1, at[1] += (PetscReal)field;
  }
}

PetscErrorCode NodeFields(const Grid *grid, const Case *c, const Points *points, PetscInt *field)
{
  PetscReal *sum; /* of each node: how often it was told, and what */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * grid->n_nodes, &sum));
  for (PetscInt e = 0; e < grid->n_cells && grid->n_fields > 1; ++e) add_field(grid, e, grid_field_of(grid, e), sum);
  for (PetscInt p = 0; p < points->n && grid->n_fields <= 1; ++p)
    add_field(grid, points->cell[p], case_field(c, points->body[p]), sum);
  PetscCall(GridSumToOwners(grid, 2, sum));
  PetscCall(GridToGhosts(grid, 2, sum));
  for (PetscInt i = 0; i < grid->n_nodes; ++i)
    field[i] = sum[2 * i] > 0 ? (PetscInt)(sum[2 * i + 1] / sum[2 * i] + 0.5) : -1;
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

PetscErrorCode EntryNodes(const Grid *grid, const Case *c, const MotionSpec *entry, const PetscInt *field, PetscInt *n,
                          PetscInt **nodes)
{
  PetscInt all;

  PetscFunctionBeginUser;
  PetscCall(GridSelectNodes(grid, &entry->on, &all, nodes));
  *n = 0;
  for (PetscInt k = 0; k < all; ++k)
    if (!field || case_takes_field(c, entry, field[(*nodes)[k]])) (*nodes)[(*n)++] = (*nodes)[k];
  PetscFunctionReturn(0);
}

PetscBool bodies_come_later(const Case *c, const MotionSpec *entry)
{
  for (PetscInt i = 0; i < entry->n_bodies; ++i)
    if (!c->bodies[case_body(c, entry->bodies[i])].absent) return PETSC_FALSE;
  return (PetscBool)(entry->n_bodies > 0);
}

static PetscBool names(const MotionSpec *entry, const char *body)
{
  for (PetscInt i = 0; i < entry->n_bodies; ++i)
    if (!strcmp(entry->bodies[i], body)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static void tell_one_field(PetscInt entry, const char *named, const char *other, Diag *diag)
{
  char path[64];
  snprintf(path, sizeof path, "boundary[%d].bodies", (int)entry);
  diag_error(diag, path, "boundary[%d] takes '%s' without '%s': no interface parts them, so their nodes are the same",
             (int)entry, named, other);
  diag_hint(diag,
            "name both or neither, or give them an interface, of any law if they never touch: "
            "interfaces: [{name: ..., between: [%s, %s]}]",
            named, other);
}

/* The first body that has a field of the entry and is not named, if any. */
static void check_entry(const Case *c, PetscInt entry, Diag *diag)
{
  const MotionSpec *s = c->boundary + entry;
  for (PetscInt i = 0; i < s->n_bodies; ++i)
    for (PetscInt b = 0; b < c->n_bodies; ++b) {
      if (names(s, c->bodies[b].name) || case_field(c, b) != case_field(c, case_body(c, s->bodies[i]))) continue;
      tell_one_field(entry, s->bodies[i], c->bodies[b].name, diag);
      return;
    }
}

void bodies_check(const Case *c, Diag *diag)
{
  for (PetscInt k = 0; k < c->n_boundary; ++k) check_entry(c, k, diag);
}
