/* Contact that springs hold, in explicit dynamics: what is pressed stands deeper than the surface. The state
 * that a carrier keeps tells it from others. */
#pragma once
#include "solve/contact/contact.h"

/* Is added to the state. */
#define CONTACT_SPRING 0.25

static inline PetscBool contact_is_sprung(PetscReal state)
{
  return state - PetscFloorReal(state) > CONTACT_SPRING / 2;
}
