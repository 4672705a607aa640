/* Arithmetic by recursive descent: a sum of products of powers of numbers, names and brackets. */
#include "base/formula.h"
#include <math.h>
#include <string.h>

#define DEEPEST 50 /* brackets and signs in one another: no text may use up the stack */

static const struct {
  const char *name;
  double (*function)(double);
} functions[] = {{"sqrt", sqrt}, {"exp", exp}, {"log", log},   {"sin", sin},
                 {"cos", cos},   {"tan", tan}, {"atan", atan}, {"abs", fabs}};

static const struct {
  const char *name;
  double (*function)(double, double);
} functions_of_two[] = {{"min", fmin}, {"max", fmax}};

static PetscErrorCode Sum(Formula *f, PetscReal *value);

static void skip(Formula *f) { f->at += strspn(f->at, " \t"); }

/* Is this the next character? Then behind it. */
static PetscBool takes(Formula *f, char c)
{
  skip(f);
  if (f->wrong || *f->at != c) return PETSC_FALSE;
  ++f->at;
  return PETSC_TRUE;
}

static void fail(Formula *f, const char *at)
{
  if (!f->wrong) f->wrong = at;
}

static PetscErrorCode Bracket(Formula *f, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(Sum(f, value));
  if (!takes(f, ')')) fail(f, f->at);
  PetscFunctionReturn(0);
}

/* A function and its brackets; *known = PETSC_FALSE if the name is none, or no bracket opens. */
static PetscErrorCode Function(Formula *f, const char *name, PetscBool *known, PetscReal *value)
{
  PetscReal first;

  PetscFunctionBeginUser;
  *known = PETSC_TRUE;
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(functions); ++k)
    if (!strcmp(name, functions[k].name) && takes(f, '(')) {
      PetscCall(Bracket(f, value));
      *value = functions[k].function(*value);
      PetscFunctionReturn(0);
    }
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(functions_of_two); ++k)
    if (!strcmp(name, functions_of_two[k].name) && takes(f, '(')) {
      PetscCall(Sum(f, &first));
      if (!takes(f, ',')) fail(f, f->at);
      PetscCall(Bracket(f, value));
      *value = functions_of_two[k].function(first, *value);
      PetscFunctionReturn(0);
    }
  *known = PETSC_FALSE;
  PetscFunctionReturn(0);
}

static PetscErrorCode Name(Formula *f, PetscReal *value)
{
  const char *begin = f->at;
  const size_t length = strspn(begin, FORMULA_LETTERS);
  PetscBool known = length > 0 && length < FORMULA_NAME;

  PetscFunctionBeginUser;
  if (known) {
    char name[FORMULA_NAME] = "";
    memcpy(name, begin, length);
    f->at += length;
    if (!strcmp(name, "pi")) {
      *value = PETSC_PI;
      PetscFunctionReturn(0);
    }
    PetscCall(Function(f, name, &known, value));
    if (known) PetscFunctionReturn(0);
    PetscCall(f->value(f->context, name, &known, value));
    if (!known) strcpy(f->name, name);
  }
  if (!known) fail(f, begin);
  PetscFunctionReturn(0);
}

static PetscErrorCode Atom(Formula *f, PetscReal *value)
{
  PetscFunctionBeginUser;
  *value = NAN;
  skip(f);
  if (f->wrong) PetscFunctionReturn(0);
  if (takes(f, '(')) PetscCall(Bracket(f, value));
  else if (*f->at == '.' || (*f->at >= '0' && *f->at <= '9')) {
    char *end;
    *value = strtod(f->at, &end);
    if (end == f->at || f->at[strspn(f->at, ".0123456789")] == 'x') fail(f, f->at); /* 0x10 is not what C reads */
    f->at = end;
  } else PetscCall(Name(f, value));
  PetscFunctionReturn(0);
}

/* -2^2 is -4, and 2^-1 a half. */
static PetscErrorCode Power(Formula *f, PetscReal *value)
{
  PetscReal exponent;

  PetscFunctionBeginUser;
  *value = NAN;
  if (++f->depth > DEEPEST) fail(f, f->at);
  else if (takes(f, '-')) {
    PetscCall(Power(f, value));
    *value = -*value;
  } else if (takes(f, '+')) PetscCall(Power(f, value));
  else {
    PetscCall(Atom(f, value));
    if (takes(f, '^')) {
      PetscCall(Power(f, &exponent));
      *value = pow(*value, exponent);
    }
  }
  --f->depth;
  PetscFunctionReturn(0);
}

static PetscErrorCode Product(Formula *f, PetscReal *value)
{
  PetscReal factor;

  PetscFunctionBeginUser;
  PetscCall(Power(f, value));
  for (;;) {
    const PetscBool times = takes(f, '*');
    if (!times && !takes(f, '/')) break;
    PetscCall(Power(f, &factor));
    *value = times ? *value * factor : *value / factor;
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode Sum(Formula *f, PetscReal *value)
{
  PetscReal term;

  PetscFunctionBeginUser;
  PetscCall(Product(f, value));
  for (;;) {
    const PetscBool plus = takes(f, '+');
    if (!plus && !takes(f, '-')) break;
    PetscCall(Product(f, &term));
    *value += plus ? term : -term;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode FormulaValue(Formula *f, PetscReal *value)
{
  PetscFunctionBeginUser;
  PetscCall(Sum(f, value));
  skip(f);
  if (*f->at) fail(f, f->at);
  if (f->wrong || isnan(*value)) *value = NAN; /* machines make some with a sign */
  PetscFunctionReturn(0);
}
