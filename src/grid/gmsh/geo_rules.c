/* What in a script of Gmsh acts on the system: runs programs, writes files, sends data, or makes
 * commands of texts. */
#include <string.h>
#include "grid/gmsh/geo_script.h"

typedef enum {
  RULE_COMMAND, /* Word "text"; or Word View[0] "text"; */
  RULE_CALL,    /* Word( or Word[ */
  RULE_OPTION,  /* .Word */
  RULE_OPTIONS, /* Word. */
  RULE_WORD     /* anywhere */
} RuleKind;

typedef struct {
  const char *word;
  RuleKind kind;
  const char *reason;
} Rule;

/* From the grammar of Gmsh 4.8 to 4.13 (Gmsh.y); its options with names of files are written or
 * removed when Gmsh ends. */
static const Rule rules[] = {{"SystemCall", RULE_COMMAND, "runs a program"},
                             {"NonBlockingSystemCall", RULE_COMMAND, "runs a program"},
                             {"System", RULE_COMMAND, "runs a program"},
                             {"OnelabRun", RULE_COMMAND, "runs a program"},
                             {"OnelabRun", RULE_CALL, "runs a program"},
                             {"ExternalProcess", RULE_WORD, "runs a program"},
                             {"Save", RULE_COMMAND, "writes a file"},
                             {"Print", RULE_COMMAND, "writes a file"},
                             {"CreateDir", RULE_COMMAND, "makes a folder"},
                             {"SendToServer", RULE_COMMAND, "sends data away"},
                             {"StringToName", RULE_CALL, "makes a command of a text"},
                             {"S2N", RULE_CALL, "makes a command of a text"},
                             {"SetString", RULE_CALL, "sets options by a text"},
                             {"Solver", RULE_OPTIONS, "sets up programs to be run"},
                             {"TmpFileName", RULE_OPTION, "names a file that Gmsh removes"},
                             {"ErrorFileName", RULE_OPTION, "names a file that Gmsh writes"},
                             {"OptionsFileName", RULE_OPTION, "names a file that Gmsh writes"},
                             {"SessionFileName", RULE_OPTION, "names a file that Gmsh writes"},
                             {"DefaultFileName", RULE_OPTION, "names a file that Gmsh writes"},
                             {"ExecutableFileName", RULE_OPTION, "names a program"},
                             {"TextEditor", RULE_OPTION, "names a program"},
                             {"ScriptingLanguages", RULE_OPTION, "makes Gmsh write scripts"},
                             {"WatchFilePattern", RULE_OPTION, "makes Gmsh read other files"},
                             {"BackgroundImageFileName", RULE_OPTION, "makes Gmsh read other files"},
                             {"SaveOptions", RULE_OPTION, "makes Gmsh write its options"},
                             {"SaveSession", RULE_OPTION, "makes Gmsh write its options"},
                             {"ParameterCommand", RULE_OPTION, "makes commands of a text"},
                             {NULL, RULE_WORD, NULL}};

/* Of Gmsh's plugins, those that only work on the mesh and on its views. */
static const char *const plugins[] = {"Crack", "NewView", "MathEval", "AnalyseMeshQuality", "AnalyseCurvedMesh", NULL};

static PetscBool is_doubtful(const GeoScript *s, size_t at) { return at >= s->doubtful_from; }

/* Does this word stand at [at, end)? Where Gmsh may lose its place, and behind digits, a longer
 * word may be cut. */
static PetscBool is_word(const GeoScript *s, size_t at, size_t end, const char *word)
{
  const size_t n = strlen(word);
  if (end - at < n || strncmp(s->text + end - n, word, n)) return PETSC_FALSE;
  return end - at == n || is_doubtful(s, at) || geo_is_digit(s->text[at]);
}

static PetscBool is_any(char c, const char *set) { return c && strchr(set, c); }

/* Is there a text at `at` that ends a command: "...";? In code whatever opens a text is enough. */
static PetscBool is_text(const GeoScript *s, size_t at, PetscBool code)
{
  if (!is_any(s->text[at], "\"'")) return PETSC_FALSE;
  if (code) return PETSC_TRUE;
  const size_t end = geo_quote_end(s, at);
  if (end == s->n) return PETSC_FALSE;
  size_t behind = end + 1;
  while (geo_is_space(s->text[behind])) ++behind;
  return is_any(s->text[behind], ";/");
}

/* Does what follows a word make a command of it? */
static PetscBool takes_text(const GeoScript *s, size_t end, PetscBool code)
{
  const size_t at = geo_next(s, end);
  if (is_text(s, at, code)) return PETSC_TRUE;
  if (!code && s->text[at] == '/' && is_any(s->text[at + 1], "/*")) return PETSC_TRUE;
  if (!geo_is_letter(s->text[at])) return PETSC_FALSE;
  return code || is_any(s->text[geo_next(s, geo_word_end(s, at))], "([{~");
}

static PetscBool fits(const GeoScript *s, const Rule *rule, size_t at, size_t end, PetscBool code)
{
  const char next = s->text[geo_next(s, end)];
  size_t before = at;
  switch (rule->kind) {
  case RULE_COMMAND: return takes_text(s, end, code);
  case RULE_CALL: return is_any(next, "([{");
  case RULE_OPTIONS: return is_any(next, ".");
  case RULE_OPTION:
    while (before > 0 && geo_is_space(s->text[before - 1])) --before;
    return before > 0 && s->text[before - 1] == '.';
  default: return PETSC_TRUE;
  }
}

/* Plugin(Name), where Name is not one of the harmless ones. */
static PetscBool is_plugin(const GeoScript *s, size_t at, size_t end)
{
  if (!is_word(s, at, end, "Plugin")) return PETSC_FALSE;
  size_t name = geo_next(s, end);
  if (!is_any(s->text[name], "([")) return PETSC_FALSE;
  name = geo_next(s, name + 1);
  const size_t n = geo_word_end(s, name) - name;
  for (int i = 0; plugins[i]; ++i)
    if (strlen(plugins[i]) == n && !strncmp(s->text + name, plugins[i], n)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* The word before the bracket that closes at `at` in code is Printf; so it is believed of brackets
 * too far apart. */
static PetscBool closes_printf(const GeoScript *s, size_t at)
{
  const size_t first = at > 100000 ? at - 100000 : 0;
  int depth = 0;
  do {
    if (s->kind[at] == GEO_CODE) depth += is_any(s->text[at], ")]}") - is_any(s->text[at], "([{");
  } while (depth > 0 && at-- > first);
  if (depth > 0) return first > 0;
  while (at > 0 && (geo_is_space(s->text[at - 1]) || s->kind[at - 1] == GEO_COMMENT)) --at;
  return at >= 6 && !strncmp(s->text + at - 6, "Printf", 6);
}

/* Printf("...") > "file"; */
static PetscBool writes_to_file(const GeoScript *s, size_t at)
{
  const PetscBool code = s->kind[at] == GEO_CODE;
  size_t before = at, name = at + (s->text[at + 1] == '>' ? 2 : 1);
  if (s->text[at] != '>' || s->text[at + 1] == '=') return PETSC_FALSE;
  name = geo_next(s, name);
  if (is_text(s, name, code)) return PETSC_TRUE;
  while (before > 0 && (geo_is_space(s->text[before - 1]) || (code && s->kind[before - 1] == GEO_COMMENT))) --before;
  if (before == 0 || !is_any(s->text[before - 1], ")]")) return PETSC_FALSE;
  if (code && closes_printf(s, before - 1)) return PETSC_TRUE;
  if (!is_doubtful(s, at) || !geo_is_letter(s->text[name]) || !s->prints) return PETSC_FALSE;
  return is_any(s->text[geo_next(s, geo_word_end(s, name))], ";([{~/");
}

/* What the word at [at, end) does; NULL: nothing. */
static const char *judge(const GeoScript *s, size_t at, size_t end)
{
  const PetscBool code = s->kind[at] == GEO_CODE;
  for (const Rule *rule = rules; rule->word; ++rule)
    if (is_word(s, at, end, rule->word) && fits(s, rule, at, end, code)) return rule->reason;
  return is_plugin(s, at, end) ? "is a plugin that may write files" : NULL;
}

void geo_find_action(const GeoScript *s, GeoFinding *finding)
{
  for (size_t at = 0, end; at < s->n && !finding->reason; at = end) {
    end = PetscMax(at + 1, geo_word_end(s, at));
    if (s->kind[at] != GEO_CODE && !is_doubtful(s, at)) continue;
    if (writes_to_file(s, at)) *finding = (GeoFinding){at, 1, "writes into a file"};
    else *finding = (GeoFinding){at, end - at, judge(s, at, end)};
  }
}

/* The name behind Include or Merge. */
static void read_name(const GeoScript *s, size_t end, GeoInclusion *found)
{
  const size_t at = geo_next(s, end), quote = geo_quote_end(s, at), n = quote > at ? quote - at - 1 : 0;
  const PetscBool quoted = is_any(s->text[at], "\"'");
  const PetscBool whole = quote < s->n && n > 0 && n < sizeof found->name;
  found->name[0] = 0;
  if (!quoted || (whole && s->text[geo_next(s, quote + 1)] != ';'))
    found->problem = "reads a file whose name is put together";
  else if (!whole) found->problem = "reads a file whose name makes no sense";
  else (void)snprintf(found->name, sizeof found->name, "%.*s", (int)n, s->text + at + 1);
  if (!found->problem && (strchr(found->name, '\\') || found->name[1] == ':'))
    found->problem = "reads a file whose name makes no sense";
}

PetscBool geo_next_inclusion(const GeoScript *s, size_t *at, GeoInclusion *found)
{
  static const char *const words[] = {"Include", "Merge", "MergeWithBoundingBox"};
  for (size_t end; *at < s->n; *at = end) {
    const size_t start = *at;
    const PetscBool code = s->kind[start] == GEO_CODE;
    end = PetscMax(start + 1, geo_word_end(s, start));
    if (!code && !is_doubtful(s, start)) continue;
    for (int i = 0; i < 3; ++i) {
      if (!is_word(s, start, end, words[i]) || !takes_text(s, end, code)) continue;
      *found = (GeoInclusion){.at = start, .width = end - start, .merged = i > 0, .certain = code};
      read_name(s, end, found);
      *at = end;
      return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}
