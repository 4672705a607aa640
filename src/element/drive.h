/* One material point: each of six components is a strain or a stress that is prescribed, and the
 * deformation is sought (docs/theory.md, "One material point").
 *
 * The deformation gradient is F = (I + G) D: D = diag(exp e_xx, exp e_yy, exp e_zz), and G holds the
 * shears e_xy, e_yz, e_zx above its diagonal. So lines along x keep their direction and planes of x
 * and y their normal; without shears e is the logarithmic strain, and e_xy alone is simple shear.
 * Components stand in Voigt order xx yy zz xy yz zx. */
#pragma once
#include "material/law.h"

/* What is prescribed of a component: its total Cauchy stress, or e. */
typedef struct {
  PetscBool stress[6];
  PetscBool undrained; /* the volume stays, and a pore pressure takes what that asks for */
  PetscReal seconds;   /* that the way from `from` to `to` takes; 0: time does not count */
} DriveControl;

typedef struct {
  Material *material; /* is told of time */
  PetscReal time;     /* s */
  PetscReal state[LAW_MAX_STATE];
  PetscReal strain[6]; /* e */
  PetscReal stress[6]; /* effective Cauchy stress, Pa, tension positive */
  PetscReal pore;      /* pore pressure, Pa: total stress = stress - pore I */
  PetscReal J;         /* of the start's state over the unstressed volume: tau = J det F stress */
} DrivePoint;

#define DRIVE_ITERATIONS 40

/* How it went. */
typedef struct {
  PetscInt iterations, substeps; /* in all */
  PetscReal reached;             /* share of the way from `from` to `to`, 1 if all went well */
  PetscReal passed;              /* most of a piece of its table of strength at once (Law.passed) */
  LawStatus status;              /* the law's last answer */
  PetscInt n;                    /* of the last Newton iteration: its residuals, relative */
  PetscReal residual[DRIVE_ITERATIONS];
} DriveReport;

/* Start with this stress (six components) and pore pressure, undeformed; no stress at all is the law's own initial
 * state. PETSC_FALSE if the law cannot carry it. */
PetscBool drive_start(DrivePoint *point, Material *material, const PetscReal stress[6], PetscReal pore);

/* F of the point, row by row. */
void drive_gradient(const PetscReal strain[6], PetscReal F[9]);
/* What the point has of the components that are prescribed. */
void drive_values(const DrivePoint *point, const DriveControl *control, PetscReal values[6]);

/* Lead the prescribed components from `from` (that of the point) to `to` along a line, in one increment
 * if Newton converges, else in parts, halved up to ten times. PETSC_FALSE: the point stands where
 * report->reached tells. */
PetscBool drive_advance(DrivePoint *point, const DriveControl *control, const PetscReal from[6], const PetscReal to[6],
                        DriveReport *report);
