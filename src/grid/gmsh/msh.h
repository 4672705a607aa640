/* A Gmsh file as it stands, on rank 0 only. */
#pragma once
#include "base/diag/diag.h"
#include "case/case.h"

#define MSH_MAX_NODES 8

typedef struct {
  const char *name;
  PetscInt code, dim, nodes; /* code: Gmsh's number; nodes: 0 for types that talus does not know */
} MshType;

typedef struct {
  PetscInt dim, tag;
  char *name;
} MshName;

/* All elements of all dimensions, in the order of the file. Nodes are named by their index in x. */
typedef struct {
  PetscInt n_nodes, *node_tag;
  PetscReal *x; /* n_nodes x 3 */
  PetscInt n_elements;
  const MshType **type;
  PetscInt *tag, *entity; /* entity: the geometric curve, surface or volume it meshes */
  PetscInt *node;         /* n_elements x MSH_MAX_NODES */
  PetscInt n_marks, mark_capacity, *mark_element,
    *mark_group; /* element mark_element[k] is in physical group mark_group[k] */
  PetscInt n_names;
  MshName *names;
} MshFile;

/* Read versions 2.2 and 4.1, ASCII or binary. Not collective. On a mistake in the file *msh is NULL
 * and `message` says where and what; the file is called `shown` in it. */
PetscErrorCode MshRead(const char *path, const char *shown, MshFile **msh, size_t size, char *message);
PetscErrorCode MshDestroy(MshFile **msh);

/* Run gmsh on a .geo (not collective); `output` gets the name of a temporary file that the caller
 * removes. */
PetscErrorCode GeoRun(const char *path, PetscInt dim, PetscInt n_parameters, const NamedValue *parameters, size_t size,
                      char *output, size_t message_size, char *message);

/* The file that a grid names, which gmsh may have to make of a .geo first. Not collective; mistakes
 * go to diag at `path`, and *msh stays NULL. */
PetscErrorCode MshLoad(const GridSpec *spec, PetscInt dim, const char *path, Diag *diag, MshFile **msh);
/* Collective. An error for each of the grid's parameters that no .geo of the case mentions. */
PetscErrorCode GeoCheckParameters(MPI_Comm comm, const Case *c, Diag *diag);
/* Not collective. Told of a .geo, of what it includes and merges, and of what these do; of no other file. */
typedef void GeoFile(void *context, const char *file);
void geo_files(const char *file, GeoFile *each, void *context);
