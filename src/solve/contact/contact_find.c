/* Which material may meet a wall in this step, and the nodes that carry it there. */
#include "material/law.h"
#include "solve/contact/contact.h"

#define TOUCHES 1e-6   /* of a cell: within this what had no force at the start of the step touches */
#define STIFF 0.02     /* strain up to which what may yield moves as a body */
#define EDGE 1e-6      /* of its curvature that an edge may lack */
#define ROUND_OFF 1e-9 /* by how much more a corner is farther away than its sides */

/* Thickness of the material point's part of the body towards n: planes of the undeformed body along
 * its surface, of which those r apart are r |F^T n| apart now; or as far as the place on that which it stands
 * beside. */
PetscReal contact_reach(const PetscReal F[9], const PetscReal n[3], PetscReal first, const PetscReal *corner,
                        PetscInt dim)
{
  PetscReal square = 0, ahead = 0, away = 0;
  for (int j = 0; j < 3; ++j) {
    const PetscReal pulled = F[j] * n[0] + F[3 + j] * n[1] + F[6 + j] * n[2];
    square += PetscSqr(pulled);
    if (j < dim) ahead -= corner[j] * pulled, away += PetscSqr(corner[j]);
  }
  const PetscReal stretch = PetscMax(THINNEST, PetscMin(THICKEST, PetscSqrtReal(square)));
  return PetscMax(stretch * first, PetscMin(THICKEST * PetscSqrtReal(away), ahead));
}

PetscReal contact_reach_of(const Points *points, PetscInt p, const PetscReal n[3])
{
  PetscReal F[9];
  point_F(points, p, F);
  return contact_reach(F, n, points->real[POINT_REACH][p], point_real(points, POINT_CORNER, p), points->dim);
}

/* How far ahead the corner is that the point stands beside, or a side that is farther than the point is thick; 0: the
 * point knows of none. */
static PetscReal ahead_of(const Points *points, PetscInt p, const PetscReal n[3])
{
  PetscReal F[9];
  if (contact_farthest(points, p) <= (1 + ROUND_OFF) * THICKEST * points->real[POINT_REACH][p]) return 0;
  point_F(points, p, F);
  return contact_reach(F, n, 0, point_real(points, POINT_CORNER, p), points->dim);
}

/* Nothing has sheared yet. */
void contact_take_back(Points *points, PetscInt p, const PetscReal n[3], PetscReal reach)
{
  PetscReal F[9], *corner = point_real(points, POINT_CORNER, p), ahead = 0;
  point_F(points, p, F);
  reach /= F[0];
  for (PetscInt d = 0; d < points->dim; ++d) ahead -= corner[d] * n[d];
  for (PetscInt d = 0; d < points->dim && ahead > reach; ++d) corner[d] += (ahead - reach) * n[d];
  points->real[POINT_REACH][p] = PetscMin(points->real[POINT_REACH][p], reach);
}

/* Nothing has sheared yet. */
void contact_let_reach(Points *points, PetscInt p, const PetscReal n[3], PetscReal reach)
{
  PetscReal F[9], *corner = point_real(points, POINT_CORNER, p), ahead = 0;
  if (reach <= contact_farthest(points, p)) return;
  point_F(points, p, F);
  for (PetscInt d = 0; d < points->dim; ++d) ahead -= corner[d] * n[d];
  for (PetscInt d = 0; d < points->dim; ++d) corner[d] -= (reach / F[0] - ahead) * n[d];
  for (PetscInt d = 0; d < points->components[POINT_BESIDE]; ++d) point_real(points, POINT_BESIDE, p)[d] = 0;
}

PetscReal contact_farthest(const Points *points, PetscInt p)
{
  const PetscReal *corner = point_real(points, POINT_CORNER, p);
  PetscReal square = 0;
  for (PetscInt d = 0; d < points->dim; ++d) square += PetscSqr(corner[d]);
  return THICKEST * PetscMax(points->real[POINT_REACH][p], PetscSqrtReal(square));
}

PetscErrorCode ContactAdd(Contact *s, ContactPoint **c)
{
  PetscFunctionBeginUser;
  if (s->n == s->capacity) {
    s->capacity += s->capacity / 2 + 64;
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof *s->point, &s->point));
  }
  *c = s->point + s->n++;
  **c = (ContactPoint){.first = s->n_nodes, .slot = s->n_slots, .cover = 1, .anchor = -1};
  PetscFunctionReturn(0);
}

PetscErrorCode ContactAddNodes(Contact *s, ContactPoint *c, PetscInt n)
{
  PetscFunctionBeginUser;
  if (s->n_nodes + n > s->capacity_nodes) {
    s->capacity_nodes += s->capacity_nodes / 2 + n + 256;
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->node, &s->node));
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->N, &s->N));
    PetscCall(PetscRealloc((size_t)s->capacity_nodes * sizeof *s->lead, &s->lead));
    PetscCall(PetscRealloc((size_t)(s->capacity_nodes * s->dim) * sizeof *s->turn, &s->turn));
  }
  if (s->n_slots + n * n > s->capacity_slots) {
    s->capacity_slots += s->capacity_slots / 2 + n * n + 1024;
    PetscCall(PetscRealloc((size_t)s->capacity_slots * sizeof *s->slot, &s->slot));
  }
  c->n = c->own = n;
  s->n_nodes += n;
  s->n_slots += n * n;
  PetscFunctionReturn(0);
}

void contact_remember(ContactPoint *c, PetscInt dim, const PetscReal *kept, const PetscReal normal[3])
{
  c->before = (ContactState)(int)(kept[KEPT_STATE] + 0.5);
  for (PetscInt d = 0; d < dim; ++d) c->last[d] = kept[KEPT_FORCE + d];
  c->stays = kept[KEPT_STAYS(dim)];
  c->state = c->before;
  for (int d = 0; d < 3; ++d) c->normal[d] = c->push[d] = c->facing[d] = normal[d];
}

void contact_stand(Contact *s, PetscReal share)
{
  for (ContactPoint *c = s->point; c < s->point + s->n; ++c) {
    PetscReal pressure = 0;
    c->gap = c->open;
    if (c->gone) c->state = CONTACT_OPEN;
    if (c->state == CONTACT_OPEN) continue; /* what is kept there may be a slip */
    for (int d = 0; d < 3; ++d) pressure += c->last[d] * c->normal[d] / share;
    c->now.pressure = pressure;
    for (int d = 0; d < 3; ++d) c->now.shear[d] = c->last[d] / share - pressure * c->normal[d];
  }
}

/* By what the strength of the contact is divided; 0: of what sticks until it yields. */
static PetscReal divisor_of(const Contact *s, const NodalScene *scene, const ContactPoint *c)
{
  return s->divisor[c->wall * scene->c->n_bodies + scene->points->body[c->owner]];
}

void contact_take_law(const Contact *s, const NodalScene *scene, ContactPoint *c)
{
  const WallSpec *w = c->wall < s->n_walls ? scene->c->walls + c->wall : NULL;
  const InterfaceSpec *i = w ? NULL : scene->c->interfaces + (c->wall - s->n_walls);
  const PetscReal friction = w ? w->friction : i->friction, divisor = divisor_of(s, scene, c);
  c->law = (ContactLaw){.kind = w ? w->contact : i->contact};
  c->law.friction = c->law.kind == CONTACT_STICK || divisor == 0 ? CONTACT_STICKING : friction / divisor;
}

void contact_take_section(const Contact *s, const NodalScene *scene, PetscReal section, ContactPoint *c)
{
  const PetscBool wall = c->wall < s->n_walls;
  const PetscReal divisor = divisor_of(s, scene, c);
  c->inner = !contact_is_surface(scene, c->owner, c->facing);
  const PetscReal adhesion =
    wall ? scene->c->walls[c->wall].adhesion : scene->c->interfaces[c->wall - s->n_walls].adhesion;
  c->section = c->cover * section;
  c->bond = c->own_bond = divisor > 0 ? adhesion / divisor * c->section : 0;
}

/* A bonded interface holds what touches at the start, or when a stage brings it (that is not open any more then), and
 * nothing that comes later. */
static PetscBool is_let_go(const ContactPoint *c, PetscBool first)
{
  if (c->law.kind != CONTACT_BONDED || c->before != CONTACT_OPEN) return PETSC_FALSE;
  return !first || !c->touches;
}

PetscBool contact_passes(const Contact *s, ContactPoint *c, PetscReal gap, PetscBool first)
{
  c->touches = gap <= TOUCHES * s->length;
  return gap > s->near || is_let_go(c, first);
}

/* Force on the material before the contact point by the stress that it has, and by its weight beyond that. */
static void force_of_stress(const NodalScene *scene, const ContactPoint *c, PetscReal f[3])
{
  const Points *points = scene->points;
  const PetscInt p = c->owner;
  const PetscReal J = points->real[POINT_J][p], density = points->real[POINT_MASS][p] / points->real[POINT_VOLUME][p];
  const PetscReal factor = case_factor(scene->c, &scene->c->gravity_amplitude, scene->t);
  PetscReal tau[6], beyond = 0;
  point_tau(points, p, tau);
  for (int d = 0; d < 3; ++d) beyond -= density * c->reach * factor * scene->c->gravity[d] * c->normal[d];
  for (int d = 0; d < 3; ++d) f[d] = beyond * c->normal[d];
  for (int k = 0; k < 6; ++k) {
    const int i = voigt_row[k], j = voigt_column[k];
    f[i] -= tau[k] * c->normal[j];
    if (i != j) f[j] -= tau[k] * c->normal[i];
  }
  for (int d = 0; d < 3; ++d) f[d] *= c->section / J;
}

void contact_press(ContactPoint *c, const PetscReal force[3])
{
  const PetscBool rubs = c->law.kind != CONTACT_FRICTIONLESS, bonded = c->law.kind == CONTACT_BONDED;
  PetscReal f[3], pressure = 0, square = 0;
  for (int d = 0; d < 3; ++d) pressure += force[d] * c->normal[d];
  const PetscBool bears = (PetscBool)(pressure > 0 || bonded);
  for (int d = 0; d < 3; ++d) f[d] = force[d] - pressure * c->normal[d], square += f[d] * f[d];
  const PetscReal most = c->law.kind == CONTACT_FRICTION ? c->law.friction * pressure : CONTACT_STICKING * pressure;
  const PetscReal part = bonded ? 1 : rubs && square > 0 ? PetscMin(1, most / PetscSqrtReal(square)) : 0;
  for (int d = 0; d < 3; ++d) c->last[d] = bears ? pressure * c->normal[d] + part * f[d] : 0;
  c->before = c->state = !bears ? CONTACT_OPEN : rubs ? CONTACT_STICKS : CONTACT_SLIDES;
  c->stays = bears;
}

void contact_start(const NodalScene *scene, ContactPoint *c)
{
  const BodySpec *body = scene->c->bodies + scene->points->body[c->owner];
  PetscReal f[3];
  if (!scene->first || !c->touches || c->before != CONTACT_OPEN || !body_has_stress(body)) return;
  force_of_stress(scene, c, f);
  contact_press(c, f);
}

PetscBool contact_meets_body(const Case *c, PetscInt k, PetscInt body)
{
  return case_wall_meets(c->walls + k, c->bodies[body].name);
}

/* May the surface have turned since, with nothing that presses on it? What has flowed has others now. */
static PetscBool turns(const NodalScene *scene, PetscInt p, PetscReal state)
{
  if (state > CONTACT_OPEN + 2 * CONTACT_SPRING) return PETSC_FALSE;
  return (PetscBool)(!scene->materials[scene->points->material[p]].law->yields ||
                     !contact_is_strained(scene->points, p, STIFF));
}

PetscReal contact_reach_left(const NodalScene *scene, PetscInt p, const PetscReal *kept, const PetscReal n[3],
                             PetscReal gap)
{
  const PetscReal left = kept[KEPT_REACH];
  if (left <= 0) return contact_reach_of(scene->points, p, n);
  return turns(scene, p, kept[KEPT_STATE]) ? PetscMax(left, PetscMin(gap, ahead_of(scene->points, p, n))) : left;
}

static PetscBool lets_go_of_spring(const NodalScene *scene, const PetscReal *kept)
{
  return (PetscBool)(contact_is_sprung(kept[KEPT_STATE]) && scene->c->analysis.type != ANALYSIS_EXPLICIT);
}

PetscReal contact_behind_left(const NodalScene *scene, ContactKind kind, const PetscReal *kept, PetscReal gap)
{
  const PetscReal behind = kept[KEPT_PASSED(scene->grid->dim)];
  if (!lets_go_of_spring(scene, kept)) return behind;
  return kind == CONTACT_BONDED ? -gap : PetscMax(behind, -gap);
}

PetscBool contact_let_in(const NodalScene *scene, const PetscReal *kept, PetscReal behind)
{
  return (PetscBool)(behind != 0 && (lets_go_of_spring(scene, kept) || contact_is_let_in(kept[KEPT_STATE])));
}

/* What the functions of the point are `reach` beyond it along -n, more than N there; means over a domain become those
 * over its side, but of what springs have let in, which pushed with straight ones: with others what rests would not be
 * in balance. */
static void take_lead(const NodalScene *scene, PetscInt p, PetscInt nn, const PetscReal *dN, const PetscReal n[3],
                      PetscReal reach, PetscBool let_in, PetscReal *lead)
{
  const PetscInt dim = scene->grid->dim;
  PetscReal bend[3 * CLOUD_MAX_NODES];
  const PetscBool bends = !let_in && scene->bends && scene->bends(scene->bends_context, p, nn, bend);
  for (PetscInt I = 0; I < nn; ++I) {
    lead[I] = 0;
    for (PetscInt d = 0; d < dim; ++d) {
      lead[I] -= dN[I * dim + d] * reach * n[d];
      if (bends) lead[I] += 0.5 * bend[I * dim + d] * PetscSqr(reach * n[d]);
    }
  }
}

/* Around an edge the distance bends by its inverse, and by less around all that is round, and larger than it. */
static PetscBool is_edge(const WallPlace *place)
{
  return (PetscBool)(place->gap > 0 && wall_bend(place) * place->gap > 1 - EDGE);
}

/* Does the wall meet what is there, and not the other way round? */
static PetscBool arrives(const Contact *s, const NodalScene *scene, PetscInt k)
{
  if (scene->t <= scene->c->start) return PETSC_TRUE; /* with the run, or its stage */
  return (PetscBool)(wall_comes(s->walls, k, scene->t) && !wall_stands(s->walls, k, scene->t));
}

/* Does the motion of the point's body begin now? Its wall may have been there for long. */
static PetscBool begins(const NodalScene *scene, PetscInt p)
{
  return (PetscBool)(scene->t <= scene->c->start && scene->c->bodies[scene->points->body[p]].begins);
}

/* By how much a wall has passed the surface of a point at the start of the step. One that comes where some of the body
 * is already, in dynamics, has passed that much: to push it out within a step of any length would give it what speed
 * and energy one likes (docs/theory.md, section 76). */
static PetscReal behind_of(const Contact *s, const NodalScene *scene, PetscInt k, const PetscReal *kept, PetscReal gap)
{
  const PetscReal behind = contact_behind_left(scene, scene->c->walls[k].contact, kept, gap);
  if (!scene->moves || kept[KEPT_STATE] != 0 || gap + behind >= 0 || !arrives(s, scene, k)) return behind;
  return -gap;
}

/* The surface of a point, `at` in group g of the support, before one side of wall k: slot and kept are those of that
 * side. */
static PetscErrorCode MeetSide(Contact *s, const NodalScene *scene, PetscInt g, PetscInt at, PetscInt k,
                               WallPlace place, PetscInt slot, const PetscReal *kept, ContactPoint **met)
{
  const PetscInt dim = s->dim, p = scene->seen ? scene->seen[g] : at;
  const Points *points = scene->points;
  const PetscReal *x = point_real(points, POINT_X, p);
  const Material *material = scene->materials + points->material[p];
  ContactPoint *c = NULL;

  PetscFunctionBeginUser;
  *met = NULL;
  const PetscReal reach = contact_reach_left(scene, p, kept, place.normal, place.gap);
  const PetscInt nn = support_nodes(scene->support, g), *node = scene->support->node + scene->support->node_start[g];
  const PetscReal *N = support_N(scene->support, g, at), *dN = support_dN(scene->support, g, at, dim);
  PetscCall(ContactAdd(s, &c));
  c->owner = p, c->wall = k, c->slot_kept = slot;
  c->reach = reach;
  c->modulus[0] = material->wave_modulus, c->density[0] = material->density;
  c->stiffer = material_confined(material) / material->wave_modulus;
  c->softer = material_sheared(material) / material->wave_modulus;
  contact_take_law(s, scene, c);
  contact_remember(c, dim, kept, place.normal);
  c->edge = is_edge(&place);
  place.gap -= reach;
  c->behind = behind_of(s, scene, k, kept, place.gap);
  c->let_in = contact_let_in(scene, kept, c->behind);
  place.gap += c->behind;
  if (contact_passes(s, c, place.gap, scene->first)) {
    --s->n;
    PetscFunctionReturn(0);
  }
  c->gone = !wall_comes(s->walls, k, scene->t);
  c->open = place.gap;
  c->touches = c->touches && !c->gone;
  c->begins = begins(scene, p);
  PetscCall(ContactAddNodes(s, c, nn));
  for (PetscInt d = 0; d < dim; ++d) c->x[d] = x[d] - reach * place.normal[d];
  contact_take_section(s, scene, contact_section(scene, p, place.normal, (PetscReal[]){x[0], c->x[0]}), c);
  if (kept[KEPT_STATE] == 0 && !c->gone) contact_start(scene, c);
  take_lead(scene, p, nn, dN, place.normal, reach, c->let_in, s->lead + c->first);
  for (PetscInt I = 0; I < nn; ++I) {
    s->node[c->first + I] = node[I];
    s->N[c->first + I] = N[I] + s->lead[c->first + I];
  }
  *met = c;
  PetscFunctionReturn(0);
}

/* All sides of wall k that the point meets. */
static PetscErrorCode MeetPoint(Contact *s, const NodalScene *scene, PetscInt g, PetscInt at, PetscInt k)
{
  const PetscInt p = scene->seen ? scene->seen[g] : at;
  const Points *points = scene->points;
  const PetscReal *x = point_real(points, POINT_X, p), *kept[WALL_SIDES];
  WallPlace place[WALL_SIDES];
  PetscInt slot[WALL_SIDES];

  PetscFunctionBeginUser;
  if (!contact_meets_body(scene->c, k, points->body[p])) PetscFunctionReturn(0);
  const int side = contact_side(s, scene, p, k);
  const PetscInt n = wall_sides(s->walls, k, scene->t, x, s->near + contact_farthest(points, p), side, place);
  contact_note_crossing(s, scene, p, k, side, n);
  contact_find_slots(s, points, p, k, n, place, slot, kept);
  for (PetscInt i = 0; i < n; ++i) {
    ContactPoint *c;
    PetscCall(MeetSide(s, scene, g, at, k, place[i], slot[i], kept[i], &c));
    if (!c) continue;
    c->side = side;
    place[i].gap = c->open - c->behind;
    if (n > 1) PetscCall(ContactAnchor(s, scene, &place[i], c));
  }
  PetscFunctionReturn(0);
}

/* How far the points of a group are from its first, and from their surfaces, m. */
static PetscReal extent_of(const Points *points, PetscInt first, PetscInt end)
{
  const PetscReal *x = point_real(points, POINT_X, first);
  PetscReal square = 0, farthest = 0;
  for (PetscInt p = first; p < end; ++p) {
    const PetscReal *y = point_real(points, POINT_X, p);
    PetscReal apart = 0;
    for (PetscInt d = 0; d < points->dim; ++d) apart += PetscSqr(y[d] - x[d]);
    square = PetscMax(square, apart);
    farthest = PetscMax(farthest, contact_farthest(points, p));
  }
  return PetscSqrtReal(square) + farthest;
}

/* Points of a cell stand close to each other: where their first is far from the wall, all are. */
static PetscErrorCode MeetGroup(Contact *s, const NodalScene *scene, PetscInt g)
{
  const PetscInt first = scene->support->point_start[g], end = scene->support->point_start[g + 1];
  const PetscReal *x = point_real(scene->points, POINT_X, first);
  const PetscReal within = end > first + 1 ? s->near + extent_of(scene->points, first, end) : 0;
  WallPlace place;

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < s->n_walls; ++k) {
    const int side = within > 0 ? wall_side(s->walls, k, scene->t, x) : 0;
    if (within > 0 && !wall_near(s->walls, k, scene->t, x, within, side, &place)) continue;
    for (PetscInt p = first; p < end; ++p) PetscCall(MeetPoint(s, scene, g, p, k));
  }
  PetscFunctionReturn(0);
}

PetscErrorCode ContactFind(Contact *s, const NodalScene *scene)
{
  const Support *w = scene->support;

  PetscFunctionBeginUser;
  s->n = s->n_nodes = s->n_slots = s->n_anchors = 0;
  s->length = s->near = scene->grid->smallest;
  for (PetscInt g = 0; g < w->n_groups && s->n_walls; ++g) PetscCall(MeetGroup(s, scene, g));
  if (s->n_partners > s->n_walls) PetscCall(ContactFindBodies(s, scene));
  PetscFunctionReturn(0);
}
