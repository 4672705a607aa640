/* ProjectParameters.json: what is computed, with which files; then all the rest of the project. */
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include "import/kratos/project.h"

/* Keys of solver_settings that are read, or that say how Kratos solves and not what. */
static const char *const settings_known[] = {
  "solver_type",
  "model_part_name",
  "domain_size",
  "echo_level",
  "analysis_type",
  "time_integration_method",
  "scheme_type",
  "model_import_settings",
  "material_import_settings",
  "grid_model_import_settings",
  "time_stepping",
  "convergence_criterion",
  "displacement_relative_tolerance",
  "displacement_absolute_tolerance",
  "residual_relative_tolerance",
  "residual_absolute_tolerance",
  "max_iteration",
  "problem_domain_sub_model_part_list",
  "processes_sub_model_part_list",
  "pressure_dofs",
  "auxiliary_variables_list",
  "axis_symmetric_flag",
  "linear_solver_settings",
  "block_builder",
  "compute_reactions",
  "reform_dofs_at_each_step",
  "line_search",
  "move_mesh_flag",
  "newmark_beta",
  "consistent_mass_matrix",
  "damp_factor_m",
  NULL,
};

static void read_scheme(KratosProject *p, const YamlNode *settings)
{
  const char *scheme = kratos_text(settings, "scheme_type"), *type = kratos_text(settings, "solver_type");
  const YamlNode *node = yaml_find(settings, "solver_type");
  p->dynamic = !strcasecmp(type, "dynamic");
  if (!p->dynamic && strcasecmp(type, "static") && strcasecmp(type, "quasi-static") && strcasecmp(type, "quasi_static"))
    kratos_refuse(&p->parameters, node ? node : settings,
                  "a solver_type '%s' is not read: static, quasi-static, dynamic", type);
  if (!strcasecmp(kratos_text(settings, "time_integration_method"), "explicit"))
    kratos_refuse(&p->parameters, yaml_find(settings, "time_integration_method"),
                  "talus is implicit: explicit integration is not read");
  if (!p->dynamic) return;
  p->beta = kratos_number(&p->parameters, settings, "newmark_beta", 0.25);
  if (!scheme[0] || !strcmp(scheme, "bossak"))
    p->bossak = kratos_number(&p->parameters, settings, "damp_factor_m", -0.3);
  else if (strcmp(scheme, "newmark"))
    kratos_refuse(&p->parameters, yaml_find(settings, "scheme_type"), "a scheme '%s' is not read: newmark, bossak",
                  scheme);
}

/* Kratos adds steps up as long as the end is not reached: the last may go beyond it, and where the sum of ten steps of
 * 0.1 s is less than 1 s there is an eleventh. */
static PetscInt steps_until(PetscReal start, PetscReal end, PetscReal step)
{
  PetscInt n = 0;
  for (PetscReal t = start; t < end; t += step) ++n;
  return n;
}

static void read_times(KratosProject *p, const YamlNode *problem, const YamlNode *settings)
{
  const YamlNode *stepping = yaml_find(settings, "time_stepping");
  p->start = kratos_number(&p->parameters, problem, "start_time", 0);
  p->end = kratos_number(&p->parameters, problem, "end_time", 1) - p->start;
  p->step = kratos_number(&p->parameters, stepping, "time_step", 0);
  if (!(p->step > 0) || !(p->end > 0) || p->end / p->step > 1e9) {
    kratos_refuse(&p->parameters, settings, "a time_step > 0 and an end_time behind the start_time are expected");
    p->step = p->end = 1;
  }
  p->n_steps = steps_until(p->start, p->start + p->end, p->step);
  p->end = p->step * (PetscReal)p->n_steps;
}

/* Types of elements say more about the formulation. */
static void read_types(KratosProject *p)
{
  for (PetscInt i = 0; i < p->body->n_types; ++i) {
    const char *type = p->body->types[i], *rest = strstr(type, "UpdatedLagrangian");
    if (!rest || strstr(type, "PQ"))
      diag_error(p->diag, NULL, "%s: talus has nothing for '%s': elements UpdatedLagrangian... are read", p->body->file,
                 type);
    if (strstr(type, "UP2D") || strstr(type, "UP3D")) p->mixed = PETSC_TRUE;
    if (strstr(type, "Axisym")) p->axisymmetric = PETSC_TRUE;
  }
  if (p->body->conditions.n)
    diag_error(p->diag, NULL, "%s: conditions that move with material points are not read, only those of the grid",
               p->body->file);
}

static PetscErrorCode ReadMesh(KratosProject *p, const YamlNode *settings, const char *key, Mdpa **mesh)
{
  const YamlNode *import = yaml_find(settings, key);
  const char *name = kratos_text(import, "input_filename");
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (!name[0]) kratos_refuse(&p->parameters, settings, "%s with its input_filename is missing", key);
  else {
    kratos_path(p, name, ".mdpa", path);
    PetscCall(MdpaRead(path, p->diag, mesh));
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadSettings(KratosProject *p, const YamlNode *settings)
{
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < settings->n; ++i) {
    int k = 0;
    while (settings_known[k] && strcmp(settings_known[k], settings->child[i]->key)) ++k;
    if (!settings_known[k]) diag_warning(p->diag, NULL, "solver_settings.%s is left out", settings->child[i]->key);
  }
  p->dim = kratos_number(&p->parameters, settings, "domain_size", 2) == 3 ? 3 : 2;
  if (kratos_number(&p->parameters, settings, "domain_size", 2) != p->dim)
    kratos_refuse(&p->parameters, yaml_find(settings, "domain_size"), "domain_size is 2 or 3");
  p->axisymmetric = kratos_flag(settings, "axis_symmetric_flag");
  p->mixed = kratos_flag(settings, "pressure_dofs");
  p->consistent = kratos_flag(settings, "consistent_mass_matrix");
  read_scheme(p, settings);
  PetscCall(ReadMesh(p, settings, "grid_model_import_settings", &p->grid));
  PetscCall(ReadMesh(p, settings, "model_import_settings", &p->body));
  kratos_path(p, kratos_text(yaml_find(settings, "material_import_settings"), "materials_filename"), "", path);
  PetscCall(KratosOpen(p->diag, path, &p->materials));
  PetscFunctionReturn(0);
}

/* Loads are forces on the whole thickness, talus's slice is 1 m thick. */
static void check_thickness(KratosProject *p)
{
  PetscBool loaded = PETSC_FALSE;
  for (PetscInt a = 0; a < p->n_actions; ++a)
    loaded = loaded || p->actions[a].kind == KRATOS_LINE_LOAD || p->actions[a].kind == KRATOS_POINT_LOAD;
  for (PetscInt b = 0; b < p->n_bodies && loaded && p->dim == 2; ++b)
    if (p->bodies[b].thickness != 1)
      kratos_refuse(&p->materials, p->bodies[b].node, "a THICKNESS of %g beside loads is not read, only 1",
                    (double)p->bodies[b].thickness);
}

static void find_folder(const char *path, char file[PETSC_MAX_PATH_LEN], char folder[PETSC_MAX_PATH_LEN])
{
  struct stat info;
  if (!stat(path, &info) && S_ISDIR(info.st_mode)) {
    snprintf(file, PETSC_MAX_PATH_LEN, "%.4000s/ProjectParameters.json", path);
    snprintf(folder, PETSC_MAX_PATH_LEN, "%.4000s", path);
  } else {
    const char *slash = strrchr(path, '/');
    snprintf(file, PETSC_MAX_PATH_LEN, "%.4000s", path);
    snprintf(folder, PETSC_MAX_PATH_LEN, "%.*s", slash ? (int)(slash - path) : 1, slash ? path : ".");
  }
}

PetscErrorCode KratosRead(const char *path, Diag *diag, KratosProject *p)
{
  char file[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  *p = (KratosProject){.diag = diag};
  find_folder(path, file, p->folder);
  PetscCall(KratosOpen(diag, file, &p->parameters));
  const YamlNode *root = p->parameters.document ? p->parameters.document->root : NULL;
  const YamlNode *problem = root ? yaml_find(root, "problem_data") : NULL,
                 *settings = root ? yaml_find(root, "solver_settings") : NULL;
  if (root && (!problem || !settings || settings->kind != YAML_MAPPING))
    diag_error(diag, NULL, "%s has no problem_data or no solver_settings: no project of Kratos", file);
  if (!problem || !settings || diag_errors(diag)) PetscFunctionReturn(0);
  snprintf(p->name, sizeof p->name, "%s", kratos_text(problem, "problem_name"));
  PetscCall(ReadSettings(p, settings));
  read_times(p, problem, settings);
  if (!p->grid || !p->body || !p->materials.document || !p->materials.document->root) PetscFunctionReturn(0);
  read_types(p);
  PetscCall(KratosReadMaterials(p));
  PetscCall(KratosReadProcesses(p));
  check_thickness(p);
  PetscFunctionReturn(0);
}

PetscErrorCode KratosClear(KratosProject *p)
{
  PetscFunctionBeginUser;
  PetscCall(YamlDestroy(&p->parameters.document));
  PetscCall(YamlDestroy(&p->materials.document));
  PetscCall(MdpaDestroy(&p->grid));
  PetscCall(MdpaDestroy(&p->body));
  PetscCall(PetscFree(p->bodies));
  PetscCall(PetscFree(p->actions));
  PetscCall(PetscFree(p->checks));
  PetscFunctionReturn(0);
}
