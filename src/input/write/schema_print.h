/* Shared by the printers of the reference: all tables that the top one reaches, each once, in the
 * order they are met. */
#pragma once
#include "input/schema/schema.h"

#define SCHEMA_MAX_TABLES 64

typedef struct {
  PetscInt n;
  const SchemaTable *table[SCHEMA_MAX_TABLES];
} SchemaTables;

void schema_collect(SchemaTables *all);
/* The default as a reader wants it: "0.25", "step / 1024", "required"; empty if there is none. */
const char *schema_default(const SchemaEntry *entry, char *buffer, size_t size);
PetscErrorCode SchemaPrintJson(FILE *out);
