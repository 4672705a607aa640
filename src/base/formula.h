/* Arithmetic on a line of text: numbers, names, + - * / ^, brackets, pi and functions of one number
 * (sqrt exp log sin cos tan atan abs; angles in rad) or of two (min max). */
#pragma once
#include <petscsys.h>

#define FORMULA_SIGNS \
  "numbers, + - * / ^, brackets, pi, sqrt exp log sin cos tan atan abs, min max of two" /* in helps */

#define FORMULA_LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789" /* of names */
#define FORMULA_NAME 64                                                                   /* bytes of a name at most */

typedef struct {
  /* The value of a name; known = PETSC_FALSE: there is none. */
  PetscErrorCode (*value)(void *context, const char *name, PetscBool *known, PetscReal *value);
  void *context;
  const char *at;          /* the text, and as it is read what is left of it */
  const char *wrong;       /* the rest that makes no sense, the text being well-formed before it; NULL: all does */
  char name[FORMULA_NAME]; /* the name that is not known, if that is why */
  int depth;
} Formula;

/* Of a formula with `value`, `context` and `at` alone. nan if it is wrong. Collective if `value` is. */
PetscErrorCode FormulaValue(Formula *formula, PetscReal *value);
