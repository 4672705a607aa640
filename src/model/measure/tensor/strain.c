/* The logarithmic strain of a body, of what lies in a shape, or at a place of the material. */
#include "material/algebra/invariants.h"
#include "model/measure/tensor/tensor.h"

static void strain(const Model *m, PetscInt p, PetscReal share, PetscReal sum[6], PetscReal *volume)
{
  const PetscReal deformed = share * m->points->real[POINT_VOLUME][p] * m->points->real[POINT_J][p];
  PetscReal F[9], e[6];
  point_F(m->points, p, F);
  strain_logarithmic(F, e);
  for (int k = 0; k < 6; ++k) sum[k] += deformed * e[k];
  *volume += deformed;
}

enum { VOLUMETRIC = TENSOR_OWN, DEVIATORIC };

static PetscErrorCode Value(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const int which = measure_number(s)->which;
  PetscReal e[6];

  PetscFunctionBeginUser;
  PetscCall(MeasureTensor(m, s, index, strain, e));
  if (PetscIsNanReal(e[0])) *value = NAN;
  else if (which == VOLUMETRIC) *value = e[0] + e[1] + e[2];
  else if (which == DEVIATORIC) *value = strain_deviatoric(e);
  else *value = tensor_number(e, which);
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  TENSOR("xx", "along x, lengthening positive", TENSOR_XX, ),
  TENSOR("yy", "along y", TENSOR_YY, ),
  TENSOR("zz", "along z: out of the plane, round the circle in axisymmetry", TENSOR_ZZ, ),
  TENSOR("xy", "component of the tensor: half of the angle", TENSOR_XY, ),
  TENSOR("yz", "the same (3D)", TENSOR_YZ, ),
  TENSOR("zx", "the same (3D)", TENSOR_ZX, ),
  TENSOR("volumetric", "the trace: ln of the volume over the unstressed one", VOLUMETRIC, ),
  TENSOR("deviatoric", "sqrt(2/3 e:e) of the deviator e", DEVIATORIC, ),
  TENSOR("eps_1", "the largest principal strain", TENSOR_1, ),
  TENSOR("eps_2", "the middle one", TENSOR_2, ),
  TENSOR("eps_3", "the smallest one", TENSOR_3, ),
  NULL,
};

const Measure measure_strain = {
  .key = "strain",
  .takes = MEASURE_WORD,
  .number = {.unit = "",
             .help = "logarithmic strain ln V of the deformation since the start, and before that of a given stress "
                     "(`k0`, `stress`) the change of volume alone, a third of it along each axis: what that stress has "
                     "sheared is not in it (ln V since the unstressed state where none is given); its mean over the "
                     "volume, or at a tracer a linear fit to the points of its body around it; invariants are those of "
                     "that"},
  .words = words};
