/* The table of points: storage, growth, and what treats all fields alike. */
#include "points/fields.h"

void *points_field(const Points *points, int field, size_t *bytes)
{
  switch (field) {
  case FIELD_ID: *bytes = sizeof *points->id; return points->id;
  case FIELD_CELL: *bytes = sizeof *points->cell; return points->cell;
  case FIELD_BODY: *bytes = sizeof *points->body; return points->body;
  case FIELD_MATERIAL: *bytes = sizeof *points->material; return points->material;
  default: *bytes = sizeof(PetscReal) * (size_t)points->components[field]; return points->real[field];
  }
}

void points_set_field(Points *points, int field, void *data)
{
  switch (field) {
  case FIELD_ID: points->id = data; break;
  case FIELD_CELL: points->cell = data; break;
  case FIELD_BODY: points->body = data; break;
  case FIELD_MATERIAL: points->material = data; break;
  default: points->real[field] = data;
  }
}

size_t points_bytes(const Points *points)
{
  size_t sum = 0, bytes;
  for (int f = 0; f < N_FIELDS; ++f) {
    (void)points_field(points, f, &bytes);
    sum += bytes;
  }
  return sum;
}

PetscErrorCode PointsCreate(PetscInt dim, PetscInt n_state, PetscInt n_force, Points **points)
{
  Points *new;
  PetscFunctionBeginUser;
  PetscCheck(dim == 2 || dim == 3, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "dimension %" PetscInt_FMT, dim);
  PetscCall(PetscNew(&new));
  new->dim = dim;
  for (int f = 0; f < POINT_N_REAL; ++f) new->components[f] = dim;
  new->components[POINT_MASS] = new->components[POINT_VOLUME] = new->components[POINT_J] = new->components[POINT_WORK] =
    1;
  new->components[POINT_F] = dim == 3 ? 9 : 5;
  new->components[POINT_TAU] = dim == 3 ? 6 : 4;
  new->components[POINT_STATE] = n_state;
  new->components[POINT_PRESSURE] = 0;
  new->components[POINT_FORCE] = n_force;
  new->components[POINT_EDGE] = 0;
  new->components[POINT_LEAN] = 0;
  new->components[POINT_OVERHANG] = 0;
  new->components[POINT_DOMAIN] = 0;
  new->components[POINT_SLOPE] = 0;
  new->components[POINT_REACH] = 0;
  new->components[POINT_CORNER] = 0;
  new->components[POINT_BESIDE] = 0;
  new->components[POINT_FACE] = 0;
  new->components[POINT_CONTACT] = 0;
  new->components[POINT_FIELD] = 0;
  new->components[POINT_SPACING] = 0;
  new->components[POINT_CARRIED] = 0;
  new->components[POINT_FLOW] = 0;
  new->components[POINT_MECHANISM] = 0;
  *points = new;
  PetscFunctionReturn(0);
}

PetscErrorCode FollowersCreate(PetscInt dim, PetscInt n_force, Points **points)
{
  PetscFunctionBeginUser;
  PetscCall(PointsCreate(dim, 0, n_force, points));
  (*points)->components[POINT_OVERHANG] = dim; /* nothing is stored yet */
  PetscFunctionReturn(0);
}

PetscInt points_near(const Points *points, const PetscReal *x, PetscReal *square)
{
  PetscInt near = -1;
  *square = PETSC_MAX_REAL;
  for (PetscInt p = 0; p < points->n; ++p) {
    PetscReal sum = 0;
    for (PetscInt d = 0; d < points->dim; ++d) sum += PetscSqr(point_real(points, POINT_X, p)[d] - x[d]);
    if (sum >= *square) continue;
    *square = sum;
    near = p;
  }
  return near;
}

PetscInt points_field_near(const Points *points, const PetscReal *x)
{
  PetscReal square;
  const PetscInt near = points->components[POINT_FIELD] ? points_near(points, x, &square) : -1;
  return near >= 0 ? point_field(points, near) : 0;
}

PetscErrorCode PointsDestroy(Points **points)
{
  PetscFunctionBeginUser;
  if (!*points) PetscFunctionReturn(0);
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    void *data = points_field(*points, f, &bytes);
    PetscCall(PetscFree(data));
  }
  PetscCall(PetscFree(*points));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsReserve(Points *points, PetscInt capacity)
{
  PetscFunctionBeginUser;
  if (capacity <= points->capacity) PetscFunctionReturn(0);
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    char *old = points_field(points, f, &bytes), *data;
    if (!bytes) continue;
    PetscCall(PetscMalloc1(bytes * (size_t)capacity, &data));
    if (points->n) PetscCall(PetscArraycpy(data, old, bytes * (size_t)points->n));
    PetscCall(PetscFree(old));
    points_set_field(points, f, data);
  }
  points->capacity = capacity;
  PetscFunctionReturn(0);
}

PetscErrorCode PointsReserveMore(Points *points, PetscInt n)
{
  const PetscInt64 needed = (PetscInt64)points->n + n, grown = points->capacity + points->capacity / 2;
  PetscFunctionBeginUser;
  PetscCheck(needed <= PETSC_MAX_INT, PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE,
             "%lld points on one rank cannot be numbered: use more ranks", (long long)needed);
  if (needed > points->capacity)
    PetscCall(PointsReserve(points, (PetscInt)PetscMin(PetscMax(needed, PetscMax(grown, 16)), PETSC_MAX_INT)));
  PetscFunctionReturn(0);
}

PetscErrorCode PointsAppend(Points *points, PetscInt *index)
{
  static const PetscReal identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  PetscFunctionBeginUser;
  if (points->n == points->capacity) PetscCall(PointsReserveMore(points, 1));
  const PetscInt p = points->n++;
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    char *data = points_field(points, f, &bytes);
    if (bytes) memset(data + bytes * (size_t)p, 0, bytes);
  }
  point_set_F(points, p, identity);
  points->real[POINT_J][p] = 1;
  points->cell[p] = -1;
  if (index) *index = p;
  PetscFunctionReturn(0);
}

/* The size is a constant at each call below, so that the copy becomes a few moves instead of a call
 * of memcpy. */
static inline void gather_sized(char *restrict to, const char *restrict from, size_t bytes, PetscInt n,
                                const PetscInt *restrict index)
{
  for (PetscInt k = 0; k < n; ++k) memcpy(to + bytes * (size_t)k, from + bytes * (size_t)index[k], bytes);
}

void field_gather(void *to, const void *from, size_t bytes, PetscInt n, const PetscInt *index)
{
  switch (bytes) {
  case 0: break;
  case 4: gather_sized(to, from, 4, n, index); break;
  case 8: gather_sized(to, from, 8, n, index); break;
  case 16: gather_sized(to, from, 16, n, index); break;
  case 24: gather_sized(to, from, 24, n, index); break;
  case 32: gather_sized(to, from, 32, n, index); break;
  case 40: gather_sized(to, from, 40, n, index); break;
  case 48: gather_sized(to, from, 48, n, index); break;
  case 64: gather_sized(to, from, 64, n, index); break;
  case 72: gather_sized(to, from, 72, n, index); break;
  default: gather_sized(to, from, bytes, n, index);
  }
}

void points_pack(const Points *points, PetscInt n, const PetscInt *index, char *buffer)
{
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    const char *data = points_field(points, f, &bytes);
    field_gather(buffer, data, bytes, n, index);
    buffer += bytes * (size_t)n;
  }
}

PetscErrorCode PointsUnpack(Points *points, PetscInt n, const char *buffer)
{
  PetscFunctionBeginUser;
  if (!n) PetscFunctionReturn(0);
  PetscCall(PointsReserveMore(points, n));
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    char *data = points_field(points, f, &bytes);
    if (bytes) memcpy(data + bytes * (size_t)points->n, buffer, bytes * (size_t)n);
    buffer += bytes * (size_t)n;
  }
  points->n += n;
  PetscFunctionReturn(0);
}

/* Runs of points that stay move as one piece: few points leave, so the runs are long. */
static void compact_field(char *data, size_t bytes, PetscInt n, const PetscBool *drop)
{
  size_t kept = 0;
  for (PetscInt p = 0; p < n;) {
    if (drop[p]) {
      ++p;
      continue;
    }
    PetscInt end = p + 1;
    while (end < n && !drop[end]) ++end;
    const size_t run = (size_t)(end - p);
    if (kept != (size_t)p) memmove(data + bytes * kept, data + bytes * (size_t)p, bytes * run);
    kept += run;
    p = end;
  }
}

PetscErrorCode PointsCompact(Points *points, const PetscBool *drop)
{
  PetscInt kept = 0;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < points->n; ++p) kept += !drop[p];
  if (kept == points->n) PetscFunctionReturn(0);
  for (int f = 0; f < N_FIELDS; ++f) {
    size_t bytes;
    char *data = points_field(points, f, &bytes);
    if (bytes) compact_field(data, bytes, points->n, drop);
  }
  points->n = kept;
  PetscFunctionReturn(0);
}
