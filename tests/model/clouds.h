/* The bases of clouds as cases have them that say no more than their names. */
#pragma once
#include "case/case.h"

static const BasisSpec usual_lme = {
  .kind = "lme", .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
static const BasisSpec usual_mls = {
  .kind = "mls", .effective_radius = 1, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
