/* Does anything in a .geo listen to the numbers that a case hands to it? gmsh itself takes any name
 * without a word. */
#include <ctype.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include "grid/gmsh/msh.h"

#define MAX_NAMES 64
#define MAX_DEPTH 8 /* of files that include each other */

/* What is known of the names in some files. */
typedef struct {
  const char *wanted;
  PetscBool found, lost; /* lost: a file gives it another value, whatever it was given */
  PetscInt n;            /* names that the files let others choose */
  char names[MAX_NAMES][64];
  GeoFile *each; /* told of every file that is there; NULL: names are looked for */
  void *context;
} Search;

static PetscBool is_name(int c) { return isalnum(c) || c == '_'; }

/* Comments and texts become blanks; the text of `Include "file"` is looked at before. */
static void blank_comments(char *text)
{
  for (char *p = text; *p;) {
    char *end = p;
    if (!strncmp(p, "//", 2)) end = p + strcspn(p, "\n");
    else if (!strncmp(p, "/*", 2)) end = strstr(p, "*/") ? strstr(p, "*/") + 2 : p + strlen(p);
    else if (*p == '"') end = strchr(p + 1, '"') ? strchr(p + 1, '"') + 1 : p + strlen(p);
    if (end == p) ++p;
    while (p < end) *p++ = ' ';
  }
}

static void note(Search *s, const char *name, size_t length)
{
  if (s->n == MAX_NAMES || length >= sizeof s->names[0]) return;
  for (PetscInt i = 0; i < s->n; ++i)
    if (strlen(s->names[i]) == length && !strncmp(s->names[i], name, length)) return;
  snprintf(s->names[s->n++], sizeof s->names[0], "%.*s", (int)length, name);
}

/* Names before the `=` of DefineConstant[ a = 1, b = {2, Min 0} ], at p, behind that word. */
static void note_constants(Search *s, const char *p)
{
  int depth = 0;
  PetscBool first = PETSC_TRUE; /* is a name due? */
  for (p += strspn(p, " \t\r\n"); *p && *p != ';'; ++p) {
    depth += (*p == '{' || *p == '[') - (*p == '}' || *p == ']');
    if (*p == ',' && depth == 1) first = PETSC_TRUE;
    if (!first || depth != 1 || !is_name((unsigned char)*p)) continue;
    size_t length = 1;
    while (is_name((unsigned char)p[length])) ++length;
    note(s, p, length);
    p += length - 1;
    first = PETSC_FALSE;
  }
}

static PetscBool is_wanted(const Search *s, const char *p, size_t length)
{
  return (PetscBool)(length == strlen(s->wanted) && !strncmp(p, s->wanted, length));
}

/* `b = 2;` where `b` stands, behind another statement, and not b = 2 * b; */
static PetscBool is_set(const Search *s, const char *p)
{
  const char *value = p + strlen(s->wanted) + strspn(p + strlen(s->wanted), " \t\r\n");
  if (*value != '=' || value[1] == '=') return PETSC_FALSE;
  for (++value; *value && *value != ';';) {
    size_t length = 0;
    while (is_name((unsigned char)value[length])) ++length;
    if (is_wanted(s, value, length)) return PETSC_FALSE;
    value += length ? length : 1;
  }
  return PETSC_TRUE;
}

static void look_at_words(Search *s, const char *text)
{
  static const char define[] = "DefineConstant";
  char before = ';'; /* what stands before the word; behind If (!Exists(b)) a bracket */
  for (const char *p = text; *p;) {
    size_t length = 0;
    while (is_name((unsigned char)p[length])) ++length;
    if (is_wanted(s, p, length)) s->found = PETSC_TRUE;
    if (is_wanted(s, p, length) && before == ';' && is_set(s, p)) s->lost = PETSC_TRUE;
    if (!isspace((unsigned char)*p)) before = p[length ? length - 1 : 0];
    if (length == strlen(define) && !strncmp(p, define, length)) note_constants(s, p + length);
    p += length ? length : 1;
  }
}

static char *read_text(const char *file)
{
  struct stat info;
  FILE *in = !stat(file, &info) && S_ISREG(info.st_mode) && info.st_size < (64 << 20) ? fopen(file, "rb") : NULL;
  char *text = in ? malloc((size_t)info.st_size + 1) : NULL;
  if (!in) return NULL;
  if (text) text[fread(text, 1, (size_t)info.st_size, in)] = 0;
  fclose(in);
  return text;
}

static void look_into(Search *s, const char *file, int depth);

/* Every `Include "other.geo"` (word: Include), beside the file that says so. */
static void look_into_included(Search *s, const char *file, const char *text, const char *word, int depth)
{
  const char *slash = strrchr(file, '/');
  for (const char *p = strstr(text, word); p; p = strstr(p + 1, word)) {
    char other[PETSC_MAX_PATH_LEN];
    const char *name = p + strlen(word), *end;
    name += strspn(name, " \t");
    if (*name != '"' || !(end = strchr(name + 1, '"'))) continue;
    snprintf(other, sizeof other, "%.*s%.*s", name[1] == '/' || !slash ? 0 : (int)(slash - file) + 1, file,
             (int)(end - name - 1), name + 1);
    look_into(s, other, depth + 1);
  }
}

static void look_into(Search *s, const char *file, int depth)
{
  char *text = depth < MAX_DEPTH ? read_text(file) : NULL;
  if (!text) return;
  if (s->each) s->each(s->context, file);
  look_into_included(s, file, text, "Include", depth);
  if (s->each) look_into_included(s, file, text, "Merge", depth);
  blank_comments(text);
  if (!s->each) look_at_words(s, text);
  free(text);
}

static PetscBool is_geo(const char *file)
{
  const size_t n = file ? strlen(file) : 0;
  return n > 4 && !strcmp(file + n - 4, ".geo");
}

static void tell(const Search *s, PetscBool any, Diag *diag)
{
  const char *words[MAX_NAMES + 1] = {NULL};
  char path[160];
  for (PetscInt i = 0; i < s->n; ++i) words[i] = s->names[i];
  PetscSNPrintf(path, sizeof path, "grid.parameters.%.120s", s->wanted);
  if (!any) diag_error(diag, path, "parameters are for a .geo; a .msh takes none");
  else {
    if (s->lost)
      diag_error(diag, path, "the .geo of the case gives '%s' a value itself: what it is told is lost", s->wanted);
    else diag_error(diag, path, "the .geo of the case has no use for a number '%s'", s->wanted);
    if (s->n && !s->lost) diag_hint_names(diag, s->wanted, words);
    else diag_hint(diag, "a .geo takes numbers by DefineConstant[ name = value ];");
  }
}

PetscErrorCode GeoCheckParameters(MPI_Comm comm, const Case *c, Diag *diag)
{
  PetscMPIInt rank;
  Search *s;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(PetscNew(&s));
  for (PetscInt k = 0; k < c->grid.n_parameters && !rank; ++k) {
    PetscBool any = is_geo(c->grid.mesh);
    *s = (Search){.wanted = c->grid.parameters[k].name};
    if (any) look_into(s, c->grid.mesh, 0);
    for (PetscInt b = 0; b < c->n_bodies; ++b) {
      any |= is_geo(c->bodies[b].mesh);
      if (is_geo(c->bodies[b].mesh)) look_into(s, c->bodies[b].mesh, 0);
    }
    if ((!s->found || s->lost) && !access(c->grid.mesh, R_OK))
      tell(s, any, diag); /* a file that is not there is told of elsewhere */
  }
  PetscCall(PetscFree(s));
  PetscFunctionReturn(0);
}

void geo_files(const char *file, GeoFile *each, void *context)
{
  Search s = {.each = each, .context = context};
  if (is_geo(file)) look_into(&s, file, 0);
}
