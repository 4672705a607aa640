/* Subroutines that follow the calling convention UMAT, which many laws of soils are written for
 * (docs/theory.md, "Laws of one's own").
 *
 * State: Cauchy stress and logarithmic strain, which turn along with the material, F, the place, STATEV. */
#pragma once
#include <stddef.h>
#include "material/law.h"

#define UMAT_PLACE 21
#define UMAT_KEPT 24 /* stress 6, strain 6, F 9, place 3 */
#define UMAT_MOST_STATEV 24

/* As Fortran passes them; the last is the length of cmname, which Fortran adds. */
typedef void (*UmatCall)(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                         double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                         const double *dstran, const double *time, const double *dtime, const double *temp,
                         const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                         const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props,
                         const int *nprops, const double *coords, const double *drot, double *pnewdt,
                         const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
                         const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc,
                         size_t cmname_length);

typedef void (*SdviniCall)(double *statev, const double *coords, const int *nstatv, const int *ncrds, const int *noel,
                           const int *npt, const int *layer, const int *kspt);

typedef struct {
  UmatCall call;
  SdviniCall begin; /* NULL: STATEV begins with 0 */
  int n_props, n_statev;
  char name[80]; /* CMNAME, blanks behind */
} Umat;

/* A point starts at x, m: what SDVINI makes of STATEV there, from 0. */
void umat_begin(const Umat *umat, const PetscReal x[3], PetscReal *state);
/* One point. props: those of the case; time, dt: of the step; c NULL: not wanted. */
LawStatus umat_point(const Umat *umat, const PetscReal *props, PetscReal time, PetscReal dt, const PetscReal dF[9],
                     const PetscReal *old, PetscReal *state, PetscReal tau[6], PetscReal *c);
