/* What nothing resists: unknowns whose diagonal in the tangent of statics is empty, as where every point around carries
 * grains that are apart, and bodies that all but nothing holds. A factorisation says no more than that it failed, or
 * moves them by kilometres. */
#include "solve/newton/newton_private.h"
#include <limits.h>
#include <string.h>

/* Of the largest diagonal: less is none. */
#define NO_STIFFNESS 1e-14
/* Of the largest increment: as much moves with it. */
#define AS_FAR 0.9
#define PLACE 96        /* characters of a place */
#define UNLIMITED 1e300 /* a strength that is none */

/* Diagonals of the tangent at local nodes (n_nodes x dim), and the largest of those that are free. */
static PetscErrorCode Diagonals(const Newton *n, PetscReal *diagonal, PetscReal *largest)
{
  const StepProblem *p = n->problem;
  PetscReal most = 0;
  Vec v;

  PetscFunctionBeginUser;
  PetscCall(VecDuplicate(n->x, &v));
  PetscCall(MatGetDiagonal(p->system->matrix, v));
  PetscCall(SystemToNodes(p->system, p->grid, v, 0, p->grid->dim, diagonal));
  PetscCall(VecDestroy(&v));
  for (PetscInt k = 0; k < p->system->n_active; ++k)
    for (PetscInt d = 0, i = p->system->active[k] * p->grid->dim; d < p->grid->dim; ++d, ++i)
      if (!p->fixed[i]) most = PetscMax(most, PetscAbsReal(diagonal[i]));
  PetscCall(MPIU_Allreduce(&most, largest, 1, MPIU_REAL, MPIU_MAX, n->comm));
  PetscFunctionReturn(0);
}

static PetscBool is_loose(const StepProblem *p, PetscInt node, const PetscReal *diagonal, PetscReal least)
{
  if (p->system->number[node] < 0) return PETSC_FALSE;
  for (PetscInt d = 0, i = node * p->grid->dim; d < p->grid->dim; ++d, ++i)
    if (!p->fixed[i] && PetscAbsReal(diagonal[i]) <= least) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The point of the lowest id that moves a loose node, over all ranks: its body and place. PETSC_FALSE: none does. */
static PetscErrorCode FindPoint(const Newton *n, const unsigned char *loose, PetscInt *body, PetscReal x[3],
                                PetscBool *found)
{
  const StepProblem *p = n->problem;
  const Support *s = p->in.support;
  const Points *points = p->in.points;
  PetscInt64 id = LLONG_MAX, least;
  PetscReal place[4] = {0, 0, 0, 0}, all[4];

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < s->n_groups; ++g)
    for (PetscInt q = s->point_start[g]; q < s->point_start[g + 1]; ++q) {
      const PetscReal *N = support_N(s, g, q), *at = point_real(points, POINT_X, q);
      PetscBool moves = PETSC_FALSE;
      for (PetscInt i = 0; i < support_nodes(s, g); ++i)
        if (N[i] > 0 && loose[s->node[s->node_start[g] + i]]) moves = PETSC_TRUE;
      if (!moves || points->id[q] >= id) continue;
      id = points->id[q];
      for (PetscInt d = 0; d < points->dim; ++d) place[d] = at[d];
      place[3] = (PetscReal)points->body[q];
    }
  PetscCall(MPIU_Allreduce(&id, &least, 1, MPIU_INT64, MPI_MIN, n->comm));
  if (id != least)
    for (int k = 0; k < 4; ++k) place[k] = -PETSC_MAX_REAL;
  PetscCall(MPIU_Allreduce(place, all, 4, MPIU_REAL, MPIU_MAX, n->comm));
  *found = (PetscBool)(least < LLONG_MAX);
  *body = *found ? (PetscInt)all[3] : -1;
  for (int d = 0; d < 3; ++d) x[d] = all[d];
  PetscFunctionReturn(0);
}

static const char *place_text(const Newton *n, const PetscReal x[3], char text[PLACE])
{
  snprintf(text, PLACE, n->problem->grid->dim == 2 ? "(%.4g, %.4g)" : "(%.4g, %.4g, %.4g)", (double)x[0], (double)x[1],
           (double)x[2]);
  return text;
}

static PetscReal parameter(const MaterialSpec *material, const char *name, PetscReal otherwise)
{
  for (PetscInt k = 0; k < material->n_parameters; ++k)
    if (!strcmp(material->parameters[k].name, name)) return material->parameters[k].value;
  return otherwise;
}

/* What would hold the body together: where a cut-off ends its tension no cohesion does. */
static const char *what_it_lacks(const Case *c, PetscInt body)
{
  for (PetscInt k = 0; k < c->n_materials; ++k) {
    const MaterialSpec *material = c->materials + k;
    if (strcmp(material->name, c->bodies[body].material) != 0) continue;
    if (parameter(material, "tension_cutoff", UNLIMITED) >= UNLIMITED) break;
    return parameter(material, "cohesion", 0) > 0 ? "some tension (raise `tension_cutoff`; it has cohesion)"
                                                  : "some cohesion and tension (`tension_cutoff`)";
  }
  return "some cohesion";
}

/* May its material come apart? Of a cloud whose material may not, what is loose is the cloud. */
static PetscBool may_come_apart(const StepProblem *p, PetscInt body)
{
  const Case *c = p->scene.c;
  for (PetscInt k = 0; k < c->n_materials && p->grid->cloud; ++k)
    if (!strcmp(c->materials[k].name, c->bodies[body].material)) return p->in.materials[k].law->yields;
  return PETSC_TRUE;
}

/* Loose: so many nodes, around a point of a body. */
static void tell_loose(Newton *n, const PetscInt loose[2], PetscInt body, const PetscReal x[3])
{
  const Case *c = n->problem->scene.c;
  char place[PLACE];
  if (may_come_apart(n->problem, body))
    snprintf(n->loose, sizeof n->loose,
             "nothing resists at %d of %d nodes, as around %s m in '%s': it has no stiffness there, as grains that are "
             "apart; hold it together, give it %s, or let it move (type: dynamic)",
             (int)loose[0], (int)loose[1], place_text(n, x, place), c->bodies[body].name, what_it_lacks(c, body));
  else
    snprintf(
      n->loose, sizeof n->loose,
      "nothing resists at %d of %d nodes, as around %s m in '%s': points see too few nodes there, or none to one "
      "side, as in cells much longer than wide; take cells of one shape, a larger `max_radius` of the basis, or "
      "method fem",
      (int)loose[0], (int)loose[1], place_text(n, x, place), c->bodies[body].name);
}

PetscErrorCode NewtonLooseReason(Newton *n, const char **reason)
{
  const StepProblem *p = n->problem;
  PetscReal *diagonal, largest, x[3];
  PetscInt counts[2] = {0, p->system->n_active}, all[2], body;
  unsigned char *loose;
  PetscBool found = PETSC_FALSE;

  PetscFunctionBeginUser;
  *reason = NULL;
  if (p->in.inertia > 0 || p->system->form == SYSTEM_BLOCKS) PetscFunctionReturn(0);
  PetscCall(PetscCalloc2(p->grid->n_nodes * p->grid->dim, &diagonal, p->grid->n_nodes, &loose));
  PetscCall(Diagonals(n, diagonal, &largest));
  for (PetscInt i = 0; i < p->grid->n_nodes; ++i) loose[i] = is_loose(p, i, diagonal, NO_STIFFNESS * largest);
  for (PetscInt k = 0; k < p->system->n_active; ++k) counts[0] += loose[p->system->active[k]];
  PetscCall(MPIU_Allreduce(counts, all, 2, MPIU_INT, MPI_SUM, n->comm));
  if (all[0]) PetscCall(FindPoint(n, loose, &body, x, &found));
  PetscCall(PetscFree2(diagonal, loose));
  if (!found) PetscFunctionReturn(0);
  tell_loose(n, all, body, x);
  *reason = n->loose;
  PetscFunctionReturn(0);
}

/* Nodes whose increment is among the largest, and the axis of that. */
static PetscErrorCode FarthestNodes(const Newton *n, unsigned char *far, int *axis)
{
  const StepProblem *p = n->problem;
  const PetscInt dim = p->grid->dim;
  PetscReal *increment, most[3] = {0, 0, 0};
  Vec v;

  PetscFunctionBeginUser;
  PetscCall(SNESGetSolutionUpdate(n->snes, &v));
  PetscCall(PetscCalloc1(p->grid->n_nodes * dim, &increment));
  PetscCall(SystemToNodes(p->system, p->grid, v, 0, dim, increment));
  for (PetscInt i = 0; i < p->grid->n_nodes * dim; ++i)
    most[i % dim] = PetscMax(most[i % dim], PetscAbsReal(increment[i]));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, most, 3, MPIU_REAL, MPIU_MAX, n->comm));
  *axis = most[2] > PetscMax(most[0], most[1]) ? 2 : most[1] > most[0];
  for (PetscInt i = 0; i < p->grid->n_nodes; ++i)
    far[i] = PetscAbsReal(increment[i * dim + *axis]) >= AS_FAR * most[*axis];
  PetscCall(PetscFree(increment));
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonFarReason(Newton *n, const char **reason)
{
  const StepProblem *p = n->problem;
  unsigned char *far;
  PetscInt body;
  PetscReal x[3];
  PetscBool found = PETSC_FALSE;
  char place[PLACE];
  int axis = 0;

  PetscFunctionBeginUser;
  *reason = NULL;
  if (p->system->form == SYSTEM_BLOCKS) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(p->grid->n_nodes, &far));
  PetscCall(FarthestNodes(n, far, &axis));
  PetscCall(FindPoint(n, far, &body, x, &found));
  PetscCall(PetscFree(far));
  if (!found) PetscFunctionReturn(0);
  snprintf(
    n->loose, sizeof n->loose,
    "an increment of a thousand times the grid's size, in %c of '%s' around %s m: next to nothing holds it there%s",
    "xyz"[axis], p -> scene.c->bodies[body].name, place_text(n, x, place),
    p->scene.contact ? "; friction that is overcome and walls that it leaves do not" : "");
  *reason = n->loose;
  PetscFunctionReturn(0);
}
