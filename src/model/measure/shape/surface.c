/* The free surface of a body in two dimensions: height over x, from the sections of its points.
 *
 * Each point shares its area between the two nearest stations by linear weights, so that the profile
 * integrates to the section of the body's material (J at most 1) exactly and does not jump when a point
 * crosses a station. Stations stand one cell apart from the grid's lowest x on. Rings are weighed by
 * their sections, too: their volumes are quadratic in x beside the axis, where no two points a cell
 * integrate them. */
#include "model/measure/measure.h"

typedef struct {
  PetscInt n;
  PetscReal x0, dx;  /* station i stands at x0 + i dx, m */
  PetscReal *height; /* n, m of solid material above the station */
} Profile;

static PetscReal station_spacing(const Model *m)
{
  const GridSpec *spec = &m->c->grid;
  if (spec->kind == GRID_BOX) return (spec->max[0] - spec->min[0]) / (PetscReal)spec->counts[0];
  return m->grid->smallest;
}

/* What one m of height above station i holds, m2: the outer ones have half a hat. */
static PetscReal station_width(const Profile *s, PetscInt i) { return (i == 0 || i == s->n - 1 ? 0.5 : 1) * s->dx; }

static PetscErrorCode ProfileCreate(const Model *m, const MeasureSpec *spec, Profile *s)
{
  const PetscInt body = measure_body(m, spec);

  PetscFunctionBeginUser;
  s->dx = station_spacing(m);
  s->x0 = m->grid->min[0];
  s->n = (PetscInt)PetscCeilReal((m->grid->max[0] - s->x0) / s->dx - 1e-9) + 1;
  PetscCall(PetscCalloc1(s->n, &s->height));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal area = measure_share(m, spec, body, p) * measure_solid_area(m, p);
    if (area == 0) continue;
    const PetscReal at = (point_real(m->points, POINT_X, p)[0] - s->x0) / s->dx;
    const PetscInt i = PetscMax(0, PetscMin(s->n - 2, (PetscInt)PetscFloorReal(at)));
    const PetscReal share = PetscMax(0, PetscMin(1, at - (PetscReal)i));
    s->height[i] += (1 - share) * area;
    s->height[i + 1] += share * area;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->height, (PetscMPIInt)s->n, MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt i = 0; i < s->n; ++i) s->height[i] /= station_width(s, i);
  PetscFunctionReturn(0);
}

/* Height at x, linear between stations. */
static PetscReal height_at(const Profile *s, PetscReal x)
{
  const PetscReal at = (x - s->x0) / s->dx;
  const PetscInt i = PetscMax(0, PetscMin(s->n - 2, (PetscInt)PetscFloorReal(at)));
  const PetscReal share = PetscMax(0, PetscMin(1, at - (PetscReal)i));
  return (1 - share) * s->height[i] + share * s->height[i + 1];
}

/* The farthest x at which the surface is still as high as the threshold. */
static PetscReal reach_of(const Profile *s, PetscReal threshold)
{
  for (PetscInt i = s->n - 1; i >= 0; --i) {
    if (s->height[i] < threshold) continue;
    if (i == s->n - 1) return s->x0 + (PetscReal)i * s->dx;
    return s->x0 + s->dx * ((PetscReal)i + (s->height[i] - threshold) / (s->height[i] - s->height[i + 1]));
  }
  return s->x0;
}

static PetscReal front_of(const Profile *s) { return reach_of(s, 0.5 * s->dx); }

/* Angle (deg, positive if it falls towards +x) of the line fitted by least squares to the surface
 * between 20 % and 80 % of the way from its highest station to the front. */
static PetscReal slope_of(const Profile *s)
{
  PetscInt top = 0;
  PetscReal n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (PetscInt i = 1; i < s->n; ++i)
    if (s->height[i] > s->height[top]) top = i;
  const PetscReal start = s->x0 + (PetscReal)top * s->dx, length = front_of(s) - start;
  for (PetscInt i = 0; i < s->n; ++i) {
    const PetscReal x = s->x0 + (PetscReal)i * s->dx;
    if (x < start + 0.2 * length || x > start + 0.8 * length) continue;
    n += 1, sx += x, sy += s->height[i], sxx += x * x, sxy += x * s->height[i];
  }
  const PetscReal denominator = n * sxx - sx * sx;
  return denominator > 0 ? -PetscAtanReal((n * sxy - sx * sy) / denominator) * 180 / PETSC_PI : 0;
}

static PetscBool is_flat(const Profile *profile)
{
  for (PetscInt i = 0; i < profile->n; ++i)
    if (profile->height[i] != 0) return PETSC_FALSE;
  return PETSC_TRUE;
}

enum { FRONT, REACH, HEIGHT, SLOPE };

/* nan where there is no body. */
PetscErrorCode MeasureSurface(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const int which = measure_number(s)->which;
  Profile profile;

  (void)index;
  PetscFunctionBeginUser;
  PetscCall(ProfileCreate(m, s, &profile));
  if (is_flat(&profile)) *value = NAN;
  else if (which == HEIGHT) *value = height_at(&profile, s->at);
  else if (which == REACH) *value = reach_of(&profile, s->at);
  else *value = which == SLOPE ? slope_of(&profile) : front_of(&profile);
  PetscCall(PetscFree(profile.height));
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD("front", "farthest x at which the surface is still half a cell high, m", "m", .in = PETSC_TRUE,
       .value = MeasureSurface),
  WORD("reach", "farthest x at which the surface is still `at` high, m: on every mesh the same question", "m",
       .at = PETSC_TRUE, .in = PETSC_TRUE, .value = MeasureSurface, .which = REACH),
  WORD("height", "height of the material above x = `at`, m", "m", .at = PETSC_TRUE, .in = PETSC_TRUE,
       .value = MeasureSurface, .which = HEIGHT),
  WORD("slope",
       "angle of repose, positive if it falls towards +x, by least squares between a fifth and four fifths of the way "
       "from "
       "the highest place to the front, deg",
       "deg", .in = PETSC_TRUE, .value = MeasureSurface, .which = SLOPE),
  NULL,
};

const Measure measure_surface = {
  .key = "surface",
  .takes = MEASURE_WORD,
  .only_2d = PETSC_TRUE,
  .number = {.unit = "m or deg", .help = "free surface of a body: from the area above x, in cells of the grid"},
  .words = words};
