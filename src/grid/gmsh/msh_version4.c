/* Entities, nodes and elements of Gmsh 4.1: elements stand in blocks, and their physical groups
 * with the entities. */
#include "grid/gmsh/msh_reader.h"

static PetscErrorCode ReadEntity(MshReader *r, PetscInt dim)
{
  MshEntity *entity = r->entities + r->n_entities;

  PetscFunctionBeginUser;
  entity->dim = dim;
  entity->tag = (PetscInt)msh_int(r);
  for (int k = 0; k < (dim ? 6 : 3); ++k) (void)msh_real(r);
  entity->n_groups = msh_count(r, msh_size(r), 2, 4, "physical groups");
  entity->first_group = r->n_groups;
  if (r->n_groups + entity->n_groups > r->group_capacity) {
    r->group_capacity = 2 * (r->n_groups + entity->n_groups);
    PetscCall(PetscRealloc((size_t)r->group_capacity * sizeof(PetscInt), &r->groups));
  }
  for (PetscInt g = 0; g < entity->n_groups; ++g) r->groups[r->n_groups++] = (PetscInt)msh_int(r);
  const PetscInt n_bounding = dim ? msh_count(r, msh_size(r), 2, 4, "bounding entities") : 0;
  for (PetscInt b = 0; b < n_bounding && !r->failed; ++b) (void)msh_int(r);
  r->n_entities += !r->failed;
  PetscFunctionReturn(0);
}

PetscErrorCode MshReadEntities(MshReader *r)
{
  PetscInt n[4], all = 0;

  PetscFunctionBeginUser;
  if (r->entities) msh_fail(r, "there are two $Entities sections");
  for (int d = 0; d < 4; ++d) all += n[d] = msh_count(r, msh_size(r), 8, 36, "geometric entities");
  if (r->failed) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(all + 1, &r->entities));
  for (PetscInt d = 0; d < 4; ++d)
    for (PetscInt k = 0; k < n[d] && !r->failed; ++k) PetscCall(ReadEntity(r, d));
  PetscFunctionReturn(0);
}

static const MshEntity *find_entity(const MshReader *r, PetscInt64 dim, PetscInt64 tag)
{
  for (PetscInt k = 0; k < r->n_entities; ++k)
    if (r->entities[k].dim == dim && r->entities[k].tag == tag) return r->entities + k;
  return NULL;
}

PetscErrorCode MshReadNodes4(MshReader *r)
{
  const PetscInt64 blocks = msh_size(r), claimed = msh_size(r);
  const PetscInt n = msh_count(r, claimed, 8, 32, "nodes");
  PetscInt done = 0;

  PetscFunctionBeginUser;
  (void)msh_size(r), (void)msh_size(r);
  PetscCall(MshAllocateNodes(r, n));
  for (PetscInt64 b = 0; b < blocks && !r->failed; ++b) {
    const PetscInt64 dim = msh_int(r);
    (void)msh_int(r);
    const PetscInt64 parameters = msh_int(r) ? dim : 0, in_block = msh_size(r);
    if (dim < 0 || dim > 3) msh_fail(r, "a block of nodes has dimension %lld", (long long)dim);
    if (in_block < 0 || in_block > n - done) msh_fail(r, "a block has more nodes than the file says");
    const PetscInt end = r->failed ? done : done + (PetscInt)in_block;
    for (PetscInt k = done; k < end && !r->failed; ++k) r->msh->node_tag[k] = msh_tag(r, msh_size(r), "node");
    for (PetscInt k = done; k < end && !r->failed; ++k) {
      msh_position(r, k);
      for (PetscInt64 p = 0; p < parameters; ++p) (void)msh_real(r);
    }
    done = end;
  }
  if (done != n) msh_fail(r, "the file claims %lld nodes but its blocks hold %lld", (long long)n, (long long)done);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadElement4(MshReader *r, PetscInt element, const MshType *type, PetscInt64 entity_tag,
                                   const MshEntity *entity)
{
  MshFile *msh = r->msh;

  PetscFunctionBeginUser;
  msh->type[element] = type;
  msh->entity[element] = (PetscInt)entity_tag;
  msh->tag[element] = msh_tag(r, msh_size(r), "element");
  for (PetscInt i = 0; i < type->nodes; ++i) msh->node[MSH_MAX_NODES * element + i] = msh_tag(r, msh_size(r), "node");
  for (PetscInt g = 0; entity && g < entity->n_groups && !r->failed; ++g)
    PetscCall(MshAddMark(msh, element, r->groups[entity->first_group + g]));
  PetscFunctionReturn(0);
}

PetscErrorCode MshReadElements4(MshReader *r)
{
  const PetscInt64 blocks = msh_size(r), claimed = msh_size(r), first_tag = msh_size(r);
  const PetscInt n = msh_count(r, claimed, 4, 16, "elements");
  PetscInt done = 0;

  PetscFunctionBeginUser;
  (void)msh_size(r);
  PetscCall(MshAllocateElements(r, n));
  for (PetscInt64 b = 0; b < blocks && !r->failed; ++b) {
    const PetscInt64 dim = msh_int(r), tag = msh_int(r), code = msh_int(r), in_block = msh_size(r);
    const MshEntity *entity = find_entity(r, dim, tag);
    const MshType *type = r->failed ? NULL : msh_type(r, code, first_tag + done);
    if (in_block < 0 || in_block > n - done) msh_fail(r, "a block has more elements than the file says");
    for (PetscInt64 k = 0; k < in_block && !r->failed; ++k) PetscCall(ReadElement4(r, done++, type, tag, entity));
  }
  if (done != n) msh_fail(r, "the file claims %lld elements but its blocks hold %lld", (long long)n, (long long)done);
  PetscFunctionReturn(0);
}
