#include "case/fields.h"
#include <string.h>

#define P PETSC_TRUE, PETSC_FALSE /* points only */
#define PG PETSC_TRUE, PETSC_TRUE /* points and grid */

static OutputField fields[OUTPUT_FIELDS_MOST + 1] = {
  {"displacement", "m", "displacement from the start", 3, PG},
  {"velocity", "m/s", "velocity; on the grid of mpm the mean of the points, by mass", 3, PG},
  {"acceleration", "m/s2", "acceleration; on the grid of mpm the mean of the points, by mass", 3, PG},
  {"stress", "Pa", "Cauchy stress, tension positive: xx yy zz xy yz zx", 6, PG},
  {"pressure", "Pa",
   "minus a third of the trace of the stress, p, compression positive; on the grid the mixed unknown, if there is one",
   1, PG},
  {"mises", "Pa", "von Mises equivalent stress, q", 1, PG},
  {"mobilised_friction", "deg", "angle of friction that holds the stress without cohesion", 1, PG},
  {"strain", "",
   "logarithmic strain ln V since the unstressed state: xx yy zz xy yz zx, shears not doubled; of a given stress "
   "(`k0`, "
   "`stress`) it has the change of volume alone, a third along each axis, and not what that has sheared",
   6, PG},
  {"deviatoric_strain", "", "sqrt(2/3 e:e) of its deviator e", 1, PG},
  {"volume_strain", "", "ln of the volume over the unstressed one, positive where it has grown", 1, PG},
  {"deformation_gradient", "", "deformation gradient, row by row; begins as J^(1/3) I with the J of a given stress", 9,
   P},
  {"equivalent_plastic_strain", "", "accumulated plastic strain, 0 for elastic laws", 1, PG},
  {"plastic_increment", "", "what the last step added to it: where a body slides, at a factor of safety", 1, P},
  {"mechanism", "m/s",
   "displacement in the last step per time; at a limit load or a factor of safety per factor: how it fails", 3, PG},
  {"opening", "", "ln of the volume by which grains are apart, where the law remembers it (opening_memory)", 1, P},
  {"preconsolidation", "Pa", "largest isotropic pressure so far, of modified-cam-clay", 1, P},
  {"mass", "kg", "mass of a point; on the grid the mass gathered at a node", 1, PG},
  {"density", "kg/m3", "current density", 1, P},
  {"volume", "m3", "current volume (for unit thickness in plane strain, all round in axisymmetry)", 1, P},
  {"energy", "J/m3", "stored elastic energy per undeformed volume", 1, P},
  {"contact_force", "N", "force of walls, and of second bodies of interfaces, on the point, at the end of the step", 3,
   P},
  {"id", "", "number of the point, the same through the whole run", 1, P},
  {"body", "", "index of the body in the case file", 1, P},
  {"material", "", "index of the material in the case file", 1, P},
};

const OutputField *const output_fields = fields;

const OutputField *output_field_find(const char *name)
{
  for (const OutputField *field = output_fields; field->name; ++field)
    if (!strcmp(field->name, name)) return field;
  return NULL;
}

PetscBool output_field_add(const OutputField *field)
{
  static PetscInt loaded = OUTPUT_FIELDS_MOST; /* where they begin */
  PetscInt n = 0;
  while (fields[n].name && strcmp(fields[n].name, field->name) != 0) ++n;
  if (fields[n].name) return (PetscBool)(n < loaded || fields[n].components == field->components);
  loaded = PetscMin(loaded, n);
  if (n < OUTPUT_FIELDS_MOST) fields[n] = *field;
  return PETSC_TRUE;
}
