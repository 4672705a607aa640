/* Points of one case as those of another. */
#include "material/pressure.h"
#include "model/stage/stage_private.h"
#include "points/onto.h"
#include "points/split.h"

/* The body of this case that one of the other is: of its name, if it is there in both; or -1. */
static PetscInt body_here(const Case *c, const BodySpec *other)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!strcmp(c->bodies[b].name, other->name)) return c->bodies[b].absent || other->absent ? -1 : b;
  return -1;
}

PetscBool body_comes(const Case *c, const Case *from, PetscInt b)
{
  for (PetscInt k = 0; k < from->n_bodies; ++k)
    if (body_here(c, from->bodies + k) == b) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscInt body_material(const Case *c, PetscInt body)
{
  PetscInt i = 0;
  while (strcmp(c->materials[i].name, c->bodies[body].material)) ++i;
  return i;
}

static PetscErrorCode TellStress(const Model *m, PetscInt failed, Diag *diag)
{
  PetscInt any;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(&failed, &any, 1, MPIU_INT, MPI_MAX, m->comm));
  if (any < 0) PetscFunctionReturn(0);
  PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d].material", (int)any));
  diag_error(diag, path, "the law of '%s' has no state that carries the stress that '%s' has: it cannot take over",
             m->c->bodies[any].material, m->c->bodies[any].name);
  PetscFunctionReturn(0);
}

/* Materials of the points become those of their bodies. */
static PetscErrorCode SwapMaterials(Model *m, const Case *from, Diag *diag)
{
  Diag *unheard;
  Material *was;
  PetscInt failed = -1;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&unheard));
  PetscCall(PetscCalloc1(from->n_materials, &was));
  for (PetscInt i = 0; i < from->n_materials; ++i) PetscCall(MaterialAt(from, i, m->time, unheard, &was[i]));
  PetscCall(DiagDestroy(&unheard));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscInt body = m->points->body[p], i = body_material(m->c, body);
    const Material *before = &was[m->points->material[p]], *now = &m->materials[i];
    m->points->material[p] = i;
    if (!before->law) continue;
    m->points->real[POINT_MASS][p] *= now->density / before->density;
    if (!material_as_stiff(before, now) && !point_swap(m->points, p, before, now)) failed = body;
    if (before->law != now->law) size_start(m, p);
  }
  PetscCall(PetscFree(was));
  PetscCall(TellStress(m, failed, diag));
  PetscFunctionReturn(0);
}

/* Points of a law that has none yet: pressures as unknowns. */
static void find_pressures(Model *m, const Table *table)
{
  PetscReal tau[6];
  if (table_has(table, "pressure")) return;
  for (PetscInt p = 0; p < m->points->n && m->points->components[POINT_PRESSURE]; ++p) {
    const Material *material = &m->materials[m->points->material[p]];
    point_tau(m->points, p, tau);
    m->points->real[POINT_PRESSURE][p] = pressure_of_state(material, point_real(m->points, POINT_STATE, p), tau);
  }
}

/* Points of bodies that were not there before, as they were seeded; *placed gets the fields of m's points. */
static PetscErrorCode SetAside(const Model *m, const Case *from, Points **placed)
{
  const Points *points = m->points;
  PetscBool *take;

  PetscFunctionBeginUser;
  PetscCall(PointsCreate(m->dim, 0, 0, placed));
  PetscCall(PetscArraycpy((*placed)->components, points->components, POINT_N_REAL));
  PetscCall(PetscMalloc1(points->n, &take));
  for (PetscInt p = 0; p < points->n; ++p) take[p] = body_comes(m->c, from, points->body[p]);
  PetscCall(PointsCopy(points, take, *placed));
  PetscCall(PetscFree(take));
  PetscFunctionReturn(0);
}

/* Ids are for life: behind those that are there. */
static PetscErrorCode Place(Model *m, Points *placed)
{
  PetscInt64 last = -1, all;
  PetscBool *take;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) last = PetscMax(last, point_seed_id(m->points->id[p]));
  PetscCallMPI(MPI_Allreduce(&last, &all, 1, MPIU_INT64, MPI_MAX, m->comm));
  PetscCall(PetscMalloc1(placed->n, &take));
  for (PetscInt p = 0; p < placed->n; ++p) {
    take[p] = PETSC_TRUE;
    placed->id[p] += all + 1;
  }
  PetscCall(PointsCopy(placed, take, m->points));
  PetscCall(PetscFree(take));
  PetscFunctionReturn(0);
}

/* Points of a coarser grid, whose domains (of gimp) are no wider than a cell: where they stand farther apart than
 * cells are wide, the material would have gaps. */
static PetscErrorCode FitPoints(Model *m, Diag *diag)
{
  const PetscReal h = m->grid->smallest;
  PetscReal local = 0, apart;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
    const PetscReal weight = kinematics_weight(m->c->kinematics, point_real(m->points, POINT_X, p)[0]);
    local = PetscMax(local, PetscPowReal(volume / weight, 1.0 / (PetscReal)m->dim));
  }
  PetscCall(MPIU_Allreduce(&local, &apart, 1, MPIU_REAL, MPIU_MAX, m->comm));
  if (apart > 1.05 * h) {
    diag_error(diag, "grid",
               "points of the run stand up to %.3g m apart, farther than the cells are wide (%.3g m): "
               "the material would have gaps",
               (double)apart, (double)h);
    diag_hint(diag, "take larger cells, or begin with more points_per_cell");
  }
  for (PetscInt p = 0; p < m->points->n; ++p)
    for (PetscInt d = 0; d < m->points->components[POINT_DOMAIN]; ++d) {
      PetscReal *half = point_real(m->points, POINT_DOMAIN, p) + d;
      *half = PetscMin(*half, 0.5 * h);
    }
  PetscFunctionReturn(0);
}

PetscErrorCode TakePoints(Model *m, const Tables *tables, const Case *from, PetscBool onto, Diag *diag,
                          char reason[256])
{
  const Table *table = tables_find(tables, "points");
  PetscInt *body;
  Points *placed;

  PetscFunctionBeginUser;
  if (!table) snprintf(reason, 256, "points is missing");
  if (reason[0]) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(from->n_bodies, &body));
  for (PetscInt b = 0; b < from->n_bodies; ++b) body[b] = body_here(m->c, from->bodies + b);
  const PointsChange change = {.n_bodies = from->n_bodies, .n_materials = from->n_materials, .body = body};
  PetscCall(SetAside(m, from, &placed));
  m->points->n = 0;
  PetscCall(PointsSetState(m->points, LAW_MAX_STATE));
  PetscCall((onto ? PointsTakeOnto : PointsTake)(m->points, m->grid, table, &change, reason));
  if (onto && !reason[0]) PetscCall(FitPoints(m, diag));
  if (!reason[0]) PetscCall(SwapMaterials(m, from, diag));
  PetscCall(PointsSetState(m->points, m->n_state));
  if (!reason[0]) find_pressures(m, table);
  if (!reason[0]) PetscCall(Place(m, placed));
  if (!m->method->clouds) PetscCall(PointsSort(m->points));
  PetscCall(PointsDestroy(&placed));
  PetscCall(PetscFree(body));
  PetscFunctionReturn(0);
}
