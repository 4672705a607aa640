/* Loads that the material carries, through stages that bring some, change some and drop others. Their carriers know
 * the places that the load had in the undeformed body, and no other: those of a load that comes later go with the
 * body from the start, and push nothing till then. */
#include <string.h>
#include "model/stage/stage_private.h"

static PetscBool same_text(const char *a, const char *b) { return (PetscBool)(a && b ? !strcmp(a, b) : a == b); }

static PetscBool same_numbers(const PetscReal *a, const PetscReal *b, PetscInt n)
{
  for (PetscInt i = 0; i < n; ++i)
    if (a[i] != b[i]) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool same_shape(const Shape *a, const Shape *b)
{
  if (a->kind != b->kind || a->n_vertices != b->n_vertices || a->n_children != b->n_children || a->open != b->open ||
      !same_text(a->file, b->file) || !same_text(a->group, b->group))
    return PETSC_FALSE;
  if (!same_numbers(a->min, b->min, 3) || !same_numbers(a->max, b->max, 3) || !same_numbers(a->centre, b->centre, 3) ||
      !same_numbers(a->point, b->point, 3) || !same_numbers(a->normal, b->normal, 3) ||
      !same_numbers(a->radii, b->radii, 2) || !same_numbers(a->angle, b->angle, 2) ||
      !same_numbers(a->offset, b->offset, 3) || a->radius != b->radius || a->length != b->length ||
      a->scale != b->scale || !same_numbers(a->vertices, b->vertices, 2 * a->n_vertices))
    return PETSC_FALSE;
  for (PetscInt i = 0; i < a->n_children; ++i)
    if (!same_shape(a->children + i, b->children + i)) return PETSC_FALSE;
  return PETSC_TRUE;
}

/* Do they act at the same place? */
static PetscBool same_place(const LoadSpec *a, const LoadSpec *b)
{
  if (a->kind != b->kind) return PETSC_FALSE;
  if (a->kind == LOAD_POINT) return same_numbers(a->at, b->at, 3);
  if (!same_text(a->on.body, b->on.body) || !same_text(a->on.boundary, b->on.boundary)) return PETSC_FALSE;
  for (int d = 0; d < 3; ++d) {
    if (a->on.has[d] != b->on.has[d]) return PETSC_FALSE;
    if (a->on.has[d] && (a->on.min[d] != b->on.min[d] || a->on.max[d] != b->on.max[d])) return PETSC_FALSE;
  }
  return (PetscBool)(a->on.has_shape == b->on.has_shape &&
                     (!a->on.has_shape || same_shape(&a->on.shape, &b->on.shape)));
}

/* How alike loads of the same place must be to be one, from sure to possible. */
enum { NAME_AND_VALUE, NAME, PLACE, LIKENESSES };

static PetscBool are_alike(const LoadSpec *a, const LoadSpec *b, int likeness)
{
  if (!same_place(a, b)) return PETSC_FALSE;
  if (likeness < PLACE && !same_text(a->name, b->name)) return PETSC_FALSE;
  return (PetscBool)(likeness > NAME_AND_VALUE || same_numbers(a->value, b->value, 3));
}

/* now[i]: which load of the case load i of the one before goes on as, -1: none; was[k]: the other way. */
static void map_loads(const Case *c, const Case *from, PetscInt *now, PetscInt *was)
{
  for (PetscInt i = 0; i < from->n_loads; ++i) now[i] = -1;
  for (PetscInt k = 0; k < c->n_loads; ++k) was[k] = -1;
  for (int likeness = 0; likeness < LIKENESSES; ++likeness)
    for (PetscInt k = 0; k < c->n_loads; ++k)
      for (PetscInt i = 0; i < from->n_loads && was[k] < 0; ++i)
        if (now[i] < 0 && are_alike(c->loads + k, from->loads + i, likeness)) now[i] = k, was[k] = i;
}

/* In a cloud all of them are. */
static PetscBool is_carried(const Case *c, const LoadSpec *load)
{
  const Method *method = method_find(c->method);
  return (PetscBool)(load->kind != LOAD_TRACTION || load->on.body || (method && method->clouds));
}

PetscBool loads_are_carried(const Case *c)
{
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (is_carried(c, c->loads + k)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The component of a value that is largest. */
static PetscInt largest_of(const LoadSpec *load)
{
  PetscInt d = 0;
  for (PetscInt i = 1; i < 3; ++i)
    if (PetscAbsReal(load->value[i]) > PetscAbsReal(load->value[d])) d = i;
  return d;
}

#define BESIDE 1e-9 /* of how far it is from the origin: a point that stands on the surface of its body */

/* Does it act on the body? A point load acts on what is at its place. unknown: the answer where the case does not
 * tell, of a side of the grid, and of a body without a shape. */
static PetscBool acts_on(const LoadSpec *load, const BodySpec *body, PetscInt dim, PetscBool unknown)
{
  const PetscReal beside =
    BESIDE * (1 + PetscAbsReal(load->at[0]) + PetscAbsReal(load->at[1]) + PetscAbsReal(load->at[2]));
  if (load->on.body) return (PetscBool)!strcmp(body->name, load->on.body);
  if (load->kind != LOAD_POINT || !body->has_shape) return unknown;
  return shape_contains(&body->shape, dim, load->at, beside);
}

/* Does it begin with a body that it acts on? */
static PetscBool comes_with_body(const Case *c, const Case *from, const LoadSpec *load, PetscBool unknown)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b)
    if (!c->bodies[b].absent && body_comes(c, from, b) &&
        acts_on(load, &c->bodies[b], kinematics_dim(c->kinematics), unknown))
      return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Does the stage before tell where it acts, though it does not act there? Bodies that go from beside a side of the grid
 * leave it another surface. */
static PetscBool may_wait(const Case *c, const Case *before, const LoadSpec *load)
{
  const PetscBool on_side = (PetscBool)(!load->on.body && load->kind != LOAD_POINT);
  for (PetscInt b = 0; b < before->n_bodies && on_side; ++b)
    if (!before->bodies[b].absent && body_comes(before, c, b)) return PETSC_FALSE;
  return (PetscBool)!comes_with_body(c, before, load, PETSC_TRUE);
}

/* Carriers of a load of 0 know no more of the surface that they stand for. */
static PetscBool has_lost_surface(const LoadSpec *before, const LoadSpec *load)
{
  return (PetscBool)(load->kind != LOAD_POINT && !load_pushes(before) && load_pushes(load));
}

static LoadSpec waiting(const LoadSpec *load, PetscInt stage)
{
  static PetscReal never[1] = {0};
  LoadSpec w = *load;
  w.amplitude = (Amplitude){.n = 1, .time = never, .value = never};
  w.factor = NULL;
  w.waits = load->waits ? load->waits : stage;
  return w;
}

PetscErrorCode LoadsWait(const Case *c, Case *before)
{
  const PetscInt n = before->n_loads;
  PetscInt *now, *was;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &now, c->n_loads, &was));
  map_loads(c, before, now, was);
  PetscCall(PetscRealloc((size_t)(n + c->n_loads) * sizeof *before->loads, &before->loads));
  for (PetscInt k = 0; k < c->n_loads; ++k) {
    const LoadSpec *load = c->loads + k;
    const PetscBool goes_on = (PetscBool)(was[k] >= 0 && !has_lost_surface(before->loads + was[k], load));
    if (goes_on || !is_carried(c, load) || !may_wait(c, before, load)) continue;
    before->loads[before->n_loads++] = waiting(load, c->stage);
  }
  PetscCall(PetscFree2(now, was));
  PetscFunctionReturn(0);
}

/* No carriers go on as its own, and none come with a body. */
static void tell_no_carriers(const Case *c, PetscInt k, Diag *diag)
{
  const PetscInt waits = c->loads[k].waits;
  char path[64], which[64] = "this load";
  if (waits) snprintf(which, sizeof which, "a load of stage %d", (int)waits + 1);
  if (c->stage == 0) {
    diag_error(diag, waits ? "initial.run" : case_load_path(c, k, path),
               "the material carries %s from its undeformed surface on, of which the run of `initial` knows nothing",
               which);
    diag_hint(diag, "let it stand in the case of that run, too: in a stage behind the state that is taken");
  } else {
    diag_error(diag, waits ? "bodies" : case_load_path(c, k, path),
               "bodies come or go with this stage, and the case does not tell whether %s acts on them", which);
    diag_hint(diag, "name the body that carries it: a traction or a pressure `on: {body: ...}`");
  }
}

static void check_load(const Case *c, const Case *from, PetscInt k, const LoadSpec *before, Diag *diag)
{
  const LoadSpec *load = c->loads + k;
  char path[64], key[96];
  if (!before && !comes_with_body(c, from, load, PETSC_FALSE)) {
    tell_no_carriers(c, k, diag);
  } else if (before && has_lost_surface(before, load)) {
    snprintf(key, sizeof key, "%s.value", case_load_path(c, k, path));
    diag_error(diag, key,
               "it was 0 before, and the carriers of the load know no more of the surface that they stand for");
    diag_hint(diag, "give it a value there, with an amplitude that is 0");
  }
}

PetscErrorCode LoadsCheck(const Case *c, const Case *from, Diag *diag)
{
  PetscInt *now, *was;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(from->n_loads, &now, c->n_loads, &was));
  map_loads(c, from, now, was);
  for (PetscInt k = 0; k < c->n_loads; ++k)
    if (is_carried(c, c->loads + k)) check_load(c, from, k, was[k] >= 0 ? from->loads + was[k] : NULL, diag);
  PetscCall(PetscFree2(now, was));
  PetscFunctionReturn(0);
}

/* A traction acts on undeformed surface, of which the carrier's force was `before` times as much; a pressure on the
 * present one. */
static void change_force(const LoadSpec *load, const LoadSpec *before, PetscInt dim, PetscReal *force)
{
  const PetscInt d = largest_of(before);
  const PetscReal area = load_pushes(before) ? force[d] / before->value[d] : 0;
  for (PetscInt i = 0; i < dim; ++i)
    force[i] = load->kind == LOAD_PRESSURE ? (load_pushes(before) ? force[i] / before->value[0] * load->value[0] : 0)
                                           : (load->kind == LOAD_POINT ? 1 : area) * load->value[i];
}

PetscErrorCode TakeCarriers(Model *m, const Tables *tables, const Case *from, char reason[256])
{
  const Case *c = m->c;
  Points *carriers = m->loads->carriers, *begun;
  PetscInt *now, *was;
  PetscBool *begins;

  PetscFunctionBeginUser;
  if (!loads_are_carried(c)) PetscFunctionReturn(0);
  PetscCall(PetscMalloc2(from->n_loads, &now, c->n_loads, &was));
  map_loads(c, from, now, was);
  const PointsChange change = {.n_bodies = from->n_loads, .n_materials = PetscMax(1, from->n_materials), .body = now};
  /* carriers of loads that begin with their body are those that the body was drawn with */
  PetscCall(PetscMalloc1(carriers->n, &begins));
  for (PetscInt p = 0; p < carriers->n; ++p) begins[p] = (PetscBool)(was[carriers->body[p]] < 0);
  PetscCall(PutAside(carriers, m->dim, begins, &begun));
  PetscCall(PetscFree(begins));
  PetscCall(PointsTake(carriers, m->grid, tables_find(tables, "carriers"), &change, reason));
  PetscCall(PutBack(&begun, reason, carriers));
  for (PetscInt p = 0; p < carriers->n && !reason[0]; ++p) {
    const PetscInt k = carriers->body[p];
    if (was[k] < 0) continue;
    const LoadSpec *before = from->loads + was[k];
    PetscReal *force = point_real(carriers, POINT_FORCE, p);
    if (!same_numbers(c->loads[k].value, before->value, 3)) change_force(c->loads + k, before, m->dim, force);
  }
  PetscCall(PetscFree2(now, was));
  PetscFunctionReturn(0);
}

PetscErrorCode RenameLoads(const Case *c, const Case *from, Table *ended)
{
  PetscInt *now, *was;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(from->n_loads, &now, c->n_loads, &was));
  map_loads(c, from, now, was);
  PetscCall(PickRows(ended, c->n_loads, was));
  PetscCall(PetscFree2(now, was));
  PetscFunctionReturn(0);
}
