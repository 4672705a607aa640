/* Bodies of revolution about the axis x = 0, y along it. */
#include "case/kinematics/kinematics.h"

const Kinematics kinematics_axisymmetric = {
  .name = "axisymmetric",
  .help = "bodies of revolution: x is the radius, y the axis",
  .dim = 2,
  .hoop = PETSC_TRUE,
};
