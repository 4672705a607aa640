/* Nodes and elements of Gmsh 2.2. Counts stand as text in binary files too. */
#include "grid/gmsh/msh_reader.h"

static PetscInt64 count_line(MshReader *r)
{
  const PetscInt64 n = msh_text_int(r);
  if (r->binary) msh_skip_line(r);
  return n;
}

PetscErrorCode MshReadNodes2(MshReader *r)
{
  const PetscInt64 claimed = count_line(r);
  const PetscInt n = msh_count(r, claimed, 8, 28, "nodes");

  PetscFunctionBeginUser;
  PetscCall(MshAllocateNodes(r, n));
  for (PetscInt k = 0; k < n && !r->failed; ++k) {
    r->msh->node_tag[k] = msh_tag(r, msh_int(r), "node");
    msh_position(r, k);
  }
  PetscFunctionReturn(0);
}

/* Tags of an element: the physical group, the geometric entity, and partitions that do not
 * matter. */
static PetscErrorCode ReadElement2(MshReader *r, PetscInt element, const MshType *type, PetscInt64 n_tags)
{
  MshFile *msh = r->msh;
  PetscInt64 group = 0;

  PetscFunctionBeginUser;
  msh->type[element] = type;
  msh->entity[element] = 0;
  for (PetscInt64 t = 0; t < n_tags && !r->failed; ++t) {
    const PetscInt64 tag = msh_int(r);
    if (t == 0) group = tag;
    if (t == 1) msh->entity[element] = (PetscInt)tag;
  }
  for (PetscInt i = 0; i < type->nodes; ++i) msh->node[MSH_MAX_NODES * element + i] = msh_tag(r, msh_int(r), "node");
  if (group && !r->failed) PetscCall(MshAddMark(msh, element, group));
  PetscFunctionReturn(0);
}

PetscErrorCode MshReadElements2(MshReader *r)
{
  const PetscInt64 claimed = count_line(r);
  const PetscInt n = msh_count(r, claimed, 8, 8, "elements");
  PetscInt64 follow = 0, n_tags = 0, code = 0;

  PetscFunctionBeginUser;
  PetscCall(MshAllocateElements(r, n));
  for (PetscInt k = 0; k < n && !r->failed; ++k) {
    if (r->binary && follow-- == 0) {
      code = msh_int(r), follow = msh_int(r) - 1, n_tags = msh_int(r);
      if (follow < 0) msh_fail(r, "a block of elements is empty: the file is damaged");
    }
    r->msh->tag[k] = msh_tag(r, msh_int(r), "element");
    if (!r->binary) code = msh_text_int(r), n_tags = msh_text_int(r);
    const MshType *type = r->failed ? NULL : msh_type(r, code, r->msh->tag[k]);
    if (!r->failed) PetscCall(ReadElement2(r, k, type, n_tags));
  }
  PetscFunctionReturn(0);
}
