/* Where one curve has values and another one has none. */
#pragma once
#include "picture/compare/difference.h"

typedef struct {
  PetscBool any;
  PetscReal from, to; /* first and last time of it, s */
} Lack;

/* Where has `a` no value (NaN, infinite) while b has one? Within the time of both; what lies between an entry with a
 * value and one without counts as neither. Returns lack->any. */
PetscBool curve_lack(const Curve *a, const Curve *b, Lack *lack);
