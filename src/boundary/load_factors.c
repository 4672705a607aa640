#include "boundary/load_factors.h"
#include <math.h>
#include "base/formula.h"
#include "base/diag/diag.h"
#include "boundary/loads.h"

static PetscErrorCode Ones(PetscInt n, PetscReal **f)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(3 * n + 1, f)); /* never NULL */
  for (PetscInt i = 0; i < 3 * n; ++i) (*f)[i] = 1;
  PetscFunctionReturn(0);
}

/* Does anything vary from place to place? */
static PetscBool varies(const Loads *l, PetscInt load) { return l->asked[load].ask || l->c->loads[load].factor; }

/* What a caller gives, times the formula of the case. */
static PetscErrorCode Evaluate(const Loads *l, PetscInt load, PetscInt n, const PetscReal *X, const PetscReal *x,
                               PetscReal t, PetscReal *f)
{
  const PetscReal now = case_time(l->c, t);
  LoadPlace place = {.dim = l->dim, .t = now - l->c->loads[load].amplitude.origin};
  PetscReal factor;

  PetscFunctionBeginUser;
  if (l->asked[load].ask) l->asked[load].ask(l->asked[load].context, n, X, x, now, f);
  for (PetscInt i = 0; i < n && l->c->loads[load].factor; ++i) {
    Formula formula = {.value = LoadPlaceValue, .context = &place, .at = l->c->loads[load].factor};
    place.X = X + 3 * i;
    place.x = x + 3 * i;
    PetscCall(FormulaValue(&formula, &factor));
    for (int d = 0; d < 3; ++d) f[3 * i + d] *= factor;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LoadFactorsOfFaces(const Loads *l, PetscInt load, PetscReal t, PetscReal **f)
{
  const LoadFaces *faces = &l->faces[load];

  PetscFunctionBeginUser;
  *f = NULL;
  if (!varies(l, load) || !faces->used) PetscFunctionReturn(0);
  PetscCall(Ones(faces->n, f));
  PetscCall(Evaluate(l, load, faces->n, faces->x, faces->x, t, *f));
  PetscFunctionReturn(0);
}

/* Places in which a carrier's factor is asked for: a piece of a surface has its mean over the Gauss points of it. */
static PetscInt samples_of(const Loads *l) { return loads_have_pieces(l) ? 1 << (l->dim - 1) : 1; }

/* Sample q of carrier p. An edge that has stretched counts as it is now for X, too. */
static void sample(const Loads *l, PetscInt p, PetscInt q, PetscReal X[3], PetscReal x[3])
{
  const Points *carriers = l->carriers;
  const PetscInt dim = l->dim;
  for (PetscInt d = 0; d < dim; ++d) {
    x[d] = point_real(carriers, POINT_X, p)[d];
    X[d] = x[d] - point_real(carriers, POINT_U, p)[d];
  }
  for (PetscInt d = 0; d < carriers->components[POINT_LEAN]; ++d) {
    x[d] += load_lean(point_real(carriers, POINT_X, p), point_real(carriers, POINT_EDGE, p), d);
    X[d] += point_real(carriers, POINT_LEAN, p)[d];
  }
  for (PetscInt k = 0; k < carriers->components[POINT_EDGE]; ++k) {
    const PetscReal side = (q >> k / dim & 1 ? 1 : -1) / PetscSqrtReal(3);
    x[k % dim] += side * point_real(carriers, POINT_EDGE, p)[k];
    X[k % dim] += side * point_real(carriers, POINT_EDGE, p)[k];
  }
}

/* One load's carriers, gathered from among all, and their factors put back. */
static PetscErrorCode Ask(const Loads *l, PetscInt load, PetscReal t, PetscReal *f)
{
  const Points *carriers = l->carriers;
  const PetscInt samples = samples_of(l);
  PetscReal *X, *x, *all;
  PetscInt n = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < carriers->n; ++p) n += samples * (carriers->body[p] == load);
  PetscCall(PetscCalloc2(3 * n, &X, 3 * n, &x));
  PetscCall(Ones(n, &all));
  n = 0;
  for (PetscInt p = 0; p < carriers->n; ++p)
    for (PetscInt q = 0; carriers->body[p] == load && q < samples; ++q, ++n) sample(l, p, q, X + 3 * n, x + 3 * n);
  PetscCall(Evaluate(l, load, n, X, x, t, all));
  const PetscReal *one = all;
  for (PetscInt p = 0; p < carriers->n; ++p) {
    if (carriers->body[p] != load) continue;
    for (int d = 0; d < 3; ++d) f[3 * p + d] = 0;
    for (PetscInt i = 0; i < 3 * samples; ++i) f[3 * p + i % 3] += *one++ / (PetscReal)samples;
  }
  PetscCall(PetscFree2(X, x));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadFactorsOfCarriers(const Loads *l, PetscBool pressures, PetscReal t, PetscReal **f)
{
  PetscFunctionBeginUser;
  *f = NULL;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    if (!varies(l, k) || l->faces[k].used || (l->c->loads[k].kind == LOAD_PRESSURE) != pressures) continue;
    if (!*f) PetscCall(Ones(l->carriers->n, f));
    PetscCall(Ask(l, k, t, *f));
  }
  PetscFunctionReturn(0);
}

/* The first place of this rank where the factor of a load is no number. */
static PetscErrorCode FindUndefined(const Loads *l, PetscInt load, PetscBool *found, PetscReal x[3])
{
  const LoadFaces *faces = &l->faces[load];
  const Points *carriers = l->carriers;
  PetscReal *f;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCall(LoadFactorsOfFaces(l, load, l->c->start, &f));
  for (PetscInt i = 0; f && i < faces->n && !*found; ++i)
    if (!isfinite(f[3 * i])) {
      *found = PETSC_TRUE;
      PetscCall(PetscArraycpy(x, faces->x + 3 * i, 3));
    }
  PetscCall(PetscFree(f));
  PetscCall(LoadFactorsOfCarriers(l, l->c->loads[load].kind == LOAD_PRESSURE, l->c->start, &f));
  for (PetscInt p = 0; f && p < carriers->n && !*found; ++p)
    if (carriers->body[p] == load && !isfinite(f[3 * p])) {
      *found = PETSC_TRUE;
      PetscCall(PetscArraycpy(x, point_real(carriers, POINT_X, p), l->dim));
    }
  PetscCall(PetscFree(f));
  PetscFunctionReturn(0);
}

PetscErrorCode LoadFactorsCheck(const Loads *l, MPI_Comm comm, Diag *diag)
{
  char path[64], key[96];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < l->c->n_loads; ++k) {
    PetscReal x[3] = {0, 0, 0};
    PetscMPIInt rank, size, first;
    PetscBool found;
    if (!l->c->loads[k].factor) continue;
    PetscCall(FindUndefined(l, k, &found, x));
    PetscCallMPI(MPI_Comm_rank(comm, &rank));
    PetscCallMPI(MPI_Comm_size(comm, &size));
    first = found ? rank : size;
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, comm));
    if (first == size) continue;
    PetscCallMPI(MPI_Bcast(x, 3, MPIU_REAL, first, comm));
    snprintf(key, sizeof key, "%s.factor", case_load_path(l->c, k, path));
    diag_error(diag, key, "is no number at (%g, %g, %g) m", (double)x[0], (double)x[1], (double)x[2]);
  }
  PetscFunctionReturn(0);
}
