/* Scripts of Gmsh that act are refused with their place; those that only draw and mesh pass,
 * whatever their texts and comments say. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cmocka.h>
#include "grid/gmsh/geo_check.h"

static char folder[64];

static void put(const char *name, const char *text, size_t n)
{
  char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *out = fopen(path, "w");
  assert_non_null(out);
  assert_int_equal(fwrite(text, 1, n, out), n);
  assert_int_equal(fclose(out), 0);
}

static void put_text(const char *name, const char *text) { put(name, text, strlen(text)); }

/* What is said of a.geo, to be freed; "" if nothing. Names of files stand without the folder. */
static char *judge(PetscBool *safe)
{
  char path[128], *text = NULL, *at;
  size_t size;
  Diag *diag;
  assert_int_equal(DiagCreate(&diag), 0);
  snprintf(path, sizeof path, "%s/a.geo", folder);
  assert_int_equal(GeoCheck(path, diag, safe), 0);
  assert_int_equal(diag_errors(diag), *safe ? 0 : 1);
  FILE *out = open_memstream(&text, &size);
  assert_int_equal(DiagFlush(diag, out), 0);
  assert_int_equal(fclose(out), 0);
  assert_int_equal(DiagDestroy(&diag), 0);
  while ((at = strstr(text, folder))) memmove(at, at + strlen(folder) + 1, strlen(at + strlen(folder) + 1) + 1);
  return text;
}

static void refused(const char *script, const char *said)
{
  PetscBool safe;
  put_text("a.geo", script);
  char *text = judge(&safe);
  if (safe) fail_msg("not refused: %s", script);
  if (!strstr(text, said)) fail_msg("no '%s' in: %s", said, text);
  free(text);
}

static void passes(const char *script)
{
  PetscBool safe;
  put_text("a.geo", script);
  char *text = judge(&safe);
  if (!safe) fail_msg("refused: %s\n%s", script, text);
  free(text);
}

#define BRANCH "If (h > 1)\n  n = 2;\nEndIf\n"

static void ActionsAreRefused(void **state)
{
  static const char *const scripts[][2] = {
    {"SystemCall \"touch x\";\n",
     "a.geo:1:1: error: this runs a program: a mesh script may do so only if you trust it\n  SystemCall \"touch x\";\n "
     " ^~~~~~~~~~\n  hint: look at it; if you know what it does, --trust"},
    {"h = 1;\n\tNonBlockingSystemCall 'x';\n", "a.geo:2:2: error: this runs a program"},
    {"System\n\n \"x\";\n", "a.geo:1:1: error: this runs a program"},
    {"System /* a */ // b\n 'x';\n", "a.geo:1:1: error: this runs a program"},
    {"SystemCall StrCat(\"touch \", \"x\");\n", "runs a program"},
    {"Point(1) = {0, 0, 0}; SystemCall Sprintf(\"x\");\n", "a.geo:1:23: error"},
    {"For i In {0:2}\n  SystemCall Sprintf(\"touch %g\", i);\nEndFor\n", "a.geo:2:3: error"},
    {"Macro act\n SystemCall \"x\";\nReturn\nCall act;\n", "a.geo:2:2: error"},
    {"OnelabRun(\"a\", \"b\");\n", "runs a program"},
    {"OnelabRun \"a\";\n", "runs a program"},
    {"Field[1] = ExternalProcess;\nField[1].CommandLine = \"x\";\n", "a.geo:1:12: error: this runs a program"},
    {"S2N[StrCat(\"System\", \"Call\")] \"x\";\n", "a.geo:1:1: error: this makes a command of a text"},
    {"StringToName [Str(\"SystemCall\")] \"x\";\n", "makes a command of a text"},
    {"SetString(\"a\", \"b\");\n", "sets options by a text"},
    {"Save \"x.msh\";\n", "a.geo:1:1: error: this writes a file"},
    {"Save View[0] \"x.pos\";\n", "writes a file"},
    {"SendToServer View[0] \"x\";\n", "sends data away"},
    {"Print \"x.png\";\n", "writes a file"},
    {"CreateDir \"x\";\n", "makes a folder"},
    {"Printf(\"a\") > \"x\";\n", "a.geo:1:13: error: this writes into a file"},
    {"Printf(\"a %g (\", 1) >> \"x\";\n", "writes into a file"},
    {"Printf(\"a\", (1 + 2)) /* > */ > Sprintf(\"x\");\n", "writes into a file"},
    {"n = \"x\";\nPrintf(\"a\")\n  > n;\n", "a.geo:3:3: error: this writes into a file"},
    {BRANCH "Printf(\"a\") > n;\n", "writes into a file"},
    {"General.TmpFileName = \"thesis\";\n", "a.geo:1:9: error: this names a file that Gmsh removes"},
    {"General . ErrorFileName = \"x\";\n", "writes"},
    {"General.SaveOptions = 1;\n", "write its options"},
    {"Solver.Executable0 = \"x\";\n", "sets up programs"},
    {"Print.ParameterCommand = \"x\";\n", "makes commands of a text"},
    {"Plugin(Bubbles).OutputFile = \"x\";\nPlugin(Bubbles).Run;\n",
     "a.geo:1:1: error: this is a plugin that may write files"},
    {"1SystemCall \"x\";\n", "runs a program"},
    /* where Gmsh loses its place */
    {"If (0)\n a = \"x\"; E\" EndIf; SystemCall 'touch x'; \"\nEndIf\n", "a.geo:2:21: error: this runs a program"},
    {BRANCH "// SystemCall \"x\";\n", "a.geo:4:4: error: this runs a program"},
    {BRANCH "a = \"; XSystemCall 'x'; \";\n", "runs a program"},
    {BRANCH "a = \"; Printf('a') > 'x'; \";\n", "writes into a file"},
    {"a = \"SystemCall 'touch x';\"", "runs a program"},
    {"h = 1;\n\"a;SSystemCall 'touch x'; ", "a.geo:2:4: error: this runs a program"}};
  (void)state;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(scripts); ++i) refused(scripts[i][0], scripts[i][1]);
}

static void TextsThatGmshWouldCutAreRefused(void **state)
{
  char script[2048];
  (void)state;
  memset(script, 'x', sizeof script);
  memcpy(script, "a = \"", 5);
  strcpy(script + 1100, "SystemCall 'touch x';\";\n");
  refused(script, "a.geo:1:5: error: this begins a text of more than 1000 characters");
  put("a.geo", "h = \"\0SystemCall 'x';\";\n", 24);
  PetscBool safe;
  char *text = judge(&safe);
  assert_false(safe);
  assert_non_null(strstr(text, "a.geo:1:6: error: this is a byte that no text holds"));
  free(text);
}

static void WhatOnlyDrawsPasses(void **state)
{
  static const char *const scripts[] = {
    "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 1, 1};\nPhysical Surface(\"soil\") = {1};\n",
    "// SystemCall \"x\";\n/* Save \"x\"; Include StrCat(\"a\", \"b\"); */\nh = 1; // Print \"it\";\n",
    "Physical Surface(\"SystemCall\") = {1};\nPhysical Curve(\"Save\") = {1};\nPrintf(\"SystemCall 'x';\");\n",
    "Physical Surface(\"Save\") = {1};",
    BRANCH
    "// Save the mesh, print it, include the footing. Merge (if there is one). Don't\nPrintf(\"Save it; System = %g\", "
    "1);\n",
    BRANCH "Physical Surface(\"Include\") = {1}; Physical Curve(\"Print\") = {1};\n",
    "If (a > b)\n  c = Sqrt(2) > 1 ? 3 : 4;\nEndIf\nFor i In {1 : 3}\n  If ((i) >= (2))\n  EndIf\nEndFor\n",
    "Print.Background = 1; General.Terminal = 1; Mesh.ElementOrder = 1; Mesh.SaveAll = 1;\nSystem = 3; Save = System + "
    "1;\n",
    "Field[1] = Box;\nField[1].VIn = 0.1;\nField[2] = Structured;\nField[2].FileName = \"x.dat\";\nBackground Field = "
    "1;\n",
    "Plugin(Crack).Dimension = 1;\nPlugin(Crack).Run;\nPlugin(AnalyseMeshQuality).Run;\n",
    "DefineConstant[ h = {0.1, Name \"Parameters/h\", Min 0.01} ];\nMerge \"drawing.step\";\nv() = "
    "ShapeFromFile(\"a.brep\");\n",
    ""};
  (void)state;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(scripts); ++i) passes(scripts[i]);
}

static void WhatIsReadInIsLookedThrough(void **state)
{
  char path[128];
  (void)state;
  snprintf(path, sizeof path, "%s/sub", folder);
  assert_int_equal(mkdir(path, 0700), 0);
  put_text("sub/b.geo", "h = 1;\nInclude \"c.geo\";\n");
  put_text("sub/c.geo", "k = 1;\n SystemCall \"x\";\n");
  refused("Include \"sub/b.geo\";\n", "sub/c.geo:2:2: error: this runs a program");
  refused("Merge 'sub/b.geo';\n", "sub/c.geo:2:2: error");
  refused("MergeWithBoundingBox \"sub/c.geo\";\n", "sub/c.geo:2:2: error");
  refused(BRANCH "// Include \"sub/c.geo\";\n", "sub/c.geo:2:2: error");
  passes("// Include \"sub/c.geo\";\n");
  /* in circles */
  put_text("sub/c.geo", "Include \"../a.geo\"; Include \"b.geo\"; Include \"c.geo\";\n");
  passes("Include \"sub/b.geo\";\n");
  passes(BRANCH "// Include \"not-there.geo\";\n");
  refused("Include \"not-there.geo\";\n",
          "a.geo:1:1: error: this reads 'not-there.geo', which cannot be read (No such file");
  refused("Include StrCat(\"sub/\", \"c.geo\");\n", "a.geo:1:1: error: this reads a file whose name is put together");
  refused("f = \"sub/c.geo\";\nInclude f;\n", "whose name is put together");
  refused("Include \"sub/b\" , \"x\";\n", "whose name is put together");
  refused("Merge \"x.py\";\n", "neither a script nor a drawing");
  refused("Merge \"x.geo.gz\";\n", "neither a script nor a drawing");
  refused("Merge \"x.Step\";\n", "neither a script nor a drawing");
  put_text("m.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
  passes("Merge \"m.msh\";\n");
  put_text("m.msh", "$Mesh; SystemCall \"x\";\n");
  refused("Merge \"m.msh\";\n", "m.msh:1:8: error: this runs a program");
  put_text("m.msh", "$MeshFormat; SystemCall \"x\";\n");
  refused("Include \"m.msh\";\n", "m.msh:1:14: error: this runs a program");
  snprintf(path, sizeof path, "%s/pipe.geo", folder);
  assert_int_equal(mkfifo(path, 0600), 0);
  refused("Include \"pipe.geo\";\n", "not a plain file");
  refused("Include \"sub\";\n", "not a plain file");
}

/* Gmsh reads a.geo.opt by itself after a.geo. */
static void OptionsBesideAreLookedThrough(void **state)
{
  char path[128];
  (void)state;
  put_text("a.geo.opt", "Mesh.Algorithm = 6;\n");
  passes("h = 1;\n");
  put_text("a.geo.opt", "Mesh.Algorithm = 6;\nSystemCall \"x\";\n");
  refused("h = 1;\n", "a.geo.opt:2:1: error: this runs a program");
  snprintf(path, sizeof path, "%s/a.geo.opt", folder);
  assert_int_equal(unlink(path), 0);
}

static int make_folder(void **state)
{
  (void)state;
  strcpy(folder, "/tmp/talus-geo-XXXXXX");
  return mkdtemp(folder) ? 0 : 1;
}

static int remove_folder(void **state)
{
  char command[128];
  (void)state;
  snprintf(command, sizeof command, "rm -r '%s'", folder);
  return system(command);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(ActionsAreRefused), cmocka_unit_test(TextsThatGmshWouldCutAreRefused),
    cmocka_unit_test(WhatOnlyDrawsPasses), cmocka_unit_test(WhatIsReadInIsLookedThrough),
    cmocka_unit_test(OptionsBesideAreLookedThrough)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, make_folder, remove_folder);
  return PetscFinalize() || failed;
}
