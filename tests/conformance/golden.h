/* Golden numbers from the JSON files of tests/golden (JSON is YAML: libfyaml reads it). */
#pragma once
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>
#include <libfyaml.h>
#include <petscsys.h>

/* To be closed with fy_document_destroy(). */
static inline struct fy_document *golden_open(const char *name)
{
  char path[PETSC_MAX_PATH_LEN];
  snprintf(path, sizeof path, "%s/tests/golden/%s", TALUS_SOURCE_DIR, name);
  struct fy_document *document = fy_document_build_from_file(NULL, path);
  if (!document) fail_msg("cannot read %s", path);
  return document;
}

/* Numbers below `node`, in the order of the file whatever their nesting; returns how many (at most
 * max are kept). */
static inline PetscInt golden_flatten(struct fy_node *node, PetscInt max, PetscReal *values)
{
  if (!node || max <= 0) return 0;
  if (fy_node_is_scalar(node)) {
    values[0] = strtod(fy_node_get_scalar0(node), NULL);
    return 1;
  }
  PetscInt n = 0;
  void *at = NULL;
  for (struct fy_node *item; (item = fy_node_sequence_iterate(node, &at));)
    n += golden_flatten(item, max - n, values + n);
  return n;
}

/* Exactly n numbers of a mapping's `key`. */
static inline void golden_numbers(struct fy_node *mapping, const char *key, PetscInt n, PetscReal *values)
{
  struct fy_node *node = fy_node_mapping_lookup_by_string(mapping, key, FY_NT);
  if (golden_flatten(node, n, values) != n) fail_msg("golden data: '%s' does not hold %d numbers", key, (int)n);
}

static inline PetscReal golden_number(struct fy_node *mapping, const char *key)
{
  PetscReal value = NAN;
  golden_numbers(mapping, key, 1, &value);
  return value;
}

static inline const char *golden_text(struct fy_node *mapping, const char *key)
{
  struct fy_node *node = fy_node_mapping_lookup_by_string(mapping, key, FY_NT);
  const char *text = node ? fy_node_get_scalar0(node) : NULL;
  if (!text) fail_msg("golden data: no '%s'", key);
  return text;
}

/* Rows i of a 3 x 3 -> Voigt xx yy zz xy yz zx. */
static inline void golden_symmetric(struct fy_node *mapping, const char *key, PetscReal s[6])
{
  PetscReal full[9];
  golden_numbers(mapping, key, 9, full);
  s[0] = full[0], s[1] = full[4], s[2] = full[8];
  s[3] = full[1], s[4] = full[5], s[5] = full[2];
}
