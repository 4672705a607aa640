#include "formulation/holding.h"
#include "formulation/kernels/cloud_kernels.h"

static inline PetscBool load(const WeakFormInput *in, PetscInt p, CloudWork *work)
{
  const Support *w = in->support;
  work->nn = support_nodes(w, p);
  work->node = w->node + w->node_start[p];
  work->soft = in->soft[p];
  return work->soft > 0;
}

KERNEL void add_forces(const int dim, const WeakFormInput *in, PetscReal *force)
{
  CloudWork work;
  for (PetscInt p = 0; p < in->support->n_groups; ++p)
    if (load(in, p, &work)) cloud_hold(dim, in, &work, force);
}

void holding_forces(const WeakFormInput *in, PetscInt dim, PetscReal *force)
{
  if (dim == 2) add_forces(2, in, force);
  else add_forces(3, in, force);
}

KERNEL PetscReal sum_work(const int dim, const WeakFormInput *in)
{
  CloudWork work;
  PetscReal sum = 0;
  for (PetscInt p = 0; p < in->support->n_groups; ++p) {
    if (!load(in, p, &work)) continue;
    sum += 0.5 * work.soft * (in->lattice ? held_square(dim, dim, in, &work) : held_square(0, dim, in, &work));
  }
  return sum;
}

PetscReal holding_work(const WeakFormInput *in, PetscInt dim) { return dim == 2 ? sum_work(2, in) : sum_work(3, in); }
