/* Sides of a polygon that cross: what lies between them is inside by one way of counting and
 * outside by another, and none is what was meant. A side that only touches another one is no
 * mistake. */
#include "input/schema/schema.h"

typedef struct {
  PetscInt n, *order; /* sides by where they begin along x */
  PetscReal *from;
  const PetscReal *x;
} Sides;

static const PetscReal *begin(const Sides *s, PetscInt i) { return s->x + 2 * i; }
static const PetscReal *end(const Sides *s, PetscInt i) { return s->x + 2 * ((i + 1) % s->n); }

/* On which side of the line from a to b is c? 0: on it, within round-off. */
static int turn(const PetscReal *a, const PetscReal *b, const PetscReal *c)
{
  const PetscReal u[2] = {b[0] - a[0], b[1] - a[1]}, v[2] = {c[0] - a[0], c[1] - a[1]};
  const PetscReal left = u[0] * v[1], right = u[1] * v[0], cross = left - right;
  return PetscAbsReal(cross) <= 1e-12 * (PetscAbsReal(left) + PetscAbsReal(right)) ? 0 : cross > 0 ? 1 : -1;
}

static PetscBool cross(const Sides *s, PetscInt i, PetscInt j)
{
  const PetscReal *a = begin(s, i), *b = end(s, i), *c = begin(s, j), *d = end(s, j);
  return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

/* The crossing of which the later side comes first; PETSC_FALSE: there is none. */
static PetscBool find_crossing(const Sides *s, PetscInt *first, PetscInt *second)
{
  PetscBool found = PETSC_FALSE;
  for (PetscInt k = 0; k < s->n; ++k) {
    const PetscReal reach = PetscMax(begin(s, s->order[k])[0], end(s, s->order[k])[0]);
    for (PetscInt l = k + 1; l < s->n && s->from[l] <= reach; ++l) {
      const PetscInt i = PetscMin(s->order[k], s->order[l]), j = PetscMax(s->order[k], s->order[l]);
      if (found && (j > *second || (j == *second && i > *first))) continue;
      if (!cross(s, i, j)) continue;
      found = PETSC_TRUE;
      *first = i, *second = j;
    }
  }
  return found;
}

PetscErrorCode SchemaCheckCrossing(SchemaReader *r, const YamlNode *polygon, PetscInt n, const PetscReal *vertices)
{
  Sides s = {.n = n, .x = vertices};
  PetscInt first, second;
  char path[512];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &s.order, n, &s.from));
  for (PetscInt i = 0; i < n; ++i) s.order[i] = i, s.from[i] = PetscMin(begin(&s, i)[0], end(&s, i)[0]);
  PetscCall(PetscSortRealWithArrayInt(n, s.from, s.order));
  if (find_crossing(&s, &first, &second)) {
    SchemaError(r, polygon->child[second], "%s: sides %d and %d cross", yaml_path(polygon, path, sizeof(path)),
                (int)first + 1, (int)second + 1);
    diag_hint(r->diag,
              "side 1 goes from the first corner to the second: corners stand in their order around the shape");
  }
  PetscCall(PetscFree2(s.order, s.from));
  PetscFunctionReturn(0);
}
