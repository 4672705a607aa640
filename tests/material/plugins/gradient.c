/* A law for the tests of material/plugin: talus's own neo-hookean, from the increment of the deformation gradient, with
 * its two moduli as parameters. GIVES=0: without a tangent. What is wrong with it else: BAD. */
#include <math.h>
#include <string.h>
#include <talus/law.h>

#ifndef BAD
#define BAD 0
#endif
#define COMPONENTS (BAD == 3 ? 4 : BAD == 9 ? 1 : 6)

enum { LAMBDA, MU };
static const int row[6] = {0, 1, 2, 0, 1, 2}, column[6] = {0, 1, 2, 1, 2, 0};

static const TalusLawParameter parameters[] = {
  {BAD == 1 ? "young" : "lambda", "Pa", "first of Lame", 0, 1e30, NAN, 0},
  {"mu", "Pa", "second of Lame", 0, 1e30, BAD == 2 ? -1 : NAN, TALUS_LAW_OPEN_MIN},
  {.name = 0},
};
static const TalusLawState fields[] = {
  {"b", "", "left Cauchy-Green tensor", COMPONENTS, {1, 1, 1, 0, 0, 0}},
  {.name = 0},
};

static int update(const double *p, const TalusLawStep *step, const double dF[9], const double *old, double *b,
                  double tau[6], double *c)
{
  static const int voigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  (void)step;
  for (int k = 0; k < 6; ++k) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += dF[3 * row[k] + i] * old[voigt[i][j]] * dF[3 * column[k] + j];
    b[k] = sum;
  }
  const double det =
    b[0] * (b[1] * b[2] - b[4] * b[4]) - b[3] * (b[3] * b[2] - b[4] * b[5]) + b[5] * (b[3] * b[4] - b[1] * b[5]);
  const double log_J = 0.5 * log(det);
  for (int k = 0; k < 6; ++k) tau[k] = p[MU] * (b[k] - (k < 3)) + (k < 3 ? p[LAMBDA] * log_J : 0);
  for (int k = 0; c && k < 36; ++k) {
    const int i = k / 6, j = k % 6;
    const double shear = p[MU] - p[LAMBDA] * log_J;
    c[k] = (i < 3 && j < 3 ? p[LAMBDA] : 0) + (i == j ? (i < 3 ? 2 : 1) * shear : 0);
  }
  return TALUS_LAW_OK;
}

static double energy(const double *p, const double strain[6], const double *b)
{
  const double det =
    b[0] * (b[1] * b[2] - b[4] * b[4]) - b[3] * (b[3] * b[2] - b[4] * b[5]) + b[5] * (b[3] * b[4] - b[1] * b[5]);
  const double log_J = 0.5 * log(det);
  (void)strain;
  return 0.5 * p[LAMBDA] * log_J * log_J - p[MU] * log_J + 0.5 * p[MU] * (b[0] + b[1] + b[2] - 3);
}

static const TalusLaw law = {
  .version = BAD == 4 ? TALUS_LAW_VERSION + 1 : TALUS_LAW_VERSION,
  .size = BAD == 5 ? 8 : sizeof(TalusLaw),
  .help = BAD == 6 ? 0 : "a neo-Hookean solid",
  .parameters = parameters,
  .state = fields,
  .flags = TALUS_LAW_SYMMETRIC | (GIVES ? TALUS_LAW_TANGENT : 0),
  .update = BAD == 7 ? 0 : update,
  .energy = energy,
};

#if BAD == 8
const TalusLaw *talus_lav(void) { return &law; }
#else
const TalusLaw *talus_law(void) { return &law; }
#endif
