/* Values of the JSON files, and what is complained of. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/file.h"
#include "import/kratos/project.h"

PetscErrorCode KratosOpen(Diag *diag, const char *path, KratosFile *file)
{
  const char *why;
  size_t length;
  char *text;

  PetscFunctionBeginUser;
  *file = (KratosFile){.diag = diag};
  PetscCall(FileLoad(path, &text, &length, &why));
  if (!text) diag_error(diag, NULL, "'%s' cannot be read: %s", path, why);
  else PetscCall(YamlCreate(path, text, length, diag, &file->document));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscReal number_of(const KratosFile *f, const YamlNode *node)
{
  char *end = NULL;
  const PetscReal value = node->kind == YAML_SCALAR ? strtod(node->text, &end) : 0;
  if (!end || end == node->text || *end || PetscIsInfOrNanReal(value)) {
    kratos_refuse(f, node, "a number is expected; functions of time and place are not read");
    return 0;
  }
  return value;
}

PetscReal kratos_number(const KratosFile *f, const YamlNode *mapping, const char *key, PetscReal fallback)
{
  const YamlNode *node = mapping ? yaml_find(mapping, key) : NULL;
  return node && !yaml_is_null(node) ? number_of(f, node) : fallback;
}

const char *kratos_text(const YamlNode *mapping, const char *key)
{
  const YamlNode *node = mapping ? yaml_find(mapping, key) : NULL;
  return node && node->kind == YAML_SCALAR ? node->text : "";
}

PetscBool kratos_flag(const YamlNode *mapping, const char *key) { return !strcmp(kratos_text(mapping, key), "true"); }

PetscBool kratos_vector(const KratosFile *f, const YamlNode *mapping, const char *key, PetscReal value[3])
{
  const YamlNode *node = mapping ? yaml_find(mapping, key) : NULL;
  for (int d = 0; d < 3; ++d) value[d] = 0;
  if (!node || node->kind != YAML_SEQUENCE) return PETSC_FALSE;
  for (PetscInt d = 0; d < PetscMin(node->n, 3); ++d)
    if (!yaml_is_null(node->child[d])) value[d] = number_of(f, node->child[d]);
  return PETSC_TRUE;
}

void kratos_path(const KratosProject *p, const char *named, const char *ending, char path[PETSC_MAX_PATH_LEN])
{
  const char *slash = strrchr(named, '/');
  snprintf(path, PETSC_MAX_PATH_LEN, "%.2000s/%.1000s%s", p->folder, named, ending);
  if (access(path, R_OK) && slash)
    snprintf(path, PETSC_MAX_PATH_LEN, "%.2000s/%.1000s%s", p->folder, slash + 1, ending);
}

const char *kratos_part(const char *full)
{
  const char *point = strchr(full, '.');
  return point ? point + 1 : full;
}

void kratos_name(const char *part, char name[KRATOS_NAME])
{
  snprintf(name, KRATOS_NAME, "%s", part);
  for (char *c = name; *c; ++c)
    if (!isalnum((unsigned char)*c)) *c = '_';
}
