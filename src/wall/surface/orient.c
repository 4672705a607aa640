/* Which side of triangles is out. */
#include <math.h>
#include "wall/surface/triangles.h"

/* Six times the volume of triangle i with the origin o. */
static PetscReal volume_share(const Triangles *t, PetscInt i, const PetscReal *o)
{
  PetscReal six = 0, x[3][3];
  for (int k = 0; k < 3; ++k)
    for (int d = 0; d < 3; ++d) x[k][d] = t->x[3 * t->vertex[i][k] + d] - o[d];
  for (int d = 0; d < 3; ++d)
    six += x[0][d] * (x[1][(d + 1) % 3] * x[2][(d + 2) % 3] - x[1][(d + 2) % 3] * x[2][(d + 1) % 3]);
  return six;
}

PetscReal triangles_volume(const Triangles *t)
{
  PetscReal six = 0;
  for (PetscInt i = 0; i < t->n; ++i) six += volume_share(t, i, t->x + 3 * t->vertex[0][0]);
  return six / 6;
}

/* Corners a b c become b a c; edge 0 stays, 1 and 2 change places. */
static void turn_triangle(Triangles *t, PetscInt i)
{
  const PetscInt v = t->vertex[i][0], e = t->edge[i][1];
  t->vertex[i][0] = t->vertex[i][1], t->vertex[i][1] = v;
  t->edge[i][1] = t->edge[i][2], t->edge[i][2] = e;
}

void triangles_turn_all(Triangles *t)
{
  for (PetscInt i = 0; i < t->n; ++i) turn_triangle(t, i);
}

/* From which vertex triangle i runs along edge e. */
static PetscInt start_of(const Triangles *t, PetscInt i, PetscInt e)
{
  int k = 0;
  while (t->edge[i][k] != e) ++k;
  return t->vertex[i][k];
}

typedef struct {
  signed char *way; /* 1: as it is, -1: to be turned, 0: not visited */
  PetscInt *queue;
  PetscInt contradiction; /* a triangle that would have to be both, -1: none */
} Flood;

/* From triangle `seed` over all edges; returns how many triangles of the queue are its piece. */
static PetscInt flood_piece(const Triangles *t, PetscInt seed, Flood *flood)
{
  PetscInt n = 0;
  flood->queue[n++] = seed;
  flood->way[seed] = 1;
  for (PetscInt at = 0; at < n; ++at) {
    const PetscInt i = flood->queue[at];
    for (int k = 0; k < 3; ++k) {
      const PetscInt e = t->edge[i][k], other = t->side[e][0] / 3 == i ? t->side[e][1] : t->side[e][0];
      if (other < 0) continue;
      const PetscInt j = other / 3;
      const signed char way = start_of(t, i, e) == start_of(t, j, e) ? (signed char)-flood->way[i] : flood->way[i];
      if (!flood->way[j]) flood->queue[n++] = j;
      else if (flood->way[j] != way) flood->contradiction = j;
      flood->way[j] = way;
    }
  }
  return n;
}

/* Turn those of a mixed piece that are fewer, or that make its volume positive. */
static void settle_piece(Triangles *t, const Flood *flood, PetscInt n, PetscBool closed, PetscInt *turned,
                         PetscInt *first)
{
  const PetscReal *o = t->x + 3 * t->vertex[flood->queue[0]][0];
  PetscInt against = 0;
  PetscReal volume = 0;
  for (PetscInt k = 0; k < n; ++k) against += flood->way[flood->queue[k]] < 0;
  if (!against) return;
  for (PetscInt k = 0; k < n; ++k) volume += flood->way[flood->queue[k]] * volume_share(t, flood->queue[k], o);
  const int wrong = (closed ? volume < 0 : 2 * against > n) ? 1 : -1;
  for (PetscInt k = 0; k < n; ++k) {
    const PetscInt i = flood->queue[k];
    if (flood->way[i] != wrong) continue;
    turn_triangle(t, i);
    if (!*turned || t->number[i] < *first) *first = t->number[i];
    ++*turned;
  }
}

PetscErrorCode TrianglesOrient(Triangles *t, PetscBool closed, PetscInt *pieces, PetscInt *turned, PetscInt *first,
                               PetscInt *two_faced)
{
  Flood flood = {.contradiction = -1};

  PetscFunctionBeginUser;
  *pieces = *turned = *first = 0;
  PetscCall(PetscCalloc1(t->n, &flood.way));
  PetscCall(PetscMalloc1(t->n, &flood.queue));
  for (PetscInt i = 0; i < t->n; ++i) {
    if (flood.way[i]) continue;
    const PetscInt n = flood_piece(t, i, &flood);
    if (flood.contradiction >= 0) break;
    settle_piece(t, &flood, n, closed, turned, first);
    ++*pieces;
  }
  *two_faced = flood.contradiction;
  PetscCall(PetscFree(flood.way));
  PetscCall(PetscFree(flood.queue));
  PetscFunctionReturn(0);
}

/* Unit normal from the corners; PETSC_FALSE if its height is within the tolerance. */
static PetscBool own_normal(const Triangles *t, PetscInt i, PetscReal normal[3])
{
  PetscReal e[3][3], longest = 0, square = 0;
  for (int k = 0; k < 3; ++k) {
    PetscReal length = 0;
    for (int d = 0; d < 3; ++d) {
      e[k][d] = t->x[3 * t->vertex[i][(k + 1) % 3] + d] - t->x[3 * t->vertex[i][k] + d];
      length += e[k][d] * e[k][d];
    }
    longest = PetscMax(longest, length);
  }
  for (int d = 0; d < 3; ++d) {
    normal[d] = e[0][(d + 1) % 3] * e[1][(d + 2) % 3] - e[0][(d + 2) % 3] * e[1][(d + 1) % 3];
    square += normal[d] * normal[d];
  }
  if (square <= PetscSqr(t->tolerance) * longest) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) normal[d] /= PetscSqrtReal(square);
  return PETSC_TRUE;
}

/* The mean normal over its edges, long ones counting more; PETSC_FALSE if no neighbour has one. */
static PetscBool borrowed_normal(const Triangles *t, const PetscBool *has, PetscInt i, PetscReal normal[3])
{
  PetscReal square = 0;
  for (int d = 0; d < 3; ++d) normal[d] = 0;
  for (int k = 0; k < 3; ++k) {
    const PetscInt e = t->edge[i][k], other = t->side[e][0] / 3 == i ? t->side[e][1] : t->side[e][0];
    PetscReal length = 0;
    if (other < 0 || !has[other / 3]) continue;
    for (int d = 0; d < 3; ++d)
      length += PetscSqr(t->x[3 * t->vertex[i][(k + 1) % 3] + d] - t->x[3 * t->vertex[i][k] + d]);
    for (int d = 0; d < 3; ++d) normal[d] += PetscSqrtReal(length) * t->normal[other / 3][d];
  }
  for (int d = 0; d < 3; ++d) square += normal[d] * normal[d];
  for (int d = 0; d < 3 && square > 0; ++d) normal[d] /= PetscSqrtReal(square);
  return square > 0;
}

PetscErrorCode TrianglesNormals(Triangles *t, PetscInt *without)
{
  PetscBool *has;
  PetscInt lacking = 0, before;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(t->n, &t->normal));
  PetscCall(PetscMalloc1(t->n, &has));
  for (PetscInt i = 0; i < t->n; ++i) lacking += !(has[i] = own_normal(t, i, t->normal[i]));
  do { /* from neighbour to neighbour */
    before = lacking;
    for (PetscInt i = 0; i < t->n && lacking; ++i)
      if (!has[i] && borrowed_normal(t, has, i, t->normal[i])) has[i] = PETSC_TRUE, --lacking;
  } while (lacking && lacking < before);
  *without = -1;
  for (PetscInt i = 0; i < t->n && lacking && *without < 0; ++i)
    if (!has[i]) *without = i;
  PetscCall(PetscFree(has));
  PetscFunctionReturn(0);
}
