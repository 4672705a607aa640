/* Good case files: values, defaults, and the way back through CaseToYaml. Runs on several ranks:
 * all get the same. */
#include "test_case.h"

static const char everything[] =
  "title: \"Everything: at once # really\"\n"
  "kinematics: plane-strain\n"
  "method: mpm\n"
  "analysis: {type: dynamic, step: 1e-3, end: 2, smallest: 1e-6, largest: 4e-3, bossak: -0.1, damping: 0.5, mass: "
  "lumped, keep_velocity: true}\n"
  "grid:\n"
  "  box: {min: [-1, 0], max: [3, 2]}\n"
  "  size: [0.5, 0.25]\n"
  "  cell: triangle\n"
  "  diagonal: crossed\n"
  "  grading: {x: 2.5}\n"
  "  outside: keep-on-boundary\n"
  "bodies:\n"
  "  - name: plate\n"
  "    shape: {difference: [{box: {min: [0, 0], max: [2, 1]}}, {circle: {centre: [1, .5], radius: 0.25}}]}\n"
  "    points_per_cell: 6\n"
  "    material: rubber\n"
  "    velocity: [1, -2]\n"
  "    spin: 3\n"
  "    spin_centre: [1, 0.5]\n"
  "    k0: 0.5\n"
  "    surface: 1\n"
  "  - {name: tip, shape: {polygon: [[2, 0], [3, 0], [2, 1]]}, material: steel, weights: gauss}\n"
  "  - {name: soil, shape: {intersection: [{half-space: {point: [0, 0.5], normal: [0, 1]}}, {union: [{box: {min: [-1, "
  "0], max: [0, 1]}}]}]}, material: steel}\n"
  "materials:\n"
  "  rubber: {law: neo-hookean, density: 1000, young: 90e6, poisson: 0}\n"
  "  steel: {law: neo-hookean, density: 7850, bulk: 1.6e11, shear: 8e10}\n"
  "boundary:\n"
  "  - {name: wall, on: {x: -1}, fix: [x, y]}\n"
  "  - {on: {boundary: top, x: [0, 1]}, displacement: {y: -0.1}, amplitude: [[0, 0], [1, 1], [2, 0.5]]}\n"
  "  - {on: {shape: {circle: {centre: [3, 2], radius: 0.1}}}, rotation: {centre: [3, 2], rate: 0.5}, moves: true}\n"
  "  - {on: {}, velocity: {x: 0.1, y: 0}}\n"
  "loads:\n"
  "  gravity: [0, -9.81]\n"
  "  gravity_amplitude: [[0, 0], [0.1, 1]]\n"
  "  points: [{at: [2, 1], force: [0, -5]}]\n"
  "  tractions: [{on: {body: plate, y: 1}, value: [0, -100]}, {on: {boundary: right}, value: [1, 0], amplitude: [[0, "
  "1]]}]\n"
  "measures:\n"
  "  tip y: {displacement: y, of: {tracer: [2, 0.5]}}\n"
  "  run-out: {extent: {max: x}, of: {body: soil}}\n"
  "  low: {extent: {min: y, beyond: 0.01}}\n"
  "  m: {mass: total}\n"
  "  mp: {mass: total, of: {body: plate}}\n"
  "  p: {momentum: x}\n"
  "  l: {angular_momentum: z}\n"
  "  w: {energy: external}\n"
  "  r: {reaction: y, of: {boundary: wall}}\n"
  "  r1: {reaction: x, of: {boundary: 1}}\n"
  "  d: {energy: dissipated, of: {body: soil}}\n"
  "  b: {energy: balance}\n"
  "  toe: {surface: front, of: {body: soil}}\n"
  "  top: {surface: height, at: 0}\n"
  "  repose: {surface: slope}\n"
  "  stop: {run_out_time: {max: x, speed: 0.01}, of: {body: soil}}\n"
  "  stop2: {run_out_time: {max: x, speed: 0.1, front: surface}}\n"
  "  stop3: {run_out_time: {min: y, speed: 0.1}}\n"
  "  rough: {roughness: pressure}\n"
  "newton: {residual: 1e-9, max_iterations: 12}\n"
  "linear: direct\n"
  "stabilisation: {stiffness: 0}\n"
  "output: {fields: [stress, id], every: 0.1, history: {steps: 5}, grid: false}\n"
  "petsc: {snes_monitor: , ksp_type: cg, ksp_rtol: 1e-9, snes_error_if_not_converged: true}\n";

static void Values(void **state)
{
  Case *c = read_good(everything);
  (void)state;
  assert_string_equal(c->title, "Everything: at once # really");
  assert_string_equal(c->folder, "/tmp");
  assert_int_equal(c->analysis.type, ANALYSIS_DYNAMIC);
  ASSERT_NEAR(c->analysis.beta, 0.25 * 1.1 * 1.1, 1e-16);
  ASSERT_NEAR(c->analysis.gamma, 0.6, 1e-15);
  assert_int_equal(c->grid.counts[0], 8);
  assert_int_equal(c->grid.counts[1], 8);
  assert_int_equal(c->grid.diagonal, DIAGONAL_CROSSED);
  ASSERT_NEAR(c->grid.grading[0], 2.5, 0);
  ASSERT_NEAR(c->grid.grading[1], 1, 0);
  assert_int_equal(c->grid.outside, OUTSIDE_KEEP);
  assert_int_equal(c->n_bodies, 3);
  assert_int_equal(c->bodies[0].shape.kind, SHAPE_DIFFERENCE);
  assert_int_equal(c->bodies[0].shape.children[1].kind, SHAPE_BALL);
  ASSERT_NEAR(c->bodies[0].spin[2], 3, 0);
  assert_true(c->bodies[0].has_k0);
  assert_int_equal(c->bodies[1].points_per_cell, 3);
  assert_int_equal(c->bodies[1].shape.n_vertices, 3);
  ASSERT_NEAR(c->bodies[1].shape.vertices[5], 1, 0);
  assert_int_equal(c->bodies[2].shape.children[1].children[0].kind, SHAPE_BOX);
  assert_string_equal(c->materials[1].parameters[0].name, "bulk");
  assert_int_equal(CaseDestroy(&c), 0);
  assert_null(c);
}

static void MotionAndLoads(void **state)
{
  Case *c = read_good(everything);
  (void)state;
  assert_string_equal(c->boundary[0].name, "wall");
  assert_int_equal(c->boundary[0].kind, MOTION_FIXED);
  assert_true(c->boundary[0].component[0] && c->boundary[0].component[1] && !c->boundary[0].component[2]);
  assert_true(c->boundary[0].on.has[0] && !c->boundary[0].on.has[1]);
  ASSERT_NEAR(c->boundary[0].on.max[0], -1, 0);
  assert_int_equal(c->boundary[1].kind, MOTION_DISPLACEMENT);
  assert_true(!c->boundary[1].component[0] && c->boundary[1].component[1]);
  assert_int_equal(c->boundary[1].amplitude.n, 3);
  assert_true(!c->boundary[1].moves && c->boundary[2].moves);
  assert_int_equal(c->boundary[2].kind, MOTION_ROTATION);
  ASSERT_NEAR(c->boundary[2].axis[2], 1, 0);
  assert_int_equal(c->boundary[3].kind, MOTION_VELOCITY);
  assert_int_equal(c->n_loads, 3);
  assert_int_equal(c->loads[0].kind, LOAD_TRACTION);
  assert_string_equal(c->loads[0].on.body, "plate");
  assert_int_equal(c->loads[2].kind, LOAD_POINT);
  ASSERT_NEAR(c->loads[2].value[1], -5, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

static void MeasuresAndOutput(void **state)
{
  const char *const kinds[] = {
    "displacement",       "extent",           "extent",           "mass: total",        "mass: total",
    "momentum",           "angular_momentum", "energy: external", "reaction",           "reaction",
    "energy: dissipated", "energy: balance",  "surface: front",   "surface: height",    "surface: slope",
    "run_out_time",       "run_out_time",     "run_out_time",     "roughness: pressure"};
  Case *c = read_good(everything);
  (void)state;
  assert_int_equal(c->n_measures, 19);
  for (PetscInt i = 0; i < 19; ++i) {
    char what[64];
    const MeasureSpec *m = &c->measures[i];
    snprintf(what, sizeof what, "%s%s%s", m->kind, m->word ? ": " : "", m->word ? m->word : "");
    assert_string_equal(what, kinds[i]);
  }
  assert_int_equal(c->measures[0].component, 1);
  assert_true(c->measures[1].maximum && !c->measures[2].maximum);
  assert_null(c->measures[3].body);
  assert_string_equal(c->measures[4].body, "plate");
  assert_int_equal(c->measures[6].component, 2);
  assert_int_equal(c->measures[8].boundary, 0);
  assert_int_equal(c->measures[9].boundary, 1);
  assert_string_equal(c->measures[10].body, "soil");
  assert_true(c->measures[13].has_at && c->measures[13].at == 0 && !c->measures[12].has_at);
  assert_true(c->measures[15].maximum && c->measures[15].component == 0 && c->measures[15].front == FRONT_POINTS);
  ASSERT_NEAR(c->measures[15].speed, 0.01, 0);
  assert_int_equal(c->measures[16].front, FRONT_SURFACE);
  assert_true(!c->measures[17].maximum && c->measures[17].component == 1);
  ASSERT_NEAR(c->newton.increment, 1e-10, 0);
  assert_int_equal(c->newton.max_iterations, 12);
  ASSERT_NEAR(c->output.every, 0.1, 0);
  ASSERT_NEAR(c->output.history, -5, 0);
  assert_int_equal(c->output.n_fields, 2);
  assert_int_equal(c->n_petsc, 4);
  assert_string_equal(c->petsc[0], "-snes_monitor");
  assert_string_equal(c->petsc[2], "-ksp_rtol 1e-9");
  assert_int_equal(CaseDestroy(&c), 0);
}

static void Defaults(void **state)
{
  Case *c = read_good(PLAIN);
  (void)state;
  ASSERT_NEAR(c->analysis.end, 1, 0);
  ASSERT_NEAR(c->analysis.step, 0.25, 0);
  ASSERT_NEAR(c->analysis.largest, 0.25, 0);
  ASSERT_NEAR(c->analysis.smallest, 0.25 / 1024, 0);
  ASSERT_NEAR(c->analysis.beta, 0.25, 0);
  ASSERT_NEAR(c->analysis.gamma, 0.5, 0);
  assert_string_equal(c->formulation, "displacement");
  assert_int_equal(c->grid.cell, CELL_QUADRILATERAL);
  assert_int_equal(c->bodies[0].points_per_cell, 4);
  ASSERT_NEAR(c->output.every, 0, 0);
  ASSERT_NEAR(c->output.history, -1, 0);
  assert_true(c->output.grid);
  assert_int_equal(c->output.n_fields, 3);
  assert_int_equal(c->linear, LINEAR_AUTO);
  ASSERT_NEAR(c->stabilisation.mass, 0.1, 0);
  ASSERT_NEAR(c->stabilisation.inertia, 0, 0);
  ASSERT_NEAR(c->newton.residual, 1e-8, 0);
  assert_int_equal(c->n_measures, 0);
  assert_string_equal(c->title, "");
  assert_int_equal(CaseDestroy(&c), 0);
}

static const char solid[] =
  "kinematics: 3d\nmethod: fem\nanalysis: {type: static}\n"
  "grid: {mesh: bar.geo, parameters: {h: 0.1, n: 3}}\n"
  "bodies: [{name: bar, region: steel, material: s, points_per_cell: 4, spin: [0, 0, 1], velocity: [1, 2, 3]}]\n"
  "materials: {s: {law: neo-hookean, density: 1, young: 1, poisson: 0.25}}\n"
  "boundary: [{on: {boundary: foot, z: 0}, fix: [x, y, z]}, {on: {z: 1}, rotation: {centre: [0, 0, 0], rate: 1, axis: "
  "[0, 1, 1]}}]\n";

/* Incompressible materials, given before the key that allows them. */
static const char soft[] =
  "materials: {a: {law: j2, density: 1, shear: 3, bulk: inf, yield_stress: 1}, b: {law: neo-hookean-split, density: 1, "
  "young: 3, "
  "poisson: 0.5}}\nmixed: {stabilisation: 2.5}\nformulation: mixed\n" PLAIN_TOP PLAIN_GRID
  "bodies: [{name: one, shape: {box: {min: [0, 0], max: [2, 1]}}, material: a}]\n";

static void Mixed(void **state)
{
  Case *c = read_good(soft);
  (void)state;
  assert_string_equal(c->formulation, "mixed");
  assert_true(case_is_mixed(c));
  ASSERT_NEAR(c->mixed.stabilisation, 2.5, 0);
  assert_string_equal(c->materials[0].parameters[1].name, "bulk");
  assert_true(c->materials[0].parameters[1].value == INFINITY);
  assert_int_equal(CaseDestroy(&c), 0);
  c = read_good(solid);
  ASSERT_NEAR(c->mixed.stabilisation, 2, 0); /* docs/decisions.md, 17 */
  assert_int_equal(CaseDestroy(&c), 0);
}

static void Mesh3D(void **state)
{
  Case *c = read_good(solid);
  (void)state;
  assert_int_equal(c->grid.kind, GRID_MESH);
  assert_string_equal(c->grid.mesh, "/tmp/bar.geo");
  assert_int_equal(c->grid.n_parameters, 2);
  assert_string_equal(c->grid.parameters[0].name, "h");
  assert_string_equal(c->bodies[0].region, "steel");
  assert_false(c->bodies[0].has_shape);
  ASSERT_NEAR(c->bodies[0].velocity[2], 3, 0);
  assert_true(c->boundary[1].component[2]);
  assert_int_equal(CaseDestroy(&c), 0);
}

static const char walls_2d[] = PLAIN
  "walls:\n"
  "  - {name: floor, shape: {half-space: {point: [0, 0], normal: [0, 1]}}, friction_angle: 30, adhesion: 5}\n"
  "  - {name: gate, shape: {line: [[1, 0], [1, 0.3], [1.1, 2]]}, until: 0.4, thickness: 0.01, bodies: [beam]}\n"
  "  - {name: drum, shape: {circle: {centre: [1, 1], radius: 2}}, inside: true, contact: stick, from: 0.1,\n"
  "     motion: [{rotation: {centre: [1, 1], rate: 3}, amplitude: [[0, 0], [1, 1]]}, {velocity: {y: -0.1}}]}\n"
  "  - {name: lip, shape: {arc: {centre: [1, 1], radius: 2, from: 270, to: 45}}, friction: 0.3}\n";
static const char walls_3d[] =
  "kinematics: 3d\nmethod: fem\nanalysis: {type: static, steps: 4}\ngrid: {mesh: /tmp/a.msh}\n"
  "bodies: [{name: a, region: b, material: rubber, points_per_cell: 4}]\n" PLAIN_MATERIALS
  "walls:\n"
  "  - {name: a, shape: {cylinder: {base: [0, 0, 1], axis: [0, 0, 2], length: 3, radius: 0.5}}}\n"
  "  - {name: b, shape: {difference: [{cone: {base: [0, 0, 1], axis: [0, 1, 2], length: 3, radius: 0.5}},\n"
  "     {cone: {base: [0, 0, 1], axis: [0, 1, 2], length: 3, radius: 0, end_radius: 0.25}}]}, contact: bonded}\n"
  "  - {name: c, shape: {disk: {centre: [0, 0, 1], normal: [0, 0, 2], radius: 3, hole: 0.5}}}\n"
  "  - {name: d, shape: {revolved: {base: [0, 0, 1], axis: [1, 0, 0], line: [[0.1, 0], [0.5, 0.4]]}}}\n"
  "  - {name: e, shape: {revolved: {base: [0, 0, 1], axis: [1, 0, 0], polygon: [[0.1, 0], [0.5, 0.4], [0, 1]]}}}\n"
  "  - {name: f, shape: {surface: {file: /tmp/a.stl, scale: 0.001, offset: [0, 0.5, 0]}}, inside: true}\n"
  "  - {name: g, shape: {surface: {file: /tmp/a.msh, group: top, open: true}},\n"
  "     motion: [{displacement: {x: 0.1, z: 2}}, {rotation: {centre: [0, 0, 0], axis: [0, 1, 1], rate: 3}}]}\n";

static void WallsOfThePlane(void **state)
{
  Case *c = read_good(walls_2d);
  (void)state;
  assert_int_equal(c->n_walls, 4);
  assert_int_equal(c->walls[0].contact, CONTACT_FRICTION);
  ASSERT_NEAR(c->walls[0].friction, 0.57735026918962576, 1e-15);
  assert_int_equal(c->walls[1].shape.n_vertices, 3);
  assert_true(c->walls[1].has_until && !c->walls[0].has_until);
  assert_int_equal(c->walls[1].n_bodies, 1);
  assert_string_equal(c->walls[1].bodies[0], "beam");
  assert_int_equal(c->walls[2].n_motions, 2);
  assert_int_equal(c->walls[2].motions[0].kind, MOTION_ROTATION);
  ASSERT_NEAR(c->walls[2].motions[0].axis[2], 1, 0);
  assert_int_equal(c->walls[2].motions[0].amplitude.n, 2);
  ASSERT_NEAR(c->walls[2].motions[1].value[1], -0.1, 0);
  ASSERT_NEAR(c->walls[3].shape.angle[1], 405, 0);
  assert_int_equal(CaseDestroy(&c), 0);
}

static void WallsOfSpace(void **state)
{
  Case *c = read_good(walls_3d);
  (void)state;
  assert_int_equal(c->n_walls, 7);
  ASSERT_NEAR(c->walls[0].shape.radii[1], 0.5, 0);
  assert_int_equal(c->walls[1].shape.children[1].kind, SHAPE_CONE);
  assert_false(shape_is_solid(&c->walls[2].shape) || shape_is_solid(&c->walls[3].shape));
  assert_true(shape_is_solid(&c->walls[4].shape) && shape_is_solid(&c->walls[5].shape));
  ASSERT_NEAR(c->walls[5].shape.scale, 0.001, 0);
  ASSERT_NEAR(c->walls[6].shape.scale, 1, 0);
  assert_string_equal(c->walls[6].shape.group, "top");
  assert_int_equal(CaseDestroy(&c), 0);
}

static char *ToYaml(const Case *c)
{
  char *text;
  assert_int_equal(CaseToYaml(c, &text), 0);
  return text;
}

/* What is written reads back to the same: the second text equals the first, and the numbers agree
 * to the last bit. */
static void RoundTrip(void **state)
{
  const char *const texts[] = {everything, PLAIN, solid, soft, walls_2d, walls_3d};
  (void)state;
  for (int i = 0; i < 6; ++i) {
    Case *first = read_good(texts[i]), *second;
    char *once = ToYaml(first), *twice;
    second = read_good(once);
    twice = ToYaml(second);
    assert_string_equal(once, twice);
    AnalysisSpec analysis = first->analysis;
    assert_string_equal(analysis.transfer, second->analysis.transfer);
    analysis.transfer = second->analysis.transfer;
    assert_memory_equal(&analysis, &second->analysis, sizeof(analysis));
    assert_memory_equal(&first->newton, &second->newton, sizeof(first->newton));
    assert_memory_equal(first->grid.counts, second->grid.counts, sizeof(first->grid.counts));
    assert_memory_equal(first->gravity, second->gravity, sizeof(first->gravity));
    assert_int_equal(first->n_loads, second->n_loads);
    assert_int_equal(first->n_petsc, second->n_petsc);
    for (PetscInt k = 0; k < first->n_petsc; ++k) assert_string_equal(first->petsc[k], second->petsc[k]);
    for (PetscInt k = 0; k < first->n_measures; ++k) {
      assert_string_equal(first->measures[k].kind, second->measures[k].kind);
      assert_memory_equal(first->measures[k].tracer, second->measures[k].tracer, sizeof(first->measures[k].tracer));
    }
    PetscFree(once);
    PetscFree(twice);
    CaseDestroy(&first);
    CaseDestroy(&second);
  }
}

/* Numbers that have no short decimal form, and texts that YAML would take for something else. */
static void RoundTripOddValues(void **state)
{
  const char text[] =
    "title: \"null\"\nkinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, steps: 3}\n"
    "grid: {box: {min: [0, 0], max: [0.30000000000000004, 1e-7]}, counts: [3, 1]}\n"
    "bodies:\n  - {name: 7, shape: {box: {min: [0, 0], max: [0.1, 1e-7]}}, material: true}\n"
    "materials: {true: {law: neo-hookean, density: 1000.1, young: 123456789.123456789, poisson: -0.9}}\n";
  Case *first = read_good(text);
  char *yaml = ToYaml(first);
  Case *second = read_good(yaml);
  (void)state;
  assert_string_equal(second->title, "null");
  assert_string_equal(second->bodies[0].name, "7");
  assert_string_equal(second->bodies[0].material, "true");
  assert_true(first->grid.max[0] == second->grid.max[0] && second->grid.max[0] == 0.30000000000000004);
  assert_true(first->analysis.step == 1. / 3. && second->analysis.step == first->analysis.step);
  assert_true(second->materials[0].parameters[0].value == 123456789.123456789);
  PetscFree(yaml);
  CaseDestroy(&first);
  CaseDestroy(&second);
}

/* Anchors and aliases, other line ends, a byte order mark: all plain YAML; and `on` as YAML 1.1 writes it. */
static void YamlForms(void **state)
{
  const char alias[] = PLAIN "boundary:\n  - {on: &foot {y: 0}, fix: [y]}\n  - {on: *foot, fix: [x]}\n";
  const char on[] = PLAIN "boundary:\n  - true: {y: 0}\n    fix: [y]\n";
  const char bom[] = "\xef\xbb\xbf" PLAIN;
  char crlf[2000], *out = crlf;
  Case *c = read_good(alias);
  (void)state;
  assert_true(c->boundary[1].on.has[1]);
  CaseDestroy(&c);
  c = read_good(on);
  assert_true(c->boundary[0].on.has[1]);
  CaseDestroy(&c);
  c = read_good(bom);
  CaseDestroy(&c);
  for (const char *p = PLAIN; *p; ++p) {
    if (*p == '\n') *out++ = '\r';
    *out++ = *p;
  }
  *out = '\0';
  c = read_good(crlf);
  assert_string_equal(c->bodies[0].name, "beam");
  CaseDestroy(&c);
}

/* Each component has its own place, in the plane and in space, for whatever is prescribed or
 * acts. */
static void Components(void **state)
{
  static const char space[] =
    "kinematics: 3d\nmethod: mpm\nanalysis: {type: static, steps: 4}\n"
    "grid: {box: {min: [0, 1, 2], max: [4, 6, 8]}, counts: [2, 3, 4]}\n"
    "bodies:\n  - {name: beam, shape: {box: {min: [0, 1, 2], max: [2, 6, 8]}}, material: rubber, velocity: [1, 2, 3],\n"
    "     spin: [4, 5, 6], spin_centre: [7, 8, 9]}\n" PLAIN_MATERIALS
    "boundary:\n"
    "  - {on: {x: 0}, displacement: {x: 0.1, y: 0.2, z: 0.3}}\n"
    "  - {on: {y: 1}, velocity: {y: 0.5}}\n"
    "  - {on: {z: [2, 3]}, fix: [z]}\n"
    "  - {on: {y: 6}, rotation: {centre: [1, 2, 3], axis: [4, 5, 6], rate: 7}}\n"
    "loads:\n  gravity: [1, 2, 3]\n"
    "  tractions: [{on: {body: beam, x: 2}, value: [4, 5, 6]}]\n"
    "  points: [{at: [0.1, 1.2, 2.3], force: [7, 8, 9]}]\n";
  Case *c = read_good(space);
  const MotionSpec *m = c->boundary;
  (void)state;
  for (int d = 0; d < 3; ++d) {
    assert_int_equal(c->grid.counts[d], 2 + d);
    ASSERT_NEAR(c->bodies[0].velocity[d], 1 + d, 0);
    ASSERT_NEAR(c->bodies[0].spin[d], 4 + d, 0);
    ASSERT_NEAR(c->bodies[0].spin_centre[d], 7 + d, 0);
    ASSERT_NEAR(m[0].value[d], 0.1 * (1 + d), 1e-15);
    assert_true(m[0].component[d]);
    ASSERT_NEAR(m[1].value[d], d == 1 ? 0.5 : 0, 0);
    assert_true(m[1].component[d] == (d == 1) && m[2].component[d] == (d == 2));
    assert_true(m[0].on.has[d] == (d == 0) && m[1].on.has[d] == (d == 1) && m[2].on.has[d] == (d == 2));
    ASSERT_NEAR(m[3].centre[d], 1 + d, 0);
    ASSERT_NEAR(m[3].axis[d], 4 + d, 0);
    ASSERT_NEAR(c->gravity[d], 1 + d, 0);
    ASSERT_NEAR(c->loads[0].value[d], 4 + d, 0);
    ASSERT_NEAR(c->loads[1].at[d], 0.1 + 1.1 * d, 1e-15);
    ASSERT_NEAR(c->loads[1].value[d], 7 + d, 0);
  }
  ASSERT_NEAR(m[2].on.min[2], 2, 0);
  ASSERT_NEAR(m[2].on.max[2], 3, 0);
  CaseDestroy(&c);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Values),
                                     cmocka_unit_test(MotionAndLoads),
                                     cmocka_unit_test(Components),
                                     cmocka_unit_test(MeasuresAndOutput),
                                     cmocka_unit_test(Defaults),
                                     cmocka_unit_test(Mixed),
                                     cmocka_unit_test(Mesh3D),
                                     cmocka_unit_test(RoundTrip),
                                     cmocka_unit_test(WallsOfThePlane),
                                     cmocka_unit_test(WallsOfSpace),
                                     cmocka_unit_test(RoundTripOddValues),
                                     cmocka_unit_test(YamlForms)};
  PetscMPIInt rank;
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank > 0 && !freopen("/dev/null", "w", stdout)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
