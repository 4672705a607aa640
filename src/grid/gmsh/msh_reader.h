/* What the readers of the Gmsh versions share: a file in memory, a place in it, and the first
 * mistake found.
 *
 * No number is read beyond the end, whatever the file claims. After the first mistake every read
 * yields 0, so that the loops need only look at `failed`. */
#pragma once
#include "grid/gmsh/msh.h"

/* Physical groups of a geometric entity (version 4). */
typedef struct {
  PetscInt dim, tag, first_group, n_groups;
} MshEntity;

typedef struct {
  const char *path; /* for messages */
  char *data;
  const char *at, *end;
  PetscBool binary, failed;
  PetscInt major;
  size_t message_size;
  char *message;
  MshFile *msh;
  PetscInt n_entities, n_groups, group_capacity;
  MshEntity *entities;
  PetscInt *groups;
  PetscBool has_nodes, has_elements;
} MshReader;

/* Keep the first mistake, with the line where there are lines. */
void msh_fail(MshReader *r, const char *format, ...) PETSC_ATTRIBUTE_FORMAT(2, 3);
void msh_skip_space(MshReader *r);
void msh_skip_line(MshReader *r);
PetscInt64 msh_text_int(MshReader *r);
PetscReal msh_text_real(MshReader *r);
void msh_take(MshReader *r, size_t n, void *value);
/* Numbers of the three kinds that Gmsh writes, int, size_t and double, as text or binary. */
PetscInt64 msh_int(MshReader *r);
PetscInt64 msh_size(MshReader *r);
PetscReal msh_real(MshReader *r);
/* A number of things, each of at least so many bytes: a broken count must not ask for more memory
 * than the file can fill. */
PetscInt msh_count(MshReader *r, PetscInt64 n, PetscInt64 text_bytes, PetscInt64 binary_bytes, const char *what);
PetscInt msh_tag(MshReader *r, PetscInt64 tag, const char *what);

PetscErrorCode MshAddMark(MshFile *msh, PetscInt element, PetscInt64 group);
const MshType *msh_type(MshReader *r, PetscInt64 code, PetscInt64 element);
PetscErrorCode MshAllocateNodes(MshReader *r, PetscInt n);
PetscErrorCode MshAllocateElements(MshReader *r, PetscInt n);
void msh_position(MshReader *r, PetscInt node);

/* msh_version2.c, msh_version4.c: what follows the line with the section's name. */
PetscErrorCode MshReadNodes2(MshReader *r);
PetscErrorCode MshReadElements2(MshReader *r);
PetscErrorCode MshReadEntities(MshReader *r);
PetscErrorCode MshReadNodes4(MshReader *r);
PetscErrorCode MshReadElements4(MshReader *r);
