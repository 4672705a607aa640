/* The unit of a key, found by walking the tables along its path. */
#include <string.h>
#include "input/case_file.h"
#include "input/schema/schema.h"
#include "material/law.h"

static const char *unit_of_constant(const char *key, size_t length)
{
  SchemaEntry elastic;
  for (PetscInt i = 0; (elastic = schema_elastic(i)).key; ++i)
    if (strlen(elastic.key) == length && !strncmp(elastic.key, key, length)) return elastic.unit;
  for (const Law *const *law = laws; *law; ++law)
    for (const LawParameter *p = (*law)->parameters; p && p->name; ++p)
      if (strlen(p->name) == length && !strncmp(p->name, key, length)) return p->unit;
  return NULL;
}

/* Behind the step at `path`: after its dot, or at the end. */
static const char *next_step(const char *path)
{
  path += strcspn(path, ".");
  return *path ? path + 1 : path;
}

const char *schema_unit(const char *path)
{
  const SchemaTable *table = &schema_case;
  while (table && *path) {
    const size_t length = strcspn(path, ".[");
    SchemaEntry e;
    PetscInt i = 0;
    while ((e = schema_entry(table, i)).key && (strlen(e.key) != length || strncmp(e.key, path, length))) ++i;
    if (!e.key) return table->open == SchemaOpenMaterial ? unit_of_constant(path, length) : NULL;
    path = next_step(path);
    if (e.type == TYPE_NAMED) path = next_step(path); /* whose it is */
    if (e.type != TYPE_TABLE && e.type != TYPE_LIST && e.type != TYPE_NAMED) return e.unit;
    table = e.table;
  }
  return NULL;
}
