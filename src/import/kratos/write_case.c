/* case.yaml of a project. */
#include <string.h>
#include "import/kratos/project.h"
#include "input/schema/schema.h"

static void write_vector(FILE *out, const PetscReal *value, PetscInt dim)
{
  fputc('[', out);
  for (PetscInt d = 0; d < dim; ++d) {
    if (d) fputs(", ", out);
    schema_write_real(out, value[d]);
  }
  fputc(']', out);
}

static void write_analysis(const KratosProject *p, FILE *out)
{
  fprintf(out, "analysis: {type: %s, end: ", p->dynamic ? "dynamic" : "static");
  schema_write_real(out, p->end);
  if (p->dynamic) {
    fputs(", step: ", out);
    schema_write_real(out, p->step);
    if (p->bossak < 0) {
      fputs(", bossak: ", out);
      schema_write_real(out, p->bossak);
    } else if (p->beta != 0.25) {
      fputs(", beta: ", out);
      schema_write_real(out, p->beta);
    }
    if (!p->consistent) fputs(", mass: lumped", out); /* Kratos's default, in 2019 all that it had */
    fputs(", transfer: thesis", out);                 /* as Kratos does */
  } else fprintf(out, ", steps: %" PetscInt_FMT, p->n_steps);
  if (p->dynamic || kratos_is_held(p)) {
    fputs("}\n", out);
    return;
  }
  fputs(
    ", unheld: hold}\n"
    "# No part holds everything. Kratos solves such systems as they are; what rigid motion it finds along what\n"
    "# nothing holds depends on its solver, stresses do not. Here single nodes are held, which bear nothing.\n",
    out);
  diag_warning(p->diag, NULL,
               "no part of the grid holds the material in all directions and from turning: what is left free is held "
               "by single nodes that bear nothing (analysis: {unheld: hold})");
}

static void write_bodies(const KratosProject *p, FILE *out)
{
  fputs("bodies:\n", out);
  for (PetscInt b = 0; b < p->n_bodies; ++b) {
    const KratosBody *body = &p->bodies[b];
    fprintf(out, "  - {name: %s, mesh: body.msh, region: %s, points_per_cell: %" PetscInt_FMT ", material: %s",
            body->name, body->name, body->points, body->name);
    if (body->velocity[0] != 0 || body->velocity[1] != 0 || body->velocity[2] != 0) {
      fputs(", velocity: ", out);
      write_vector(out, body->velocity, p->dim);
    }
    fputs("}\n", out);
  }
  fputs("materials:\n", out);
  for (PetscInt b = 0; b < p->n_bodies; ++b) {
    fprintf(out, "  %s: {law: %s", p->bodies[b].name, p->bodies[b].law);
    for (PetscInt i = 0; i < p->bodies[b].n_constants; ++i) {
      fprintf(out, ", %s: ", p->bodies[b].key[i]);
      schema_write_real(out, p->bodies[b].constant[i]);
    }
    fputs("}\n", out);
  }
}

/* From `from` when the case begins to 1 at its end. */
static void write_ramp(const char *key, int from, PetscReal end, FILE *out)
{
  fprintf(out, ", %s: [[0, %d], [", key, from);
  schema_write_real(out, end);
  fputs(", 1]]", out);
}

/* The grid starts anew in every step: what Kratos prescribes is the displacement of each step. */
static void write_held(const KratosProject *p, const KratosAction *a, PetscBool moves, FILE *out)
{
  const PetscBool grows =
    moves && p->dynamic; /* without amplitude it comes at once in dynamics, by and by in statics */
  PetscBool first = PETSC_TRUE;
  for (PetscInt d = 0; d < p->dim; ++d) {
    if (!a->set[d] || (a->value[d] != 0) != moves) continue;
    if (first)
      fprintf(out, "  - {name: %s%s, on: {boundary: %s}, %s", a->name, moves ? "_moves" : "", a->name,
              moves ? "displacement: {" : "fix: [");
    fprintf(out, "%s%c", first ? "" : ", ", "xyz"[d]);
    if (moves) {
      fputs(": ", out);
      schema_write_real(out, a->value[d] * (PetscReal)p->n_steps);
    }
    first = PETSC_FALSE;
  }
  if (first) return;
  fputs(moves ? "}" : "]", out);
  if (grows) write_ramp("amplitude", 0, p->end, out);
  fputs("}\n", out);
}

static void write_boundary(const KratosProject *p, FILE *out)
{
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; i < p->n_actions; ++i) {
    const KratosAction *a = &p->actions[i];
    if (a->kind != KRATOS_HELD && a->kind != KRATOS_SLIP) continue;
    if (!any) fputs("boundary:\n", out);
    any = PETSC_TRUE;
    if (a->kind == KRATOS_SLIP) fprintf(out, "  - {name: %s, on: {boundary: %s}, fix: [normal]}\n", a->name, a->name);
    else {
      write_held(p, a, PETSC_FALSE, out);
      write_held(p, a, PETSC_TRUE, out);
    }
  }
}

static void write_amplitude(const KratosProject *p, const char *key, FILE *out)
{
  if (!p->dynamic && p->n_steps > 1) write_ramp(key, 1, p->end, out); /* else all of it at once is what both do */
}

static void write_factor(const KratosAction *a, FILE *out)
{
  if (a->factor[0]) fprintf(out, ", factor: \"%s\"", a->factor);
}

/* A force at each node of a part. */
static void write_points(const KratosProject *p, const KratosAction *a, FILE *out)
{
  const MdpaPart *part = mdpa_part(p->grid, a->part);
  for (PetscInt k = 0; k < part->nodes.n; ++k) {
    const PetscInt node = mdpa_node(p->grid, part->nodes.id[k]);
    if (node < 0) continue;
    fputs("    - {at: ", out);
    write_vector(out, p->grid->x[node], p->dim);
    fputs(", force: ", out);
    write_vector(out, a->value, p->dim);
    write_amplitude(p, "amplitude", out);
    write_factor(a, out);
    fputs("}\n", out);
  }
}

static void write_loads_of(const KratosProject *p, KratosKind kind, const char *key, FILE *out)
{
  PetscBool any = PETSC_FALSE;
  for (PetscInt i = 0; i < p->n_actions; ++i) {
    const KratosAction *a = &p->actions[i];
    if (a->kind != kind) continue;
    if (!any) fprintf(out, "  %s:\n", key);
    any = PETSC_TRUE;
    if (kind == KRATOS_POINT_LOAD) write_points(p, a, out);
    else {
      fprintf(out, "    - {on: {boundary: %s}, value: ", a->name);
      write_vector(out, a->value, p->dim);
      write_amplitude(p, "amplitude", out);
      write_factor(a, out);
      fputs("}\n", out);
    }
  }
}

static void write_loads(const KratosProject *p, FILE *out)
{
  fputs("loads:\n  gravity: ", out);
  write_vector(out, p->gravity, p->dim);
  fputc('\n', out);
  if (!p->dynamic && p->n_steps > 1) {
    fputs("  gravity_amplitude: [[0, 1], [", out);
    schema_write_real(out, p->end);
    fputs(", 1]]\n", out);
  }
  write_loads_of(p, KRATOS_LINE_LOAD, "tractions", out);
  write_loads_of(p, KRATOS_POINT_LOAD, "points", out);
}

PetscErrorCode KratosWriteCase(const KratosProject *p, FILE *out)
{
  PetscFunctionBeginUser;
  fprintf(out, "# Written by talus import kratos; what was left out or taken otherwise was said then.\ntitle: ");
  schema_write_text(out, p->name);
  fprintf(out, "\nkinematics: %s\nmethod: mpm\n",
          p->dim == 3       ? "3d"
          : p->axisymmetric ? "axisymmetric"
                            : "plane-strain");
  if (p->mixed) fputs("formulation: mixed\n", out);
  fputs("basis: {cell: {}}                 # linear functions, as Kratos has them\n", out);
  write_analysis(p, out);
  fputs("grid: {mesh: grid.msh, outside: remove}\n", out);
  write_bodies(p, out);
  write_boundary(p, out);
  write_loads(p, out);
  fprintf(out, "output: {fields: [displacement, velocity, stress], every: {steps: %" PetscInt_FMT "}}\n",
          PetscMax(p->n_steps / 20, 1));
  PetscFunctionReturn(0);
}
