/* How points hand what they have to nodes. */
#pragma once
#include "solve/contact/contact.h"

/* A shape function of the material point; those that dip below zero would divide by little. */
static inline PetscReal contact_weight(const Contact *s, PetscInt e) { return PetscMax(0, s->N[e] - s->lead[e]); }
