#include "solve/forces/nodal_force.h"

#define NODAL_FORCE(x) extern const NodalForce nodal_force_##x;
#include "solve/forces/nodal_forces.inc"
#undef NODAL_FORCE

const NodalForce *const nodal_forces[] = {
#define NODAL_FORCE(x) &nodal_force_##x,
#include "solve/forces/nodal_forces.inc"
#undef NODAL_FORCE
  NULL};
