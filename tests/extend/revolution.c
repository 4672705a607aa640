/* Bodies of revolution, as in src/case/kinematics/axisymmetric.c, under another word. */
#include "case/kinematics/kinematics.h"

const Kinematics kinematics_revolution = {
  .name = "revolution",
  .help = "bodies of revolution: x is the radius, y the axis",
  .dim = 2,
  .hoop = PETSC_TRUE,
};
