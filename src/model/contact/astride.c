/* Nodes astride of a wall: it is thinner than they reach, and what is on both of its sides moves with them as if it
 * were one. Contact acts on the sum of both sides there, and so cannot part them. Of a bonded wall both sides move with
 * it in any case. */
#include <string.h>
#include "base/math/vector.h"
#include "model/model_private.h"

#define ALONG 0.7  /* cosine: of what sees the same side of a wall, and its opposite */
#define SHARE 1e-3 /* of a node's mass: what is less on one of the sides holds nothing that shows */

/* The side of a wall that a node sees, as the plane through its nearest place. */
typedef struct {
  PetscBool near;
  PetscReal normal[3], offset; /* m */
} Face;

static void place_of_node(const Grid *grid, PetscInt node, PetscReal x[3])
{
  for (PetscInt d = 0; d < 3; ++d) x[d] = d < grid->dim ? grid->x[node * grid->dim + d] : 0;
}

/* Collective. The farthest that a point is from a node that it touches, m. */
static PetscErrorCode FindReach(const Model *m, PetscReal *reach)
{
  const Support *w = m->space->support;
  PetscReal farthest = 0, x[3];

  PetscFunctionBeginUser;
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt i = w->node_start[g]; i < w->node_start[g + 1]; ++i) {
      place_of_node(m->grid, w->node[i], x);
      for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1]; ++p) {
        PetscReal square = 0;
        for (PetscInt d = 0; d < m->dim; ++d) square += PetscSqr(point_real(m->points, POINT_X, p)[d] - x[d]);
        farthest = PetscMax(farthest, square);
      }
    }
  PetscCall(MPIU_Allreduce(&farthest, reach, 1, MPIU_REAL, MPIU_MAX, m->comm));
  *reach = PetscSqrtReal(*reach);
  PetscFunctionReturn(0);
}

/* What nodes that material touches see of wall k. */
static void see_from_nodes(const Model *m, PetscInt k, PetscReal reach, Face *face)
{
  WallPlace place;
  PetscReal x[3];
  for (PetscInt node = 0; node < m->grid->n_nodes; ++node) {
    face[node].near = PETSC_FALSE;
    if (!m->nodes->touched[node]) continue;
    place_of_node(m->grid, node, x);
    if (!wall_near(m->walls, k, m->time, x, reach, 0, &place)) continue;
    face[node].near = PETSC_TRUE;
    for (int d = 0; d < 3; ++d) face[node].normal[d] = place.normal[d];
    face[node].offset = vector_dot(place.normal, x) - place.gap;
  }
}

/* On which side of the wall is x, where `place` is nearest: 0 the one that the node sees, 1 the other one, -1 neither,
 * as beside an end. In a slot the side across is before the one that the node sees, not behind it. */
static int side_of(const Face *face, const PetscReal *x, const WallPlace *place)
{
  const PetscReal cosine = vector_dot(face->normal, place->normal);
  if (cosine > ALONG) return 0;
  return cosine < -ALONG && vector_dot(face->normal, x) < face->offset ? 1 : -1;
}

/* Where point p is nearest to wall k within `within`, m. What springs of explicit dynamics have let in stands beyond
 * the side that it rests on, and is on that side all the same. */
static PetscBool find_place(const Model *m, PetscInt k, PetscInt p, PetscReal within, WallPlace *place)
{
  const NodalScene scene = nodal_scene(m, m->time, m->nodes->du);
  const PetscReal *at = point_real(m->points, POINT_X, p);
  const PetscReal x[3] = {at[0], at[1], m->dim == 3 ? at[2] : 0};
  const int came = contact_side(m->contact, &scene, p, k);
  return wall_near(m->walls, k, m->time, x, within, came == wall_side(m->walls, k, m->time, x) ? 0 : came, place);
}

static PetscBool sees_any(const Support *w, PetscInt g, const Face *face)
{
  for (PetscInt i = w->node_start[g]; i < w->node_start[g + 1]; ++i)
    if (face[w->node[i]].near) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Add the mass that point p of a group gives to nodes that see wall k, each its own side; kinds: as WeighSides. */
static void weigh_point(const Model *m, PetscInt k, PetscInt g, PetscInt p, PetscReal reach, const Face *face,
                        PetscInt kinds, PetscReal *mass)
{
  const Support *w = m->space->support;
  const PetscInt *node = w->node + w->node_start[g], kind = kinds > 1 ? m->points->body[p] : 0;
  const PetscReal *N = support_N(w, g, p), *x = point_real(m->points, POINT_X, p);
  WallPlace place;
  if (!find_place(m, k, p, 2 * reach, &place)) return;
  for (PetscInt i = 0; i < support_nodes(w, g); ++i) {
    const int side = face[node[i]].near ? side_of(face + node[i], x, &place) : -1;
    if (side >= 0) mass[2 * (node[i] * kinds + kind) + side] += m->points->real[POINT_MASS][p] * N[i];
  }
}

/* Collective. Mass of nodes from either side of wall k, n_nodes x kinds x 2, on owners: of all bodies together
 * (kinds = 1), or of each. */
static PetscErrorCode WeighSides(const Model *m, PetscInt k, PetscReal reach, const Face *face, PetscInt kinds,
                                 PetscReal **mass)
{
  const Support *w = m->space->support;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(2 * kinds * m->grid->n_nodes, mass));
  for (PetscInt g = 0; g < w->n_groups; ++g)
    for (PetscInt p = w->point_start[g]; p < w->point_start[g + 1] && sees_any(w, g, face); ++p)
      weigh_point(m, k, g, p, reach, face, kinds, *mass);
  PetscCall(GridSumToOwners(m->grid, 2 * kinds, *mass));
  PetscFunctionReturn(0);
}

static PetscBool is_astride(const PetscReal mass[2])
{
  return (PetscBool)(PetscMin(mass[0], mass[1]) > SHARE * (mass[0] + mass[1]));
}

/* Pairs of bodies that nodes are astride between: how many of them, bodies x bodies. */
static void count_pairs(const Model *m, PetscInt k, const PetscReal *all, const PetscReal *mass, PetscInt *pairs)
{
  const PetscInt n = m->c->n_bodies;
  for (PetscInt node = 0; node < m->grid->n_owned; ++node) {
    if (!is_astride(all + 2 * node)) continue;
    for (PetscInt pair = 0; pair < n * n; ++pair) {
      const PetscInt a = pair / n, b = pair % n;
      const PetscReal *of = mass + 2 * node * n;
      if (!contact_meets_body(m->c, k, a) && !contact_meets_body(m->c, k, b)) continue;
      pairs[PetscMin(a, b) * n + PetscMax(a, b)] += of[2 * a] > 0 && of[2 * b + 1] > 0;
    }
  }
}

/* The pair that most nodes are astride between: two bodies, before the two sides of one. */
static void choose_pair(PetscInt n, const PetscInt *pairs, Astride *found)
{
  PetscInt most = 0, n_pairs = 0;
  for (PetscInt pair = 0; pair < n * n; ++pair) {
    const PetscBool two = (PetscBool)(pair / n != pair % n), other = (PetscBool)(found->body[0] != found->body[1]);
    n_pairs += pairs[pair] > 0;
    if (!pairs[pair] || (two == other && pairs[pair] <= most) || (most && two < other)) continue;
    most = pairs[pair];
    found->body[0] = pair / n, found->body[1] = pair % n;
  }
  found->nodes = most;
  found->others = PetscMax(0, n_pairs - 1);
}

static PetscErrorCode FindPairs(const Model *m, PetscInt k, PetscReal reach, const Face *face, const PetscReal *all,
                                Astride *found)
{
  const PetscInt n = m->c->n_bodies;
  PetscReal *mass;
  PetscInt *pairs;

  PetscFunctionBeginUser;
  PetscCall(WeighSides(m, k, reach, face, n, &mass));
  PetscCall(PetscCalloc1(n * n, &pairs));
  count_pairs(m, k, all, mass, pairs);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, pairs, n * n, MPIU_INT, MPI_SUM, m->comm));
  choose_pair(n, pairs, found);
  found->time = m->time;
  PetscCall(PetscFree(pairs));
  PetscCall(PetscFree(mass));
  PetscFunctionReturn(0);
}

static PetscErrorCode LookAtWall(Model *m, PetscInt k, PetscReal reach, Face *face)
{
  PetscBool any = PETSC_FALSE;
  PetscReal *all;

  PetscFunctionBeginUser;
  see_from_nodes(m, k, reach, face);
  PetscCall(WeighSides(m, k, reach, face, 1, &all));
  for (PetscInt node = 0; node < m->grid->n_owned && !any; ++node) any = is_astride(all + 2 * node);
  PetscCall(MPIU_Allreduce(MPI_IN_PLACE, &any, 1, MPIU_BOOL, MPI_LOR, m->comm));
  if (any) PetscCall(FindPairs(m, k, reach, face, all, m->astride + k));
  PetscCall(PetscFree(all));
  PetscFunctionReturn(0);
}

/* Is it asked of wall k, and not known yet? */
static PetscBool is_open(const Model *m, PetscInt k)
{
  if (m->astride[k].nodes || m->c->walls[k].contact == CONTACT_BONDED) return PETSC_FALSE;
  return (PetscBool)!wall_has_one_side(m->walls, k);
}

PetscErrorCode AstrideLook(Model *m)
{
  PetscInt open = 0;
  PetscReal reach;
  Face *face;

  PetscFunctionBeginUser;
  if (!m->c->n_walls) PetscFunctionReturn(0);
  if (!m->astride) PetscCall(PetscCalloc1(m->c->n_walls, &m->astride));
  for (PetscInt k = 0; k < m->c->n_walls; ++k) open += is_open(m, k);
  if (!open) PetscFunctionReturn(0);
  PetscCall(ModelInitialise(m));
  PetscCall(FindReach(m, &reach));
  PetscCall(PetscMalloc1(m->grid->n_nodes, &face));
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    if (is_open(m, k)) PetscCall(LookAtWall(m, k, reach, face));
  PetscCall(PetscFree(face));
  PetscFunctionReturn(0);
}

/* " (seen at t = 2 s)", or nothing of what is so from the start. */
static const char *since(const Model *m, const Astride *found, char text[64])
{
  text[0] = 0;
  if (found->time > m->c->start) snprintf(text, 64, " (seen at t = %.4g s)", (double)found->time);
  return text;
}

/* Walls that part for sure are as thick as two points of either side reach towards each other. */
static const char *parting_thickness(const Model *m)
{
  return m->space->basis == basis_find("bspline") ? "three" : "two";
}

static void hint_parting(const Model *m, const char *a, const char *b, Diag *diag)
{
  const PetscBool background = (PetscBool)(m->method->restores_grid && m->c->grid.kind != GRID_BOX);
  const char *thick = parting_thickness(m);
  if (background) diag_hint(diag, "make the wall as thick as %s cells", thick);
  else if (!strcmp(a, b))
    diag_hint(diag,
              "make the wall as thick as %s cells, or a body of what is on each side, with an interface between them",
              thick);
  else
    diag_hint(diag,
              "`interfaces: [{name: ..., between: [%s, %s], contact: frictionless}]` gives each nodes of its own; a "
              "wall as thick as %s cells parts them, too",
              a, b, thick);
}

static void tell_wall(const Model *m, PetscInt k, const Astride *found, Diag *diag)
{
  const char *wall = m->c->walls[k].name, *a = m->c->bodies[found->body[0]].name,
             *b = m->c->bodies[found->body[1]].name;
  char path[64], when[64], others[64] = "";
  snprintf(path, sizeof path, "walls[%d]", (int)k);
  if (found->others) snprintf(others, sizeof others, " (pairs of bodies besides: %d)", (int)found->others);
  if (found->body[0] == found->body[1])
    diag_warning(diag, path,
                 "wall '%s' is thinner than nodes reach and parts nothing%s: what of '%s' is on its two sides sticks "
                 "to itself by %d nodes%s",
                 wall, since(m, found, when), a, (int)found->nodes, others);
  else
    diag_warning(diag, path,
                 "wall '%s' is thinner than nodes reach and parts nothing%s: '%s' and '%s' on its two sides stick to "
                 "each other by %d nodes%s",
                 wall, since(m, found, when), a, b, (int)found->nodes, others);
  hint_parting(m, a, b, diag);
}

void astride_tell(Model *m, Diag *diag)
{
  for (PetscInt k = 0; m->astride && k < m->c->n_walls; ++k) {
    if (!m->astride[k].nodes || m->astride[k].told) continue;
    tell_wall(m, k, m->astride + k, diag);
    m->astride[k].told = PETSC_TRUE;
  }
}

PetscErrorCode AstrideGoOn(Model *m, const Model *before)
{
  PetscFunctionBeginUser;
  if (!m->c->n_walls || !before->astride) PetscFunctionReturn(0);
  if (!m->astride) PetscCall(PetscCalloc1(m->c->n_walls, &m->astride));
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    for (PetscInt i = 0; i < before->c->n_walls; ++i)
      if (before->astride[i].told && !strcmp(m->c->walls[k].name, before->c->walls[i].name))
        m->astride[k] = before->astride[i];
  PetscFunctionReturn(0);
}
