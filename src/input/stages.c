#include "input/stages.h"
#include <string.h>
#include "base/text.h"
#include "input/case_file.h"
#include "input/schema/keys/schema_keys.h"

/* Lays the words of one stage. */
typedef struct {
  YamlDocument *document;
  PetscInt stage;
  Diag *diag;
} Layer;

static const char *const not_laid[] = {"name", "reset", "release", NULL};

static PetscBool is_one_of(const char *key, const char *const *list)
{
  for (; *list; ++list)
    if (!strcmp(key, *list)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* A copy; stage -1: every node keeps its own. */
static PetscErrorCode Clone(const Layer *l, const YamlNode *node, PetscInt stage, YamlNode **copy)
{
  YamlNode *child;

  PetscFunctionBeginUser;
  PetscCall(YamlNodeCreate(l->document, node->kind, copy));
  (*copy)->plain = node->plain;
  (*copy)->place = node->place;
  (*copy)->key_place = node->key_place;
  (*copy)->argument = node->argument;
  (*copy)->stage = stage < 0 ? node->stage : stage;
  if (node->text) PetscCall(PetscStrallocpy(node->text, &(*copy)->text));
  if (node->key) PetscCall(PetscStrallocpy(node->key, &(*copy)->key));
  for (PetscInt i = 0; i < node->n; ++i) {
    PetscCall(Clone(l, node->child[i], stage, &child));
    PetscCall(YamlNodeAppend(*copy, child));
  }
  PetscFunctionReturn(0);
}

static void set_stage(YamlNode *node, PetscInt stage)
{
  node->stage = stage;
  for (PetscInt i = 0; i < node->n; ++i) set_stage(node->child[i], stage);
}

/* The stage has said it in the same words, here. */
static void set_repeated(YamlNode *node, const YamlNode *words)
{
  node->repeated = PETSC_TRUE;
  node->place = words->place;
  node->key_place = words->key_place;
  for (PetscInt i = 0; i < node->n && i < words->n; ++i) set_repeated(node->child[i], words->child[i]);
}

/* Entries of a list that stood in the one before are as old as they were there. */
static void keep_age(const YamlNode *before, YamlNode *list)
{
  for (PetscInt i = 0; i < list->n && before->kind == YAML_SEQUENCE; ++i)
    for (PetscInt k = 0; k < before->n; ++k)
      if (yaml_equal(before->child[k], list->child[i])) {
        set_stage(list->child[i], before->child[k]->stage);
        set_repeated(list->child[i], list->child[i]);
      }
}

static PetscErrorCode Replace(const Layer *l, YamlNode *node, const YamlNode *by)
{
  YamlNode *copy, *parent = node->parent;
  const PetscInt index = node->index;

  PetscFunctionBeginUser;
  PetscCall(Clone(l, by, l->stage, &copy));
  if (copy->kind == YAML_SEQUENCE) keep_age(node, copy);
  copy->parent = parent;
  copy->index = index;
  parent->child[index] = copy;
  PetscCall(YamlNodeDestroy(&node));
  PetscFunctionReturn(0);
}

static const char *name_of(const YamlNode *entry)
{
  const YamlNode *name = yaml_find(entry, "name");
  return name && name->kind == YAML_SCALAR && !yaml_is_null(name) ? name->text : NULL;
}

static PetscBool is_absent(const YamlNode *entry)
{
  const YamlNode *absent = yaml_find(entry, "absent");
  return absent && absent->text && !strcmp(absent->text, "true");
}

/* Does a stage change the list entry by entry? Those of things which are there for long: loads come and go as a whole,
 * and so does what a stage gives as an empty list. */
static PetscBool goes_by_entries(const YamlNode *list, const YamlNode *over)
{
  static const char *const lists[] = {"bodies", "boundary", "walls", "interfaces", NULL};
  if (list->kind != YAML_SEQUENCE || over->kind != YAML_SEQUENCE || !over->n) return PETSC_FALSE;
  return (PetscBool)(list->parent && !list->parent->parent && list->key && is_one_of(list->key, lists));
}

/* {name: gate, absent: true} */
static PetscBool says_presence_only(const YamlNode *entry)
{
  return entry->n == 2 && yaml_find(entry, "name") && yaml_find(entry, "absent");
}

/* An entry that can only change one that is there: of a body without its place, of a law without its name. */
static PetscBool only_changes(const YamlNode *list, const YamlNode *entry)
{
  static const char *const places[] = {"shape", "region", "mesh", NULL};
  const char *key = list->key ? list->key : "";
  if (!strcmp(key, "materials")) return !yaml_find(entry, "law");
  if (says_presence_only(entry)) return PETSC_TRUE;
  for (PetscInt i = 0; i < entry->n && !strcmp(key, "bodies"); ++i)
    if (is_one_of(entry->child[i]->key, places)) return PETSC_FALSE;
  return !strcmp(key, "bodies");
}

static PetscErrorCode TellMissing(const Layer *l, const YamlNode *list, const YamlNode *entry, const char *name)
{
  const char **names;
  char path[512];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(list->n + 1, &names));
  for (PetscInt i = 0, n = 0; i < list->n; ++i) {
    const YamlNode *child = list->child[i];
    PetscCheck(child, PETSC_COMM_SELF, PETSC_ERR_PLIB, "a list without an entry");
    const char *other = list->kind == YAML_MAPPING ? child->key : name_of(child);
    if (other) names[n++] = other;
  }
  yaml_error(l->document, l->diag, entry, PETSC_TRUE, "there is no '%s' in %s that the stage could change", name,
             yaml_path(list, path, sizeof path));
  diag_hint_names(l->diag, name, names);
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

/* tip: {absent: true} */
static PetscBool drops(const YamlNode *list, const YamlNode *entry)
{
  return list->key && !strcmp(list->key, "measures") && entry->n == 1 && is_absent(entry);
}

static PetscErrorCode Lay(const Layer *l, YamlNode *under, const YamlNode *over);

static PetscErrorCode LayKeys(const Layer *l, YamlNode *under, const YamlNode *over, const char *const *without)
{
  YamlNode *copy;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < over->n; ++i) {
    const YamlNode *child = over->child[i];
    YamlNode *was = yaml_find(under, child->key);
    if (without && is_one_of(child->key, without)) continue;
    if (l->diag && drops(under, child)) {
      if (was) PetscCall(YamlNodeRemove(under, was->index));
      else PetscCall(TellMissing(l, under, child, child->key));
    } else if (was) PetscCall(Lay(l, was, child));
    else if (l->diag && child->kind == YAML_MAPPING && under->key && !strcmp(under->key, "materials") &&
             only_changes(under, child))
      PetscCall(TellMissing(l, under, child, child->key));
    else {
      PetscCall(Clone(l, child, l->stage, &copy));
      PetscCall(YamlNodeAppend(under, copy));
    }
  }
  PetscFunctionReturn(0);
}

/* The entry of a list that the other one changes: of its name, or the same; NULL: it is a new one. */
static YamlNode *find_entry(const YamlNode *list, const YamlNode *entry)
{
  const char *name = name_of(entry);
  for (PetscInt i = 0; i < list->n; ++i) {
    const char *other = name_of(list->child[i]);
    if (name ? other && !strcmp(name, other) : yaml_equal(list->child[i], entry)) return list->child[i];
  }
  return NULL;
}

/* Of two entries of a name in one list the second would take the place of the first. */
static void check_names(const Layer *l, const YamlNode *list)
{
  char path[512];
  for (PetscInt i = 1; i < list->n && l->diag; ++i)
    for (PetscInt k = 0; k < i; ++k) {
      const char *name = name_of(list->child[i]), *other = name_of(list->child[k]);
      if (!name || !other || strcmp(name, other)) continue;
      yaml_error(l->document, l->diag, yaml_find(list->child[i], "name"), PETSC_TRUE, "the name '%s' is taken by %s",
                 name, yaml_path(list->child[k], path, sizeof path));
      break;
    }
}

/* Of a body that is there only its material can change: with all else it has begun. */
static void check_begun(const Layer *l, const YamlNode *was, const YamlNode *entry)
{
  static const char *const changes[] = {"name", "material", "absent", NULL};
  for (PetscInt i = 0; i < entry->n; ++i) {
    const YamlNode *child = entry->child[i], *other = yaml_find(was, child->key);
    if (is_one_of(child->key, changes) || (other && yaml_equal(other, child))) continue;
    yaml_error(l->document, l->diag, child, PETSC_TRUE, "'%s' is there already, and its `%s` is what it began with",
               name_of(was), child->key);
    diag_hint(l->diag,
              "of a body that is there a stage changes `material`, or says `absent: true`; all else is of bodies "
              "that come");
  }
}

/* What comes begins with the stage that brings it, whatever named it before: its times count from there. */
static PetscErrorCode LayOnEntry(const Layer *l, YamlNode *was, const YamlNode *entry)
{
  const PetscBool comes = is_absent(was);

  PetscFunctionBeginUser;
  PetscCall(LayKeys(l, was, entry, NULL));
  if (comes && !is_absent(was)) set_stage(was, l->stage);
  PetscFunctionReturn(0);
}

/* What stands there in the same words is as old as it was, unless it comes only now; -1: in other words. */
static PetscInt age_of(const YamlNode *was, const YamlNode *entry, const char *key)
{
  const YamlNode *before = yaml_find(was, key), *now = yaml_find(entry, key);
  return before && now && !is_absent(was) && yaml_equal(before, now) ? before->stage : -1;
}

/* A wall that rubs in another way has been drawn where it was, and the load of its mass goes on. */
static PetscErrorCode ReplaceEntry(const Layer *l, YamlNode *was, const YamlNode *entry)
{
  static const char *const kept[] = {"shape", "mass"};
  const YamlNode *list = was->parent;
  const PetscInt index = was->index, age[] = {age_of(was, entry, kept[0]), age_of(was, entry, kept[1])};

  PetscFunctionBeginUser;
  PetscCall(Replace(l, was, entry));
  for (int k = 0; k < 2; ++k) {
    YamlNode *node = age[k] < 0 ? NULL : yaml_find(list->child[index], kept[k]);
    if (node) set_stage(node, age[k]);
    if (node) set_repeated(node, node);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode LayEntries(const Layer *l, YamlNode *list, const YamlNode *over)
{
  const PetscBool by_keys = list->key && !strcmp(list->key, "bodies");
  YamlNode *copy;

  PetscFunctionBeginUser;
  check_names(l, over);
  for (PetscInt i = 0; i < over->n; ++i) {
    const YamlNode *entry = over->child[i];
    YamlNode *was = find_entry(list, entry);
    if (!was && name_of(entry) && only_changes(list, entry)) PetscCall(TellMissing(l, list, entry, name_of(entry)));
    else if (!was) {
      PetscCall(Clone(l, entry, l->stage, &copy));
      PetscCall(YamlNodeAppend(list, copy));
    } else if (yaml_equal(was, entry)) set_repeated(was, entry);
    else if (by_keys || says_presence_only(entry)) {
      if (by_keys && l->stage > 0 && !is_absent(was) && !is_absent(entry)) check_begun(l, was, entry);
      PetscCall(LayOnEntry(l, was, entry));
    } else PetscCall(ReplaceEntry(l, was, entry));
  }
  PetscFunctionReturn(0);
}

/* What says by itself what it is. */
static PetscBool stands_alone(const YamlNode *over)
{
  const char *in = over->parent && over->parent->key ? over->parent->key : "";
  return yaml_find(over, "law") || yaml_find(over, "type") || (over->key && !strcmp(over->key, "strength")) ||
         !strcmp(in, "measures");
}

static PetscErrorCode Lay(const Layer *l, YamlNode *under, const YamlNode *over)
{
  const PetscBool mappings = under->kind == YAML_MAPPING && over->kind == YAML_MAPPING;

  PetscFunctionBeginUser;
  if (yaml_equal(under, over)) set_repeated(under, over);
  else if (mappings && !stands_alone(over)) PetscCall(LayKeys(l, under, over, NULL));
  else if (goes_by_entries(under, over)) PetscCall(LayEntries(l, under, over));
  else PetscCall(Replace(l, under, over));
  PetscFunctionReturn(0);
}

/* The file without its list of stages. */
static PetscErrorCode Bare(const Layer *l, const YamlNode *root, YamlNode **bare)
{
  static const char *const left_out[] = {"stages", NULL};
  const YamlNode empty = {.kind = YAML_MAPPING, .plain = root->plain, .place = root->place};

  PetscFunctionBeginUser;
  PetscCall(Clone(l, &empty, 0, bare));
  PetscCall(LayKeys(&(Layer){.document = l->document}, *bare, root, left_out));
  PetscFunctionReturn(0);
}

PetscErrorCode StageLay(YamlDocument *document, PetscInt k, Diag *diag)
{
  const YamlNode *stages = yaml_find(document->root, "stages");
  const Layer l = {.document = document, .stage = k, .diag = diag};

  PetscFunctionBeginUser;
  if (k == 0) {
    PetscCall(PetscCalloc1(stages->n, &document->stage));
    PetscCall(Bare(&l, document->root, document->stage));
  } else PetscCall(Clone(&l, document->stage[k - 1], -1, document->stage + k));
  document->n_stages = k + 1;
  PetscCall(LayKeys(&l, document->stage[k], stages->child[k], not_laid));
  if (document->n_nodes > YAML_MAX_NODES)
    yaml_error(document, diag, stages->child[k], PETSC_FALSE, "so many stages of a file as large as this are too much");
  PetscFunctionReturn(0);
}

/* The lines of a key at the top of a resolved case; *length 0: it is not there. */
static const char *find_section(const char *text, const char *key, size_t *length)
{
  const size_t n = strlen(key);
  const char *begin = NULL, *line = text;
  *length = 0;
  for (; *line; line += strcspn(line, "\n"), line += *line == '\n') {
    if (*line == ' ') continue;
    if (begin) break;
    if (!strncmp(line, key, n) && line[n] == ':') begin = line;
  }
  if (begin) *length = (size_t)(line - begin);
  return begin;
}

/* Measures that the stage before had, and this one has not. */
static void write_dropped(FILE *out, const Case *before, const Case *stage, PetscBool *head)
{
  for (PetscInt k = 0; k < before->n_measures; ++k) {
    if (case_measure_of(stage, before->measures[k].name) >= 0) continue;
    fputs(*head ? "" : "measures:\n", out);
    *head = PETSC_TRUE;
    fputs("  ", out);
    schema_write_text(out, before->measures[k].name);
    fputs(": {absent: true}\n", out);
  }
}

PetscErrorCode StageText(const Case *before, const Case *stage, char **text)
{
  TextStream stream;
  char *was, *is;

  PetscFunctionBeginUser;
  PetscCall(CaseToYaml(before, &was));
  PetscCall(CaseToYaml(stage, &is));
  PetscCall(TextOpen(&stream));
  for (const SchemaEntry *e = schema_stage.entries; e->key; ++e) {
    size_t n, m;
    if (e->type != TYPE_PART) continue;
    const char *now = find_section(is, e->key, &n), *then = find_section(was, e->key, &m);
    PetscBool head = n && (n != m || strncmp(now, then, n));
    if (head) fwrite(now, 1, n, stream.out);
    if (!strcmp(e->key, "measures")) write_dropped(stream.out, before, stage, &head);
  }
  PetscCall(TextClose(&stream, text));
  PetscCall(PetscFree(was));
  PetscCall(PetscFree(is));
  PetscFunctionReturn(0);
}
