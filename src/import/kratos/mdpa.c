#include "import/kratos/mdpa.h"
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include "base/file.h"

#define MDPA_MOST_ID 20000000 /* a table of ids is as long as the largest */
#define MDPA_DEEPEST 16       /* parts within parts */

/* Words of the text, one after the other; comments are none. */
typedef struct {
  const char *at;
  int line;
  char word[256];
  Diag *diag;
  Mdpa *model;
  PetscBool bad; /* a mistake has been told: the rest is not read */
} Reader;

static void complain(Reader *r, const char *what)
{
  const DiagPlace place = {.file = r->model->file, .line = r->line, .column = 1};
  if (!r->bad) diag_at(r->diag, DIAG_ERROR, &place, "%s, not '%s'", what, r->word[0] ? r->word : "the end of the file");
  r->bad = PETSC_TRUE;
}

/* The next word into r->word; PETSC_FALSE at the end. */
static PetscBool next(Reader *r)
{
  for (;;) {
    while (isspace((unsigned char)*r->at)) r->line += *r->at++ == '\n';
    if (strncmp(r->at, "//", 2)) break;
    r->at += strcspn(r->at, "\n");
  }
  size_t length = 0;
  while (r->at[length] && !isspace((unsigned char)r->at[length]) && strncmp(r->at + length, "//", 2)) ++length;
  snprintf(r->word, sizeof r->word, "%.*s", (int)PetscMin(length, sizeof r->word - 1), r->at);
  r->at += length;
  return length > 0 && !r->bad;
}

static PetscBool is(const Reader *r, const char *word) { return !strcmp(r->word, word); }

static PetscInt integer(Reader *r)
{
  char *end;
  const long value = strtol(r->word, &end, 10);
  if (end == r->word || *end || value < 0 || value > MDPA_MOST_ID)
    complain(r, "a number of a node or element is expected");
  return r->bad ? 0 : (PetscInt)value;
}

static PetscReal number(Reader *r)
{
  char *end;
  (void)next(r);
  const PetscReal value = strtod(r->word, &end);
  if (end == r->word || *end || PetscIsInfOrNanReal(value)) complain(r, "a coordinate is expected");
  return r->bad ? 0 : value;
}

/* Behind `End`: the rest of what began. */
static void end_block(Reader *r, const char *name)
{
  (void)next(r);
  if (!is(r, name)) complain(r, "a block ends with another name than it began with");
}

static PetscErrorCode ReadNodes(Reader *r)
{
  Mdpa *m = r->model;

  PetscFunctionBeginUser;
  while (next(r) && !is(r, "End")) {
    if (m->n_nodes == m->node_capacity) {
      m->node_capacity = PetscMax(256, 2 * m->node_capacity);
      PetscCall(PetscRealloc((size_t)m->node_capacity * sizeof(PetscInt), &m->node_id));
      PetscCall(PetscRealloc((size_t)m->node_capacity * sizeof *m->x, &m->x));
    }
    m->node_id[m->n_nodes] = integer(r);
    for (int d = 0; d < 3; ++d) m->x[m->n_nodes][d] = number(r);
    m->most = PetscMax(m->most, m->node_id[m->n_nodes]);
    ++m->n_nodes;
  }
  end_block(r, "Nodes");
  PetscCall(PetscRealloc((size_t)(m->most + 1) * sizeof(PetscInt), &m->index));
  for (PetscInt i = 0; i <= m->most; ++i) m->index[i] = -1;
  for (PetscInt i = 0; i < m->n_nodes; ++i) m->index[m->node_id[i]] = i;
  PetscFunctionReturn(0);
}

static PetscErrorCode FindOrAddType(Mdpa *m, const char *name, PetscInt *type)
{
  PetscFunctionBeginUser;
  for (*type = 0; *type < m->n_types; ++*type)
    if (!strcmp(m->types[*type], name)) PetscFunctionReturn(0);
  PetscCall(PetscRealloc((size_t)(m->n_types + 1) * sizeof(char *), &m->types));
  PetscCall(PetscStrallocpy(name, &m->types[m->n_types++]));
  PetscFunctionReturn(0);
}

/* "2D4N" at the end of a type's name: 4; 0 if there is no such end. */
static PetscInt nodes_of_type(const char *name)
{
  const size_t length = strlen(name);
  size_t digits = 0;
  if (length < 4 || name[length - 1] != 'N') return 0;
  while (digits < length - 1 && isdigit((unsigned char)name[length - 2 - digits])) ++digits;
  const long n = strtol(name + length - 1 - digits, NULL, 10);
  return n >= 1 && n <= MDPA_MAX_NODES ? (PetscInt)n : 0;
}

/* Lines "id property node node ...". */
static PetscErrorCode ReadEntities(Reader *r, MdpaEntities *list, const char *block)
{
  Mdpa *m = r->model;
  PetscInt type = 0;

  PetscFunctionBeginUser;
  (void)next(r);
  const PetscInt n = nodes_of_type(r->word);
  if (!n) complain(r, "a type that ends with its number of nodes, as in 2D4N, is expected");
  else PetscCall(FindOrAddType(m, r->word, &type));
  while (next(r) && !is(r, "End")) {
    if (list->n == list->capacity) {
      list->capacity = PetscMax(256, 2 * list->capacity);
      PetscCall(PetscRealloc((size_t)list->capacity * sizeof(MdpaEntity), &list->entity));
    }
    MdpaEntity *e = &list->entity[list->n++];
    *e = (MdpaEntity){.id = integer(r), .n = n, .type = type};
    (void)next(r); /* its properties: materials are by model parts */
    for (PetscInt i = 0; i < n && next(r); ++i) {
      const PetscInt id = integer(r);
      if (!r->bad && mdpa_node(m, id) < 0) complain(r, "a node that the file has is expected");
      if (!r->bad) e->node[i] = m->index[id];
    }
  }
  end_block(r, block);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadIds(Reader *r, MdpaIds *list, const char *block)
{
  PetscFunctionBeginUser;
  while (next(r) && !is(r, "End")) {
    if (list->n == list->capacity) {
      list->capacity = PetscMax(64, 2 * list->capacity);
      PetscCall(PetscRealloc((size_t)list->capacity * sizeof(PetscInt), &list->id));
    }
    list->id[list->n++] = integer(r);
  }
  end_block(r, block);
  PetscFunctionReturn(0);
}

/* Behind "Begin <block>", of whatever kind: on to its End. */
static void skip(Reader *r)
{
  char block[256];
  snprintf(block, sizeof block, "%s", r->word);
  while (next(r))
    if (is(r, "End") && next(r) && is(r, block)) return;
  complain(r, "a block has no end");
}

/* Behind "Begin SubModelPart"; `outer`: the name of the part around it and a point, or "". */
static PetscErrorCode ReadPart(Reader *r, const char *outer, int depth)
{
  Mdpa *m = r->model;
  const PetscInt part = m->n_parts++;
  char name[512];

  PetscFunctionBeginUser;
  (void)next(r);
  snprintf(name, sizeof name, "%.250s%.255s", outer, r->word);
  PetscCall(PetscRealloc((size_t)m->n_parts * sizeof(MdpaPart), &m->parts));
  m->parts[part] = (MdpaPart){0};
  PetscCall(PetscStrallocpy(name, &m->parts[part].name));
  PetscCall(PetscStrlcat(name, ".", sizeof name));
  while (next(r) && !is(r, "End")) {
    if (!is(r, "Begin") || !next(r)) complain(r, "the begin or the end of a block is expected");
    else if (is(r, "SubModelPartNodes")) PetscCall(ReadIds(r, &m->parts[part].nodes, "SubModelPartNodes"));
    else if (is(r, "SubModelPartElements")) PetscCall(ReadIds(r, &m->parts[part].elements, "SubModelPartElements"));
    else if (is(r, "SubModelPartConditions"))
      PetscCall(ReadIds(r, &m->parts[part].conditions, "SubModelPartConditions"));
    else if (is(r, "SubModelPart") && depth == MDPA_DEEPEST) complain(r, "parts are not that deep in each other");
    else if (is(r, "SubModelPart")) PetscCall(ReadPart(r, name, depth + 1));
    else skip(r);
  }
  end_block(r, "SubModelPart");
  PetscFunctionReturn(0);
}

static int by_id(const void *a, const void *b)
{
  const PetscInt left = ((const MdpaEntity *)a)->id, right = ((const MdpaEntity *)b)->id;
  return (left > right) - (left < right);
}

static PetscErrorCode ReadBlocks(Reader *r)
{
  Mdpa *m = r->model;

  PetscFunctionBeginUser;
  while (next(r)) {
    if (!is(r, "Begin") || !next(r)) complain(r, "the begin of a block is expected");
    else if (is(r, "Nodes")) PetscCall(ReadNodes(r));
    else if (is(r, "Elements")) PetscCall(ReadEntities(r, &m->elements, "Elements"));
    else if (is(r, "Conditions")) PetscCall(ReadEntities(r, &m->conditions, "Conditions"));
    else if (is(r, "SubModelPart")) PetscCall(ReadPart(r, "", 0));
    else {
      if (strcmp(r->word, "ModelPartData") && strcmp(r->word, "Properties") && strcmp(r->word, "Table"))
        diag_warning(r->diag, NULL, "%s:%d: the block %s is left out", m->file, r->line, r->word);
      skip(r);
    }
  }
  if (m->elements.n) qsort(m->elements.entity, (size_t)m->elements.n, sizeof(MdpaEntity), by_id);
  if (m->conditions.n) qsort(m->conditions.entity, (size_t)m->conditions.n, sizeof(MdpaEntity), by_id);
  PetscFunctionReturn(0);
}

PetscErrorCode MdpaRead(const char *file, Diag *diag, Mdpa **model)
{
  char *text;
  const char *why;
  size_t length;

  PetscFunctionBeginUser;
  *model = NULL;
  PetscCall(FileLoad(file, &text, &length, &why));
  if (!text) {
    diag_error(diag, NULL, "'%s' cannot be read: %s", file, why);
    PetscFunctionReturn(0);
  }
  PetscCall(PetscNew(model));
  PetscCall(PetscStrallocpy(file, &(*model)->file));
  Reader r = {.at = text, .line = 1, .diag = diag, .model = *model};
  PetscCall(ReadBlocks(&r));
  PetscCall(PetscFree(text));
  if (r.bad) PetscCall(MdpaDestroy(model));
  PetscFunctionReturn(0);
}

PetscErrorCode MdpaDestroy(Mdpa **model)
{
  Mdpa *m = *model;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < m->n_types; ++i) PetscCall(PetscFree(m->types[i]));
  for (PetscInt i = 0; i < m->n_parts; ++i) {
    PetscCall(PetscFree(m->parts[i].name));
    PetscCall(PetscFree(m->parts[i].nodes.id));
    PetscCall(PetscFree(m->parts[i].elements.id));
    PetscCall(PetscFree(m->parts[i].conditions.id));
  }
  PetscCall(PetscFree(m->types));
  PetscCall(PetscFree(m->parts));
  PetscCall(PetscFree(m->elements.entity));
  PetscCall(PetscFree(m->conditions.entity));
  PetscCall(PetscFree(m->node_id));
  PetscCall(PetscFree(m->x));
  PetscCall(PetscFree(m->index));
  PetscCall(PetscFree(m->file));
  PetscCall(PetscFree(*model));
  PetscFunctionReturn(0);
}

const MdpaPart *mdpa_part(const Mdpa *model, const char *name)
{
  for (PetscInt i = 0; i < model->n_parts; ++i)
    if (!strcmp(model->parts[i].name, name)) return &model->parts[i];
  return NULL;
}

PetscInt mdpa_node(const Mdpa *model, PetscInt id) { return model->index && id <= model->most ? model->index[id] : -1; }

PetscInt mdpa_find(const MdpaEntities *entities, PetscInt id)
{
  const MdpaEntity key = {.id = id};
  const MdpaEntity *found =
    entities->n ? bsearch(&key, entities->entity, (size_t)entities->n, sizeof key, by_id) : NULL;
  return found ? (PetscInt)(found - entities->entity) : -1;
}
