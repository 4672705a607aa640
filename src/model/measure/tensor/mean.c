#include "base/math/eigen.h"
#include "model/measure/tensor/tensor.h"

PetscErrorCode MeasureTensor(Model *m, const MeasureSpec *s, PetscInt index, PointTensor *tensor, PetscReal value[6])
{
  const PetscInt body = measure_body(m, s);
  PetscReal sum[7] = {0}; /* the last: of the volume */

  PetscFunctionBeginUser;
  if (measure_has_tracer(s)) {
    PetscCall(TensorNear(m, index, tensor, value));
    PetscFunctionReturn(0);
  }
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal share = measure_share(m, s, body, p);
    if (share > 0) tensor(m, p, share, sum, &sum[6]);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, sum, 7, MPIU_REAL, MPI_SUM, m->comm));
  for (int k = 0; k < 6; ++k) value[k] = sum[6] > 0 ? sum[k] / sum[6] : NAN;
  PetscFunctionReturn(0);
}

PetscReal tensor_number(const PetscReal value[6], int which)
{
  PetscReal principal[3], v[9];
  if (which < TENSOR_1) return value[which];
  sym_eigen(value, principal, v);
  return principal[which - TENSOR_1];
}
