/* The reference: valid JSON that names every table, and docs/case-file.md as the program prints
 * it. */
#include <libfyaml.h>
#include "test_case.h"

static char *Print(SchemaStyle style)
{
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(SchemaPrint(out, style), 0);
  fclose(out);
  return text;
}

static const char *At(struct fy_document *json, const char *path)
{
  struct fy_node *node = fy_node_by_path(fy_document_root(json), path, (size_t)-1, FYNWF_DONT_FOLLOW);
  return node ? fy_node_get_scalar0(node) : NULL;
}

static void Json(void **state)
{
  const struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_FORCE};
  char *text = Print(SCHEMA_JSON);
  struct fy_document *json = fy_document_build_from_string(&config, text, strlen(text));
  (void)state;
  assert_non_null(json);
  assert_string_equal(At(json, "/$schema"), "https://json-schema.org/draft/2020-12/schema");
  assert_string_equal(At(json, "/$ref"), "#/$defs/case");
  assert_string_equal(At(json, "/$defs/case/properties/grid/$ref"), "#/$defs/grid");
  assert_string_equal(At(json, "/$defs/case/properties/bodies/items/$ref"), "#/$defs/body");
  assert_string_equal(At(json, "/$defs/shape/properties/union/items/$ref"), "#/$defs/shape");
  assert_string_equal(At(json, "/$defs/newton/properties/max_iterations/type"), "integer");
  assert_string_equal(At(json, "/$defs/material/properties/density/exclusiveMinimum"), "0");
  assert_string_equal(At(json, "/$defs/newton/additionalProperties"), "false");
  fy_document_destroy(json);
  free(text);
}

/* Every reference inside the schema points to a definition that is there. */
static void References(void **state)
{
  const struct fy_parse_cfg config = {.flags = FYPCF_QUIET | FYPCF_JSON_FORCE};
  char *text = Print(SCHEMA_JSON), path[200];
  struct fy_document *json = fy_document_build_from_string(&config, text, strlen(text));
  int n = 0;
  (void)state;
  assert_non_null(json);
  for (const char *p = text; (p = strstr(p, "\"$ref\": \"#")); ++n) {
    p += strlen("\"$ref\": \"#");
    snprintf(path, sizeof(path), "%.*s/type", (int)strcspn(p, "\""), p);
    if (!At(json, path)) fail_msg("nothing at %s", path);
  }
  assert_true(n > 15);
  fy_document_destroy(json);
  free(text);
}

static void Text(void **state)
{
  char *text = Print(SCHEMA_TEXT);
  (void)state;
  assert_non_null(strstr(text, "density [kg/m3]"));
  assert_non_null(strstr(text, "step / 1024"));
  assert_non_null(strstr(text, "law neo-hookean"));
  free(text);
}

/* Run `talus schema --markdown > docs/case-file.md` after a change of the tables. */
static void Committed(void **state)
{
  char *text = Print(SCHEMA_MARKDOWN), *file;
  FILE *in = fopen(TALUS_SOURCE_DIR "/docs/case-file.md", "rb");
  const size_t size = strlen(text);
  (void)state;
  assert_non_null(in);
  file = calloc(size + 2, 1);
  assert_int_equal(fread(file, 1, size + 1, in), size);
  assert_string_equal(file, text);
  fclose(in);
  free(file);
  free(text);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Json), cmocka_unit_test(References), cmocka_unit_test(Text),
                                     cmocka_unit_test(Committed)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
