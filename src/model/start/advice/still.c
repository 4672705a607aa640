/* A case in which nothing happens: a block of words was forgotten. */
#include "model/model_private.h"

static PetscBool is_zero(const PetscReal v[3]) { return (PetscBool)(v[0] == 0 && v[1] == 0 && v[2] == 0); }

static PetscBool something_acts(const Case *c)
{
  PetscBool acts = (PetscBool)(c->initial.run || case_acting_loads(c) > 0 || !is_zero(c->gravity));
  for (PetscInt k = 0; k < c->n_boundary; ++k) acts |= c->boundary[k].kind != MOTION_FIXED;
  for (PetscInt k = 0; k < c->n_walls; ++k) acts |= c->walls[k].n_motions || c->walls[k].has_mass;
  for (PetscInt k = 0; k < c->n_materials; ++k) acts |= c->materials[k].n_amplitudes > 0;
  for (PetscInt k = 0; k < c->n_bodies; ++k)
    acts |= !is_zero(c->bodies[k].velocity) || !is_zero(c->bodies[k].spin) || body_has_stress(c->bodies + k);
  return acts;
}

void model_advise_still(const Model *m, const Case *whole, Diag *diag)
{
  PetscBool acts = (PetscBool)(m->body_force != NULL);
  for (PetscInt k = 0; k < case_stages(whole); ++k) acts |= something_acts(case_stage(whole, k));
  if (acts || m->c->stage > 0) return;
  diag_warning(diag, "loads",
               "nothing acts on what is here: there is no gravity, load, prescribed motion, velocity or stress at the "
               "start");
  diag_hint(diag, "weight is `loads: {gravity: %s}`", m->dim == 2 ? "[0, -9.81]" : "[0, 0, -9.81]");
}
