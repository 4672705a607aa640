/* What a point is led through: the language of the file is told in docs/element.md. */
#pragma once
#include "element/drive.h"
#include "element/element.h"
#include "input/yaml/yaml.h"

/* A test of the laboratory: which components it prescribes. The y axis is the axis of the sample. */
typedef struct {
  const char *name, *help;
  const char *unit;    /* of where it goes */
  int component;       /* that goes there... */
  PetscReal sign;      /* ...times this */
  PetscBool stress[6]; /* is the component's stress prescribed? Else its strain */
  PetscBool isotropic; /* xx and zz go along with yy */
} ElementTest;
extern const ElementTest *const element_tests[]; /* ended by NULL */

typedef struct {
  PetscReal value[6];
  PetscBool given[6];
} ElementComponents;

/* A part of the path: of a test, or components by themselves. */
typedef struct {
  const ElementTest *test; /* NULL: components */
  PetscBool has_to;
  PetscReal to;
  ElementComponents strain, stress;
  PetscBool relative; /* `to` and stresses count from where the stage begins, too */
  PetscBool undrained;
  PetscInt steps;
  PetscReal seconds; /* that it takes; 0: time does not count */
} ElementStage;

typedef struct {
  char *title;
  MaterialSpec own; /* the file's, if it is not that of a case */
  Material material;
  ElementComponents start; /* effective Cauchy stress, Pa, tension positive */
  PetscReal pore;          /* at the start, Pa */
  PetscReal divided;       /* by which the case divides the strength; 0: by nothing */
  PetscReal cell;          /* size of the point's cell, m; 0: the law does not ask, or nobody knows */
  PetscInt n_stages;
  ElementStage *stages;
  YamlDocument *document; /* NULL: the material is that of a case... */
  Case *c;                /* ...this one */
} ElementSpec;

/* On a mistake *spec stays NULL, and diag says file:line:column. */
PetscErrorCode ElementRead(const ElementOptions *options, Diag *diag, ElementSpec **spec);
PetscErrorCode ElementSpecDestroy(ElementSpec **spec);

/* What the stage prescribes, and where it leads it from where the point is. */
void element_stage(const ElementStage *stage, const DrivePoint *point, DriveControl *control, PetscReal from[6],
                   PetscReal to[6]);
/* "triaxial, undrained"; "strain yy, stress xx". Returns text. */
const char *element_stage_name(const ElementStage *stage, size_t size, char *text);
/* Material i of a case as points of a run begin with it: divided strength, and the size of their cells. */
PetscErrorCode ElementMaterial(const Case *c, PetscInt i, Diag *diag, ElementSpec *spec);
/* The stages and the start that a command line tells; mistakes go to diag. */
PetscErrorCode ElementWords(const ElementOptions *options, Diag *diag, ElementSpec *spec);
