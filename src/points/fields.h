/* The table of fields behind Points, for this room only.
 *
 * Whatever treats all fields alike (growing, compacting, sorting, migrating) walks over this table,
 * so that a new field is one new line and can never be forgotten by one of them. */
#pragma once
#include "points/points.h"

enum { FIELD_ID = POINT_N_REAL, FIELD_CELL, FIELD_BODY, FIELD_MATERIAL, N_FIELDS };

/* Storage of a field and the bytes that one point takes in it (0: the field does not exist). */
void *points_field(const Points *points, int field, size_t *bytes);
void points_set_field(Points *points, int field, void *data);
/* Bytes of one point in all fields together. */
size_t points_bytes(const Points *points);

/* to[k] = from[index[k]], elements of so many bytes. */
void field_gather(void *to, const void *from, size_t bytes, PetscInt n, const PetscInt *index);

/* Copy the points index[0 .. n) into buffer (n x points_bytes), field after field. */
void points_pack(const Points *points, PetscInt n, const PetscInt *index, char *buffer);
/* Append n points from such a buffer. */
PetscErrorCode PointsUnpack(Points *points, PetscInt n, const char *buffer);
/* Make room for n more points; the capacity grows geometrically. */
PetscErrorCode PointsReserveMore(Points *points, PetscInt n);
