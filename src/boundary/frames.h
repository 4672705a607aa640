/* Frames of nodes that are held along directions which are not those of the axes.
 *
 * The reflection H = 1 - 2 w w^T swaps an axis with a direction (its sign apart) and is its own
 * inverse. Flags of prescribed dofs and the unknowns of the linear system are components in the
 * frame, H v; all nodal arrays are components along the axes, except where it is said. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt n, capacity;
  PetscInt *node;        /* n local nodes */
  PetscReal *w;          /* n x 3, of length 1 */
  PetscInt n_nodes, *of; /* n_nodes: which frame the node has, -1 if none; NULL where nobody has one */
} Frames;

/* Forget all; the frames that follow are of as many local nodes. */
PetscErrorCode FramesClear(Frames *frames, PetscInt n_nodes);
/* Of a node that has none yet: the axis gets the direction (dim, of length 1). */
PetscErrorCode FramesAdd(Frames *frames, PetscInt dim, PetscInt node, PetscInt axis, const PetscReal *direction);
PetscErrorCode FramesDestroy(Frames *frames);

/* w of the node; NULL if its components are those along the axes. */
static inline const PetscReal *frame_of(const Frames *frames, PetscInt node)
{
  return frames->n && frames->of[node] >= 0 ? frames->w + 3 * frames->of[node] : NULL;
}

/* v (dim) becomes H v: into the frame, and out of it. */
static inline void frame_turn(PetscInt dim, const PetscReal *w, PetscReal *v)
{
  PetscReal along = 0;
  for (PetscInt d = 0; d < dim; ++d) along += w[d] * v[d];
  for (PetscInt d = 0; d < dim; ++d) v[d] -= 2 * along * w[d];
}

/* H_row a H_column of a block whose rows begin `stride` numbers apart; NULL: along the axes. Behind the displacements
 * of a block (stride > dim) stand pressures, which have no direction. */
static inline void frame_turn_block(PetscInt dim, PetscInt stride, const PetscReal *row, const PetscReal *column,
                                    PetscReal *a)
{
  PetscReal v[3];
  for (PetscInt j = 0; row && j < stride; ++j) {
    for (PetscInt d = 0; d < dim; ++d) v[d] = a[d * stride + j];
    frame_turn(dim, row, v);
    for (PetscInt d = 0; d < dim; ++d) a[d * stride + j] = v[d];
  }
  for (PetscInt i = 0; column && i < stride; ++i) frame_turn(dim, column, a + i * stride);
}

/* The vectors (n_nodes x dim) of all nodes that have a frame. */
static inline void frames_turn(const Frames *frames, PetscInt dim, PetscReal *vectors)
{
  for (PetscInt k = 0; k < frames->n; ++k) frame_turn(dim, frames->w + 3 * k, vectors + frames->node[k] * dim);
}
