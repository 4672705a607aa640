/* Triangles as files give them, and what is made of them on the way to facets. */
#pragma once
#include "wall/wall.h"

typedef struct {
  PetscInt n;
  PetscReal (*corner)[3][3]; /* n, m */
  PetscInt *number;          /* n, where they stand in the file, from 1 */
  PetscInt n_vertices;
  PetscReal *x; /* n_vertices x 3: corners that coincide are one vertex */
  PetscInt (*vertex)[3];
  PetscInt n_edges;
  PetscInt (*edge)[3];    /* edge k joins corners k and k + 1 */
  PetscInt (*side)[2];    /* n_edges: 3 triangle + k of the triangles that meet there, -1: none */
  PetscInt *met;          /* n_edges: how many they are */
  PetscReal (*normal)[3]; /* n, unit */
  PetscReal epsilon;      /* by what share numbers were rounded: those of files in single precision, as a rule */
  PetscReal tolerance;    /* m, what that cannot tell apart */
} Triangles;

PetscErrorCode TrianglesFree(Triangles *t);
/* Room for n of them: corner and number. */
PetscErrorCode TrianglesAllocate(PetscInt n, Triangles *t);

/* --- stl.c --- ASCII or binary; a mistake is told by `message`, which is empty otherwise. */
PetscErrorCode StlRead(const char *path, Triangles *t, size_t size, char *message);

/* --- terrain.c --- The solid below heights: its surface, its sides and a bottom. A post without a height is
 * told by `message`. */
PetscErrorCode TerrainTriangles(const struct Relief *relief, Triangles *t, size_t size, char *message);

/* --- weld.c --- */
/* Vertices of the corners; triangles that have lost one of their three are left out, the first of
 * them is number *first. */
PetscErrorCode TrianglesWeld(Triangles *t, PetscInt *left_out, PetscInt *first);
/* Edges, and who meets there. */
PetscErrorCode TrianglesJoin(Triangles *t);

/* --- orient.c --- */
/* Turn triangles so that neighbours agree: those of a piece that contradict most others, or that
 * make its volume negative if it is closed. pieces: of which there are so many; turned: how many
 * triangles; first: the number of one of them. two_faced: a triangle where that is impossible, or -1. */
PetscErrorCode TrianglesOrient(Triangles *t, PetscBool closed, PetscInt *pieces, PetscInt *turned, PetscInt *first,
                               PetscInt *two_faced);
/* The volume that they enclose, m3, if they are closed. */
PetscReal triangles_volume(const Triangles *t);
void triangles_turn_all(Triangles *t);
/* Unit normals; triangles thinner than the tolerance take those of their neighbours. Returns one
 * without any, or -1. */
PetscErrorCode TrianglesNormals(Triangles *t, PetscInt *without);
