/* Energies: those of bodies, and those that energy.c keeps for the whole model. */
#include "model/measure/measure.h"
#include "model/model_private.h"

/* Of the whole model walls with mass count, too: the first rank's, since ranks are added up. */
static PetscReal of_walls(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscMPIInt rank;
  (void)MPI_Comm_rank(m->comm, &rank);
  return rank || body >= 0 || s->has_in ? 0 : rigid_motion(m);
}

static PetscReal kinetic(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal sum = of_walls(m, s, body);
  for (PetscInt p = 0; p < m->points->n; ++p) {
    const PetscReal *v = point_real(m->points, POINT_V, p);
    PetscReal square = 0;
    for (PetscInt d = 0; d < m->dim; ++d) square += v[d] * v[d];
    sum += 0.5 * measure_share(m, s, body, p) * m->points->real[POINT_MASS][p] * square;
  }
  return sum;
}

static PetscReal elastic(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal energy[LAW_BATCH], sum = 0;
  for (PetscInt first = 0, n; first < m->points->n; first += n) {
    n = PetscMin(LAW_BATCH, m->points->n - first);
    model_point_energies(m, first, n, energy);
    for (PetscInt p = first; p < first + n; ++p) {
      const PetscReal share = measure_share(m, s, body, p);
      if (share > 0) sum += share * m->points->real[POINT_VOLUME][p] * energy[p - first];
    }
  }
  return sum;
}

static PetscReal mechanical(const Model *m, const MeasureSpec *s, PetscInt body)
{
  return kinetic(m, s, body) + elastic(m, s, body);
}

static PetscReal dissipated(const Model *m, const MeasureSpec *s, PetscInt body)
{
  PetscReal work = 0;
  for (PetscInt p = 0; p < m->points->n; ++p) work += measure_share(m, s, body, p) * m->points->real[POINT_WORK][p];
  return work - elastic(m, s, body);
}

static PetscErrorCode External(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Energies e;

  (void)s, (void)index;
  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  *value = e.external + e.boundary;
  PetscFunctionReturn(0);
}

/* What has come in against where it is now, over the largest of all. Of what is no more than steps leave open a share
 * means nothing. */
static PetscErrorCode BalanceValue(Model *m, const MeasureSpec *s, PetscInt index, PetscReal *value)
{
  Energies e;
  PetscReal largest = 0, sum = 0;

  (void)s, (void)index;
  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  const PetscReal terms[] = {e.kinetic,   e.elastic, e.dissipated, e.damped,    e.transfer, e.friction,
                             e.numerical, e.outside, -e.external,  -e.boundary, -e.start};
  for (size_t k = 0; k < PETSC_STATIC_ARRAY_LENGTH(terms); ++k) {
    sum += terms[k];
    largest = PetscMax(largest, PetscAbsReal(terms[k]));
  }
  *value = largest > energy_unresolved(m) ? sum / largest : 0;
  PetscFunctionReturn(0);
}

static const MeasureNumber *const words[] = {
  WORD("kinetic", "energy of motion; of the whole model that of walls with mass that are there, too", .sum = kinetic),
  WORD("elastic", "stored in the material", .sum = elastic),
  WORD("mechanical", "kinetic and elastic: what an elastic body that is left alone keeps", .sum = mechanical),
  WORD("dissipated", "work of the stress that is not stored: plastic dissipation", .sum = dissipated),
  WORD("external", "work done by loads, gravity and prescribed motion", .of = OF_MODEL, .value = External),
  WORD("damped", "taken by Rayleigh damping", .of = OF_MODEL, .kept = offsetof(Model, damped_energy)),
  WORD("transfer", "lost between points and grid, and at nodes that stop material", .of = OF_MODEL,
       .kept = offsetof(Model, transfer_energy)),
  WORD("held", "of transfer: taken by what holds nodes that domains of points hardly reach", .of = OF_MODEL,
       .kept = offsetof(Model, held_energy)),
  WORD("friction", "taken by sliding along walls and other bodies", .of = OF_MODEL,
       .kept = offsetof(Model, friction_energy)),
  WORD("numerical",
       "taken by the damping of the time scheme (bossak, beta, gamma), less what `stabilisation.room` makes",
       .of = OF_MODEL, .kept = offsetof(Model, numerical_energy)),
  WORD("outside", "gone with points that left the grid: with those removed, and in stopping those kept on its boundary",
       .of = OF_MODEL, .kept = offsetof(Model, outside.energy)),
  WORD("balance",
       "kinetic + elastic + dissipated + damped + transfer + friction + numerical + outside - external, less its "
       "value at the start, over the largest of these (no unit): 0 if all is accounted for",
       .unit = "", .of = OF_MODEL, .value = BalanceValue),
  NULL,
};

const Measure measure_energy = {
  .key = "energy", .takes = MEASURE_WORD, .number = {.unit = "J", .help = "energy"}, .words = words};
