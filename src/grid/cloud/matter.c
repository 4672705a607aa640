/* Voxels of what the cells of a mesh filled. They are a sixth of a spacing wide, so that of a slot of one cell four of
 * six are left by cells that do not stand along them. */
#include "grid/cloud/matter.h"

#define VOXELS 6          /* along the edge of a cell */
#define SHIFT 0.3         /* voxels: sides of cells that stand along the axes are no sides of voxels */
#define DEEP 6            /* layers; clouds reach no farther */
#define MOST 2147483647.0 /* voxels */

/* Samples of a cell stand no farther apart than voxels are wide. */
static PetscInt samples_of(const CloudMatter *m, PetscInt nodes, const PetscReal *x)
{
  PetscReal longest2 = 0;
  for (PetscInt i = 0; i < nodes; ++i)
    for (PetscInt k = 0; k < i; ++k) {
      PetscReal square = 0;
      for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(x[i * m->dim + d] - x[k * m->dim + d]);
      longest2 = PetscMax(longest2, square);
    }
  return (PetscInt)PetscCeilReal(PetscSqrtReal(longest2) / m->size);
}

#define UNROLLED static inline __attribute__((always_inline))

/* Position in voxels from the corner of the first. */
UNROLLED void in_voxels(const PetscInt dim, const CloudMatter *m, const PetscReal *x, PetscReal *v)
{
  for (PetscInt d = 0; d < dim; ++d) v[d] = (x[d] - m->low[d]) / m->size;
}

/* Number of the voxel at v, field after field; -1: outside. */
UNROLLED PetscInt64 voxel_at(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscReal *v)
{
  PetscInt64 voxel = field;
  for (PetscInt d = dim - 1; d >= 0; --d) {
    if (!(v[d] >= 0 && v[d] < (PetscReal)m->counts[d])) return -1;
    voxel = voxel * m->counts[d] + (PetscInt64)v[d];
  }
  return voxel;
}

UNROLLED PetscBool is_set(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscReal *v)
{
  const PetscInt64 voxel = voxel_at(dim, m, field, v);
  return (PetscBool)(voxel >= 0 && (m->bits[voxel / 8] >> (voxel % 8) & 1));
}

/* Or half a voxel beside it: nodes stand on the sides of cells. */
UNROLLED PetscBool holds(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscReal *v)
{
  if (is_set(dim, m, field, v)) return PETSC_TRUE;
  for (PetscInt corner = 0; corner < 1 << dim; ++corner) {
    PetscReal beside[3];
    for (PetscInt d = 0; d < dim; ++d) beside[d] = v[d] + (corner >> d & 1 ? 0.5 : -0.5);
    if (is_set(dim, m, field, beside)) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Number of the block with these coordinates; -1: outside. */
UNROLLED PetscInt64 block_at(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscInt *at)
{
  PetscInt64 block = field;
  for (PetscInt d = dim - 1; d >= 0; --d) {
    if (at[d] < 0 || at[d] >= m->blocks[d]) return -1;
    block = block * m->blocks[d] + at[d];
  }
  return block;
}

/* Is all that is as near to v as the end of the way full? Most ways need no more. */
UNROLLED PetscBool is_deep(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscReal *v,
                           PetscReal longest)
{
  PetscInt at[3];
  for (PetscInt d = 0; d < dim; ++d) at[d] = (PetscInt)v[d] / VOXELS;
  const PetscInt64 block = block_at(dim, m, field, at);
  return (PetscBool)(block >= 0 && longest <= VOXELS * ((PetscReal)m->depth[block] - 1));
}

/* No two samples of the way have a whole voxel between them. */
UNROLLED PetscBool joins(const PetscInt dim, const CloudMatter *m, PetscInt field, const PetscReal *a,
                         const PetscReal *b)
{
  PetscReal v[3], end[3], longest = 0;
  in_voxels(dim, m, a, v);
  in_voxels(dim, m, b, end);
  for (PetscInt d = 0; d < dim; ++d) longest = PetscMax(longest, PetscAbsReal(end[d] - v[d]));
  if (is_deep(dim, m, field, v, longest)) return PETSC_TRUE;
  const PetscReal n = PetscCeilReal(longest);
  for (PetscInt d = 0; d < dim; ++d) end[d] = (end[d] - v[d]) / n;
  for (PetscReal i = 1; i < n; ++i) {
    for (PetscInt d = 0; d < dim; ++d) v[d] += end[d];
    if (!holds(dim, m, field, v)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

PetscBool matter_holds(const CloudMatter *m, PetscInt field, const PetscReal *x)
{
  PetscReal v[3];
  in_voxels(m->dim, m, x, v);
  return holds(m->dim, m, field, v);
}

PetscBool matter_joins(const CloudMatter *m, PetscInt field, const PetscReal *a, const PetscReal *b)
{
  return m->dim == 2 ? joins(2, m, field, a, b) : joins(3, m, field, a, b);
}

/* The reference cell goes from 0 to 1 in simplices, from -1 to 1 in others. */
static void fill_cell(CloudMatter *m, CellType type, const PetscReal *x, PetscInt field)
{
  const Cell *cell = &cells[type];
  const PetscBool simplex = (PetscBool)(cell->nodes == m->dim + 1);
  const PetscInt n = samples_of(m, cell->nodes, x), planes = m->dim == 3 ? n : 0;
  for (PetscInt k = 0; k <= planes; ++k)
    for (PetscInt j = 0; j <= n; ++j)
      for (PetscInt i = 0; i <= n; ++i) {
        PetscReal xi[3] = {(PetscReal)i / (PetscReal)n, (PetscReal)j / (PetscReal)n, (PetscReal)k / (PetscReal)n};
        PetscReal at[3], v[3];
        if (simplex && i + j + k > n) continue;
        for (PetscInt d = 0; d < m->dim && !simplex; ++d) xi[d] = 2 * xi[d] - 1;
        cell_position(type, x, xi, at);
        in_voxels(m->dim, m, at, v);
        const PetscInt64 voxel = voxel_at(m->dim, m, field, v);
        m->bits[voxel / 8] |= (unsigned char)(1 << (voxel % 8));
      }
}

/* How many voxels there are in the box of all cells listed. */
static PetscErrorCode Size(CloudMatter *m, const Grid *mesh, PetscInt n, const PetscInt *cell, PetscReal *voxels)
{
  PetscReal x[3 * CELL_MAX_NODES], range[6];

  PetscFunctionBeginUser;
  for (int d = 0; d < 6; ++d) range[d] = -PETSC_MAX_REAL; /* -lowest, highest */
  for (PetscInt k = 0; k < n; ++k) {
    grid_cell_x(mesh, cell[k], x);
    for (PetscInt i = 0; i < mesh->nodes_per_cell; ++i)
      for (PetscInt d = 0; d < m->dim; ++d) {
        range[d] = PetscMax(range[d], -x[i * m->dim + d]);
        range[3 + d] = PetscMax(range[3 + d], x[i * m->dim + d]);
      }
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, range, 6, MPIU_REAL, MPIU_MAX, mesh->comm));
  *voxels = m->n_fields;
  for (PetscInt d = 0; d < m->dim; ++d) {
    m->low[d] = -range[d] - SHIFT * m->size;
    const PetscReal count = PetscFloorReal((range[3 + d] - m->low[d]) / m->size) + 1;
    *voxels *= count;
    m->counts[d] = (PetscInt)PetscMin(count, MOST);
  }
  PetscFunctionReturn(0);
}

static PetscBool is_full(const CloudMatter *m, PetscInt field, const PetscInt *at)
{
  const PetscInt planes = m->dim == 3 ? VOXELS : 1;
  for (PetscInt k = 0; k < VOXELS * VOXELS * planes; ++k) {
    const PetscInt ijk[3] = {k % VOXELS, k / VOXELS % VOXELS, k / (VOXELS * VOXELS)};
    PetscReal v[3];
    for (PetscInt d = 0; d < m->dim; ++d) v[d] = 0.5 + VOXELS * at[d] + ijk[d];
    if (!holds(m->dim, m, field, v)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Is a block beside it, across sides or corners, less deep than k? */
static PetscBool is_beside(const CloudMatter *m, PetscInt field, const PetscInt *at, int k)
{
  for (PetscInt n = 0; n < (m->dim == 3 ? 27 : 9); ++n) {
    const PetscInt other[3] = {at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1};
    const PetscInt64 block = block_at(m->dim, m, field, other);
    if (block < 0 || m->depth[block] < k) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Layer by layer, from the blocks that are not full. */
static PetscErrorCode Depths(CloudMatter *m)
{
  PetscInt n = 1;

  PetscFunctionBeginUser;
  for (PetscInt d = 0; d < m->dim; ++d) n *= m->blocks[d] = (m->counts[d] + VOXELS - 1) / VOXELS;
  PetscCall(PetscMalloc1(n * m->n_fields, &m->depth));
  for (int k = 0; k <= DEEP; ++k)
    for (PetscInt b = 0; b < n * m->n_fields; ++b) {
      const PetscInt in = b % n, at[3] = {in % m->blocks[0], in / m->blocks[0] % m->blocks[1],
                                          m->dim == 3 ? in / (m->blocks[0] * m->blocks[1]) : 0};
      if (k == 0) m->depth[b] = is_full(m, b / n, at) ? DEEP : 0;
      else if (m->depth[b] > k && is_beside(m, b / n, at, k)) m->depth[b] = (unsigned char)k;
    }
  PetscFunctionReturn(0);
}

static PetscErrorCode Centres(CloudMatter *m, const Grid *mesh)
{
  PetscInt last = -1, all;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < mesh->n_cells; ++c) last = PetscMax(last, mesh->global_cell[c]);
  PetscCall(MPIU_Allreduce(&last, &all, 1, MPIU_INT, MPI_MAX, mesh->comm));
  PetscCall(PetscMalloc1((all + 1) * m->dim, &m->centre));
  for (PetscInt i = 0; i < (all + 1) * m->dim; ++i) m->centre[i] = -PETSC_MAX_REAL;
  for (PetscInt c = 0; c < mesh->n_cells; ++c) {
    PetscReal centre[3];
    grid_cell_centre(mesh, c, centre);
    for (PetscInt d = 0; d < m->dim; ++d) m->centre[mesh->global_cell[c] * m->dim + d] = centre[d];
  }
  PetscCall(
    MPIU_Allreduce(MPI_IN_PLACE, m->centre, (PetscMPIInt)((all + 1) * m->dim), MPIU_REAL, MPIU_MAX, mesh->comm));
  PetscFunctionReturn(0);
}

static PetscErrorCode Fill(CloudMatter *m, const Grid *mesh, PetscInt n, const PetscInt *cell, const PetscReal *field,
                           PetscReal voxels)
{
  const size_t bytes = (size_t)(voxels / 8) + 1;
  PetscReal x[3 * CELL_MAX_NODES];

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(bytes, &m->bits));
  for (PetscInt k = 0; k < n; ++k) {
    if (k && cell[k] == cell[k - 1]) continue; /* points of a cell stand together */
    grid_cell_x(mesh, cell[k], x);
    fill_cell(m, grid_cell_type(mesh, cell[k]), x, field ? (PetscInt)field[k] : 0);
  }
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, m->bits, (PetscMPIInt)bytes, MPI_UNSIGNED_CHAR, MPI_BOR, mesh->comm));
  PetscCall(Depths(m));
  PetscCall(Centres(m, mesh));
  PetscFunctionReturn(0);
}

PetscErrorCode CloudMatterCreate(const Grid *mesh, PetscReal spacing, PetscInt n_fields, PetscInt n,
                                 const PetscInt *cell, const PetscReal *field, CloudMatter **matter)
{
  CloudMatter *m;
  PetscReal voxels;

  PetscFunctionBeginUser;
  *matter = NULL;
  PetscCall(PetscNew(&m));
  m->dim = mesh->dim;
  m->n_fields = n_fields;
  m->size = PetscMin(spacing, PetscMax(mesh->smallest, spacing / 4)) / VOXELS;
  PetscCall(Size(m, mesh, n, cell, &voxels));
  if (voxels > MOST || (PetscReal)mesh->n_cells_global * mesh->dim > MOST) PetscCall(PetscFree(m));
  else PetscCall(Fill(m, mesh, n, cell, field, voxels));
  *matter = m;
  PetscFunctionReturn(0);
}

PetscErrorCode CloudMatterDestroy(CloudMatter **matter)
{
  PetscFunctionBeginUser;
  if (!*matter) PetscFunctionReturn(0);
  PetscCall(PetscFree((*matter)->bits));
  PetscCall(PetscFree((*matter)->depth));
  PetscCall(PetscFree((*matter)->centre));
  PetscCall(PetscFree(*matter));
  PetscFunctionReturn(0);
}
