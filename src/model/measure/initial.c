/* What the state before the first step was like. */
#include "model/measure/measure.h"

static const MeasureNumber *const words[] = {
  WORD("lacked",
       "norm of the forces out of balance as given, over that of the weight or of the loads; without these of what "
       "walls, interfaces and boundaries bear; nan without a given stress",
       "", OF_MODEL, .kept = offsetof(Model, initial.lacked)),
  WORD("left", "the same in the equilibrium; nan where none was sought", "", OF_MODEL,
       .kept = offsetof(Model, initial.left)),
  WORD("moved", "largest displacement of a point (fem: of a node) on the way there, likewise", "m", OF_MODEL,
       .kept = offsetof(Model, initial.moved)),
  WORD("beyond", "points whose given stress was beyond their strength", "", OF_MODEL,
       .kept = offsetof(Model, initial.beyond)),
  NULL,
};

const Measure measure_initial = {.key = "initial",
                                 .takes = MEASURE_WORD,
                                 .number = {.help = "the state before the first step (initial: {equilibrium: ...})"},
                                 .words = words};
