/* Bodies that share nodes and have the same place would fill it twice. */
#include "points/seed/seed.h"
#include <math.h>

#define SAMPLES 512     /* in a cell that two bodies have */
#define DEEP 1e-3       /* of a cell's size: bodies that touch, to round-off, have nothing in common so deep inside */
#define NEGLIGIBLE 1e-3 /* of the smaller body: polygons that stand for curves may overlap by as much */

/* The k-th of the samples of a reference cell, which no plane along its sides meets in rows; returns its weight
 * among them. */
static PetscReal sample_of(CellType type, PetscInt k, PetscReal *xi)
{
  const PetscInt dim = cells[type].dim;
  const PetscReal golden = dim == 2 ? 1.61803398874989484820 : 1.32471795724474602596;
  const PetscBool simplex = (PetscBool)(cells[type].nodes == dim + 1);
  PetscReal left = 1, weight = 1, step = 1;
  for (PetscInt d = 0; d < dim; ++d) {
    /* one coordinate goes evenly, so that the rows of the others fill the plane or space */
    step /= golden;
    const PetscReal along = d == dim - 1 ? ((PetscReal)k + 0.5) / SAMPLES : 0.5 + (PetscReal)k * step;
    const PetscReal u = along - floor(along);
    xi[d] = simplex ? u * left : 2 * u - 1;
    weight *= left;
    if (simplex) left *= 1 - u;
  }
  return weight;
}

static PetscBool is_whole(const Seeding *s, PetscInt k) { return (PetscBool)(!s->cut || s->cut[k] < 0); }

/* Does the body have this place in its k-th cell? */
static PetscBool has_place(const Seeding *s, PetscInt k, const PetscReal *position, PetscReal deep)
{
  if (is_whole(s, k)) return PETSC_TRUE;
  return shape_contains(&s->body->shape, s->source->dim, position, -deep);
}

/* How much of a cell both have, m3: the i-th of one, the k-th of the other. */
static PetscReal shared_in(const Seeding *a, PetscInt i, const Seeding *b, PetscInt k)
{
  const PetscInt cell = a->cells[i];
  const CellType type = grid_cell_type(a->source, cell);
  PetscReal x[CELL_MAX_NODES * 3], xi[3], position[3], all = 0, both = 0;
  grid_cell_x(a->source, cell, x);
  const PetscReal deep = DEEP * PetscPowReal(cell_volume(type, x), 1 / (PetscReal)a->source->dim);
  for (PetscInt n = 0; n < SAMPLES; ++n) {
    const PetscReal weight = sample_of(type, n, xi);
    cell_position(type, x, xi, position);
    all += weight;
    if (has_place(a, i, position, deep) && has_place(b, k, position, deep)) both += weight;
  }
  return both / all * seed_cell_volume(a, cell);
}

/* What two bodies have in common. */
typedef struct {
  PetscReal volume, whole; /* m3; cells that both fill */
} Shared;

/* place: of the cells of s among these, of others -1. */
static Shared shared_by(const Seeding *other, const Seeding *s, const PetscInt *place)
{
  Shared shared = {0, 0};
  if (!other->ready || other->source != s->source) return shared;
  for (PetscInt i = 0; i < other->n_cells; ++i) {
    const PetscInt k = place[other->cells[i]];
    if (k < 0) continue;
    shared.volume += shared_in(other, i, s, k);
    shared.whole += is_whole(other, i) && is_whole(s, k) ? 1 : 0;
  }
  return shared;
}

/* What was there before has moved: whether what comes fits to it shapes as drawn do not say, cells hardly. */
static PetscBool is_overlap(const Seeding *s, const Seeding *other, const Shared *shared)
{
  if (shared->whole > 0) return PETSC_TRUE;
  return (PetscBool)(!case_goes_on(s->c) && shared->volume > NEGLIGIBLE * PetscMin(s->volume, other->volume));
}

static void tell_overlap(const Seeding *s, const Seeding *other, PetscReal volume)
{
  char path[128];
  seed_path(s->b, "", sizeof path, path);
  diag_error(s->diag, path, "bodies '%s' and '%s' overlap: %.3g %s would be filled twice", other->body->name,
             s->body->name, (double)volume, kinematics_is_plane(s->c->kinematics) ? "m2" : "m3");
  diag_hint(s->diag, "let one end where the other begins: `shape: {difference: [...]}` leaves room for it");
}

PetscErrorCode SeedCheckOverlap(const Seeding *all, const Seeding *s, PetscInt *place)
{
  const PetscInt n = (PetscInt)(s - all);
  Shared *shared;
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &shared));
  for (PetscInt k = 0; k < s->n_cells; ++k) place[s->cells[k]] = k;
  for (PetscInt b = 0; b < n; ++b) shared[b] = shared_by(all + b, s, place);
  for (PetscInt k = 0; k < s->n_cells; ++k) place[s->cells[k]] = -1;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, shared, (PetscMPIInt)(2 * n), MPIU_REAL, MPIU_SUM, s->grid->comm));
  for (PetscInt b = 0; b < n && seed_tells(s->grid); ++b)
    if (is_overlap(s, all + b, shared + b)) tell_overlap(s, all + b, shared[b].volume);
  PetscCall(PetscFree(shared));
  PetscFunctionReturn(0);
}
