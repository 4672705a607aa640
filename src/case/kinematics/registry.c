#include "case/kinematics/kinematics.h"
#include <string.h>

#define KINEMATICS(x) extern const Kinematics kinematics_##x;
#include "case/kinematics/kinematics.inc"
#undef KINEMATICS

const Kinematics *const kinematics_list[] = {
#define KINEMATICS(x) &kinematics_##x,
#include "case/kinematics/kinematics.inc"
#undef KINEMATICS
  NULL};

const Kinematics *kinematics_find(const char *name)
{
  for (PetscInt i = 0; kinematics_list[i]; ++i)
    if (!strcmp(kinematics_list[i]->name, name)) return kinematics_list[i];
  return NULL;
}
