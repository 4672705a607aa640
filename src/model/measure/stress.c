/* The stress of a body, or of what lies in a shape: its mean over the volume that the material has. */
#include "model/measure/measure.h"

static PetscErrorCode Mean(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[2] = {0, 0}, tau[6]; /* of tau V0 = sigma V, and of V */

  (void)index;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal volume = measure_share(m, s, body, p) * m->points->real[POINT_VOLUME][p];
    if (volume == 0) continue;
    point_tau(m->points, p, tau);
    sum[0] += volume * tau[measure_number(s)->which];
    sum[1] += volume * m->points->real[POINT_J][p];
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 2, MPIU_REAL, MPI_SUM, m->comm));
  *value = sum[1] > 0 ? sum[0] / sum[1] : NAN;
  PetscFunctionReturn(0);
}

#define STRESS(word, what, number) WORD(word, what, .value = Mean, .which = number, .in = PETSC_TRUE)
static const MeasureNumber *const words[] = {
  STRESS("xx", "normal stress along x", 0),
  STRESS("yy", "along y", 1),
  STRESS("zz", "along z: out of the plane, round the circle in axisymmetry", 2),
  STRESS("xy", "shear stress", 3),
  STRESS("yz", "shear stress (3D)", 4),
  STRESS("zx", "shear stress (3D)", 5),
  NULL,
};

const Measure measure_stress = {
  .key = "stress",
  .takes = MEASURE_WORD,
  .number = {.unit = "Pa", .help = "mean Cauchy stress over the volume, tension positive"},
  .words = words};
