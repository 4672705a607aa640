/* A project of Kratos's material point method as far as talus can compute it. */
#pragma once
#include "import/kratos/mdpa.h"
#include "input/yaml/yaml.h"

#define KRATOS_NAME 256

/* A JSON file, read as the YAML that it is. */
typedef struct {
  YamlDocument *document;
  Diag *diag;
} KratosFile;

typedef struct {
  char part[KRATOS_NAME]; /* of the body's mesh */
  char name[KRATOS_NAME]; /* the same as a name of the case */
  char law[64];           /* talus's */
  PetscInt n_constants;   /* the rest of the material */
  const char *key[6];
  PetscReal constant[6];
  PetscInt points; /* per cell */
  PetscReal thickness, velocity[3];
  const YamlNode *node;
} KratosBody;

typedef enum { KRATOS_HELD, KRATOS_SLIP, KRATOS_LINE_LOAD, KRATOS_POINT_LOAD } KratosKind;

/* Something that acts at a part of the grid. */
typedef struct {
  KratosKind kind;
  char part[KRATOS_NAME], name[KRATOS_NAME];
  PetscBool set[3];         /* which components */
  PetscReal value[3];       /* m in each step, N/m2, N */
  char factor[KRATOS_NAME]; /* a formula of places and time; "": 1 */
} KratosAction;

typedef struct {
  char file[PETSC_MAX_PATH_LEN]; /* results that the project compares itself with */
  const YamlNode *variables;
  PetscBool points; /* of material points; else of the grid's nodes */
} KratosCheck;

typedef struct {
  Diag *diag;
  char folder[PETSC_MAX_PATH_LEN], name[KRATOS_NAME];
  KratosFile parameters, materials;
  Mdpa *grid, *body;
  PetscInt dim, n_steps;
  PetscReal start;     /* Kratos's time when the case begins, s; the case's own is 0 */
  PetscReal step, end; /* of the case's time */
  PetscBool dynamic, axisymmetric, mixed;
  PetscBool consistent; /* mass; else all of it at the nodes */
  PetscReal beta, gamma, bossak;
  PetscReal gravity[3];
  PetscInt n_bodies;
  KratosBody *bodies;
  PetscInt n_actions;
  KratosAction *actions;
  PetscInt n_checks;
  KratosCheck *checks;
} KratosProject;

/* A value of `mapping`; wrong kinds are errors at their place, and give the fallback. */
PetscReal kratos_number(const KratosFile *f, const YamlNode *mapping, const char *key, PetscReal fallback);
const char *kratos_text(const YamlNode *mapping, const char *key); /* "" if there is none */
PetscBool kratos_flag(const YamlNode *mapping, const char *key);
/* Up to three numbers; null is 0. PETSC_FALSE: there are none. */
PetscBool kratos_vector(const KratosFile *f, const YamlNode *mapping, const char *key, PetscReal value[3]);
/* "this is refused": an error at the node (at its key if `key`). */
#define kratos_refuse(f, node, ...) yaml_error((f)->document, (f)->diag, node, PETSC_FALSE, __VA_ARGS__)
/* Where a file that the project names lies: beside the parameters by its path or its last name. */
void kratos_path(const KratosProject *p, const char *named, const char *ending, char path[PETSC_MAX_PATH_LEN]);
/* The name of a model part behind its first point: "Background_Grid.Floor": "Floor". */
const char *kratos_part(const char *full);
/* Letters, digits and underscores of it, as names in a case are. */
void kratos_name(const char *part, char name[KRATOS_NAME]);

PetscErrorCode KratosOpen(Diag *diag, const char *path, KratosFile *file);
/* project.c: read all; diag has errors if it cannot be computed. */
PetscErrorCode KratosRead(const char *path, Diag *diag, KratosProject *project);
PetscErrorCode KratosClear(KratosProject *project);
PetscErrorCode KratosReadProcesses(KratosProject *project);
PetscErrorCode KratosReadMaterials(KratosProject *project);

/* Does one part of the grid hold the material by itself, from turning, too? If not, several may do so together. */
PetscBool kratos_is_held(const KratosProject *project);

/* Writers. */
PetscErrorCode KratosWriteGrid(const KratosProject *project, const char *file);
PetscErrorCode KratosWriteBody(const KratosProject *project, const char *file);
/* What is compared becomes a measure of the case and n rows of the reference. */
PetscErrorCode KratosWriteCase(const KratosProject *project, FILE *out);
PetscErrorCode KratosWriteReference(const KratosProject *project, FILE *measures, FILE *reference, PetscInt *n);
