/* A key with nothing behind it is a mistake, whichever it is: every key of the cases that come with
 * talus, one after the other. */
#include "test_case.h"
#include <glob.h>
#include "input/yaml/yaml.h"

/* What may be empty: a text is then none, and an option of PETSc needs no value. */
static PetscBool may_be_empty(const YamlNode *node)
{
  const YamlNode *in = node->parent;
  return !strcmp(node->key, "title") || (in && in->key && !strcmp(in->key, "petsc"));
}

static Case *read_with(const char *file, const char *set, char **said)
{
  size_t length;
  Diag *diag;
  Case *c;
  assert_int_equal(DiagCreate(&diag), 0);
  assert_int_equal(CaseRead(PETSC_COMM_SELF, file, 1, &set, diag, &c), 0);
  FILE *out = open_memstream(said, &length);
  assert_int_equal(DiagFlush(diag, out), 0);
  fclose(out);
  assert_int_equal(DiagDestroy(&diag), 0);
  return c;
}

#define MOST 4000
static Names seen; /* paths without their indices */
static char *kept[MOST];
static int n_emptied;

static PetscBool is_new(const YamlNode *node)
{
  char path[512], *to = path;
  for (const char *from = yaml_path(node, path, sizeof path); *from; ++from)
    if (!strchr("[]0123456789", *from)) *to++ = *from;
  *to = '\0';
  if (names_find(&seen, path) >= 0) return PETSC_FALSE;
  assert_true(n_emptied < MOST);
  kept[n_emptied] = strdup(path);
  assert_int_equal(NamesSet(&seen, kept[n_emptied], n_emptied), 0);
  ++n_emptied;
  return PETSC_TRUE;
}

static void empty(const char *file, const YamlNode *node)
{
  char path[512], set[600], name[300], *said;
  snprintf(set, sizeof set, "%s=", yaml_path(node, path, sizeof path));
  snprintf(name, sizeof name, "%s must be ", node->key);
  Case *c = read_with(file, set, &said);
  const char *told = strstr(said, name);
  if (c || !told || !strstr(told, "not empty"))
    fail_msg("%s: %s is%s told of:\n%s", file, set, c ? " not" : " wrongly", said);
  free(said);
}

static void empty_all(const char *file, const YamlNode *node)
{
  if (node->key && !may_be_empty(node) && is_new(node)) empty(file, node);
  for (PetscInt i = 0; i < node->n; ++i) empty_all(file, node->child[i]);
}

static void every_key(void **state)
{
  glob_t cases;
  (void)state;
  assert_int_equal(glob(TALUS_SOURCE_DIR "/cases/*/case.yaml", 0, NULL, &cases), 0);
  for (size_t k = 0; k < cases.gl_pathc; ++k) {
    const char *file = cases.gl_pathv[k];
    char *bytes, reason[256];
    YamlDocument *document;
    size_t size;
    Diag *diag;
    assert_int_equal(FileReadEverywhere(PETSC_COMM_SELF, file, &size, &bytes, reason), 0);
    assert_int_equal(DiagCreate(&diag), 0);
    assert_int_equal(YamlCreate(file, bytes, size, diag, &document), 0);
    empty_all(file, document->root);
    assert_int_equal(YamlDestroy(&document), 0);
    assert_int_equal(DiagDestroy(&diag), 0);
    assert_int_equal(PetscFree(bytes), 0);
  }
  globfree(&cases);
  print_message("%d keys\n", n_emptied);
  assert_true(n_emptied > 500);
  assert_int_equal(NamesFree(&seen), 0);
  for (int k = 0; k < n_emptied; ++k) free(kept[k]);
}

/* {} says that a thing is there, with its defaults. */
static void braces(void **state)
{
  Case *c = read_good(PLAIN "basis: {gimp: {}}\nloads: {}\nnewton: {}\nboundary: [{on: {}, fix: [x]}]\nwalls: []\n");
  (void)state;
  assert_int_equal(CaseDestroy(&c), 0);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_key), cmocka_unit_test(braces)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
