#include "case/kinematics/kinematics.h"

const Kinematics kinematics_plane_strain = {
  .name = "plane-strain",
  .help = "two-dimensional, unit thickness",
  .dim = 2,
};
