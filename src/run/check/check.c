#include "case/shape_volume.h"
#include "grid/cloud/cloud.h"
#include "run/check/check_private.h"
#include "run/report/price.h"
#include "run/stages/initial.h"
#include "solve/levels/coarse_box.h"
#include <stdarg.h>

/* What is known of each body over all ranks. */
typedef struct {
  PetscReal mass, volume;
  PetscInt points, on_faces, cells;
} BodyCount;

static PETSC_ATTRIBUTE_FORMAT(3, 4) void say(const Model *m, FILE *out, const char *format, ...)
{
  PetscMPIInt rank;
  va_list arguments;
  MPI_Comm_rank(m->comm, &rank);
  if (rank) return;
  va_start(arguments, format);
  vfprintf(out, format, arguments);
  va_end(arguments);
}

/* A point on a face belongs to two cells: which one it feels is a matter of round-off. */
static PetscBool is_on_face(const Model *m, PetscInt p)
{
  const CellType type = grid_cell_type(m->grid, m->points->cell[p]);
  return PetscAbsReal(cell_outside(type, point_real(m->points, POINT_XI, p))) < 1e-9;
}

static PetscErrorCode CountBodies(const Model *m, BodyCount *count)
{
  const PetscInt n = m->c->n_bodies;
  PetscReal *sum;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(5 * n, &sum));
  for (PetscInt p = 0; p < m->points->n; ++p) {
    PetscReal *s = sum + 5 * m->points->body[p];
    s[0] += m->points->real[POINT_MASS][p];
    s[1] += m->points->real[POINT_VOLUME][p];
    s[2] += 1;
    s[3] += is_on_face(m, p);
    s[4] += p == 0 || m->points->cell[p] != m->points->cell[p - 1];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(5 * n), MPIU_REAL, MPI_SUM, m->comm));
  for (PetscInt b = 0; b < n; ++b)
    count[b] = (BodyCount){.mass = sum[5 * b],
                           .volume = sum[5 * b + 1],
                           .points = (PetscInt)sum[5 * b + 2],
                           .on_faces = (PetscInt)sum[5 * b + 3],
                           .cells = (PetscInt)sum[5 * b + 4]};
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(0);
}

/* Of the body as it is seeded: initial stress has changed the volume of its points since. */
static PetscReal body_density(const Model *m, PetscInt body)
{
  for (PetscInt i = 0; i < m->c->n_materials; ++i)
    if (!strcmp(m->c->materials[i].name, m->c->bodies[body].material)) return m->c->materials[i].density;
  return 1;
}

/* Has initial stress changed the volume that its points would have without it? */
static PetscBool is_strained(const Model *m, PetscInt body, const BodyCount *count)
{
  return (PetscBool)(PetscAbsReal(count->volume * body_density(m, body) / count->mass - 1) > 1e-9);
}

/* What stands for a body's shape, and what that measures. */
static PetscErrorCode ReportFill(const Model *m, PetscInt body, PetscReal mass, FILE *out)
{
  const BodySpec *spec = &m->c->bodies[body];
  const PetscBool fills = body_fills_shape(spec, m->method->restores_grid);
  const PetscReal volume = mass / body_density(m, body),
                  shape = spec->has_shape && !spec->region
                            ? shape_volume(&spec->shape, m->c->kinematics, m->grid->min, m->grid->max)
                            : 0;

  PetscFunctionBeginUser;
  if (shape > 0)
    say(m, out, "#     %s: %.6g m3 for %.6g m3 of its shape (%+.2f %%)\n",
        fills ? "fill: shape" : "fill: cells, whole ones", (double)volume, (double)shape,
        (double)(100 * (volume / shape - 1)));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportBodies(const Model *m, Diag *diag, FILE *out)
{
  BodyCount *count;
  char path[64];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(m->c->n_bodies, &count));
  PetscCall(CountBodies(m, count));
  for (PetscInt b = 0; b < m->c->n_bodies; ++b) {
    if (m->c->bodies[b].absent) continue;
    const char *name = m->c->bodies[b].name;
    say(m, out, "#   body %s: %d points in %d cells, volume %g m3%s, mass %g kg\n", name, (int)count[b].points,
        (int)count[b].cells, (double)count[b].volume, is_strained(m, b, &count[b]) ? " without stress" : "",
        (double)count[b].mass);
    PetscCall(ReportFill(m, b, count[b].mass, out));
    PetscCall(PetscSNPrintf(path, sizeof path, "bodies[%d]", (int)b));
    PetscMPIInt rank;
    PetscCallMPI(MPI_Comm_rank(m->comm, &rank));
    if (rank) continue;
    if (count[b].on_faces)
      diag_warning(diag, path, "%d material points of '%s' lie on faces between cells", (int)count[b].on_faces, name);
  }
  PetscCall(PetscFree(count));
  PetscFunctionReturn(0);
}

/* What multigrid needs beside its matrix, measured: levels of a box, of the matrix; algebraic ones, bytes for each
 * number of a node's own block, however many nodes it sees, since those who see many are gathered in one of the next
 * level. */
#define BOX_LEVELS 0.7
#define ALGEBRAIC_LEVELS 750
/* Program and libraries, a rank. */
#define PROGRAM 45e6
/* A node's fields. */
#define NODE 600

/* Lists that grow have as much room to spare. */
#define ROOM 1.25

/* Nodes that a point with a domain comes to see, and their square: along each axis three of splines, of gimp two, and
 * one more where its domain, half a cell as a rule, lies across a knot, of gimp a line. */
static PetscReal nodes_of_domain(const Model *m, int power)
{
  const PetscReal least = m->space->basis == basis_find("gimp") ? 2 : 3, more = least + 1;
  const PetscReal mean = power == 1 ? 0.5 * (least + more) : 0.5 * (least * least + more * more);
  return m->dim == 3 ? mean * mean * mean : mean * mean;
}

/* What points see: numbers of nodes, N and dN, and where the pairs of these stand in the tangent; over all ranks.
 * Points with domains come to have nodes of their own, though many share them as they are seeded. */
static PetscErrorCode SupportMemory(const Model *m, PetscInt points, PetscReal *seen, PetscReal *pairs)
{
  const Support *w = m->space->support;
  PetscReal sums[3] = {0, 0, 0};

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < w->n_groups; ++g) {
    const PetscReal nn = (PetscReal)support_nodes(w, g);
    sums[0] += nn * (PetscReal)(w->point_start[g + 1] - w->point_start[g]);
    sums[1] += nn;
    sums[2] += nn * nn;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sums, 3, MPIU_REAL, MPI_SUM, m->comm));
  for (int k = 0; m->space->basis->domains && k < 3; ++k)
    sums[k] = PetscMax(sums[k], (PetscReal)points * nodes_of_domain(m, k < 2 ? 1 : 2));
  *seen = ROOM * (8 * (PetscReal)(1 + m->dim) * sums[0] + 4 * sums[1]);
  *pairs = ROOM * 4 * sums[2];
  PetscFunctionReturn(0);
}

/* Bytes of a tangent and what solves with it. In dynamics blocks stand in single precision twice, as they are gathered
 * and as rows have them, and for a while as they are; else PETSc has its own beside ours, or a coarse level does. */
static PetscReal tangent_memory(const Model *m, PetscInt unknowns)
{
  const LinearProblem problem = {.choice = m->c->linear,
                                 .dim = m->dim,
                                 .unknowns = unknowns,
                                 .pairs = m->system->n_pairs_global,
                                 .block = m->system->block,
                                 .symmetric = m->symmetric,
                                 .failing = case_seeks(&m->c->analysis),
                                 .levels = coarse_box_fits(m->grid),
                                 .mixed = m->formulation->pressure,
                                 .memory = m->machine_memory};
  const PetscReal block = (PetscReal)m->system->block,
                  value = m->scheme->inertia && !problem.mixed ? 8 + 4 + 4 : 8 + 8 + 4,
                  matrix = problem.pairs * (block * block * value + 12);
  if (m->scheme->inertia) return matrix;
  if (linear_factorises(&problem)) return matrix + linear_factor_bytes(&problem);
  return matrix + (problem.levels ? BOX_LEVELS * matrix : ALGEBRAIC_LEVELS * block * (PetscReal)unknowns);
}

/* Bytes, roughly: points, what they see, nodes, and where a step is solved for the tangent and its solver. */
static PetscErrorCode EstimateMemory(const Model *m, PetscInt points, PetscInt unknowns, PetscReal *needed)
{
  PetscReal per_point = 24, seen = 0, slots = 0;
  PetscMPIInt ranks;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(m->comm, &ranks));
  PetscCall(SupportMemory(m, points, &seen, &slots));
  for (PetscInt f = 0; f < POINT_N_REAL; ++f) per_point += 8 * (PetscReal)m->points->components[f];
  *needed = PROGRAM * ranks + (PetscReal)points * per_point + seen + NODE * (PetscReal)m->grid->n_nodes_global;
  if (m->c->analysis.type != ANALYSIS_EXPLICIT) *needed += slots + tangent_memory(m, unknowns);
  PetscFunctionReturn(0);
}

static void report_memory(const Model *m, PetscReal needed, Diag *diag, FILE *out)
{
  PetscMPIInt rank;
  MPI_Comm_rank(m->comm, &rank);
  say(m, out, "#   memory: about %.3g MB\n", (double)needed / 1e6);
  if (rank || m->machine_memory <= 0 || needed < m->machine_memory) return;
  diag_warning(diag, NULL, "the run will need about %.3g GB of memory, and there are %.3g GB", (double)needed / 1e9,
               (double)m->machine_memory / 1e9);
  if (m->c->linear == LINEAR_DIRECT) diag_hint(diag, "`linear: auto` iterates where a factorisation has no room");
}

/* How large clouds are, and how many are not what the rule aims at. */
static PetscErrorCode ReportClouds(const Model *m, FILE *out)
{
  const Support *w = m->space->support;
  PetscInt local[2] = {w->n_groups, w->n_groups ? w->node_start[w->n_groups] : 0}, all[2];

  PetscFunctionBeginUser;
  PetscCall(MPIU_Allreduce(local, all, 2, MPIU_INT, MPI_SUM, m->comm));
  say(m, out, "# the cloud\n#   %.1f nodes carry a point on average\n", (double)all[1] / (double)PetscMax(all[0], 1));
  PetscFunctionReturn(0);
}

/* A run that is cut into stages finds the nodes that statics before or after it would: its answer is not that of the
 * whole, unless the case says so. */
static void report_followers(const Model *m, FILE *out)
{
  const PetscReal follow = m->c->stabilisation.follow;
  if (m->c->spec && m->c->analysis.type == ANALYSIS_DYNAMIC && m->space->basis->domains && follow > 0)
    say(m, out, "#   stabilisation: follow = %g; a case of dynamics without stages has 0 unless it says so\n",
        (double)follow);
}

/* The fastest, those of pressure too where a pressure of its own bears them; HUGE_VAL in what is incompressible. */
static PetscReal fastest_wave(const Model *m)
{
  PetscReal most = 0;
  for (PetscInt i = 0; i < m->c->n_materials; ++i) {
    const Material *material = m->materials + i;
    const PetscReal modulus =
      m->formulation->pressure && !(material->compliance > 0) ? HUGE_VAL : material_confined(material);
    most = PetscMax(most, PetscSqrtReal(modulus / material->density));
  }
  return most;
}

static void report_waves(const Model *m, FILE *out)
{
  const PetscReal speed = fastest_wave(m), crossed = m->control.next / m->grid->smallest;
  if (isfinite(speed))
    say(m, out, "#   waves: %g m/s, %.3g cells in a step of %g s\n", (double)speed, (double)(speed * crossed),
        (double)m->control.next);
  else say(m, out, "#   waves: of pressure at once, since what is incompressible has no others\n");
}

static PetscErrorCode ReportSizes(Model *m, Diag *diag, FILE *out)
{
  PetscInt points;
  PetscReal needed = 0;
  char from[80], to[80], told[256];

  PetscFunctionBeginUser;
  PetscCall(ModelActivate(m));
  PetscCall(ModelCountPoints(m, &points));
  const PetscInt unknowns = m->system->n_active_global * m->system->block;
  if (m->grid->cloud) PetscCall(ReportClouds(m, out));
  say(m, out, "# the model\n#   grid: %d cells (%s%s%s), %d nodes, from %s to %s m\n", (int)m->grid->n_cells_global,
      cells[m->grid->type].name, grid_is_mixed(m->grid) ? ", " : "",
      grid_is_mixed(m->grid) ? cells[m->grid->first_type].name : "", (int)m->grid->n_nodes_global,
      text_position(m->dim, m->grid->min, from), text_position(m->dim, m->grid->max, to));
  method_tell_basis(m->method, m->c, sizeof told, told);
  say(m, out, "#   basis: %s\n", told);
  if (method_tell_transfer(m->method, m->c, sizeof told, told)) say(m, out, "#   transfer: %s\n", told);
  if (method_tell_scheme(m->method, m->c, sizeof told, told)) say(m, out, "#   scheme: %s\n", told);
  report_followers(m, out);
  say(m, out, "#   points: %d; unknowns at the start: %d\n", (int)points, (int)unknowns);
  PetscCall(EstimateMemory(m, points, unknowns, &needed));
  report_memory(m, needed, diag, out);
  if (m->scheme->inertia) report_waves(m, out);
  PetscCall(PriceTell(m, sizeof told, told));
  if (told[0]) say(m, out, "#   explicit: %s\n", told);
  PetscFunctionReturn(0);
}

/* What nobody wrote into the case file. */
static PetscErrorCode ReportAxis(const Model *m, FILE *out)
{
  PetscInt count[2];

  PetscFunctionBeginUser;
  if (boundary_axis(m->boundary) < 0) PetscFunctionReturn(0);
  PetscCall(ModelCountPrescribed(m, boundary_axis(m->boundary), count));
  say(m, out, "#   full circle: volumes, masses, forces and energies are those of the whole body of revolution\n");
  say(m, out, "#   axis: %d nodes at x = 0 are held along x, whatever `boundary` says\n", (int)count[0]);
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportEntry(const Model *m, PetscInt k, FILE *out)
{
  const MotionSpec *entry = m->c->boundary + k;
  PetscInt count[2];

  PetscFunctionBeginUser;
  PetscCall(ModelCountPrescribed(m, k, count));
  say(m, out, "#   boundary[%d]: moves %d nodes", (int)k, (int)count[0]);
  for (PetscInt i = 0; i < entry->n_bodies; ++i) say(m, out, "%s%s", i ? ", " : " of ", entry->bodies[i]);
  say(m, out, "%s\n", count[0] && !count[1] ? ", none beside material" : "");
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportSets(const Model *m, FILE *out)
{
  PetscFunctionBeginUser;
  for (PetscInt s = 0; s < m->grid->n_sets; ++s) {
    const GridSet *set = &m->grid->sets[s];
    PetscInt local[3] = {0, set->n_faces, set->n_cells}, all[3];
    for (PetscInt k = 0; k < set->n_nodes; ++k) local[0] += set->nodes[k] < m->grid->n_owned;
    PetscCall(MPIU_Allreduce(local, all, 3, MPIU_INT, MPI_SUM, m->comm));
    if (all[2]) say(m, out, "#   region %s: %d cells\n", set->name, (int)all[2]);
    else say(m, out, "#   boundary %s: %d nodes, %d faces\n", set->name, (int)all[0], (int)all[1]);
  }
  for (PetscInt k = 0; k < m->c->n_boundary; ++k) PetscCall(ReportEntry(m, k, out));
  PetscCall(ReportAxis(m, out));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReportInterfaces(const Model *m, FILE *out)
{
  PetscFunctionBeginUser;
  if (m->grid->n_fields > 1)
    say(m, out, "#   velocity fields: %d, each with its share of these cells and nodes\n", (int)m->grid->n_fields);
  if (m->grid->cloud && m->grid->cloud->n_motions > 1)
    say(m, out, "#   velocity fields: %d, each with nodes of its own\n", (int)m->grid->cloud->n_motions);
  for (PetscInt k = 0; k < m->c->n_interfaces; ++k) {
    PetscInt local[2] = {0, 0}, all[2];
    for (const ContactPoint *c = m->contact->point; c < m->contact->point + m->contact->n; ++c) {
      if (c->wall != m->c->n_walls + k) continue;
      ++local[0];
      local[1] += c->touches;
    }
    PetscCall(MPIU_Allreduce(local, all, 2, MPIU_INT, MPI_SUM, m->comm));
    say(m, out, "#   interface %s: %d points of '%s' touch '%s', %d more are near it\n", m->c->interfaces[k].name,
        (int)all[1], m->c->interfaces[k].between[0], m->c->interfaces[k].between[1], (int)(all[0] - all[1]));
  }
  PetscFunctionReturn(0);
}

/* One model: of a case, or of a stage, from what is seeded. */
static PetscErrorCode CheckOne(MPI_Comm comm, const Case *whole, const Case *c, Diag *diag, FILE *out)
{
  Imbalance unsaid;
  Model *m;

  PetscFunctionBeginUser;
  PetscCall(ModelCreate(comm, c, diag, &m));
  if (m) model_advise_still(m, whole, diag);
  if (!m) PetscFunctionReturn(0);
  if (c->spec) say(m, out, "# stage %d: %s\n", (int)c->stage + 1, c->spec->name);
  PetscCall(ReportSizes(m, diag, out));
  PetscCall(ReportSets(m, out));
  PetscCall(ReportBodies(m, diag, out));
  PetscCall(ReportInterfaces(m, out));
  PetscCall(CheckOpenings(m, diag));
  if (c->initial.run && c->stage == 0) PetscCall(InitialTake(m, diag, &unsaid));
  PetscCall(ModelDestroy(&m));
  fflush(out);
  PetscFunctionReturn(0);
}

PetscErrorCode CheckModel(MPI_Comm comm, const Case *c, Diag *diag, FILE *out)
{
  PetscInt errors = 0;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < case_stages(c) && !errors; ++k) {
    if (c->n_stages) c->stage_case[k]->grid.trusted = c->grid.trusted;
    if (c->n_stages) diag_of_stage(diag, k, c->stages[k].name);
    if (k > 0) PetscCall(RenameCheck(case_stage(c, k), case_stage(c, k - 1), PETSC_TRUE, diag));
    PetscCall(CheckOne(comm, c, case_stage(c, k), diag, out));
    PetscCall(DiagReduce(comm, diag, &errors));
  }
  diag_of_stage(diag, -1, NULL);
  PetscFunctionReturn(0);
}
