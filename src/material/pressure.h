/* Laws with their mean stress as an unknown of its own: what the mixed formulation asks of a
 * material.
 *
 * A volumetric strain theta of the displacements stands against p / K of the unknown pressure p
 * (tension positive), and the stress takes its volumetric part from p (docs/theory.md, "Mixed
 * formulation"). By the law's volumetric part:
 *
 *   VOLUME_LINEAR   theta = J - 1      tau = dev tau + J p I      p: mean Cauchy stress
 *   VOLUME_LOG      theta = ln J       tau = dev tau + p I        p: mean Kirchhoff stress
 *   VOLUME_COUPLED  theta = ln J^e     tau of the law with the elastic volume exp(p / K) in place
 *   of J^e before it flows */
#pragma once
#include "material/law.h"

/* What one batch gives. */
typedef struct {
  PetscReal theta[LAW_BATCH], rate[LAW_BATCH]; /* volumetric strain, and its derivative by tr d */
  /* after the flow, which may take some of a coupled law's pressure away */
  PetscReal pressure[LAW_BATCH];
  PetscReal tau[6 * LAW_BATCH];
  PetscReal c[36 * LAW_BATCH];       /* L_v tau = c : d at constant p */
  PetscReal coupling[6 * LAW_BATCH]; /* d tau / d p at constant deformation */
} PressureStress;

/* As Law.update, with the pressure p of each point (n) given; c and coupling only if `tangent`.
 * `update` is the law's own or its update_hoop (p strains z in the plane, too), which then says what
 * of c means something. */
LawStatus pressure_update(const Material *material, LawUpdate update, PetscInt n, const PetscReal *dF,
                          const PetscReal *p, const PetscReal *old, PetscReal *state, PetscBool tangent,
                          PressureStress *s);

/* Pressure unknown that belongs to a stress state of the law itself: its Kirchhoff stress, and the
 * volume of its state. */
PetscReal pressure_of_state(const Material *material, const PetscReal *state, const PetscReal tau[6]);

/* What the stabilisation holds pressures by that vary inside a cell, over its alpha, 1/Pa: of the state and Kirchhoff
 * stress at the start of a step. 1 / G; where points that flow move through cells, the shape that they have gained by
 * that over their stress, up to MOST_SOFTENED times as much (docs/theory.md, section 92). */
#define MOST_SOFTENED 16
PetscReal pressure_softness(const Material *material, const PetscReal *state, const PetscReal tau[6]);

/* Stored energy per undeformed volume: that of shape from the state, that of volume from the
 * pressure after the flow. */
PetscReal pressure_energy(const Material *material, const PetscReal *state, PetscReal p);
