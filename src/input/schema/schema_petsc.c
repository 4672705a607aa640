/* The `petsc:` block: options of PETSc, as far as a case file may set them. */
#include <string.h>
#include "input/petsc_options.h"
#include "input/schema/schema.h"

static void unknown(SchemaReader *r, const YamlNode *node, const char *name)
{
  char nearest[64];
  SchemaKeyError(r, node, "a case file may not set the PETSc option '%.80s'", name);
  if (petsc_option_nearest(name, nearest))
    diag_hint(r->diag, "did you mean '%s'? Options that do not solve or print belong on the command line", nearest);
  else
    diag_hint(r->diag,
              "it may choose solvers, set their tolerances and print on the terminal; other options of PETSc belong on "
              "the command line: -%.80s",
              name);
}

static void refuse(SchemaReader *r, const YamlNode *node, const char *name, PetscOptionKind kind)
{
  char path[512];
  SchemaError(r, node, "%s may not be '%.80s' in a case file: %s", yaml_path(node, path, sizeof path), node->text,
              petsc_option_refusal(kind, node->text));
  if (kind == PETSC_OPTION_VIEW)
    diag_hint(r->diag, "write true, or ascii::FORMAT; files, pictures and sockets are for the command line (-%.80s)",
              name);
  else diag_hint(r->diag, "on the command line (-%.80s) it is yours to say", name);
}

/* May this stand in a case file? */
static PetscBool allowed(SchemaReader *r, const YamlNode *node, const char *name)
{
  const PetscOptionKind kind = petsc_option_kind(name);
  if (kind == PETSC_OPTION_UNKNOWN) unknown(r, node, name);
  else if (!yaml_is_null(node) && petsc_option_refusal(kind, node->text)) refuse(r, node, name, kind);
  else return PETSC_TRUE;
  return PETSC_FALSE;
}

/* snes_rtol: 1e-9 becomes "-snes_rtol 1e-9"; an option without a value is written with nothing, or
 * true. */
static PetscErrorCode ReadOption(SchemaReader *r, const YamlNode *node, char **option)
{
  const char *name = node->key + (node->key[0] == '-');
  char path[512];

  PetscFunctionBeginUser;
  if (node->kind != YAML_SCALAR) SchemaError(r, node, "%s must be a single value", yaml_path(node, path, sizeof(path)));
  else if (!name[0] || strpbrk(name, " \t\n")) SchemaKeyError(r, node, "'%s' is no name of a PETSc option", node->key);
  else if (allowed(r, node, name)) {
    const PetscBool bare = yaml_is_null(node);
    const size_t size = strlen(name) + strlen(node->text) + 3;
    PetscCall(PetscMalloc1(size, option));
    snprintf(*option, size, bare ? "-%s%s" : "-%s %s", name, bare ? "" : node->text);
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SchemaReadOptions(SchemaReader *r, const SchemaEntry *e, const YamlNode *node, void *target)
{
  char ***options = (char ***)((char *)target + e->offset);
  PetscInt *n = (PetscInt *)((char *)target + e->count);

  PetscFunctionBeginUser;
  if (node->kind != YAML_MAPPING) {
    schema_mismatch(r, e, node);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscCalloc1(node->n, options));
  for (PetscInt i = 0; i < node->n; ++i) {
    PetscCall(ReadOption(r, node->child[i], &(*options)[*n]));
    *n += (*options)[*n] != NULL;
  }
  PetscFunctionReturn(0);
}
