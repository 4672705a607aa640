#include "element/drive.h"
#include <math.h>
#include <string.h>
#include "base/math/svd.h"
#include "base/math/tensor.h"

#define N_UNKNOWNS 7 /* e, and the pore pressure over the stiffness */
#define STRESS_TOLERANCE 1e-10
#define STRAIN_TOLERANCE 1e-13
#define SINGULAR 1e-9 /* singular values that are none: of a point that flows */
#define MOST_HALVINGS 10
#define MOST_STRETCH 0.5 /* largest change of a strain in one iteration */

typedef struct {
  const DriveControl *control;
  PetscReal target[6], log_volume, pore;
} Aim;

/* A try: unknowns, what the law makes of them, and the residual. */
typedef struct {
  DrivePoint point;
  PetscReal tau[6], c[36], residual[N_UNKNOWNS];
  PetscReal size; /* of the residual, over what is allowed: converged at 1 */
  LawStatus status;
} Try;

void drive_gradient(const PetscReal e[6], PetscReal F[9])
{
  const PetscReal D[3] = {exp(e[0]), exp(e[1]), exp(e[2])};
  memset(F, 0, 9 * sizeof *F);
  for (int k = 0; k < 3; ++k) F[4 * k] = D[k];
  F[1] = e[3] * D[1];
  F[5] = e[4] * D[2];
  F[2] = e[5] * D[2];
}

void drive_values(const DrivePoint *p, const DriveControl *control, PetscReal values[6])
{
  for (int k = 0; k < 6; ++k) values[k] = control->stress[k] ? p->stress[k] - (k < 3 ? p->pore : 0) : p->strain[k];
}

static LawStatus update(const DrivePoint *old, DrivePoint *point, PetscReal tau[6], PetscReal c[36])
{
  const Material *m = old->material;
  PetscReal F[9], before[9], inverse[9], dF[9];
  drive_gradient(point->strain, F);
  drive_gradient(old->strain, before);
  tensor_inverse(before, inverse);
  tensor_multiply(F, inverse, dF);
  const LawStatus status = m->law->update(m->parameters, 1, dF, old->state, point->state, tau, c);
  for (int k = 0; k < 6; ++k) point->stress[k] = tau[k] / (point->J * tensor_det(F));
  return status;
}

PetscBool drive_start(DrivePoint *p, Material *material, const PetscReal stress[6], PetscReal pore)
{
  PetscReal tau[6], c[36], norm2 = 0, work = 0;
  DrivePoint start = {.material = material, .pore = pore, .J = 1}, asked = start;
  for (int k = 0; k < 6; ++k) norm2 += stress[k] * stress[k];
  law_initial_state(material->law, start.state);
  if (material->law->place) material->law->place((PetscReal[]){0, 0, 0}, start.state);
  if (norm2 > 0 && !material->law->initial_stress(material->parameters, stress, start.state)) return PETSC_FALSE;
  *p = start;
  if (update(&start, &asked, tau, c) != LAW_OK) return PETSC_FALSE; /* no increment: its state is none */
  for (int k = 0; k < 6; ++k) work += tau[k] * stress[k];
  if (norm2 > 0) p->J = work / norm2;
  for (int k = 0; k < 6; ++k) p->stress[k] = tau[k] / p->J;
  return PETSC_TRUE;
}

/* Residuals over the stiffness for stresses, as they are for strains; their size over what is allowed. */
static void evaluate(const DrivePoint *old, const Aim *aim, Try *try)
{
  const PetscReal stiffness = old->material->wave_modulus;
  PetscReal value[6], stress = 0, size = 0;
  try->status = update(old, &try->point, try->tau, try->c);
  drive_values(&try->point, aim->control, value);
  for (int k = 0; k < 6; ++k) {
    stress = PetscMax(stress, fabs(try->point.stress[k]));
    if (aim->control->stress[k]) stress = PetscMax(stress, fabs(aim->target[k]));
  }
  const PetscReal allowed = STRESS_TOLERANCE * stress / stiffness + STRAIN_TOLERANCE * 0.1;
  for (int k = 0; k < 6; ++k) {
    try->residual[k] = (value[k] - aim->target[k]) / (aim->control->stress[k] ? stiffness : 1);
    size = PetscMax(size, fabs(try->residual[k]) / (aim->control->stress[k] ? allowed : STRAIN_TOLERANCE));
  }
  const PetscReal *e = try->point.strain;
  try->residual[6] =
    aim->control->undrained ? e[0] + e[1] + e[2] - aim->log_volume : (try->point.pore - aim->pore) / stiffness;
  try->size = PetscMax(size, fabs(try->residual[6]) / STRAIN_TOLERANCE);
}

/* dF/de_j F^-1: a stretch of the sheared lines, or a shear of what is above. */
static void rate_of(const PetscReal e[6], int j, PetscReal l[9])
{
  const PetscReal shear[9] = {1, e[3], e[5], 0, 1, e[4], 0, 0, 1};
  PetscReal inverse[9], left[9] = {0};
  tensor_inverse(shear, inverse);
  if (j < 3)
    for (int i = 0; i < 3; ++i) left[3 * i + j] = shear[3 * i + j];
  else left[3 * PetscMin(voigt_row[j], voigt_column[j]) + PetscMax(voigt_row[j], voigt_column[j])] = 1;
  tensor_multiply(left, inverse, l);
}

/* d sigma by a rate l: (c : d + l tau + tau l^T) / J - sigma tr l. */
static void stress_rate(const Try *try, const PetscReal l[9], PetscReal rate[6])
{
  const PetscReal *e = try->point.strain, J = try->point.J * exp(e[0] + e[1] + e[2]), trace = l[0] + l[4] + l[8];
  PetscReal tau[9], product[9], d[6];
  sym_to_full(try->tau, tau);
  tensor_multiply(l, tau, product);
  for (int k = 0; k < 6; ++k) {
    const int r = voigt_row[k], s = voigt_column[k];
    d[k] = k < 3 ? l[4 * k] : l[3 * r + s] + l[3 * s + r];
  }
  for (int k = 0; k < 6; ++k) {
    const int r = voigt_row[k], s = voigt_column[k];
    PetscReal sum = product[3 * r + s] + product[3 * s + r];
    for (int i = 0; i < 6; ++i) sum += try->c[6 * k + i] * d[i];
    rate[k] = sum / J - try->point.stress[k] * trace;
  }
}

/* Derivative of the residual by e and by the pore pressure over the stiffness. */
static void jacobian(const Aim *aim, const Try *try, PetscReal A[N_UNKNOWNS * N_UNKNOWNS])
{
  const PetscReal stiffness = try->point.material->wave_modulus;
  PetscReal l[9], rate[6];
  memset(A, 0, N_UNKNOWNS * N_UNKNOWNS * sizeof *A);
  for (int j = 0; j < 6; ++j) {
    rate_of(try->point.strain, j, l);
    stress_rate(try, l, rate);
    for (int k = 0; k < 6; ++k) A[N_UNKNOWNS * k + j] = aim->control->stress[k] ? rate[k] / stiffness : k == j;
  }
  for (int k = 0; k < 3; ++k) {
    if (aim->control->stress[k]) A[N_UNKNOWNS * k + 6] = -1;
    if (aim->control->undrained) A[N_UNKNOWNS * 6 + k] = 1;
  }
  if (!aim->control->undrained) A[N_UNKNOWNS * 6 + 6] = 1;
}

/* Where the law cannot follow, or the step is far, go less far. */
static void step(const DrivePoint *old, const Aim *aim, Try *try)
{
  const Try before = *try;
  PetscReal A[N_UNKNOWNS * N_UNKNOWNS], dx[N_UNKNOWNS], damping = 1, largest = 0;
  jacobian(aim, try, A);
  svd_solve(N_UNKNOWNS, SINGULAR, A, try->residual, dx);
  for (int k = 0; k < 6; ++k) largest = PetscMax(largest, fabs(dx[k]));
  if (largest > MOST_STRETCH) damping = MOST_STRETCH / largest;
  for (int tries = 0; tries < 8; ++tries, damping *= 0.5) {
    *try = before;
    for (int k = 0; k < 6; ++k) try->point.strain[k] -= damping * dx[k];
    if (aim->control->undrained) try->point.pore -= damping * dx[6] * old->material->wave_modulus;
    evaluate(old, aim, try);
    if (try->status == LAW_OK && isfinite(try->size)) break;
  }
}

/* From a converged point to the aim. A point that flows at a vertex of its yield surface leaves parts
 * of the strain undecided: the shortest correction is taken, so that what is alike stays alike. */
static PetscBool newton(DrivePoint *point, const Aim *aim, DriveReport *report)
{
  Try try = {.point = *point};
  evaluate(point, aim, &try);
  for (report->n = 0; report->n < DRIVE_ITERATIONS; ++report->iterations) {
    report->status = try.status;
    report->residual[report->n++] = try.size;
    if (try.status != LAW_OK || !isfinite(try.size)) return PETSC_FALSE;
    if (try.size <= 1) {
      report->passed = PetscMax(report->passed, material_passed(point->material, point->state, try.point.state));
      *point = try.point;
      return PETSC_TRUE;
    }
    step(point, aim, &try);
  }
  return PETSC_FALSE;
}

PetscBool drive_advance(DrivePoint *point, const DriveControl *control, const PetscReal from[6], const PetscReal to[6],
                        DriveReport *report)
{
  const PetscReal *e = point->strain;
  Aim aim = {.control = control, .log_volume = e[0] + e[1] + e[2], .pore = point->pore};
  PetscReal part = 1;
  report->reached = 0;
  while (report->reached < 1) {
    const PetscReal next = PetscMin(report->reached + part, 1);
    const PetscReal passes = (next - report->reached) * control->seconds;
    if (passes > 0) materials_step(1, point->material, point->time, passes, PETSC_TRUE);
    for (int k = 0; k < 6; ++k) aim.target[k] = next == 1 ? to[k] : from[k] + next * (to[k] - from[k]);
    if (newton(point, &aim, report)) {
      ++report->substeps;
      report->reached = next;
      point->time += passes;
      part *= 2;
    } else if ((part *= 0.5) < ldexp(1, -MOST_HALVINGS)) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}
