/* Bounding boxes in a balanced binary tree, split at the median of their centres. */
#include "grid/search/box_tree.h"

#define LEAF_SIZE 4
#define MAX_DEPTH 64

typedef struct {
  PetscReal bounds[6];
  PetscInt first, n; /* its boxes in index[] */
  PetscInt right;    /* second child, the first being the next node; 0: a leaf */
} TreeNode;

struct BoxTree {
  PetscInt n_nodes, *index;
  TreeNode *nodes;
  PetscReal (*bounds)[6];
};

static inline PetscReal centre_of(const BoxTree *tree, PetscInt k, PetscInt axis)
{
  const PetscReal *b = tree->bounds[tree->index[k]];
  return b[axis] + b[axis + 3];
}

static inline void swap_index(BoxTree *tree, PetscInt a, PetscInt b)
{
  const PetscInt keep = tree->index[a];
  tree->index[a] = tree->index[b];
  tree->index[b] = keep;
}

/* Hoare's selection: afterwards no centre below `middle` exceeds one above. */
static void select_median(BoxTree *tree, PetscInt lo, PetscInt hi, PetscInt middle, PetscInt axis)
{
  while (lo < hi) {
    const PetscReal pivot = centre_of(tree, lo + (hi - lo) / 2, axis);
    PetscInt i = lo, j = hi;
    while (i <= j) {
      while (centre_of(tree, i, axis) < pivot) ++i;
      while (centre_of(tree, j, axis) > pivot) --j;
      if (i <= j) swap_index(tree, i++, j--);
    }
    if (middle <= j) hi = j;
    else if (middle >= i) lo = i;
    else return;
  }
}

static void node_bounds(const BoxTree *tree, TreeNode *node)
{
  for (int d = 0; d < 3; ++d) node->bounds[d] = PETSC_MAX_REAL, node->bounds[d + 3] = -PETSC_MAX_REAL;
  for (PetscInt k = node->first; k < node->first + node->n; ++k) {
    const PetscReal *b = tree->bounds[tree->index[k]];
    for (int d = 0; d < 3; ++d) {
      node->bounds[d] = PetscMin(node->bounds[d], b[d]);
      node->bounds[d + 3] = PetscMax(node->bounds[d + 3], b[d + 3]);
    }
  }
}

static void build(BoxTree *tree, PetscInt first, PetscInt n)
{
  TreeNode *node = tree->nodes + tree->n_nodes++;
  PetscInt axis = 0;
  *node = (TreeNode){.first = first, .n = n};
  node_bounds(tree, node);
  if (n <= LEAF_SIZE) return;
  for (PetscInt d = 1; d < 3; ++d)
    if (node->bounds[d + 3] - node->bounds[d] > node->bounds[axis + 3] - node->bounds[axis]) axis = d;
  select_median(tree, first, first + n - 1, first + n / 2, axis);
  build(tree, first, n / 2);
  node->right = tree->n_nodes;
  build(tree, first + n / 2, n - n / 2);
}

PetscErrorCode BoxTreeCreate(PetscInt n, PetscReal (*bounds)[6], BoxTree **out)
{
  BoxTree *tree;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&tree));
  tree->bounds = bounds; /* now the tree's */
  PetscCall(PetscMalloc1(n, &tree->index));
  PetscCall(PetscMalloc1(2 * n / (LEAF_SIZE / 2) + 1, &tree->nodes));
  for (PetscInt k = 0; k < n; ++k) tree->index[k] = k;
  if (n) build(tree, 0, n);
  *out = tree;
  PetscFunctionReturn(0);
}

PetscErrorCode BoxTreeDestroy(BoxTree **tree)
{
  PetscFunctionBeginUser;
  if (!*tree) PetscFunctionReturn(0);
  PetscCall(PetscFree((*tree)->bounds));
  PetscCall(PetscFree((*tree)->index));
  PetscCall(PetscFree((*tree)->nodes));
  PetscCall(PetscFree(*tree));
  PetscFunctionReturn(0);
}

static inline PetscBool holds(const PetscReal bounds[6], const PetscReal x[3])
{
  return x[0] >= bounds[0] && x[0] <= bounds[3] && x[1] >= bounds[1] && x[1] <= bounds[4] && x[2] >= bounds[2] &&
         x[2] <= bounds[5];
}

void box_tree_holding(const BoxTree *tree, const PetscReal x[3], BoxVisit visit, void *context)
{
  PetscInt stack[MAX_DEPTH], depth = 0;
  if (tree->n_nodes) stack[depth++] = 0;
  while (depth) {
    const PetscInt at = stack[--depth];
    const TreeNode *node = tree->nodes + at;
    if (!holds(node->bounds, x)) continue;
    if (node->right) {
      stack[depth++] = node->right;
      stack[depth++] = at + 1;
      continue;
    }
    for (PetscInt k = node->first; k < node->first + node->n; ++k)
      if (holds(tree->bounds[tree->index[k]], x) && !visit(context, tree->index[k])) return;
  }
}

PetscInt box_tree_nearest(const BoxTree *tree, const PetscReal x[3], PetscReal within, BoxDistance distance,
                          void *context)
{
  PetscInt stack[MAX_DEPTH], depth = 0, nearest = -1;
  PetscReal least = within;
  if (tree->n_nodes) stack[depth++] = 0;
  while (depth) {
    const PetscInt at = stack[--depth];
    const TreeNode *node = tree->nodes + at;
    if (box_squared_distance(node->bounds, x) >= least) continue;
    if (node->right) {
      /* The nearer child first: it narrows the search. */
      const PetscInt a = at + 1, b = node->right;
      const PetscBool swap =
        box_squared_distance(tree->nodes[a].bounds, x) < box_squared_distance(tree->nodes[b].bounds, x);
      stack[depth++] = swap ? b : a;
      stack[depth++] = swap ? a : b;
      continue;
    }
    for (PetscInt k = node->first; k < node->first + node->n; ++k) {
      const PetscReal found = distance(context, tree->index[k]);
      if (found < least) least = found, nearest = tree->index[k];
    }
  }
  return nearest;
}
