/* What a shape holds, or all the grid: mass and volume. */
#include "model/measure/measure.h"

enum { MASS, UNDEFORMED, CURRENT };

/* Of a body that is gone it is known: 0. */
static PetscErrorCode Content(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  const PetscInt body = measure_body(m, s);
  const int which = measure_number(s)->which;
  const PetscReal *amount = m->points->real[which == MASS ? POINT_MASS : POINT_VOLUME], *J = m->points->real[POINT_J];
  PetscReal sum = 0;

  (void)index;
  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < m->points->n; ++p)
    sum += measure_share(m, s, body, p) * amount[p] * (which == CURRENT ? J[p] : 1);
  PetscCall(MPIU_Allreduce(&sum, value, 1, MPIU_REAL, MPI_SUM, m->comm));
  PetscFunctionReturn(0);
}

const Measure measure_mass = {
  .key = "mass",
  .takes = MEASURE_WORD,
  .number = {.unit = "kg", .help = "mass"},
  .words = (const MeasureNumber *const[]){
    WORD("total", "of all points, or of the body given by `of`, and of these only what lies in the shape `in`",
         .in = PETSC_TRUE, .value = Content, .which = MASS),
    NULL}};
const Measure measure_volume = {
  .key = "volume",
  .takes = MEASURE_WORD,
  .number = {.unit = "m3", .help = "volume (per m of thickness in plane strain, of the full circle in axisymmetry)"},
  .words = (const MeasureNumber *const[]){
    WORD("undeformed",
         "that the material has without stress; of laws that know no such state (modified Cam clay), at the start",
         .in = PETSC_TRUE, .value = Content, .which = UNDEFORMED),
    WORD("current", "that it has now, as its law sees it: of points that flew apart more than they fill",
         .in = PETSC_TRUE, .value = Content, .which = CURRENT),
    NULL}};
