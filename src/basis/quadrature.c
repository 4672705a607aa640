/* Gauss rules. Simplices: symmetric rules with positive weights and all points inside, of degree 1
 * 2 4 6 (triangle) and 1 2 5 6 (tetrahedron); cubes: products of Gauss-Legendre rules.
 *
 * A symmetric rule is a list of orbits: barycentric coordinates of which every distinct order is a
 * point. The numbers solve the moment equations to 20 digits; tests/basis/test_quadrature.c
 * integrates every monomial up to the degree. */
#include "basis/cell.h"

typedef struct {
  PetscInt label[4];  /* which coordinate stands where in the first point, ascending */
  PetscReal value[3]; /* the coordinate of each label */
  PetscReal weight;   /* of each point; those of a rule sum to 1 */
} Orbit;

typedef struct {
  PetscInt n_points, n_orbits;
  Orbit orbit[4];
} SimplexRule;

static const SimplexRule triangle_rules[] = {
  {1, 1, {{{0, 0, 0}, {1.0 / 3.0}, 1.0}}},
  {3, 1, {{{0, 0, 1}, {1.0 / 6.0, 2.0 / 3.0}, 1.0 / 3.0}}},
  {6,
   2,
   {{{0, 0, 1}, {0.44594849091596488632, 0.10810301816807022736}, 0.2233815896780114657},
    {{0, 0, 1}, {0.09157621350977074346, 0.81684757298045851308}, 0.10995174365532186764}}},
  {12,
   3,
   {{{0, 0, 1}, {0.24928674517091042129, 0.50142650965817915742}, 0.11678627572637936603},
    {{0, 0, 1}, {0.06308901449150222834, 0.87382197101699554332}, 0.050844906370206816921},
    {{0, 1, 2}, {0.053145049844816947353, 0.31035245103378440542, 0.636502499121398647227}, 0.082851075618373575194}}},
};

static const SimplexRule tetrahedron_rules[] = {
  {1, 1, {{{0, 0, 0, 0}, {0.25}, 1.0}}},
  {4, 1, {{{0, 0, 0, 1}, {0.13819660112501051518, 0.58541019662496845446}, 0.25}}},
  {14,
   3,
   {{{0, 0, 0, 1}, {0.3108859192633006098, 0.0673422422100981706}, 0.1126879257180158508},
    {{0, 0, 0, 1}, {0.092735250310891226402, 0.721794249067326320794}, 0.073493043116361949544},
    {{0, 0, 1, 1}, {0.045503704125649649492, 0.454496295874350350508}, 0.042546020777081466438}}},
  {24,
   4,
   {{{0, 0, 0, 1}, {0.21460287125915202929, 0.35619138622254391213}, 0.0399227502581674921},
    {{0, 0, 0, 1}, {0.040673958534611353116, 0.877978124396165940652}, 0.010077211055320642948},
    {{0, 0, 0, 1}, {0.32233789014227551034, 0.03298632957317346898}, 0.055357181543654722095},
    {{0, 0, 1, 2},
     {0.063661001875017525299, 0.26967233145831580803, 0.603005664791649141372},
     0.048214285714285714286}}},
};

#define MAX_SIDE 6

/* Gauss-Legendre on [-1, 1], 1 to 6 points. */
static const PetscReal line_point[MAX_SIDE][MAX_SIDE] = {
  {0.0},
  {-0.57735026918962576451, 0.57735026918962576451},
  {-0.77459666924148337704, 0.0, 0.77459666924148337704},
  {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480, 0.86113631159405257522},
  {-0.90617984593866399280, -0.53846931010568309104, 0.0, 0.53846931010568309104, 0.90617984593866399280},
  {-0.93246951420315202781, -0.66120938646626451366, -0.23861918608319690863, 0.23861918608319690863,
   0.66120938646626451366, 0.93246951420315202781},
};
static const PetscReal line_weight[MAX_SIDE][MAX_SIDE] = {
  {2.0},
  {1.0, 1.0},
  {0.55555555555555555556, 0.88888888888888888889, 0.55555555555555555556},
  {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263, 0.34785484513745385737},
  {0.23692688505618908751, 0.47862867049936646804, 0.56888888888888888889, 0.47862867049936646804,
   0.23692688505618908751},
  {0.17132449237917034504, 0.36076157304813860757, 0.46791393457269104739, 0.46791393457269104739,
   0.36076157304813860757, 0.17132449237917034504},
};

/* Ended by 0. Material that is stretched over several cells wants many points, hence the two large
 * rules in the plane. */
static const PetscInt rules[4][MAX_SIDE + 1] = {
  [CELL_TRIANGLE] = {1, 3, 6, 12},
  [CELL_QUADRILATERAL] = {1, 4, 9, 16, 25, 36},
  [CELL_TETRAHEDRON] = {1, 4, 14, 24},
  [CELL_HEXAHEDRON] = {1, 8, 27, 64},
};

const PetscInt *cell_rules(CellType type) { return rules[type]; }

/* The next distinct order of the labels; PETSC_FALSE after the last (then they ascend again). */
static PetscBool next_order(PetscInt n, PetscInt *label)
{
  PetscInt i = n - 2, j = n - 1;
  while (i >= 0 && label[i] >= label[i + 1]) --i;
  if (i >= 0) {
    while (label[j] <= label[i]) --j;
    const PetscInt swap = label[i];
    label[i] = label[j];
    label[j] = swap;
  }
  for (PetscInt a = i + 1, b = n - 1; a < b; ++a, --b) {
    const PetscInt swap = label[a];
    label[a] = label[b];
    label[b] = swap;
  }
  return i >= 0;
}

static void expand_simplex(PetscInt dim, PetscReal volume, const SimplexRule *rule, PetscReal *xi, PetscReal *weight)
{
  PetscInt p = 0;
  for (PetscInt o = 0; o < rule->n_orbits; ++o) {
    Orbit orbit = rule->orbit[o];
    do {
      for (PetscInt d = 0; d < dim; ++d) xi[p * dim + d] = orbit.value[orbit.label[d]];
      weight[p++] = volume * orbit.weight;
    } while (next_order(dim + 1, orbit.label));
  }
}

PetscInt cell_lattice(CellType type, PetscInt n, PetscReal *xi, PetscReal *weight)
{
  const PetscInt dim = cells[type].dim;
  PetscInt r = 0;
  if (type == CELL_TRIANGLE || type == CELL_TETRAHEDRON) return 0;
  while (rules[type][r] && rules[type][r] != n) ++r;
  if (!rules[type][r]) return 0;
  const PetscInt side = r + 1;
  for (PetscInt p = 0; p < n; ++p) {
    weight[p] = cells[type].reference_volume / (PetscReal)n;
    for (PetscInt d = 0, rest = p; d < dim; ++d, rest /= side)
      xi[p * dim + d] = (PetscReal)(2 * (rest % side) + 1 - side) / (PetscReal)side;
  }
  return side;
}

/* The first direction runs fastest. */
static void expand_cube(PetscInt dim, PetscInt side, PetscInt n, PetscReal *xi, PetscReal *weight)
{
  for (PetscInt p = 0; p < n; ++p) {
    weight[p] = 1.0;
    for (PetscInt d = 0, rest = p; d < dim; ++d, rest /= side) {
      xi[p * dim + d] = line_point[side - 1][rest % side];
      weight[p] *= line_weight[side - 1][rest % side];
    }
  }
}

PetscBool cell_quadrature(CellType type, PetscInt n, PetscReal *xi, PetscReal *weight)
{
  const PetscInt dim = cells[type].dim;
  const PetscReal volume = cells[type].reference_volume;
  PetscInt r = 0;
  while (rules[type][r] && rules[type][r] != n) ++r;
  if (!rules[type][r]) return PETSC_FALSE;
  if (type == CELL_TRIANGLE) expand_simplex(dim, volume, &triangle_rules[r], xi, weight);
  else if (type == CELL_TETRAHEDRON) expand_simplex(dim, volume, &tetrahedron_rules[r], xi, weight);
  else expand_cube(dim, r + 1, n, xi, weight);
  return PETSC_TRUE;
}
