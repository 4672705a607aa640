/* Bodies that come to stand on ground that has moved: how far their shapes, as they were drawn, begin above or in it.
 *
 * Heights are compared in columns along gravity, as wide as the parts of points are. All ranks know all columns. */
#include "model/stage/stage_private.h"

#define FARTHEST 3 /* cells: what is farther apart was not drawn to touch */
/* Cells, of the middle one of all gaps of a foot: less is what points know of where a surface is; those of triangles
 * and tetrahedra, which stand in no rows, know less. */
#define WIDE 0.1
#define WIDE_ASKEW 0.25
#define MOST_COLUMNS 4000000

typedef struct {
  PetscInt axis;  /* along which heights are measured, */
  PetscReal sign; /* upwards: 1, or -1 */
  PetscReal width;
  PetscInt n, count[3]; /* columns: of all, and along each axis; 1 along that of heights */
  PetscReal *low, *top; /* of what comes; */
  PetscReal *high;      /* of what is below its middle, m */
  PetscInt *body;       /* the one that stands lowest */
} Columns;

static void choose_axis(const Model *m, Columns *s)
{
  s->axis = case_height_axis(m->c);
  s->sign = m->c->gravity[s->axis] > 0 ? -1 : 1;
}

/* Of the parts of points: no column of a body may be without any. */
static PetscReal width_of(const Model *m)
{
  PetscReal width = 0.5;
  for (PetscInt b = 0; b < m->c->n_bodies; ++b)
    if (m->c->bodies[b].points_per_cell < (m->dim == 2 ? 4 : 8)) width = 1;
  return width * m->grid->smallest;
}

static PetscErrorCode ColumnsCreate(const Model *m, Columns *s)
{
  const Grid *grid = m->grid;

  PetscFunctionBeginUser;
  choose_axis(m, s);
  for (s->width = width_of(m), s->n = MOST_COLUMNS + 1; s->n > MOST_COLUMNS; s->width *= 2) {
    s->n = 1;
    for (PetscInt d = 0; d < m->dim; ++d) {
      s->count[d] = d == s->axis ? 1 : 1 + (PetscInt)((grid->max[d] - grid->min[d]) / s->width);
      s->n = s->n > MOST_COLUMNS ? s->n : s->n * s->count[d];
    }
    if (s->n <= MOST_COLUMNS) break;
  }
  PetscCall(PetscMalloc4(s->n, &s->low, s->n, &s->top, s->n, &s->high, s->n, &s->body));
  for (PetscInt k = 0; k < s->n; ++k)
    s->low[k] = PETSC_MAX_REAL, s->top[k] = s->high[k] = -PETSC_MAX_REAL, s->body[k] = -1;
  PetscFunctionReturn(0);
}

static PetscInt column_of(const Columns *s, const Grid *grid, const PetscReal *x)
{
  PetscInt k = 0;
  for (PetscInt d = grid->dim - 1; d >= 0; --d) {
    const PetscInt i = d == s->axis ? 0 : (PetscInt)((x[d] - grid->min[d]) / s->width);
    k = k * s->count[d] + PetscMax(0, PetscMin(i, s->count[d] - 1));
  }
  return k;
}

/* From the outermost points of a cell to its side, over half of what each would have if they shared it alike. */
static PetscReal set_back(const Model *m, PetscInt p)
{
  const CellType type = grid_cell_type(m->grid, m->points->cell[p]);
  PetscReal xi[3 * 64], weight[64], outermost = 0;
  const PetscInt n = m->c->bodies[m->points->body[p]].points_per_cell, dim = m->dim;
  if (m->points->components[POINT_DOMAIN] || cells[type].nodes == dim + 1 || n > 64) return 1;
  if (!cell_quadrature(type, n, xi, weight)) return 1;
  for (PetscInt q = 0; q < n; ++q) outermost = PetscMax(outermost, xi[q * dim]);
  return PetscPowReal((PetscReal)n, 1 / (PetscReal)dim) * (1 - outermost);
}

/* Half of what the point stands for along the heights, m: of its volume, as long in its parts as its cell is. */
static PetscReal half_of(const Model *m, const Columns *s, PetscInt p)
{
  const Points *points = m->points;
  const Grid *grid = m->grid;
  const PetscReal weight = kinematics_weight(m->c->kinematics, point_real(points, POINT_X, p)[0]);
  const PetscReal power = 1 / (PetscReal)m->dim;
  const PetscReal side = PetscPowReal(points->real[POINT_VOLUME][p] * points->real[POINT_J][p] / weight, power);
  PetscReal x[CELL_MAX_NODES * 3], least = PETSC_MAX_REAL, most = -PETSC_MAX_REAL;
  if (points->cell[p] < 0) return 0.5 * side;
  const CellType type = grid_cell_type(grid, points->cell[p]);
  grid_cell_x(grid, points->cell[p], x);
  for (PetscInt i = 0; i < cells[type].nodes; ++i) {
    least = PetscMin(least, x[i * m->dim + s->axis]);
    most = PetscMax(most, x[i * m->dim + s->axis]);
  }
  if (cells[type].nodes == m->dim + 1) return 0.5 * side;
  return 0.5 * side * set_back(m, p) * (most - least) / PetscPowReal(cell_volume(type, x), power);
}

/* What comes: where it begins and ends in each column, and which body begins there. */
static PetscErrorCode LookAbove(const Model *m, const Case *from, Columns *s)
{
  const Points *points = m->points;
  PetscReal *mine;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(s->n, &mine));
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p), height = s->sign * x[s->axis], half = half_of(m, s, p);
    const PetscInt k = column_of(s, m->grid, x);
    if (!body_comes(m->c, from, points->body[p])) continue;
    if (height - half < s->low[k]) s->body[k] = points->body[p];
    s->low[k] = PetscMin(s->low[k], height - half);
    s->top[k] = PetscMax(s->top[k], height + half);
  }
  PetscCall(PetscArraycpy(mine, s->low, s->n));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->low, (PetscMPIInt)s->n, MPIU_REAL, MPIU_MIN, m->comm));
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->top, (PetscMPIInt)s->n, MPIU_REAL, MPIU_MAX, m->comm));
  for (PetscInt k = 0; k < s->n; ++k)
    if (mine[k] > s->low[k]) s->body[k] = -1;
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->body, (PetscMPIInt)s->n, MPIU_INT, MPI_MAX, m->comm));
  PetscCall(PetscFree(mine));
  PetscFunctionReturn(0);
}

/* What is there: where it ends below the middle of what comes. */
static PetscErrorCode LookBelow(const Model *m, const Case *from, Columns *s)
{
  const Points *points = m->points;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < points->n; ++p) {
    const PetscReal *x = point_real(points, POINT_X, p), height = s->sign * x[s->axis];
    const PetscInt k = column_of(s, m->grid, x);
    if (s->body[k] < 0 || body_comes(m->c, from, points->body[p])) continue;
    if (height < 0.5 * (s->low[k] + s->top[k])) s->high[k] = PetscMax(s->high[k], height + half_of(m, s, p));
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, s->high, (PetscMPIInt)s->n, MPIU_REAL, MPIU_MAX, m->comm));
  PetscFunctionReturn(0);
}

/* Of a body, in as many columns as it stands in: gaps, and heights at which the ground ends. */
static PetscInt foot_of(const Model *m, const Columns *s, PetscInt body, PetscReal *gap, PetscReal *ground)
{
  PetscInt n = 0;
  for (PetscInt k = 0; k < s->n; ++k) {
    const PetscReal way = s->low[k] - s->high[k];
    if (s->body[k] != body || s->high[k] == -PETSC_MAX_REAL || way > FARTHEST * m->grid->smallest) continue;
    ground[n] = s->sign * s->high[k];
    gap[n++] = way;
  }
  return n;
}

static void tell(const Model *m, const Columns *s, PetscInt b, PetscReal gap, PetscReal ground, Diag *diag)
{
  char path[64];
  snprintf(path, sizeof path, "bodies[%d].shape", (int)b);
  diag_warning(diag, path, "'%s' begins %.3g m (%.2g cells) %s what it stands on, in the middle of its foot",
               m->c->bodies[b].name, (double)PetscAbsReal(gap), (double)(PetscAbsReal(gap) / m->grid->smallest),
               gap > 0 ? "above" : "inside");
  diag_hint(diag, "%s: let its shape begin where the ground is now, at %c = %.6g in the middle",
            gap > 0 ? "its lowest cells bear too much" : "matter is there twice", "xyz"[s->axis], (double)ground);
}

/* Middle ones, since columns through a side that two bodies share say nothing. */
static PetscErrorCode LookAtFeet(const Model *m, const Columns *s, Diag *diag)
{
  const PetscBool rows = m->grid->nodes_per_cell > m->dim + 1;
  const PetscReal wide = (rows ? WIDE : WIDE_ASKEW) * m->grid->smallest;
  PetscReal *gap, *ground;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(s->n, &gap, s->n, &ground));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    const PetscInt n = foot_of(m, s, b, gap, ground);
    if (!n) continue;
    PetscCall(PetscSortReal(n, gap));
    PetscCall(PetscSortReal(n, ground));
    if (PetscAbsReal(gap[n / 2]) > wide) tell(m, s, b, gap[n / 2], ground[n / 2], diag);
  }
  PetscCall(PetscFree2(gap, ground));
  PetscFunctionReturn(0);
}

PetscErrorCode BodiesStand(const Model *m, const Case *from, Diag *diag)
{
  PetscBool any = PETSC_FALSE;
  Columns s = {0};

  PetscFunctionBeginUser;
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) any |= !m->c->bodies[b].absent && body_comes(m->c, from, b);
  if (!any) PetscFunctionReturn(0);
  PetscCall(ColumnsCreate(m, &s));
  PetscCall(LookAbove(m, from, &s));
  PetscCall(LookBelow(m, from, &s));
  PetscCall(LookAtFeet(m, &s, diag));
  PetscCall(PetscFree4(s.low, s.top, s.high, s.body));
  PetscFunctionReturn(0);
}
