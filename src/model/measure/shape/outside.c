/* What has left the grid. */
#include "model/measure/measure.h"

static const MeasureNumber *const words[] = {
  WORD("removed", "points that `outside: remove` has taken out since the start, a number", "", OF_MODEL,
       .kept = offsetof(Model, outside.removed)),
  WORD("mass", "their mass, kg", "kg", OF_MODEL, .kept = offsetof(Model, outside.mass)),
  WORD("held", "points that `outside: keep-on-boundary` put back in the last step, a number", "", OF_MODEL,
       .kept = offsetof(Model, outside.held_now)),
  NULL,
};

const Measure measure_outside = {.key = "outside",
                                 .takes = MEASURE_WORD,
                                 .number = {.unit = "kg or a number", .help = "what has left the grid (grid.outside)"},
                                 .words = words};
const Measure measure_outside_momentum = {
  .key = "outside_momentum",
  .no_radial = PETSC_TRUE,
  .number = {
    .unit = "kg m/s",
    .help = "momentum that went with points that left the grid: with those removed, and in stopping those kept on its "
            "boundary",
    .of = OF_MODEL,
    .kept = offsetof(Model, outside.momentum)}};
