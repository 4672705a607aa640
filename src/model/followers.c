/* Tracers of measures and carriers of loads go with the material, out of the grid too. Where it
 * leaves them behind they end: the measure is empty and the force is gone, and the run says so. */
#include "model/measure/measure.h"
#include "model/model_private.h"

/* Of one measure or load, summed over the ranks. */
typedef struct {
  PetscReal n, place[3], force[3];
} Uncarried;

static void add_uncarried(const Points *followers, PetscInt p, Uncarried *u)
{
  PetscReal x[3] = {0, 0, 0};
  point_place(followers, p, x);
  u->n += 1;
  for (PetscInt d = 0; d < followers->dim; ++d) {
    u->place[d] += x[d];
    if (followers->components[POINT_FORCE]) u->force[d] += point_real(followers, POINT_FORCE, p)[d];
  }
}

static PetscBool has_force(const Points *carriers, PetscInt p)
{
  for (PetscInt d = 0; d < carriers->dim; ++d)
    if (point_real(carriers, POINT_FORCE, p)[d] != 0) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* What no material carries any more: measures first, then loads. The force of such a carrier is
 * taken away. *any: over all ranks. */
static PetscErrorCode FindUncarried(Model *m, Uncarried *u, PetscBool *any)
{
  const PetscInt n = m->c->n_measures + m->c->n_loads;
  Points *carriers = m->loads->carriers;
  int found = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->tracers->n; ++p) {
    const PetscInt k = m->tracers->body[p];
    if (m->memory[k].ended > 0 || m->method->carries(m->space, m->tracers, p)) continue;
    add_uncarried(m->tracers, p, u + k);
    found = 1;
  }
  for (PetscInt p = 0; p < carriers->n; ++p) {
    if (!has_force(carriers, p) || m->method->carries(m->space, carriers, p)) continue;
    add_uncarried(carriers, p, u + m->c->n_measures + carriers->body[p]);
    PetscCall(PetscArrayzero(point_real(carriers, POINT_FORCE, p), m->dim));
    found = 1;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &found, 1, MPI_INT, MPI_MAX, m->comm));
  *any = found != 0;
  if (found) PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, u, (PetscMPIInt)(7 * n), MPIU_REAL, MPIU_SUM, m->comm));
  for (PetscInt k = 0; k < n && found; ++k)
    for (int d = 0; d < 3 && u[k].n > 0; ++d) u[k].place[d] /= u[k].n;
  PetscFunctionReturn(0);
}

/* Does anything follow the material? The same answer on all ranks. */
static PetscBool has_followers(const Model *m)
{
  for (PetscInt k = 0; k < m->c->n_measures; ++k)
    if (measure_has_tracer(&m->c->measures[k])) return PETSC_TRUE;
  return m->c->n_loads != 0;
}

PetscErrorCode FollowersEnd(Model *m)
{
  const PetscInt n_measures = m->c->n_measures, n = n_measures + m->c->n_loads;
  Uncarried *u;
  PetscBool any;

  PetscFunctionBeginUser;
  if (!has_followers(m)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n, &u));
  PetscCall(FindUncarried(m, u, &any));
  for (PetscInt k = 0; k < n_measures && any; ++k) {
    if (u[k].n == 0) continue;
    m->memory[k].ended = m->time;
    PetscCall(PetscArraycpy(m->memory[k].where, u[k].place, 3));
  }
  for (PetscInt k = n_measures; k < n && any; ++k) {
    LoadMemory *memory = m->load_memory + k - n_measures;
    if (u[k].n == 0) continue;
    memory->ended = m->time;
    memory->carriers += u[k].n;
    for (int d = 0; d < 3; ++d) memory->force[d] += u[k].force[d];
    PetscCall(PetscArraycpy(memory->where, u[k].place, 3));
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}

PetscErrorCode FollowersStart(Model *m, Diag *diag)
{
  const PetscInt n_measures = m->c->n_measures, n = n_measures + m->c->n_loads;
  char path[256], list[64];
  Uncarried *u;
  PetscBool any;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->c->n_loads, &m->load_memory));
  if (!has_followers(m)) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(n, &u));
  PetscCall(FindUncarried(m, u, &any));
  for (PetscInt k = 0; k < n && any; ++k) {
    if (u[k].n == 0 || (k < n_measures && case_goes_on(m->c))) continue; /* later: where the material is by then */
    if (k >= n_measures && m->c->loads[k - n_measures].waits) continue;  /* its own stage tells */
    if (k < n_measures) snprintf(path, sizeof path, "measures.%s.of.tracer", m->c->measures[k].name);
    else
      PetscSNPrintf(path, sizeof path, "%s.%s", case_load_path(m->c, k - n_measures, list),
                    m->c->loads[k - n_measures].kind == LOAD_POINT ? "at" : "on");
    diag_error(diag, path,
               k < n_measures ? "no material carries the tracer: it starts outside of all bodies"
                              : "no material carries the force: it acts outside of all bodies");
    if (m->c->spec && k < n_measures)
      diag_hint(diag,
                "in stage '%s', where bodies that are absent carry nothing: let the measure begin with another one",
                m->c->spec->name);
    else diag_hint(diag, "a place in a body, on its surface, or in a cell beside it");
  }
  PetscCall(PetscFree(u));
  PetscFunctionReturn(0);
}
