/* A load that is raised to its limit. */
#include "model/measure/measure.h"

static const MeasureNumber *const words[] = {
  WORD("value", "the largest load, when the search is over; until then nan", "", OF_MODEL,
       .kept = offsetof(Model, raised.value)),
  WORD("load", "the load now: factor of forces, or force along a prescribed displacement in N", "", OF_MODEL,
       .kept = offsetof(Model, raised.load)),
  WORD("displacement", "of the prescribed boundary; of a load its work over its force", "m", OF_MODEL,
       .kept = offsetof(Model, raised.displacement)),
  NULL,
};

const Measure measure_limit_load = {
  .key = "limit_load",
  .takes = MEASURE_WORD,
  .number = {.unit = "", .help = "a load that is raised until nothing more holds (analysis: {type: limit-load})"},
  .words = words};
