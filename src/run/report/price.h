/* Which of implicit and explicit dynamics a case is cheaper with. */
#pragma once
#include "model/model.h"

/* Collective. What explicit dynamics takes, or would, beside implicit steps; empty where there is no choice. */
PetscErrorCode PriceTell(const Model *model, size_t size, char *told);
