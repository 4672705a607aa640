#include "model/measure/surface.h"

static PetscReal station_spacing(const Model *m)
{
  const GridSpec *spec = &m->c->grid;
  if (spec->kind == GRID_BOX) return (spec->max[0] - spec->min[0]) / (PetscReal)spec->counts[0];
  return m->grid->smallest;
}

PetscErrorCode SurfaceProfileCreate(const Model *m, PetscInt body, SurfaceProfile *s)
{
  PetscFunctionBeginUser;
  s->dx = station_spacing(m);
  s->x0 = m->grid->min[0];
  s->n = (PetscInt)PetscCeilReal((m->grid->max[0] - s->x0) / s->dx - 1e-9) + 1;
  PetscCall(PetscCalloc1(s->n, &s->height));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    if (body >= 0 && m->points->body[p] != body) continue;
    /* a loose point may have opened to many times its volume: what it holds of material has not grown */
    const PetscReal volume = PetscMin(1, m->points->real[POINT_J][p]) * m->points->real[POINT_VOLUME][p];
    const PetscReal at = (point_real(m->points, POINT_X, p)[0] - s->x0) / s->dx;
    const PetscInt i = PetscMax(0, PetscMin(s->n - 2, (PetscInt)PetscFloorReal(at)));
    const PetscReal share = PetscMax(0, PetscMin(1, at - (PetscReal)i));
    s->height[i] += (1 - share) * volume / s->dx;
    s->height[i + 1] += share * volume / s->dx;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, s->height, (PetscMPIInt)s->n, MPIU_REAL, MPI_SUM, m->comm));
  s->height[0] *= 2; /* the outer stations stand for half a spacing */
  s->height[s->n - 1] *= 2;
  PetscFunctionReturn(0);
}

PetscErrorCode SurfaceProfileDestroy(SurfaceProfile *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->height));
  PetscFunctionReturn(0);
}

PetscReal surface_height(const SurfaceProfile *s, PetscReal x)
{
  const PetscReal at = (x - s->x0) / s->dx;
  const PetscInt i = PetscMax(0, PetscMin(s->n - 2, (PetscInt)PetscFloorReal(at)));
  const PetscReal share = PetscMax(0, PetscMin(1, at - (PetscReal)i));
  return (1 - share) * s->height[i] + share * s->height[i + 1];
}

PetscReal surface_front(const SurfaceProfile *s)
{
  const PetscReal threshold = 0.5 * s->dx;
  for (PetscInt i = s->n - 1; i >= 0; --i) {
    if (s->height[i] < threshold) continue;
    if (i == s->n - 1) return s->x0 + (PetscReal)i * s->dx;
    return s->x0 + s->dx * ((PetscReal)i + (s->height[i] - threshold) / (s->height[i] - s->height[i + 1]));
  }
  return s->x0;
}

PetscReal surface_slope(const SurfaceProfile *s)
{
  PetscInt top = 0;
  PetscReal n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (PetscInt i = 1; i < s->n; ++i)
    if (s->height[i] > s->height[top]) top = i;
  const PetscReal start = s->x0 + (PetscReal)top * s->dx, length = surface_front(s) - start;
  for (PetscInt i = 0; i < s->n; ++i) {
    const PetscReal x = s->x0 + (PetscReal)i * s->dx;
    if (x < start + 0.2 * length || x > start + 0.8 * length) continue;
    n += 1, sx += x, sy += s->height[i], sxx += x * x, sxy += x * s->height[i];
  }
  const PetscReal denominator = n * sxx - sx * sx;
  return denominator > 0 ? -PetscAtanReal((n * sxy - sx * sy) / denominator) : 0;
}
