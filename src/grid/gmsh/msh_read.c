/* MshReader of Gmsh files, versions 2.2 and 4.1, ASCII and binary.
 *
 * PETSc's own reader would abort on some broken files and wait for ever on others (rank 0 stops
 * while the rest stand in a broadcast); it also forgets the element numbers that messages must
 * name. */
#include "base/file.h"
#include "grid/gmsh/msh_reader.h"

/* A double-quoted string on the rest of the line. */
static PetscErrorCode ReadQuoted(MshReader *r, char **name)
{
  const char *first = r->at, *line_end;

  PetscFunctionBeginUser;
  *name = NULL;
  line_end = memchr(r->at, '\n', (size_t)(r->end - r->at));
  if (!line_end) line_end = r->end;
  while (first < line_end && *first != '"') ++first;
  const char *last = line_end - 1;
  while (last > first && *last != '"') --last;
  if (last <= first + 1) msh_fail(r, "the name of a physical group was expected in double quotes");
  if (r->failed) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1((size_t)(last - first), name));
  memcpy(*name, first + 1, (size_t)(last - first - 1));
  (*name)[last - first - 1] = 0;
  r->at = line_end;
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadNames(MshReader *r)
{
  MshFile *msh = r->msh;
  const PetscBool binary = r->binary;

  PetscFunctionBeginUser;
  if (msh->names) msh_fail(r, "there are two $PhysicalNames sections");
  r->binary = PETSC_FALSE; /* names are always text */
  const PetscInt n = msh_count(r, msh_text_int(r), 6, 6, "physical names");
  if (!r->failed) PetscCall(PetscCalloc1(n + 1, &msh->names));
  for (PetscInt k = 0; k < n && !r->failed; ++k) {
    MshName *name = msh->names + msh->n_names;
    name->dim = (PetscInt)msh_text_int(r);
    name->tag = (PetscInt)msh_text_int(r);
    PetscCall(ReadQuoted(r, &name->name));
    msh->n_names += !r->failed;
  }
  r->binary = binary;
  PetscFunctionReturn(0);
}

static void read_format(MshReader *r)
{
  msh_skip_space(r);
  const PetscReal version = msh_text_real(r);
  const PetscInt64 binary = msh_text_int(r), bytes = msh_text_int(r);
  if (r->failed) return;
  if (version != 2.2 && version != 4.1)
    msh_fail(r, "MSH version %g is not read; write 2.2 or 4.1 (gmsh -format msh41)", (double)version);
  if (binary != 0 && binary != 1) msh_fail(r, "%lld is no file type of Gmsh", (long long)binary);
  if (bytes != 8) msh_fail(r, "numbers of %lld bytes are not read", (long long)bytes);
  r->major = version == 2.2 ? 2 : 4;
  if (r->failed || !binary) return;
  int32_t one;
  msh_skip_line(r);
  r->binary = PETSC_TRUE;
  msh_take(r, sizeof one, &one);
  if (one != 1) msh_fail(r, "the file was written on a machine with another byte order");
}

static void expect_end(MshReader *r, const char *section)
{
  const size_t length = strlen(section);
  if (r->failed) return;
  msh_skip_space(r);
  if ((size_t)(r->end - r->at) < length + 4 || strncmp(r->at, "$End", 4) || strncmp(r->at + 4, section, length))
    msh_fail(r, "$%s does not end with $End%s: the file is truncated or damaged", section, section);
  else r->at += length + 4;
}

/* A section that does not matter; what comes after an unended one cannot be trusted. */
static void skip_section(MshReader *r, const char *section)
{
  char marker[80];
  const int n = snprintf(marker, sizeof marker, "$End%s", section);
  const char *found = memmem(r->at, (size_t)(r->end - r->at), marker, (size_t)n);
  r->at = found ? found : r->end;
}

static PetscErrorCode ReadSection(MshReader *r, const char *section)
{
  PetscFunctionBeginUser;
  if (!strcmp(section, "PhysicalNames")) PetscCall(ReadNames(r));
  else if (!strcmp(section, "Nodes")) PetscCall(r->major == 2 ? MshReadNodes2(r) : MshReadNodes4(r));
  else if (!strcmp(section, "Elements")) PetscCall(r->major == 2 ? MshReadElements2(r) : MshReadElements4(r));
  else if (!strcmp(section, "Entities")) PetscCall(MshReadEntities(r));
  else if (!strcmp(section, "PartitionedEntities"))
    msh_fail(r, "the mesh is partitioned; save it in one piece: talus partitions it itself");
  else skip_section(r, section);
  expect_end(r, section);
  PetscFunctionReturn(0);
}

/* The next "$Name" line; PETSC_FALSE at the end of the file. */
static PetscBool next_section(MshReader *r, size_t size, char *section)
{
  size_t n = 0;
  if (r->failed) return PETSC_FALSE;
  msh_skip_space(r);
  if (r->at >= r->end) return PETSC_FALSE;
  if (*r->at != '$') {
    msh_fail(r, "a section such as $Nodes was expected");
    return PETSC_FALSE;
  }
  for (++r->at; r->at<r->end && * r->at> ' ' && n + 1 < size; ++r->at) section[n++] = *r->at;
  section[n] = 0;
  msh_skip_line(r);
  return PETSC_TRUE;
}

static PetscErrorCode ReadSections(MshReader *r)
{
  char section[64];

  PetscFunctionBeginUser;
  if (r->at == r->end) msh_fail(r, "the file is empty");
  if (!r->failed && (r->end - r->at < 11 || strncmp(r->at, "$MeshFormat", 11)))
    msh_fail(r, "this is no Gmsh mesh: it does not begin with $MeshFormat");
  if (!r->failed && next_section(r, sizeof section, section)) read_format(r);
  expect_end(r, "MeshFormat");
  while (next_section(r, sizeof section, section)) PetscCall(ReadSection(r, section));
  if (!r->has_nodes) msh_fail(r, "there is no $Nodes section: the file is truncated or not a mesh");
  if (!r->has_elements) msh_fail(r, "there is no $Elements section: the file is truncated or not a mesh");
  PetscFunctionReturn(0);
}

/* Replace the node numbers of the elements by indices. */
static PetscErrorCode ResolveNodes(MshReader *r)
{
  MshFile *msh = r->msh;
  PetscInt *tag, *index;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(msh->n_nodes, &tag, msh->n_nodes, &index));
  for (PetscInt k = 0; k < msh->n_nodes; ++k) tag[k] = msh->node_tag[k], index[k] = k;
  PetscCall(PetscSortIntWithArray(msh->n_nodes, tag, index));
  for (PetscInt k = 1; k < msh->n_nodes && !r->failed; ++k)
    if (tag[k] == tag[k - 1]) msh_fail(r, "node %lld is given twice", (long long)tag[k]);
  const PetscBool dense = msh->n_nodes && tag[msh->n_nodes - 1] - tag[0] == msh->n_nodes - 1;
  for (PetscInt e = 0; e < msh->n_elements && !r->failed; ++e)
    for (PetscInt i = 0; i < msh->type[e]->nodes; ++i) {
      PetscInt *node = msh->node + MSH_MAX_NODES * e + i, at = dense ? *node - tag[0] : -1;
      if (!dense) PetscCall(PetscFindInt(*node, msh->n_nodes, tag, &at));
      if (at < 0 || at >= msh->n_nodes)
        msh_fail(r, "element %lld names node %lld, which the file does not have", (long long)msh->tag[e],
                 (long long)*node);
      else *node = index[at];
    }
  PetscCall(PetscFree2(tag, index));
  PetscFunctionReturn(0);
}

static PetscErrorCode LoadFile(MshReader *r, const char *path)
{
  const char *why;
  size_t length;

  PetscFunctionBeginUser;
  PetscCall(FileLoad(path, &r->data, &length, &why));
  r->at = r->data;
  r->end = r->data + length;
  if (why) (void)snprintf(r->message, r->message_size, "cannot read '%s': %s", r->path, why);
  r->failed = why != NULL;
  PetscFunctionReturn(0);
}

PetscErrorCode MshRead(const char *path, const char *shown, MshFile **msh, size_t size, char *message)
{
  MshReader r = {.path = shown, .message_size = size};

  PetscFunctionBeginUser;
  r.message = message;
  PetscCall(PetscNew(&r.msh));
  PetscCall(LoadFile(&r, path));
  if (!r.failed) PetscCall(ReadSections(&r));
  r.binary = PETSC_TRUE; /* from here on no line can be named */
  if (!r.failed) PetscCall(ResolveNodes(&r));
  if (r.failed) PetscCall(MshDestroy(&r.msh));
  PetscCall(PetscFree(r.data));
  PetscCall(PetscFree(r.entities));
  PetscCall(PetscFree(r.groups));
  *msh = r.msh;
  PetscFunctionReturn(0);
}

PetscErrorCode MshDestroy(MshFile **msh)
{
  MshFile *m = *msh;

  PetscFunctionBeginUser;
  if (!m) PetscFunctionReturn(0);
  for (PetscInt k = 0; k < m->n_names; ++k) PetscCall(PetscFree(m->names[k].name));
  PetscCall(PetscFree(m->names));
  PetscCall(PetscFree(m->node_tag));
  PetscCall(PetscFree(m->x));
  PetscCall(PetscFree(m->type));
  PetscCall(PetscFree(m->tag));
  PetscCall(PetscFree(m->entity));
  PetscCall(PetscFree(m->node));
  PetscCall(PetscFree(m->mark_element));
  PetscCall(PetscFree(m->mark_group));
  PetscCall(PetscFree(*msh));
  PetscFunctionReturn(0);
}
