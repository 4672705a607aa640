/* Tables of a state as those of a case whose measures and walls have come, gone or changed places: each is found
 * by its name, and what was not there before begins with zeros. */
#include <string.h>
#include "model/measure/measure.h"
#include "model/stage/stage_private.h"

PetscInt measure_before(const Case *c, PetscInt k, const Case *from)
{
  return c->measures[k].since < c->stage ? case_measure_of(from, c->measures[k].name) : -1;
}

static PetscInt find_wall(const Case *c, const char *name)
{
  for (PetscInt k = 0; k < c->n_walls; ++k)
    if (!strcmp(c->walls[k].name, name)) return k;
  return -1;
}

static PetscInt find_interface(const Case *c, const char *name)
{
  for (PetscInt k = 0; k < c->n_interfaces; ++k)
    if (!strcmp(c->interfaces[k].name, name)) return k;
  return -1;
}

/* Of walls and then interfaces: which of the other case's each is. */
static PetscInt partner_before(const Case *c, PetscInt k, const Case *from)
{
  if (k < c->n_walls) return find_wall(from, c->walls[k].name);
  const PetscInt interface = find_interface(from, c->interfaces[k - c->n_walls].name);
  return interface < 0 ? -1 : from->n_walls + interface;
}

/* How many walls with mass come before wall k. */
static PetscInt rigid_index(const Case *c, PetscInt k)
{
  PetscInt n = 0;
  for (PetscInt i = 0; i < k; ++i) n += c->walls[i].has_mass;
  return n;
}

/* Blocks of `bytes`: block k of each of so many rows becomes block was[k], n of them. */
static PetscErrorCode Pick(Column *column, PetscInt64 rows, size_t bytes, PetscInt before, PetscInt n,
                           const PetscInt *was)
{
  char *data;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1((size_t)PetscMax(rows, 1) * bytes * (size_t)PetscMax(n, 1), &data));
  for (PetscInt64 r = 0; r < rows; ++r)
    for (PetscInt k = 0; k < n; ++k)
      if (was[k] >= 0)
        PetscCall(PetscMemcpy(data + ((size_t)r * (size_t)n + (size_t)k) * bytes,
                              (char *)column->data + ((size_t)r * (size_t)before + (size_t)was[k]) * bytes, bytes));
  if (column->owned) PetscCall(PetscFree(column->data));
  column->data = data;
  column->owned = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode PickRows(Table *table, PetscInt n, const PetscInt *was)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; table && i < table->n; ++i) {
    Column *column = &table->column[i];
    PetscCall(
      Pick(column, 1, column_type_bytes(column->type) * (size_t)column->components, (PetscInt)table->rows, n, was));
  }
  if (table) table->rows = n;
  PetscFunctionReturn(0);
}

/* Lists stand one behind the other. */
static PetscErrorCode PickLists(const Tables *tables, PetscInt n, const PetscInt *was)
{
  Table *lists = tables_find(tables, "measure_lists"), *numbers = tables_find(tables, "measure_numbers");
  char unheard[256];
  PetscInt total = 0, *number;

  PetscFunctionBeginUser;
  if (!lists || !numbers) PetscFunctionReturn(0);
  const PetscInt64 *length = table_data(lists, "length", COLUMN_INT64, 1, unheard);
  PetscCall(PetscMalloc1(numbers->rows, &number));
  for (PetscInt k = 0; k < n && length; ++k) {
    PetscInt first = 0;
    for (PetscInt i = 0; i < was[k]; ++i) first += (PetscInt)length[i];
    for (PetscInt i = 0; was[k] >= 0 && i < length[was[k]] && total < numbers->rows; ++i) number[total++] = first + i;
  }
  PetscCall(PickRows(numbers, total, number));
  PetscCall(PickRows(lists, n, was));
  PetscCall(PetscFree(number));
  PetscFunctionReturn(0);
}

static PetscErrorCode RenameMeasures(const Case *c, const Case *from, const Tables *tables)
{
  PetscInt *was;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(c->n_measures, &was));
  for (PetscInt k = 0; k < c->n_measures; ++k) was[k] = measure_before(c, k, from);
  PetscCall(PickLists(tables, c->n_measures, was));
  PetscCall(PickRows(tables_find(tables, "measures"), c->n_measures, was));
  PetscCall(PickRows(tables_find(tables, "ended"), c->n_measures, was));
  PetscCall(PetscFree(was));
  PetscFunctionReturn(0);
}

/* What carriers keep of each partner, for so many sides of it as another case has: a wall with corners has come, or
 * the last one gone. No other wall has more than one. */
static PetscErrorCode Refit(Column *column, PetscInt64 rows, PetscInt n, PetscInt dim, PetscInt before, PetscInt sides)
{
  const PetscInt old = contact_kept_partner(dim, before), width = contact_kept_partner(dim, sides);
  const PetscInt both = PetscMin(contact_kept_side(dim, before), contact_kept_side(dim, sides));
  PetscReal *data;

  PetscFunctionBeginUser;
  column->components = n * width;
  if (before == sides) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1((size_t)PetscMax(rows * n * width, 1), &data));
  for (PetscInt64 k = 0; k < rows * n; ++k)
    PetscCall(PetscArraycpy(data + k * width, (PetscReal *)column->data + k * old, both));
  if (column->owned) PetscCall(PetscFree(column->data));
  column->data = data;
  column->owned = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* Springs of another stiffness go on with the force that they had: surfaces are where another scheme would find
 * them. */
static void let_go_of_springs(const Case *c, const Case *from, const Column *contact, PetscInt64 rows, PetscInt dim)
{
  const PetscInt sides = contact_sides(c), side = contact_kept_side(dim, sides);
  const PetscInt64 n = rows * (c->n_walls + c->n_interfaces) * sides;
  PetscReal *kept = contact->data;
  if (c->analysis.type != ANALYSIS_EXPLICIT || c->analysis.contact == from->analysis.contact) return;
  for (PetscInt64 k = 0; k < n; ++k)
    if (contact_is_sprung(kept[k * side + KEPT_STATE])) kept[k * side + KEPT_STATE] -= CONTACT_SPRING;
}

static PetscErrorCode RenamePartners(const Case *c, const Case *from, PetscInt dim, const Tables *tables)
{
  const PetscInt n = c->n_walls + c->n_interfaces, before = from->n_walls + from->n_interfaces;
  const PetscInt sides_before = contact_sides(from), width = contact_kept_partner(dim, sides_before);
  Table *points = tables_find(tables, "points");
  PetscInt *was, *rigid, n_rigid = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &was, n, &rigid));
  for (PetscInt k = 0; k < n; ++k) {
    was[k] = partner_before(c, k, from);
    if (k >= c->n_walls || !c->walls[k].has_mass) continue;
    rigid[n_rigid++] = was[k] >= 0 && from->walls[was[k]].has_mass ? rigid_index(from, was[k]) : -1;
  }
  PetscCall(PickRows(tables_find(tables, "walls"), n, was));
  PetscCall(PickRows(tables_find(tables, "rigid_walls"), n_rigid, rigid));
  for (PetscInt i = 0; points && i < points->n; ++i) {
    Column *column = &points->column[i];
    if (strcmp(column->name, "contact") != 0 || column->components != before * width) continue;
    PetscCall(Pick(column, points->rows, (size_t)width * sizeof(PetscReal), before, n, was));
    PetscCall(Refit(column, points->rows, n, dim, sides_before, contact_sides(c)));
    let_go_of_springs(c, from, column, points->rows, dim);
  }
  PetscCall(PetscFree2(was, rigid));
  PetscFunctionReturn(0);
}

PetscErrorCode RenameTables(const Model *m, const Case *from, const Tables *tables)
{
  PetscFunctionBeginUser;
  PetscCall(RenameMeasures(m->c, from, tables));
  PetscCall(RenamePartners(m->c, from, m->dim, tables));
  PetscCall(RenameLoads(m->c, from, tables_find(tables, "ended_loads")));
  PetscFunctionReturn(0);
}

static void check_walls(const Case *c, const Case *from, Diag *diag)
{
  const PetscInt n = c->n_walls + c->n_interfaces, before = from->n_walls + from->n_interfaces;
  if (n > 0 && before == 0) {
    diag_error(diag, c->n_walls ? "walls" : "interfaces", "nothing in the state knows how far it reaches to a wall");
    diag_hint(diag, "name a wall that comes later at the top of the file, with absent: true");
  }
  for (PetscInt k = 0; k < c->n_walls && before > 0; ++k) {
    const PetscInt was = find_wall(from, c->walls[k].name);
    if (!c->walls[k].has_mass || (was >= 0 && from->walls[was].has_mass)) continue;
    diag_error(diag, "walls", "wall '%s' has mass, and the state knows nothing of its motion", c->walls[k].name);
    diag_hint(diag, "name it at the top of the file, with its mass and absent: true");
  }
}

/* Which bodies meet decides which nodes they have. */
static void check_interfaces(const Case *c, const Case *from, Diag *diag)
{
  for (int side = 0; side < 2; ++side) {
    const Case *here = side ? c : from, *there = side ? from : c;
    for (PetscInt k = 0; k < here->n_interfaces; ++k) {
      const InterfaceSpec *s = &here->interfaces[k];
      const PetscInt i = find_interface(there, s->name);
      if (i >= 0 && !strcmp(s->between[0], there->interfaces[i].between[0]) &&
          !strcmp(s->between[1], there->interfaces[i].between[1]))
        continue;
      diag_error(diag, "interfaces", "the interface '%s' between '%s' and '%s' %s: bodies would have other nodes",
                 s->name, s->between[0], s->between[1], side ? "was not there before" : "is gone");
      diag_hint(diag,
                "`contact: bonded` holds bodies together from the top of the file on, until a stage names another");
      return;
    }
  }
}

/* What points keep of events is theirs from the start. */
static void check_events(const Case *c, const Case *from, Diag *diag)
{
  char path[512];
  for (int side = 0; side < 2; ++side) {
    const Case *here = side ? c : from;
    for (PetscInt k = 0; k < here->n_measures; ++k) {
      const char *name = here->measures[k].name;
      const PetscInt now = case_measure_of(c, name);
      if (!measure_find(here->measures[k].kind)->events || (now >= 0 && measure_before(c, now, from) >= 0)) continue;
      snprintf(path, sizeof path, "measures.%s", name);
      diag_error(diag, side ? path : "measures", "'%s' counts events, and can neither come, go nor change with a stage",
                 name);
    }
  }
}

/* Bodies that come with a law that has no state without stress. */
static void check_stresses(const Case *c, const Case *from, Diag *diag)
{
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    if (c->bodies[b].absent || !body_comes(c, from, b) || body_has_stress(&c->bodies[b])) continue;
    for (PetscInt i = 0; i < c->n_materials; ++i) {
      const Law *law = law_find(c->materials[i].law);
      if (!strcmp(c->materials[i].name, c->bodies[b].material) && law && law->needs_stress)
        stress_tell_none(c, b, law, diag);
    }
  }
}

/* NAN: not given. */
static PetscReal value_of(const MaterialSpec *s, const char *name)
{
  for (PetscInt i = 0; i < s->n_parameters; ++i)
    if (!strcmp(s->parameters[i].name, name)) return s->parameters[i].value;
  return NAN;
}

/* What says how points begin means nothing to those that are there. */
static void check_starts(const Case *c, const Case *from, Diag *diag)
{
  char path[256];
  for (PetscInt b = 0; b < c->n_bodies; ++b) {
    if (c->bodies[b].absent || body_comes(c, from, b)) continue;
    const MaterialSpec *is = c->materials + body_material(c, b);
    const MaterialSpec *was = from->materials + body_material(from, case_body(from, c->bodies[b].name));
    const Law *law = strcmp(is->law, was->law) ? NULL : law_find(is->law);
    for (const LawParameter *p = law ? law->parameters : NULL; p && p->name; ++p) {
      const PetscReal now = value_of(is, p->name), before = value_of(was, p->name);
      if (!p->at_start || now == before || (isnan(now) && isnan(before))) continue;
      snprintf(path, sizeof path, "materials.%s.%s", is->name, p->name);
      diag_error(diag, path, "%s says how points begin, and those of '%s' have a state: it would change nothing",
                 p->name, c->bodies[b].name);
      diag_hint(diag, "give it from the start, or with the stage in which the body takes this law");
    }
  }
}

PetscErrorCode RenameCheck(const Case *c, const Case *from, PetscBool next, Diag *diag)
{
  const Method *method = method_find(c->method);

  PetscFunctionBeginUser;
  PetscCall(LoadsCheck(c, from, diag));
  check_starts(c, from, diag);
  if (method && method->clouds) clouds_check(c, from, diag);
  if (next) check_walls(c, from, diag);
  if (next) check_interfaces(c, from, diag);
  if (next) check_events(c, from, diag);
  if (next) check_stresses(c, from, diag);
  if (next || (c->n_walls == from->n_walls && c->n_interfaces == from->n_interfaces)) PetscFunctionReturn(0);
  diag_error(diag, c->n_walls != from->n_walls ? "walls" : "interfaces",
             "the state is one of %d walls and %d interfaces, here are %d and %d", (int)from->n_walls,
             (int)from->n_interfaces, (int)c->n_walls, (int)c->n_interfaces);
  if (c->n_walls != from->n_walls)
    diag_hint(diag, "name a wall that comes later at the top of the file, with absent: true");
  PetscFunctionReturn(0);
}
