/* ParticleMaterials.json: bodies and their laws. */
#include <stdlib.h>
#include <string.h>
#include "import/kratos/project.h"

/* A number of Kratos's and what talus calls it, with the law that has it. */
static const struct {
  const char *variable, *key;
  PetscReal factor; /* its angles are radians */
} constants[] = {{"DENSITY", "density", 1},
                 {"YOUNG_MODULUS", "young", 1},
                 {"POISSON_RATIO", "poisson", 1},
                 {"INTERNAL_FRICTION_ANGLE", "friction_angle", 180 / PETSC_PI},
                 {"INTERNAL_DILATANCY_ANGLE", "dilatancy_angle", 180 / PETSC_PI},
                 {"COHESION", "cohesion", 1},
                 {NULL, NULL, 0}};

/* Laws by the beginning of their names; `plain`: it takes the first three constants alone. */
static const struct {
  const char *begin, *law, *said;
  PetscBool plain;
} laws_known[] = {
  {"LinearElastic", "neo-hookean", "the same to first order in the strain", PETSC_TRUE},
  {"HyperElasticNeoHookeanUP", "neo-hookean-split", NULL, PETSC_TRUE},
  {"HyperElasticNeoHookean", "neo-hookean", NULL, PETSC_TRUE},
  {"HyperElasticUP", "neo-hookean-split", NULL, PETSC_TRUE}, /* names until 2019 */
  {"HyperElastic3D", "neo-hookean", NULL, PETSC_TRUE},
  {"HyperElasticPlaneStrain", "neo-hookean", NULL, PETSC_TRUE},
  {"HyperElasticAxisym", "neo-hookean", NULL, PETSC_TRUE},
  {"HenckyMCPlasticUP", "mohr-coulomb", NULL, PETSC_FALSE},
  {"HenckyMCPlastic", "mohr-coulomb", NULL, PETSC_FALSE},
  {NULL, NULL, NULL, PETSC_TRUE},
};

static void read_law(const KratosFile *f, const YamlNode *law, KratosBody *body, PetscBool *plain)
{
  const char *name = kratos_text(law, "name");
  int i = 0;
  while (laws_known[i].begin && strncmp(name, laws_known[i].begin, strlen(laws_known[i].begin))) ++i;
  if (!laws_known[i].begin) {
    kratos_refuse(f, law ? law : body->node, "talus has no law like '%s'", name[0] ? name : "none");
    diag_hint(f->diag, "linear elastic, neo-Hookean and Mohr-Coulomb laws are read");
    return;
  }
  snprintf(body->law, sizeof body->law, "%s", laws_known[i].law);
  *plain = laws_known[i].plain;
  if (laws_known[i].said)
    diag_warning(f->diag, NULL, "%s is taken as %s: %s", name, laws_known[i].law, laws_known[i].said);
}

/* A value of Kratos's as it would be written by hand: 30 degrees, not 30.000000000000004. */
static PetscReal rounded(PetscReal value)
{
  char text[40];
  snprintf(text, sizeof text, "%.12g", (double)value);
  return strtod(text, NULL);
}

/* A sheet under plane stress strains in its plane as a slice under plane strain does that has these constants. */
static void take_plane_stress(const KratosFile *f, const char *law, KratosBody *body)
{
  enum { YOUNG = 1, POISSON = 2 };
  const PetscReal nu = body->constant[POISSON];
  if (!strstr(law, "PlaneStress")) return;
  if (strncmp(law, "LinearElastic", 13)) {
    kratos_refuse(f, body->node, "talus knows plane stress only of the linear elastic law");
    return;
  }
  body->constant[YOUNG] = rounded(body->constant[YOUNG] * (1 + 2 * nu) / ((1 + nu) * (1 + nu)));
  body->constant[POISSON] = rounded(nu / (1 + nu));
  diag_warning(f->diag, NULL,
               "plane stress is taken as plane strain with E (1 + 2 nu) / (1 + nu)^2 and nu / (1 + nu): "
               "the same in the plane, stresses across it are not");
}

/* Kratos counts points of hexahedra by those of one of their faces; of tetrahedra 3 stands for 4. */
static PetscInt points_of(PetscInt n, PetscInt nodes, PetscInt dim)
{
  if (dim == 3 && nodes == 8) return n == 4 ? 8 : n == 9 ? 27 : n == 16 ? 64 : n;
  return dim == 3 && n == 3 ? 4 : n;
}

static PetscInt nodes_of_part(const Mdpa *model, const MdpaPart *part)
{
  const PetscInt first = part && part->elements.n ? mdpa_find(&model->elements, part->elements.id[0]) : -1;
  return first < 0 ? 0 : model->elements.entity[first].n;
}

static void read_body(KratosProject *p, const YamlNode *item, KratosBody *body)
{
  const KratosFile *f = &p->materials;
  const YamlNode *material = yaml_find(item, "Material"),
                 *variables = material ? yaml_find(material, "Variables") : NULL;
  PetscBool plain = PETSC_TRUE;

  *body = (KratosBody){.node = item};
  snprintf(body->part, sizeof body->part, "%s", kratos_part(kratos_text(item, "model_part_name")));
  kratos_name(body->part, body->name);
  const MdpaPart *part = mdpa_part(p->body, body->part);
  if (!part) kratos_refuse(f, item, "%s has no model part '%s'", p->body->file, body->part);
  if (!variables) {
    kratos_refuse(f, item, "a material has no Variables");
    return;
  }
  read_law(f, yaml_find(material, "constitutive_law"), body, &plain);
  for (int i = 0; constants[i].variable && (i < 3 || !plain); ++i) {
    if (i < 3 && !yaml_find(variables, constants[i].variable))
      kratos_refuse(f, variables, "the material has no %s", constants[i].variable);
    body->key[i] = constants[i].key;
    body->constant[i] = rounded(constants[i].factor * kratos_number(f, variables, constants[i].variable, 0));
    body->n_constants = i + 1;
  }
  take_plane_stress(f, kratos_text(yaml_find(material, "constitutive_law"), "name"), body);
  body->thickness = kratos_number(f, variables, "THICKNESS", 1);
  const PetscReal older = kratos_number(f, variables, "PARTICLES_PER_ELEMENT", 1),
                  points = kratos_number(f, variables, "MATERIAL_POINTS_PER_ELEMENT", older);
  if (!(points >= 1 && points < 1000)) kratos_refuse(f, variables, "a number of points in each element is expected");
  else body->points = points_of((PetscInt)points, nodes_of_part(p->body, part), p->dim);
}

PetscErrorCode KratosReadMaterials(KratosProject *p)
{
  const YamlNode *root = p->materials.document->root, *list = root ? yaml_find(root, "properties") : NULL;

  PetscFunctionBeginUser;
  if (!list || list->kind != YAML_SEQUENCE || !list->n) {
    diag_error(p->diag, NULL, "%s has no list of 'properties'", p->materials.document->file);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(list->n, &p->bodies));
  for (p->n_bodies = 0; p->n_bodies < list->n; ++p->n_bodies)
    read_body(p, list->child[p->n_bodies], &p->bodies[p->n_bodies]);
  PetscFunctionReturn(0);
}
