/* Numbers of a path at its end, for references. */
#include "element/element_table.h"

const ElementMeasure element_measures[ELEMENT_N_MEASURES + 1] = {
  {"axial_strain", "", "logarithmic strain along y, shortening positive"},
  {"shear", "", "F_xy / F_yy"},
  {"volume_strain", "", "ln of the volume"},
  {"stress_xx", "Pa", "effective Cauchy stress, tension positive"},
  {"stress_yy", "Pa", "effective Cauchy stress, tension positive"},
  {"stress_zz", "Pa", "effective Cauchy stress, tension positive"},
  {"stress_xy", "Pa", "shear stress"},
  {"pore_pressure", "Pa", "pressure of the water"},
  {"p", "Pa", "effective pressure, compression positive"},
  {"q", "Pa", "sqrt(3/2 s:s)"},
  {"mobilised_friction", "deg", "angle of friction that holds the stress without cohesion"},
  {"k0", "", "stress xx over stress yy"},
  {"peak_q", "Pa", "largest q of the path"},
  {NULL, NULL, NULL},
};

void element_measure(const ElementTable *t, PetscReal values[ELEMENT_N_MEASURES])
{
  static const PetscInt columns[] = {ELEMENT_STRAIN + 1, ELEMENT_SHEAR,      ELEMENT_VOLUME,     ELEMENT_STRESS,
                                     ELEMENT_STRESS + 1, ELEMENT_STRESS + 2, ELEMENT_STRESS + 3, ELEMENT_PORE,
                                     ELEMENT_P,          ELEMENT_Q,          ELEMENT_FRICTION};
  enum { N_COLUMNS = sizeof columns / sizeof columns[0], K0 = N_COLUMNS, PEAK_Q };
  for (int k = 0; k < N_COLUMNS; ++k) values[k] = element_value(t, t->n - 1, columns[k]);
  values[0] *= -1;
  values[K0] = element_value(t, t->n - 1, ELEMENT_STRESS) / element_value(t, t->n - 1, ELEMENT_STRESS + 1);
  values[PEAK_Q] = 0;
  for (PetscInt i = 0; i < t->n; ++i) values[PEAK_Q] = PetscMax(values[PEAK_Q], element_value(t, i, ELEMENT_Q));
}
