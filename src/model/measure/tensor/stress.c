/* The stress of a body, of what lies in a shape, or at a place of the material. */
#include "material/algebra/invariants.h"
#include "model/measure/tensor/tensor.h"

/* tau V0 = sigma V */
static void stress(const Model *m, PetscInt p, PetscReal share, PetscReal sum[6], PetscReal *volume)
{
  const PetscReal undeformed = share * m->points->real[POINT_VOLUME][p];
  PetscReal tau[6];
  point_tau(m->points, p, tau);
  for (int k = 0; k < 6; ++k) sum[k] += undeformed * tau[k];
  *volume += undeformed * m->points->real[POINT_J][p];
}

enum { PRESSURE = TENSOR_OWN, DEVIATORIC, FRICTION };

static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const int which = measure_number(s)->which;
  PetscReal sigma[6];

  PetscFunctionBeginUser;
  PetscCall(MeasureTensor(m, s, index, stress, sigma));
  if (PetscIsNanReal(sigma[0])) *value = NAN;
  else if (which == PRESSURE) *value = stress_pressure(sigma);
  else if (which == DEVIATORIC) *value = stress_deviatoric(sigma);
  else if (which == FRICTION) *value = stress_mobilised_friction(sigma) * 180 / PETSC_PI;
  else *value = tensor_number(sigma, which);
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  TENSOR("xx", "normal stress along x", TENSOR_XX, ),
  TENSOR("yy", "along y", TENSOR_YY, ),
  TENSOR("zz", "along z: out of the plane, round the circle in axisymmetry", TENSOR_ZZ, ),
  TENSOR("xy", "shear stress", TENSOR_XY, ),
  TENSOR("yz", "shear stress (3D)", TENSOR_YZ, ),
  TENSOR("zx", "shear stress (3D)", TENSOR_ZX, ),
  TENSOR("p", "minus a third of the trace, compression positive", PRESSURE, ),
  TENSOR("q", "sqrt(3/2 s:s) of the deviator s, von Mises' equivalent stress", DEVIATORIC, ),
  TENSOR("mobilised_friction",
         "the angle of friction that holds the stress without cohesion, sin phi = (sigma_1 - sigma_3) / -(sigma_1 + "
         "sigma_3)",
         FRICTION, .unit = "deg"),
  TENSOR("sigma_1", "the largest principal stress, tension positive", TENSOR_1, ),
  TENSOR("sigma_2", "the middle one", TENSOR_2, ),
  TENSOR("sigma_3", "the smallest one", TENSOR_3, ),
  NULL,
};

const Measure measure_stress = {
  .key = "stress",
  .takes = MEASURE_WORD,
  .number = {.unit = "Pa",
             .help = "Cauchy stress, tension positive: its mean over the volume, or at a tracer a linear fit to the "
                     "points around it; invariants are those of that"},
  .words = words};
