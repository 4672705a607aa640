/* By what the strength may be divided. */
#include "model/measure/measure.h"

static const MeasureNumber *const words[] = {
  WORD("value",
       "the middle of the bracket, when the search is over; nan until then, and where Newton's method lost its way "
       "before anything slid",
       "", OF_MODEL, .kept = offsetof(Model, strength.value)),
  WORD("lower", "the largest factor with an equilibrium so far; nan: none", "", OF_MODEL,
       .kept = offsetof(Model, strength.lower)),
  WORD("upper", "the smallest factor without one so far; nan: none", "", OF_MODEL,
       .kept = offsetof(Model, strength.upper)),
  WORD("factor", "that divides the strength in this state; 0: nothing yields yet", "", OF_MODEL,
       .kept = offsetof(Model, strength.factor)),
  NULL,
};

const Measure measure_factor_of_safety = {
  .key = "factor_of_safety",
  .takes = MEASURE_WORD,
  .number = {.unit = "", .help = "by what the strength may be divided (analysis: {type: factor-of-safety})"},
  .words = words};
