#include "case/kinematics/kinematics.h"

const Kinematics kinematics_3d = {
  .name = "3d",
  .help = "three-dimensional",
  .dim = 3,
};
