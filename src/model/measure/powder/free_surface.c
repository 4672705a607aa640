/* The free surface of a powder in a container, in two dimensions: where material ends towards the
 * top, whatever is below it.
 *
 * The area of the points is shared by linear weights (hats) among the nodes of a raster; over full
 * material a node holds 1, at a plane surface 1/2. A column of the raster has its surface at the top
 * of its longest run of nodes that hold 1/2 or more, between nodes by linear interpolation: loose
 * points above never make such a run. The line fitted to the columns in the middle of the chord
 * turns the raster, until the columns stand upright on it; so steep slopes are measured like flat
 * ones. Upright columns find the beginning of that up to 80 deg; beyond, if the centre of the
 * container is known, columns along the line from it to the centre of mass do. */
#include "model/measure/measure.h"

#define MIDDLE 0.85   /* of the chord, unless the spec says otherwise */
#define ROUNDS 6      /* that the raster is turned, at most */
#define POINT_SIDES 3 /* spacing of the raster: so many sides of the mean domain of a point */
#define FEWEST 3      /* columns that make a line */

typedef struct {
  PetscReal along[2], up[2]; /* unit vectors */
  PetscReal from[2];         /* coordinates along them of the first node, m */
  PetscReal h;
  PetscInt n[2];
  PetscReal *fill; /* n[0] x n[1] */
} Raster;

/* A line through the surface, over the raster's first axis. */
typedef struct {
  PetscReal slope, deviation; /* -; m, root mean square of what is off the line */
} Line;

void measure_up(const Model *m, PetscReal right[2], PetscReal up[2])
{
  const PetscReal *g = m->c->gravity, size = PetscSqrtReal(g[0] * g[0] + g[1] * g[1]);
  up[0] = size > 0 ? -g[0] / size : 0;
  up[1] = size > 0 ? -g[1] / size : 1;
  right[0] = up[1];
  right[1] = -up[0];
}

/* The side of the mean domain of a point; 0 if there are none. */
static PetscErrorCode MeanSide(const Model *m, const MeasureSpec *s, PetscReal *side)
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[2] = {0, 0};

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal share = measure_share(m, s, body, p);
    if (share > 0) sum[0] += share * measure_solid_area(m, p), sum[1] += share;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *side = sum[1] > 0 ? PetscSqrtReal(sum[0] / sum[1]) : 0;
  PetscFunctionReturn(0);
}

/* Coordinates of a place along the axes of the raster, in its spacing. */
static void raster_place(const Raster *r, const PetscReal x[2], PetscReal place[2])
{
  place[0] = (x[0] * r->along[0] + x[1] * r->along[1] - r->from[0]) / r->h;
  place[1] = (x[0] * r->up[0] + x[1] * r->up[1] - r->from[1]) / r->h;
}

static void raster_add(Raster *r, const PetscReal x[2], PetscReal area)
{
  PetscReal place[2];
  raster_place(r, x, place);
  for (PetscInt i = (PetscInt)PetscFloorReal(place[0]), k = 0; k < 2; ++k, ++i)
    for (PetscInt j = (PetscInt)PetscFloorReal(place[1]), l = 0; l < 2; ++l, ++j) {
      if (i < 0 || i >= r->n[0] || j < 0 || j >= r->n[1]) continue;
      const PetscReal hat = (1 - PetscAbsReal(place[0] - (PetscReal)i)) * (1 - PetscAbsReal(place[1] - (PetscReal)j));
      r->fill[i * r->n[1] + j] += hat * area / (r->h * r->h);
    }
}

/* Nodes over the whole grid along axis k of the raster, a multiple of h from `from`. */
static void raster_span(Raster *r, const Grid *grid, int k)
{
  const PetscReal *axis = k ? r->up : r->along;
  PetscReal low = PETSC_MAX_REAL, high = -PETSC_MAX_REAL;
  for (int corner = 0; corner < 4; ++corner) {
    const PetscReal at =
      (corner & 1 ? grid->max : grid->min)[0] * axis[0] + (corner & 2 ? grid->max : grid->min)[1] * axis[1];
    low = PetscMin(low, at);
    high = PetscMax(high, at);
  }
  r->from[k] += r->h * (PetscFloorReal((low - r->from[k]) / r->h) - 1);
  r->n[k] = (PetscInt)PetscCeilReal((high - r->from[k]) / r->h) + 2;
}

/* Collective. Share out the points. Round an axis of symmetry there is as much on its other side,
 * which an upright raster may want to see. */
static PetscErrorCode RasterFill(Raster *r, const Model *m, const MeasureSpec *s, PetscBool mirror)
{
  const PetscInt body = measure_body(m, s), n = r->n[0] * r->n[1];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &r->fill));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *x = point_real(m->points, POINT_X, p), share = measure_share(m, s, body, p);
    if (share > 0) raster_add(r, x, share * measure_solid_area(m, p));
    if (share > 0 && mirror) raster_add(r, (PetscReal[]){-x[0], x[1]}, share * measure_solid_area(m, p));
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, r->fill, (PetscMPIInt)n, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

/* Coordinate of the surface along `up` in column i, nan if nothing there is half full. */
static PetscReal column_top(const Raster *r, PetscInt i)
{
  const PetscReal *fill = r->fill + i * r->n[1];
  PetscInt longest = 0, run = 0, top = 0;
  for (PetscInt j = 0; j < r->n[1]; ++j) {
    run = fill[j] >= 0.5 ? run + 1 : 0;
    if (run > longest) longest = run, top = j;
  }
  if (!longest) return NAN;
  const PetscReal above = top + 1 < r->n[1] ? fill[top + 1] : 0;
  return r->from[1] + r->h * ((PetscReal)top + (fill[top] - 0.5) / (fill[top] - above));
}

/* Line of least squares through the columns in the middle of the chord; *found: are there enough? */
static void fit_line(const Raster *r, PetscReal middle, Line *line, PetscBool *found)
{
  PetscInt first = r->n[0], last = -1;
  PetscReal n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (PetscInt i = 0; i < r->n[0]; ++i) {
    if (PetscIsNanReal(column_top(r, i))) continue;
    first = PetscMin(first, i);
    last = i;
  }
  const PetscReal centre = 0.5 * (PetscReal)(first + last), reach = 0.5 * middle * (PetscReal)(last - first + 1);
  for (PetscInt i = first; i <= last; ++i) {
    const PetscReal x = ((PetscReal)i - centre) * r->h, y = column_top(r, i) - column_top(r, first);
    if (PetscIsNanReal(y) || PetscAbsReal(x) > reach * r->h) continue;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
  }
  const PetscReal square = n * sxx - sx * sx;
  *found = n >= FEWEST && square > 0;
  if (!*found) return;
  line->slope = (n * sxy - sx * sy) / square;
  line->deviation = PetscSqrtReal(PetscMax(0, (syy - sy * sy / n - line->slope * (sxy - sx * sy / n)) / n));
}

/* Turn the axes by the angle whose tangent is given. */
static void turn(Raster *r, PetscReal slope)
{
  const PetscReal length = PetscSqrtReal(1 + slope * slope), a[2] = {r->along[0], r->along[1]};
  for (int d = 0; d < 2; ++d) {
    r->along[d] = (a[d] + slope * r->up[d]) / length;
    r->up[d] = (r->up[d] - slope * a[d]) / length;
  }
}

/* Collective. Axes that are not far from those of the surface. */
static PetscErrorCode StartRaster(const Model *m, const MeasureSpec *s, Raster *r)
{
  PetscReal angle;

  PetscFunctionBeginUser;
  measure_up(m, r->along, r->up);
  if (!s->has_about) PetscFunctionReturn(0);
  PetscCall(MassAngle(m, s, &angle));
  if (PetscAbsReal(angle) < 1.5) turn(r, -PetscTanReal(angle));
  else turn(r, angle > 0 ? -10 : 10);
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceFit(const Model *m, const MeasureSpec *s, PetscReal *inclination, PetscReal *deviation)
{
  const PetscReal middle = s->middle > 0 ? s->middle : MIDDLE;
  PetscReal right[2], up[2], side;
  Raster r = {0};
  Line line = {.slope = 1};
  PetscBool found = PETSC_TRUE;

  PetscFunctionBeginUser;
  *inclination = *deviation = NAN;
  PetscCall(MeanSide(m, s, &side));
  if (side == 0) PetscFunctionReturn(0);
  measure_up(m, right, up);
  PetscCall(StartRaster(m, s, &r));
  for (int round = 0; round < ROUNDS && found && PetscAbsReal(line.slope) > 1e-4; ++round) {
    r.h = POINT_SIDES * side;
    r.from[0] = r.from[1] = 0;
    raster_span(&r, m->grid, 0);
    raster_span(&r, m->grid, 1);
    PetscCall(RasterFill(&r, m, s, PETSC_FALSE));
    fit_line(&r, middle, &line, &found);
    if (found) turn(&r, line.slope);
    PetscCall(PetscFree(r.fill));
  }
  if (!found) PetscFunctionReturn(0);
  *inclination =
    -PetscAtan2Real(r.along[0] * up[0] + r.along[1] * up[1], r.along[0] * right[0] + r.along[1] * right[1]) * 180 /
    PETSC_PI;
  *deviation = line.deviation;
  PetscFunctionReturn(0);
}

/* Collective. Coordinate of the surface against gravity above the place `at` along the axis across
 * it. */
static PetscErrorCode Elevation(const Model *m, const MeasureSpec *s, PetscReal *elevation)
{
  PetscReal side;
  Raster r = {.n = {1, 0}, .from = {s->at, 0}};

  PetscFunctionBeginUser;
  *elevation = NAN;
  measure_up(m, r.along, r.up);
  PetscCall(MeanSide(m, s, &side));
  if (side == 0) PetscFunctionReturn(0);
  r.h = POINT_SIDES * side;
  raster_span(&r, m->grid, 1);
  PetscCall(RasterFill(&r, m, s, m->c->kinematics->hoop));
  *elevation = column_top(&r, 0);
  PetscCall(PetscFree(r.fill));
  PetscFunctionReturn(0);
}

enum { INCLINATION, ELEVATION, DEVIATION };

static PetscErrorCode FreeSurface(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const int which = measure_number(s)->which;
  PetscReal inclination, deviation;

  (void)index;
  PetscFunctionBeginUser;
  if (which == ELEVATION) PetscCall(Elevation(m, s, value));
  else {
    PetscCall(SurfaceFit(m, s, &inclination, &deviation));
    *value = which == DEVIATION ? deviation : inclination;
  }
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD("inclination",
       "of the line fitted to the `middle` of the surface from wall to wall: positive if it falls towards +x", "deg",
       .may_about = PETSC_TRUE, .in = PETSC_TRUE, .middle = PETSC_TRUE, .value = FreeSurface, .which = INCLINATION),
  WORD(
    "elevation",
    "coordinate against gravity of the surface `at` a coordinate across gravity, m: x where that points down, -x up, "
    "y where it points to +x, -y to -x",
    "m", .at = PETSC_TRUE, .in = PETSC_TRUE, .value = FreeSurface, .which = ELEVATION),
  WORD("deviation", "how far it is from that line: root mean square, m", "m", .may_about = PETSC_TRUE, .in = PETSC_TRUE,
       .middle = PETSC_TRUE, .value = FreeSurface, .which = DEVIATION),
  NULL,
};

const Measure measure_free_surface = {
  .key = "free_surface",
  .takes = MEASURE_WORD,
  .only_2d = PETSC_TRUE,
  .number = {.unit = "deg or m", .help = "where powder ends towards the top, whatever is below it"},
  .words = words};
