/* Springs of explicit dynamics let material into walls, by more than a thin layer of points is thick: the points behind
 * that meet the wall, too. Their body's surface is the layer's alone, and counts once. */
#include "model/explicit/explicit.h"
#include "solve/contact/touch/weight.h"

#define BEFORE 0.25 /* of its functions: what shares so much with the surface goes where that goes */
#define LOOKS 0.5   /* cosine: a surface that looks along a normal */

/* Normals of the walls that surface looks at, at its nodes when the lap begins: in the lap it comes to none far from
 * these. */
static PetscErrorCode Mark(const Model *m, Explicit *e, const NodalScene *scene)
{
  const Contact *s = m->contact;
  const PetscInt dim = m->dim, width = s->n_partners * dim;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(e->surface, m->grid->n_nodes * width));
  for (const ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (contact_depth(scene, c->owner, c->facing) != CONTACT_OUTSIDE) continue;
    for (PetscInt k = c->first; k < c->first + c->own; ++k)
      for (PetscInt d = 0; d < dim; ++d)
        e->surface[s->node[k] * width + c->wall * dim + d] += contact_weight(s, k) * c->facing[d];
  }
  PetscCall(NodesShare(m, width, e->surface));
  PetscFunctionReturn(0);
}

static PetscBool looks_there(PetscInt dim, const PetscReal *surface, const PetscReal n[3])
{
  PetscReal along = 0, square = 0;
  for (PetscInt d = 0; d < dim; ++d) along += surface[d] * n[d], square += PetscSqr(surface[d]);
  return (PetscBool)(along > 0 && PetscSqr(along) > PetscSqr(LOOKS) * square);
}

/* Does the surface of its body go before it? By the functions at the place that meets the wall. */
static PetscBool is_covered(const Contact *s, const PetscReal *surface, const ContactPoint *c)
{
  PetscReal sum = 0, shared = 0;
  for (PetscInt k = c->first; k < c->first + c->own; ++k) {
    const PetscReal N = PetscMax(0, s->N[k]);
    sum += N;
    if (looks_there(s->dim, surface + (s->node[k] * s->n_partners + c->wall) * s->dim, c->facing)) shared += N;
  }
  return (PetscBool)(shared > BEFORE * sum);
}

/* Should what covers it go, it begins where it is then: a spring that is pressed in from the start would give energy
 * that nobody has put in. */
static void leave_out(ContactPoint *c)
{
  const PetscReal gap = c->open - c->behind;
  c->section = c->bond = c->own_bond = 0;
  c->inner = PETSC_TRUE;
  c->behind = PetscMax(0, -gap);
  c->open = gap + c->behind;
}

/* What bears already does so on: its spring would lose what it has stored. */
PetscErrorCode WallsTouchSurface(Model *m, Explicit *e, const NodalScene *scene)
{
  Contact *s = m->contact;

  PetscFunctionBeginUser;
  if (!s) PetscFunctionReturn(0);
  if (e->begins) PetscCall(Mark(m, e, scene));
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    if (c->before != CONTACT_OPEN || (c->open > 0 && c->behind == 0) || !is_covered(s, e->surface, c)) continue;
    if (contact_depth(scene, c->owner, c->facing) != CONTACT_INSIDE) continue;
    leave_out(c);
  }
  PetscFunctionReturn(0);
}
