/* Bad input: each gets an error that says where and what, and all errors of a file are told. */
#include "test_case.h"

typedef struct {
  const char *name, *text;
  const char *said[4]; /* every one of these stands in what is printed */
} Bad;

#define WITH_BODY(body) PLAIN_TOP PLAIN_GRID "bodies: [" body "]\n" PLAIN_MATERIALS
#define WITH_MATERIAL(constants) PLAIN_TOP PLAIN_GRID PLAIN_BODIES "materials: {rubber: {" constants "}}\n"
#define WITH_GRID(grid) PLAIN_TOP "grid: {" grid "}\n" PLAIN_BODIES PLAIN_MATERIALS
#define AROUND(box, more)                                                        \
  "kinematics: axisymmetric\nmethod: mpm\nanalysis: {type: static}\ngrid: {" box \
  ", size: 0.5}\n" PLAIN_BODIES PLAIN_MATERIALS more
#define WITH_ANALYSIS(analysis) \
  "kinematics: plane-strain\nmethod: mpm\nanalysis: {" analysis "}\n" PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
#define WITH_WALL(wall) PLAIN "walls: [{name: a, " wall "}]\n"
#define BOX "box: {min: [0, 0], max: [4, 2]}"
#define SQUARE "shape: {box: {min: [0, 0], max: [1, 1]}}"

static const Bad bads[] = {
  /* files that are no case */
  {"empty", "", {"F: error: the file is empty"}},
  {"comment only", "# nothing\n\n", {"F: error: the file is empty"}},
  {"list", "- a\n- b\n", {"F:1:1: error: a case file consists of `key: value` lines"}},
  {"word", "hello\n", {"F:1:1: error: a case file consists of"}},
  {"garbage", "\x01\x02\xff\xfe\x80", {"F:1:1: error: byte 0x01 is no text in UTF-8"}},
  {"latin 1", "title: caf\xe9\n", {"F:1:11: error: byte 0xE9 is no text in UTF-8"}},
  {"elf",
   "\x7f"
   "ELF",
   {"byte 0x7F"}},
  /* syntax */
  {"tab", PLAIN_TOP "grid:\n\tsize: 1\n", {"F:5:1: error: syntax: ", "hint: indent with spaces"}},
  {"open quote", "title: \"abc\n", {"F:1:9: error: syntax: "}},
  {"quotes", "title: 'a'''''''''\n", {"F:1:9: error: too many doubled quotes ('') for a text in single quotes"}},
  {"open bracket", "title: [a, b\n", {"error: syntax: "}},
  {"two documents", PLAIN "---\ntitle: b\n", {"a second document begins here"}},
  {"tag", "title: !foo a\n", {"F:1:13: error: a case file has no tags"}},
  {"list as key", "? [a, b]\n: c\n", {"F:1:3: error: a key must be a single word"}},
  {"unknown alias", "title: *nope\n", {"there is no anchor"}},
  {"alias in itself", "title: &x [*x]\n", {"an alias may not stand inside its own anchor"}},
  {"duplicate key", PLAIN "method: fem\n", {"F:9:1: error: key 'method' stands twice in the file (first in line 2)"}},
  /* bases */
  {"basis of another method",
   PLAIN "basis: {lme: {gamma: 2}}\n",
   {"F:9:9: error: method mpm does not take the basis 'lme'", "hint: it takes 'cell'"}},
  {"unknown basis",
   PLAIN "basis: {splines: {}}\n",
   {"F:9:9: error: key 'splines' of basis is not known", "did you mean 'bspline'?"}},
  {"two bases", PLAIN "basis: {mls: {}, lme: {}}\n", {"F:9:18: error: basis has both 'mls' and 'lme'"}},
  {"basis without numbers",
   PLAIN "basis: {cell: {gamma: 2}}\n",
   {"F:9:16: error: key 'gamma' of basis.cell is not known"}},
  /* what means nothing where the plane turns about its axis */
  {"a grid across the axis",
   AROUND("box: {min: [-0.5, 0], max: [4, 2]}", ""),
   {"F:4:20: error: grid.box.min: x is the radius, it cannot begin at -0.5", "hint: the axis is at x = 0"}},
  {"gravity along the radius",
   AROUND(BOX, "loads: {gravity: [1, -9.81]}\n"),
   {"F:9:19: error: loads.gravity: 1 along x is not axisymmetric, gravity acts along the axis",
    "hint: the axis is y: gravity: [0, -9.81]"}},
  {"a rotation in axisymmetry",
   AROUND(BOX, "boundary: [{on: {x: 0}, rotation: {centre: [0, 0], rate: 1}}]\n"),
   {"F:9:25: error: key 'rotation' of boundary[0] has no meaning in axisymmetry"}},
  {"spins in axisymmetry",
   AROUND(BOX, "measures: {a: {spin: z}, b: {angular_momentum: z}, c: {momentum: x}, d: {momentum: y}}\n"),
   {"F:9:16: error: key 'spin' of measures.a has no meaning", "F:9:30: error: key 'angular_momentum' of measures.b",
    "F:9:66: error: measures.c.momentum: x: round the full circle it is zero", "hint: along the axis it means"}},
  /* keys */
  {"what others call it",
   WITH_MATERIAL("law: mohr-coulomb, unit_weight: 18e3, E: 1e6, poisson: 0, phi: 30, undrained_strength: 1"),
   {"hint: it is called `density` here, in kg/m3", "hint: it is called `young` here",
    "hint: it is called `friction_angle` here", "hint: it is called `cohesion` here, beside `friction_angle: 0`"}},
  {"water",
   PLAIN "water_table: 3\n",
   {"F:9:1: error: key 'water_table' of the file", "hint: there is no water in pores"}},
  {"pores",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, poisson: 0, porosity: 0.3"),
   {"key 'porosity' of materials.rubber is not known", "hint: there is no water in pores"}},
  {"a name for what it is of",
   PLAIN "boundary: [{name: base, on: {x: 0}, fix: [x, y]}]\nmeasures: {R: {reaction: y, of: base}}\n",
   {"measures.R.of must be a mapping", "hint: write `of: {boundary: base}`"}},
  {"a word of a law",
   WITH_MATERIAL("law: drucker-prager, density: 1, young: 1, poisson: 0, friction_angle: 30, cohesion: 1, match: "
                 "plain-strain"),
   {"materials.rubber.match must be one of compression, extension or plane-strain, not 'plain-strain'",
    "hint: did you mean 'plane-strain'?"}},
  {"elastic constants of a law that has its own",
   WITH_MATERIAL("law: modified-cam-clay, density: 1, young: 1, critical_stress_ratio: 1, lambda: 0.1, kappa: 0.02, "
                 "shear_modulus: 1"),
   {"error: key 'young' of materials.rubber is not known"}},
  {"unknown key",
   WITH_MATERIAL("law: neo-hookean, density: 1, yung: 1, young: 1, poisson: 0"),
   {"F:7:52: error: key 'yung' of materials.rubber is not known\n", "  hint: did you mean 'young'?", "^~~~"}},
  {"unknown key at the top",
   PLAIN "analyse: 1\n",
   {"F:9:1: error: key 'analyse' of the file is not known", "did you mean 'analysis'?"}},
  {"missing keys",
   "title: a\n",
   {"F:1:1: error: key 'kinematics' of the file is missing", "F:1:1: error: key 'bodies' of the file is missing",
    "key 'materials'", "key 'grid'"}},
  {"merge key",
   PLAIN "newton: {<<: 1}\n",
   {"F:9:10: error: merge keys (<<) are not supported", "hint: write the keys out"}},
  {"empty key", PLAIN "newton: {residual: }\n", {"newton.residual must be a number >= 0, not empty"}},
  /* options of PETSc that act */
  {"a viewer that writes",
   PLAIN "petsc: {snes_rtol: 1e-9, snes_view: \":/any/file\"}\n",
   {"F:9:38: error: petsc.snes_view may not be ':/any/file' in a case file: what a case file asks to be shown",
    "hint: write true, or ascii::FORMAT"}},
  {"a picture",
   PLAIN "petsc: {draw_save: 'm$(touch PWNED)'}\n",
   {"F:9:9: error: a case file may not set the PETSc option 'draw_save'", "belong on the command line: -draw_save\n"}},
  {"a misspelled option of PETSc", PLAIN "petsc: {ksp_rtl: 1}\n", {"F:9:9: error", "did you mean 'ksp_rtol'?"}},
  {"a solver in Python",
   PLAIN "petsc: {pc_type: python}\n",
   {"F:9:18: error: petsc.pc_type may not be 'python' in a case file: it would run what stands in other files"}},
  /* types */
  {"text for number",
   WITH_MATERIAL("law: neo-hookean, density: heavy, young: 1, poisson: 0"),
   {"F:7:49: error: materials.rubber.density must be a number > 0 in kg/m3, not 'heavy'"}},
  {"a density that nothing has",
   WITH_MATERIAL("law: neo-hookean, density: 1e-308, young: 1, poisson: 0"),
   {"F:7:49: error: materials.rubber.density: 1e-308 kg/m3 cannot be meant, nothing is smaller than 1e-15",
    "hint: is it written in kg/m3?"}},
  {"a stiffness that nothing has",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1e300, poisson: 0"),
   {"F:7:59: error: materials.rubber.young: 1e+300 Pa cannot be meant, nothing is larger than 1e+20"}},
  {"gravity that nothing has",
   PLAIN "loads: {gravity: [0, -1e300]}\n",
   {"F:9:22: error: loads.gravity[1]: -1e+300 m/s2 cannot be meant, nothing is larger than 1e+15"}},
  {"a factor that nothing has",
   PLAIN "loads: {gravity: [0, -1], gravity_amplitude: [[0, 0], [1, 1e290], [2, 1e30]]}\n",
   {"F:9:59: error: loads.gravity_amplitude[1][1]: a factor of 1e+290 cannot be meant, nothing is larger than 1e+30"}},
  {"quoted number",
   WITH_MATERIAL("law: neo-hookean, density: \"1000\", young: 1, poisson: 0"),
   {"in quotes", "hint: leave the quotes out"}},
  {"number with unit",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 90 MPa, poisson: 0"),
   {"not '90 MPa'", "its unit is Pa"}},
  {"decimal comma", WITH_MATERIAL("law: neo-hookean, density: 1, young: '9', poisson: 0"), {"leave the quotes out"}},
  {"nan",
   WITH_MATERIAL("law: neo-hookean, density: nan, young: 1, poisson: 0"),
   {"materials.rubber.density must be a number > 0", "a finite number"}},
  {"inf",
   WITH_MATERIAL("law: neo-hookean, density: .inf, young: 1, poisson: 0"),
   {"materials.rubber.density must be a number > 0", "'.inf'"}},
  {"huge",
   WITH_MATERIAL("law: neo-hookean, density: 1e999, young: 1, poisson: 0"),
   {"materials.rubber.density must be", "too large"}},
  {"hexadecimal",
   WITH_MATERIAL("law: neo-hookean, density: 0x10, young: 1, poisson: 0"),
   {"materials.rubber.density must be a number > 0"}},
  {"negative density",
   WITH_MATERIAL("law: neo-hookean, density: -1, young: 1, poisson: 0"),
   {"materials.rubber.density must be a number > 0 in kg/m3, not '-1'"}},
  {"zero density", WITH_MATERIAL("law: neo-hookean, density: 0, young: 1, poisson: 0"), {"not '0'"}},
  {"list for number", PLAIN "newton: {residual: [1]}\n", {"newton.residual must be a number >= 0, not a list"}},
  {"mapping for word", PLAIN "linear: {a: 1}\n", {"linear must be one of auto, direct or iterative, not a mapping"}},
  {"number for mapping", PLAIN "newton: 3\n", {"newton must be a mapping {key: value, ...}, not '3'"}},
  {"mapping for list", PLAIN "boundary: {on: {}, fix: [x]}\n", {"boundary must be a list of mappings, not a mapping"}},
  {"word for item", PLAIN "boundary: [left]\n", {"boundary[0] must be a mapping"}},
  {"fraction",
   PLAIN "newton: {max_iterations: 2.5}\n",
   {"newton.max_iterations must be a whole number >= 1, not '2.5'"}},
  {"yes", PLAIN "output: {grid: yes}\n", {"output.grid must be true or false, not 'yes'"}},
  {"wrong word", PLAIN "linear: dircet\n", {"linear must be one of", "did you mean 'direct'?"}},
  {"wrong method", "method: mmp\n", {"method must be one of mpm, fem or gmm, not 'mmp'", "did you mean 'mpm'?"}},
  {"bad name",
   WITH_BODY("{name: a.b, " SQUARE ", material: rubber}"),
   {"the name 'a.b' may not hold the character '.'"}},
  {"name twice",
   WITH_BODY("{name: a, " SQUARE ", material: rubber}, {name: a, " SQUARE ", material: rubber}"),
   {"the name 'a' is taken by bodies[0]"}},
  /* vectors and dimensions */
  {"long vector",
   PLAIN "loads: {gravity: [0, 0, -9.81]}\n",
   {"loads.gravity must have 2 entries (this case is two-dimensional), not 3"}},
  {"bad component", PLAIN "loads: {gravity: [0, down]}\n", {"loads.gravity[1] must be a number in m/s2, not 'down'"}},
  {"z in the plane",
   PLAIN "boundary: [{on: {x: 0}, fix: [z]}]\n",
   {"boundary[0].fix[0] must be x, y or normal, not 'z'"}},
  {"normal and axis",
   PLAIN "boundary: [{on: {x: 0}, fix: [normal, x]}]\n",
   {"boundary[0].fix: beside the normal no other component stands", "[x, y] holds nodes in the plane"}},
  {"z of a selector",
   PLAIN "boundary: [{on: {z: 0}, fix: [x]}]\n",
   {"key 'z' of boundary[0].on belongs to kinematics: 3d"}},
  {"axis twice", PLAIN "boundary: [{on: {x: 0}, fix: [x, x]}]\n", {"boundary[0].fix[1] stands twice"}},
  {"sphere in the plane",
   WITH_BODY("{name: a, shape: {sphere: {centre: [0, 0], radius: 1}}, material: rubber}"),
   {"key 'sphere'", "there is 'circle'"}},
  /* analysis */
  {"dynamic without step", WITH_ANALYSIS("type: dynamic, end: 1"), {"key 'step' of analysis is missing"}},
  {"dynamic without end", WITH_ANALYSIS("type: dynamic, step: 1"), {"key 'end' of analysis is missing"}},
  {"steps and step", WITH_ANALYSIS("type: static, steps: 2, step: 0.5"), {"analysis has both 'steps' and 'step'"}},
  {"step beyond end", WITH_ANALYSIS("type: dynamic, step: 2, end: 1"), {"analysis.step is larger than analysis.end"}},
  {"smallest above step",
   WITH_ANALYSIS("type: dynamic, step: 0.1, end: 1, smallest: 1"),
   {"analysis.smallest is larger than the step"}},
  {"bossak",
   WITH_ANALYSIS("type: dynamic, step: 0.1, end: 1, bossak: 0.1"),
   {"analysis.bossak must be a number >= -0.333333 and <= 0, not '0.1'"}},
  /* grid */
  {"size that does not divide",
   WITH_GRID(BOX ", size: 0.3"),
   {"grid.size 0.3 does not divide the box along x, which is 4 m long",
    "near it are 0.3076923077 (13 cells) and 0.2857142857 (14 cells)", "along y"}},
  {"size too large", WITH_GRID(BOX ", size: 3"), {"the largest cell possible is 2"}},
  {"size zero", WITH_GRID(BOX ", size: 0"), {"grid.size must be a number, or one for each axis > 0 in m, not '0'"}},
  {"no size", WITH_GRID(BOX), {"key 'size' of grid is missing"}},
  {"size and counts", WITH_GRID(BOX ", size: 1, counts: [4, 2]"), {"grid has both 'size' and 'counts'"}},
  {"box and mesh", WITH_GRID(BOX ", size: 1, mesh: a.msh"), {"grid has both 'box' and 'mesh'"}},
  {"empty box",
   WITH_GRID("box: {min: [0, 0], max: [0, 2]}, size: 1"),
   {"grid.box: max must be larger than min, along x 0 is not larger than 0"}},
  {"cell of another dimension",
   WITH_GRID(BOX ", size: 1, cell: tetrahedron"),
   {"has 3 dimensions, this case has 2", "quadrilateral or triangle"}},
  {"size of a mesh", WITH_GRID("mesh: a.msh, size: 1"), {"key 'size' of grid means something only beside 'box'"}},
  {"too many cells", WITH_GRID(BOX ", counts: [1000000, 1000000]"), {"more than this build can number"}},
  /* bodies */
  {"no shape",
   WITH_BODY("{name: a, material: rubber}"),
   {"bodies[0] needs at least one of 'shape', 'region' or 'mesh'"}},
  {"two shapes",
   WITH_BODY(
     "{name: a, shape: {circle: {centre: [0, 0], radius: 1}, box: {min: [0, 0], max: [1, 1]}}, material: rubber}"),
   {"bodies[0].shape has both 'box' and 'circle'"}},
  {"flat polygon",
   WITH_BODY("{name: a, shape: {polygon: [[0, 0], [1, 1], [2, 2]]}, material: rubber}"),
   {"the polygon has no area"}},
  {"sides that cross",
   WITH_BODY("{name: a, shape: {polygon: [[0, 0], [1, 1], [1, 0], [0, 1.5]]}, material: rubber}"),
   {"F:5:54: error: bodies[0].shape.polygon: sides 1 and 3 cross", "corners stand in their order around the shape"}},
  {"sides of a bow tie, which has no area either",
   PLAIN "boundary: [{on: {shape: {polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]}}, fix: [x]}]\n",
   {"boundary[0].on.shape.polygon: sides 1 and 3 cross"}},
  {"a closed line that crosses itself",
   WITH_WALL("shape: {line: [[0, 0], [1, 1], [1, 0], [0, 1], [0, 0]]}"),
   {"walls[0].shape.line: sides 1 and 3 cross"}},
  {"two corners",
   WITH_BODY("{name: a, shape: {polygon: [[0, 0], [1, 1]]}, material: rubber}"),
   {"bodies[0].shape.polygon must be a list of three corners or more [[x, y], ...] in m, not a list of 2"}},
  {"unknown material",
   WITH_BODY("{name: a, " SQUARE ", material: ruber}"),
   {"there is no 'ruber' in materials", "did you mean 'rubber'?"}},
  {"unknown rule",
   WITH_BODY("{name: a, " SQUARE ", material: rubber, points_per_cell: 5}"),
   {"no Gauss rule of a quadrilateral has 5 points; there are 1, 4, 9, 16"}},
  {"region of a box",
   WITH_BODY("{name: a, region: soil, material: rubber}"),
   {"bodies[0].region: a box grid has no regions"}},
  {"surface without k0",
   WITH_BODY("{name: a, " SQUARE ", material: rubber, surface: 1}"),
   {"key 'surface' of bodies[0] means something only beside 'k0'"}},
  {"no bodies", PLAIN_TOP PLAIN_GRID "bodies: []\n" PLAIN_MATERIALS, {"bodies is an empty list"}},
  /* materials */
  {"unknown law",
   WITH_MATERIAL("law: neo-hokean, density: 1, young: 1, poisson: 0"),
   {"materials.rubber.law must be one of neo-hookean, neo-hookean-split", "not 'neo-hokean'",
    "did you mean 'neo-hookean'?"}},
  {"incompressible",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, poisson: 0.5"),
   {"Poisson's ratio 0.5 cannot be solved for displacements alone", "`formulation: mixed`"}},
  {"incompressible by its bulk modulus",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, bulk: inf"),
   {"materials.rubber.bulk: an infinite bulk modulus cannot be solved for displacements alone"}},
  {"poisson and bulk contradict each other",
   "formulation: mixed\n" WITH_MATERIAL("law: j2, yield_stress: 1, density: 1, bulk: 1, poisson: 0.5"),
   {"no stable elastic material"}},
  {"infinite stiffness", WITH_MATERIAL("law: neo-hookean, density: 1, young: inf, poisson: 0.3"), {"young"}},
  {"negative stabilisation", "mixed: {stabilisation: -1}\n" PLAIN, {"mixed.stabilisation must be"}},
  {"poisson too large",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, poisson: 0.51"),
   {"materials.rubber.poisson must be a number > -1 and <= 0.5, not '0.51'"}},
  {"a comma for a point",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, poisson: 0,3"),
   {"key '3' of materials.rubber is not known\n", "hint: decimals follow a point: poisson: 0.3\n"}},
  {"one constant",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1"),
   {"materials.rubber needs two elastic constants, it has one", "any two of"}},
  {"three constants",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 1, poisson: 0, shear: 1"),
   {"has 3 elastic constants; exactly two"}},
  {"impossible pair",
   WITH_MATERIAL("law: neo-hookean, density: 1, young: 9, shear: 1"),
   {"no stable elastic material has young = 9 together with shear = 1"}},
  {"ambiguous pair",
   WITH_MATERIAL("law: neo-hookean, density: 1, poisson: 0, lame: 1"),
   {"no stable elastic material"}},
  /* walls */
  {"wall without a name", PLAIN "walls: [{shape: {" BOX "}}]\n", {"F:9:9: error: key 'name' of walls[0] is missing"}},
  {"wall names twice",
   PLAIN "walls: [{name: a, shape: {" BOX "}}, {name: a, shape: {" BOX "}}]\n",
   {"error: the name 'a' is taken by walls[0]"}},
  {"unknown shape of a wall", WITH_WALL("shape: {lime: [[0, 0], [1, 0]]}"), {"key 'lime'", "did you mean 'line'?"}},
  {"a line of one corner",
   WITH_WALL("shape: {line: [[0, 0]]}"),
   {"walls[0].shape.line must be a list of two corners or more [[x, y], ...] in m, not a list"}},
  {"a corner of a line in space",
   WITH_WALL("shape: {line: [[0, 0], [1, 0, 2]]}"),
   {"walls[0].shape.line[1] must be a corner [x, y] in m"}},
  {"a cylinder in the plane",
   WITH_WALL("shape: {cylinder: {base: [0, 0], axis: [0, 1], length: 1, radius: 1}}"),
   {"key 'cylinder' of walls[0].shape belongs to kinematics: 3d"}},
  {"a surface in the plane",
   WITH_WALL("shape: {surface: {file: a.stl}}"),
   {"key 'surface' of walls[0].shape belongs to kinematics: 3d"}},
  {"a line for a body",
   WITH_BODY("{name: a, material: rubber, shape: {line: [[0, 0], [1, 0]]}}"),
   {"key 'line' of bodies[0].shape is not known"}},
  {"all of a circle",
   WITH_WALL("shape: {arc: {centre: [0, 0], radius: 1, from: -180, to: 180}}"),
   {"walls[0].shape.arc goes over 360 degrees, an arc over more than 0 and less than 360", "is a `circle`"}},
  {"inside of a line",
   WITH_WALL("inside: true, shape: {line: [[0, 0], [1, 0]]}"),
   {"walls[0].inside: the shape of this wall has no inside", "material may be on both of their sides"}},
  {"a thick box", WITH_WALL("thickness: 0.1, shape: {" BOX "}"), {"walls[0].thickness: a shape that has an inside"}},
  {"negative friction",
   WITH_WALL("friction: -0.1, shape: {" BOX "}"),
   {"walls[0].friction must be a number >= 0, not '-0.1'"}},
  {"an angle of friction beyond 90 degrees",
   WITH_WALL("friction_angle: 90, shape: {" BOX "}"),
   {"walls[0].friction_angle must be a number >= 0 and < 90 in deg, not '90'"}},
  {"two frictions",
   WITH_WALL("friction: 0.5, friction_angle: 20, shape: {" BOX "}"),
   {"walls[0] has both 'friction' and 'friction_angle'"}},
  {"friction of a smooth wall",
   WITH_WALL("friction_angle: 20, contact: stick, shape: {" BOX "}"),
   {"walls[0]: friction and adhesion mean something with `contact: friction` alone"}},
  {"a gate that goes before it comes",
   WITH_WALL("from: 2, until: 1, shape: {" BOX "}"),
   {"walls[0].until must be later than `from`, 2 s"}},
  {"a wall of an unknown body",
   WITH_WALL("bodies: [beem], shape: {" BOX "}"),
   {"walls[0].bodies[0]: there is no 'beem' in bodies", "did you mean 'beam'?"}},
  {"a motion on nodes",
   WITH_WALL("motion: [{on: {x: 0}, velocity: {x: 1}}], shape: {" BOX "}"),
   {"key 'on' of walls[0].motion[0] is not known"}},
  {"a ring that grows",
   AROUND(BOX, "walls: [{name: a, shape: {" BOX "}, motion: [{velocity: {x: 1}}]}]\n"),
   {"walls[0].motion[0].velocity.x: x is the radius, and a rigid ring keeps its own"}},
  {"a wall that turns in axisymmetry",
   AROUND(BOX, "walls: [{name: a, shape: {" BOX "}, motion: [{rotation: {centre: [0, 0], rate: 1}}]}]\n"),
   {"key 'rotation' of walls[0].motion[0] has no meaning in axisymmetry"}},
  /* boundary, loads */
  {"no motion",
   PLAIN "boundary: [{on: {x: 0}}]\n",
   {"boundary[0] needs one of 'fix', 'displacement', 'velocity' or 'rotation'"}},
  {"two motions",
   PLAIN "boundary: [{on: {x: 0}, fix: [x], velocity: {y: 1}}]\n",
   {"boundary[0] has both 'fix' and 'velocity'"}},
  {"unknown side",
   PLAIN "boundary: [{on: {boundary: lefd}, fix: [x]}]\n",
   {"a box has no boundary 'lefd'", "did you mean 'left'?"}},
  {"fixed and moving",
   PLAIN "boundary: [{on: {x: 0}, fix: [x], moves: true}]\n",
   {"boundary[0].moves: what is fixed does not move"}},
  {"a boundary that moves",
   PLAIN "boundary: [{on: {boundary: top}, velocity: {y: 1}, moves: true}]\n",
   {"boundary[0].moves: a boundary of the grid stays where it is"}},
  {"side of 3d", PLAIN "boundary: [{on: {boundary: front}, fix: [x]}]\n", {"a box has no boundary 'front'"}},
  {"motion of a body",
   PLAIN "boundary: [{on: {body: beam}, fix: [x]}]\n",
   {"motion is prescribed on the grid, not on a body"}},
  {"unknown body",
   PLAIN "loads: {tractions: [{on: {body: bem}, value: [0, 1]}]}\n",
   {"loads.tractions[0].on.body: there is no 'bem' in bodies", "did you mean 'beam'?"}},
  {"factor of a load",
   PLAIN
   "loads: {tractions: [{on: {boundary: top}, value: [0, 1], factor: \"2*z\"}, {on: {boundary: top}, value: [0, 1], "
   "factor: \"max(0, 5 y)\"}], points: [{at: [1, 1], force: [1, 0], factor: \"1 +\"}]}\n",
   {"loads.tractions[0].factor: there is no 'z' here", "loads.tractions[1].factor makes no sense from 'y)' on",
    "loads.points[0].factor: something is missing at the end of '1 +'"}},
  {"reversed interval", PLAIN "boundary: [{on: {x: [2, 1]}, fix: [x]}]\n", {"the first number must not be larger"}},
  {"amplitude backwards",
   PLAIN "loads: {gravity: [0, -1], gravity_amplitude: [[1, 0], [0, 1]]}\n",
   {"times must grow from pair to pair"}},
  {"amplitude stands still",
   PLAIN "loads: {gravity: [0, -1], gravity_amplitude: [[0, 0], [1, 1], [1, 2]]}\n",
   {"times must grow from pair to pair", "a jump is two times close together, less than a step apart"}},
  {"an empty amplitude",
   PLAIN "loads: {gravity: [0, -1], gravity_amplitude: []}\n",
   {"must be a list of pairs [[time, factor], ...], not an empty list"}},
  {"amplitude no pair",
   PLAIN "loads: {gravity_amplitude: [[1, 0, 3]]}\n",
   {"loads.gravity_amplitude[0] must be a pair"}},
  {"displacement of nothing", PLAIN "boundary: [{on: {x: 0}, displacement: {}}]\n", {"needs at least one of"}},
  /* measures, output */
  {"columns of the history",
   PLAIN "measures: {time: {mass: total}, step: {volume: current}, stage: {mass: total}}\n",
   {"F:9:12: error: history.csv has a column 'time' by itself", "F:9:33: error: history.csv has a column 'step'"}},
  {"a column of cases with stages",
   PLAIN "measures: {stage: {mass: total}}\nstages: [{name: one}]\n",
   {"history.csv has a column 'stage' by itself"}},
  {"measure of nothing",
   PLAIN "measures: {tip: {displacement: y}}\n",
   {"key 'of' of measures.tip is missing", "of: {tracer: [x, y]}"}},
  {"stress at a place and in a shape",
   PLAIN "measures: {s: {stress: q, of: {tracer: [1, 0]}, in: {box: {min: [0, 0], max: [1, 1]}}}}\n",
   {"measures.s.in means nothing to stress: q"}},
  {"measure of the wrong thing",
   PLAIN "measures: {tip: {displacement: y, of: {body: beam}}}\n",
   {"measures.tip.of must name a tracer"}},
  {"measure of unknown body",
   PLAIN "measures: {a: {extent: {max: x}, of: {body: beem}}}\n",
   {"there is no 'beem' in bodies"}},
  {"surface without a place",
   PLAIN "measures: {a: {surface: height}}\n",
   {"key 'at' of measures.a is missing", "surface: height, at: x"}},
  {"place without a height",
   PLAIN "measures: {a: {surface: front, at: 1}}\n",
   {"measures.a.at means nothing to surface: front"}},
  {"shape beside what knows none",
   PLAIN "measures: {a: {outside: mass, in: {circle: {centre: [0, 0], radius: 1}}}}\n",
   {"measures.a.in means nothing to outside: mass"}},
  {"angle about nothing",
   PLAIN "measures: {a: {centre_of_mass: angle}}\n",
   {"key 'about' of measures.a is missing", "centre_of_mass: angle, about: [x, y]"}},
  {"rate over no time", PLAIN "measures: {a: {mass: total, rate: {window: 0}}}\n", {"must be longer than 0 s"}},
  {"mean over no time", PLAIN "measures: {a: {mass: total, mean: {window: 0}}}\n", {"must be longer than 0 s"}},
  {"rate and mean",
   PLAIN "measures: {a: {mass: total, mean: {window: 1}, rate: {window: 1}}}\n",
   {"measures.a takes a rate or a mean, not both"}},
  {"rate after the end",
   PLAIN "measures: {a: {mass: total, rate: {window: [1, 2]}}}\n",
   {"measures.a.rate.window begins when the run is over, at 1 s"}},
  {"a part of a surface that is more than all",
   PLAIN "measures: {a: {free_surface: inclination, middle: 1.5}}\n",
   {"measures.a.middle"}},
  {"many times of what",
   PLAIN "measures: {a: {avalanches: {times: 10}}}\n",
   {"measures.a.avalanches.times: of which motion?", "give `kinetic`"}},
  {"a container at rest",
   PLAIN "boundary:\n  - {name: tub, on: {x: 0}, fix: [x]}\nmeasures: {a: {agitation: {container: tub}}}\n",
   {"measures.a.agitation.container does not move"}},
  {"until an unknown measure",
   PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
   "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, until: [{measure: enrgy, below: 1}]}\n"
   "measures: {energy: {energy: kinetic}}\n",
   {"enrgy", "did you mean 'energy'"}},
  {"until so many of nothing",
   PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
   "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, until: [{measure: energy, count: 1}]}\n"
   "measures: {energy: {energy: kinetic}}\n",
   {"analysis.until[0].count: the measure 'energy' counts no events", "avalanches do"}},
  {"until nothing in particular",
   PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS
   "kinematics: plane-strain\nmethod: mpm\nanalysis: {type: static, until: [{measure: energy}]}\n"
   "measures: {energy: {energy: kinetic}}\n",
   {"analysis.until[0] needs one of 'below', 'above' or 'count'"}},
  {"a share beyond the surface's front",
   PLAIN "measures: {a: {run_out_time: {max: x, speed: 1, front: surface, beyond: 0.1}}}\n",
   {"measures.a.run_out_time.beyond", "the surface"}},
  {"front without a speed", PLAIN "measures: {a: {run_out_time: {max: x}}}\n", {"speed"}},
  {"speed of nothing",
   PLAIN "measures: {a: {run_out_time: {max: x, speed: 0}}}\n",
   {"measures.a.run_out_time.speed", "> 0"}},
  {"surface that goes left",
   PLAIN "measures: {a: {run_out_time: {min: x, speed: 1, front: surface}}}\n",
   {"the surface's front is max: x"}},
  {"transfer of a body",
   PLAIN "measures: {a: {energy: transfer, of: {body: beam}}}\n",
   {"measures.a.of: energy: transfer is known for the whole model only"}},
  {"roughness of a body",
   PLAIN "measures: {a: {roughness: pressure, of: {body: beam}}}\n",
   {"measures.a.of: roughness: pressure is known for the whole model only"}},
  {"reaction index", PLAIN "measures: {a: {reaction: x, of: {boundary: 3}}}\n", {"boundary has 0 entries"}},
  {"unknown field",
   PLAIN "output: {fields: [displacment]}\n",
   {"there is no field 'displacment'", "did you mean 'displacement'?"}},
  {"never", PLAIN "output: {every: 0}\n", {"output.every must be `end`, a time in s above 0, or {steps: n}, not '0'"}},
};

static void Table(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof(bads) / sizeof(bads[0]); ++i) {
    char *said;
    Case *c = read_text(bads[i].text, &said);
    if (c) fail_msg("%s: was taken for good", bads[i].name);
    for (int k = 0; k < 4 && bads[i].said[k]; ++k)
      if (!strstr(said, bads[i].said[k])) fail_msg("%s: no '%s' in:\n%s", bads[i].name, bads[i].said[k], said);
    free(said);
  }
}

/* What is wrong in a stage is told, and not what later ones lack because of it. */
static void FirstStage(void **state)
{
  static const char *const wrong[] = {"bodies: {a: 1}", "materials: [rubber]", "bodies: [{name: c}]", "loads: 3",
                                      "materials: {rubber: 3}"};
  static const char *const says[] = {"stages[0].bodies must be a list of mappings, not a mapping",
                                     "stages[0].materials must be a mapping {name: {...}, ...}, not a list",
                                     "there is no 'c' in bodies that the stage could change",
                                     "stages[0].loads must be a mapping {key: value, ...}, not '3'",
                                     "materials.rubber must be a mapping"};
  char text[2000], *said;
  (void)state;
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    snprintf(text, sizeof text,
             PLAIN
             "stages:\n  - {name: one, %s}\n  - {name: two, materials: {rubber: {young: 1}}}\n"
             "  - {name: three, bodies: [{name: beam, absent: true}]}\n",
             wrong[k]);
    assert_null(read_text(text, &said));
    if (!strstr(said, says[k])) fail_msg("no '%s' in:\n%s", says[k], said);
    assert_non_null(strstr(said, "F:10:"));
    assert_null(strstr(strstr(said, ": error: ") + 1, ": error: "));
    free(said);
  }
}

/* A grid that cannot be read says nothing of what would fit into its cells. */
static void NoGrid(void **state)
{
  static const char *const grids[] = {"grid: 3\n",
                                      "grid: {box: {min: [0, 0], max: [4, 2]}, size: 0.5, cell: hexagon}\n"};
  char text[2000], *said;
  (void)state;
  for (int k = 0; k < 2; ++k) {
    snprintf(text, sizeof text,
             PLAIN_TOP "%sbodies: [{name: a, " SQUARE ", material: rubber, points_per_cell: 4}]\n" PLAIN_MATERIALS,
             grids[k]);
    assert_null(read_text(text, &said));
    assert_null(strstr(strstr(said, ": error: ") + 1, ": error: "));
    free(said);
  }
}

/* Corners may touch sides, and lines that are open cross themselves: nothing is between. */
static void Touching(void **state)
{
  Case *c = read_good(PLAIN
                      "walls:\n  - {name: a, shape: {line: [[0, 0], [1, 1], [1, 0], [0, 1]]}}\n  - {name: b, shape: "
                      "{polygon: [[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]]}}\n");
  (void)state;
  assert_int_equal(CaseDestroy(&c), 0);
}

static int Count(const char *text, const char *word)
{
  int n = 0;
  while ((text = strstr(text, word))) ++n, ++text;
  return n;
}

/* What is missing since its key is misspelled, or goes by another name, is told once. */
static void Misspelled(void **state)
{
  static const char *const texts[] = {
    "methd: mpm\n",
    "method: mpm\ngird: {}\n",
    "method: mpm\n" PLAIN_GRID "bodies: [{name: a, shpe: {" BOX "}, material: rubber}]\n",
    "method: mpm\n" PLAIN_GRID PLAIN_BODIES "materials: {rubber: {law: neo-hookean, rho: 1, young: 1, poisson: 0}}\n",
    "method: mpm\n" PLAIN_GRID PLAIN_BODIES
    "materials: {rubber: {lwa: neo-hookean, density: 1, young: 1, poisson: 0}}\n",
    "method: mpm\n" PLAIN_GRID PLAIN_BODIES "materials: {rubber: {law: neo-hookean, density: 1, E: 1, poisson: 0}}\n"};
  static const char *const rest[] = {
    PLAIN_GRID PLAIN_BODIES PLAIN_MATERIALS, PLAIN_BODIES PLAIN_MATERIALS, PLAIN_MATERIALS, "", "", ""};
  char text[2000], *said;
  (void)state;
  for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
    snprintf(text, sizeof text, "kinematics: plane-strain\nanalysis: {type: static, steps: 4}\n%s%s", texts[k],
             rest[k]);
    assert_null(read_text(text, &said));
    if (Count(said, ": error: ") != 1 || !strstr(said, "is not known")) fail_msg("not one error:\n%s", said);
    free(said);
  }
}

/* One pass tells all of them, in the order of the lines, and nothing else. */
static void AllAtOnce(void **state)
{
  char *said;
  Case *c =
    read_text(PLAIN_TOP "grid: {" BOX
                        ", size: 0.3}\n"
                        "bodies:\n  - {name: a, " SQUARE
                        ", material: x}\n  - {name: b, material: rubber}\n"
                        "materials: {rubber: {law: neo-hookean, density: nan, yung: 1, poisson: 2}}\nlinear: no\n",
              &said);
  (void)state;
  assert_null(c);
  assert_int_equal(Count(said, ": error: "),
                   /* size along x and y, material, shape, density, yung, poisson, linear */
                   8);
  assert_true(strstr(said, "F:4:") < strstr(said, "F:6:") && strstr(said, "F:6:") < strstr(said, "F:7:") &&
              strstr(said, "F:8:") < strstr(said, "F:9:"));
  free(said);
}

static void Deep(void **state)
{
  static char text[200000];
  char *said;
  (void)state;
  memset(text, '[', sizeof(text) - 1);
  memcpy(text, "grid: ", 6);
  assert_null(read_text(text, &said));
  assert_non_null(strstr(said, "nested too deeply"));
  free(said);
}

/* Ten lines of aliases that would make nine to the twelfth values. */
static void Bomb(void **state)
{
  char text[2000] = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1]\n", line[200], *said;
  (void)state;
  for (char k = 'b'; k < 'n'; ++k) {
    const char p = (char)(k - 1);
    snprintf(line, sizeof(line), "%c: &%c [*%c, *%c, *%c, *%c, *%c, *%c, *%c, *%c, *%c]\n", k, k, p, p, p, p, p, p, p,
             p, p);
    strcat(text, line);
  }
  assert_null(read_text(text, &said));
  assert_non_null(strstr(said, "aliases of aliases"));
  free(said);
}

/* A megabyte of text, a thousand times. */
static void TextBomb(void **state)
{
  const size_t size = 1000000;
  char *text = malloc(size + 20000), *end = text, *said;
  (void)state;
  end += sprintf(end, "a: &a \"");
  memset(end, 'y', size);
  end += size;
  end += sprintf(end, "\"\nb: [*a");
  for (int i = 0; i < 1000; ++i) end += sprintf(end, ", *a");
  sprintf(end, "]\n");
  assert_null(read_text(text, &said));
  assert_non_null(strstr(said, "aliases of aliases make the file too large"));
  free(said);
  free(text);
}

/* As many as a slip of a program makes: each took the time of all before it (49 s), and a line of
 * print. */
static void ManyUnknownKeys(void **state)
{
  enum { MANY = 50000 };
  char *text = malloc(MANY * 16 + sizeof PLAIN), *end = text + sprintf(text, PLAIN), *said;
  (void)state;
  for (int i = 0; i < MANY; ++i) end += sprintf(end, "key%d: 1\n", i);
  assert_null(read_text(text, &said));
  assert_int_equal(Count(said, ": error: "), DIAG_MOST);
  assert_non_null(strstr(said, "F:9:1: error: key 'key0' of the file is not known\n"));
  assert_non_null(strstr(said, "and 49950 more errors\n"));
  assert_true(strlen(said) < 20000);
  free(said);
  free(text);
}

/* 100,000 anchors that are all asked for once (60 s). The newest of a name counts. */
static void ManyAnchors(void **state)
{
  enum { MANY = 100000 };
  char *text = malloc(MANY * 36 + sizeof PLAIN), *end = text + sprintf(text, PLAIN "newton: {residual: 1e-3}\n"), *said;
  (void)state;
  end += sprintf(end, "petsc:\n");
  for (int i = 0; i < MANY; ++i) end += sprintf(end, "  a%d: &a%d 1\n", i, i % (MANY / 2));
  end += sprintf(end, "title: [");
  for (int i = 0; i < MANY / 2; ++i) end += sprintf(end, "*a%d, ", i);
  sprintf(end, "*nobody]\n");
  assert_null(read_text(text, &said));
  assert_non_null(strstr(said, "there is no anchor (&name) of this name before it"));
  assert_int_equal(Count(said, ": error: "), 1);
  free(said);
  free(text);
}

static void NulBytes(void **state)
{
  char *said;
  (void)state;
  assert_null(read_bytes("title: a\0b\n", 11, 0, NULL, &said));
  assert_non_null(strstr(said, "F:1:9: error: byte 0x00"));
  free(said);
}

/* Every prefix of a good file, and the file with one byte changed: an answer, never a crash. */
static void Truncated(void **state)
{
  char text[] = PLAIN "loads: {gravity: [0, -9.81]}\noutput: {every: {steps: 2}}\n", *said;
  const size_t size = strlen(text);
  (void)state;
  for (size_t n = 0; n < size; n += 3) {
    Case *c = read_bytes(text, n, 0, NULL, &said);
    CaseDestroy(&c);
    free(said);
  }
  for (size_t n = 0; n < size; ++n) {
    const char kept = text[n];
    text[n] = "{}[]:,&*!|>'\"%@`#-?\n\t x0"[n % 24];
    Case *c = read_bytes(text, size, 0, NULL, &said);
    CaseDestroy(&c);
    free(said);
    text[n] = kept;
  }
}

static void NoFile(void **state)
{
  const char *const names[] = {"/tmp/talus/no/such/file.yaml", "/tmp", "/dev/null"}, *const said[] = {
                                                                                       "there is no such file",
                                                                                       "this is a directory",
                                                                                       "no plain file"};
  (void)state;
  for (int i = 0; i < 3; ++i) {
    char *text = NULL;
    size_t size;
    Diag *diag;
    Case *c;
    DiagCreate(&diag);
    assert_int_equal(CaseRead(PETSC_COMM_WORLD, names[i], 0, NULL, diag, &c), 0);
    assert_null(c);
    FILE *out = open_memstream(&text, &size);
    DiagFlush(diag, out);
    fclose(out);
    assert_non_null(strstr(text, said[i]));
    free(text);
    DiagDestroy(&diag);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(Table),       cmocka_unit_test(AllAtOnce),
                                     cmocka_unit_test(Misspelled),  cmocka_unit_test(FirstStage),
                                     cmocka_unit_test(NoGrid),      cmocka_unit_test(Touching),
                                     cmocka_unit_test(Deep),        cmocka_unit_test(Bomb),
                                     cmocka_unit_test(TextBomb),    cmocka_unit_test(ManyUnknownKeys),
                                     cmocka_unit_test(ManyAnchors), cmocka_unit_test(NulBytes),
                                     cmocka_unit_test(Truncated),   cmocka_unit_test(NoFile)};
  if (PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  const int failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
