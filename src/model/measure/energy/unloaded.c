/* What elastic bodies still store when nothing acts on them any more: all that came in should be out again. */
#include "case/case.h"
#include "model/model_private.h"

#define NOTHING 1e-9 /* a factor: tables are linear between times that are sums */

/* Does every law give back what it takes, whatever the way and the time? */
static PetscBool is_elastic(const Model *m)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    const Law *law = m->materials[i].law;
    if (law->yields || law->rate || law->step || !law->energy || m->c->materials[i].n_amplitudes) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Did it begin with nothing that acts or is stored, and is all that acts known here? */
static PetscBool is_told(const Model *m)
{
  const Case *c = m->c;
  if (c->analysis.type != ANALYSIS_STATIC || m->initial.seeking || c->staged || c->initial.run) return PETSC_FALSE;
  return (PetscBool)(!m->contact && !m->body_force && !case_has_stress(c));
}

static PetscBool is_off(const Model *m, const Amplitude *amplitude)
{
  return (PetscBool)(PetscAbsReal(case_factor(m->c, amplitude, m->time)) <= NOTHING);
}

/* Of what moves as it is told only displacements are known to be back. */
static PetscBool is_back(const Model *m, const MotionSpec *motion)
{
  if (motion->absent || motion->kind == MOTION_FIXED) return PETSC_TRUE;
  return (PetscBool)(motion->kind == MOTION_DISPLACEMENT && is_off(m, &motion->amplitude));
}

static PetscBool nothing_acts(const Model *m)
{
  const Case *c = m->c;
  const PetscReal *g = c->gravity;
  const PetscBool weighs = (PetscBool)(g[0] != 0 || g[1] != 0 || g[2] != 0);
  if (weighs && !is_off(m, &c->gravity_amplitude)) return PETSC_FALSE;
  for (PetscInt k = 0; k < case_acting_loads(c); ++k)
    if (!is_off(m, &c->loads[k].amplitude)) return PETSC_FALSE;
  for (PetscInt k = 0; k < c->n_boundary; ++k)
    if (!is_back(m, c->boundary + k)) return PETSC_FALSE;
  return PETSC_TRUE;
}

PetscErrorCode NoteUnloaded(Model *m)
{
  Energies e;

  PetscFunctionBeginUser;
  if (!is_told(m) || !is_elastic(m) || !nothing_acts(m)) PetscFunctionReturn(0);
  PetscCall(ModelEnergies(m, &e));
  m->kept_energy = PetscMax(m->kept_energy, e.elastic);
  PetscFunctionReturn(0);
}
