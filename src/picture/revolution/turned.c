/* A section turned about its axis. The distance of a place in space from the body is that in the
 * plane, at its radius; from the body without a quarter, the larger one of this and of the way out
 * of the quarter. So a ray may go as far as the distance without missing anything, and arrives
 * after a dozen leaps. */
#include <math.h>
#include "picture/raster/distance.h"
#include "picture/revolution/revolution.h"

/* Rays a pixel along each axis make edges smooth. */
enum { RAYS = 3, LEAPS = 300 };

typedef struct {
  const TurnedScene *scene;
  float *body;        /* of each pixel of the section: distance from the body, less than 0 inside, m */
  int *colour;        /* of each pixel of the section: the nearest one of the body */
  PetscReal side[2];  /* of x and z: signs of the quarter that is cut out */
  PetscReal eye, far; /* of a place along the ray, m: where rays begin and end */
} Solid;

/* The shape of what is hit: the surface of the body, or one of the planes of the cut. */
typedef enum { FACE_BODY, FACE_X, FACE_Z } Face;

/* Gaussian mean along lines of n pixels that are `stride` apart. */
static PetscErrorCode Smooth(float *values, int n, size_t stride, int lines, size_t to_next, PetscReal width)
{
  const int reach = (int)ceil(3 * width);
  PetscReal *weight;
  float *line;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(reach + 1, &weight, n, &line));
  for (int k = 0; k <= reach; ++k) weight[k] = exp(-0.5 * k * k / (width * width));
  for (int l = 0; l < lines; ++l) {
    float *v = values + (size_t)l * to_next;
    for (int i = 0; i < n; ++i) line[i] = v[(size_t)i * stride];
    for (int i = 0; i < n; ++i) {
      PetscReal sum = 0, all = 0;
      for (int k = -reach; k <= reach; ++k) {
        const PetscReal w = weight[PetscAbs(k)];
        sum += w * line[PetscMin(PetscMax(i + k, 0), n - 1)], all += w;
      }
      v[(size_t)i * stride] = (float)(sum / all);
    }
  }
  PetscCall(PetscFree2(weight, line));
  PetscFunctionReturn(0);
}

/* Distances from the body, smoothed: the mean of distances is a distance no place is nearer than,
 * but for what was smoothed away. */
static PetscErrorCode SolidCreate(const TurnedScene *scene, Solid *solid)
{
  const int w = scene->section_width, h = scene->section_height;
  const PetscReal width = PetscMax(scene->smooth / scene->pixel, 1), radius = -scene->section_min[0],
                  high = h * scene->pixel, middle = scene->y[2] * (scene->section_min[1] + 0.5 * high);
  unsigned char *in;
  float *inside;
  int *unused;

  PetscFunctionBeginUser;
  *solid = (Solid){.scene = scene, .side = {scene->x[2] < 0 ? -1 : 1, scene->z[2] < 0 ? -1 : 1}};
  solid->eye = middle + hypot(radius, 0.5 * high);
  solid->far = 2 * middle - solid->eye;
  PetscCall(PetscMalloc2(w * h, &solid->body, w * h, &solid->colour));
  PetscCall(PetscMalloc3(w * h, &in, w * h, &inside, w * h, &unused));
  for (int i = 0; i < w * h; ++i) in[i] = scene->section[4 * i + 3] >= 128;
  PetscCall(DistanceTo(w, h, in, solid->body, solid->colour));
  for (int i = 0; i < w * h; ++i) in[i] = !in[i];
  PetscCall(DistanceTo(w, h, in, inside, unused));
  for (int i = 0; i < w * h; ++i) /* the outline runs between pixels */
    solid->body[i] = (float)scene->pixel * (in[i] ? PetscMin(solid->body[i], (float)(w + h)) - 0.5f : 0.5f - inside[i]);
  PetscCall(Smooth(solid->body, w, 1, h, (size_t)w, width));
  PetscCall(Smooth(solid->body, h, (size_t)w, w, 1, width));
  PetscCall(PetscFree3(in, inside, unused));
  PetscFunctionReturn(0);
}

/* The pixel of the section at radius r and height y, and how far beyond its middle the place is. */
static int section_pixel(const TurnedScene *s, PetscReal r, PetscReal y, PetscReal beyond[2])
{
  const PetscReal at[2] = {(r - s->section_min[0]) / s->pixel - 0.5, (y - s->section_min[1]) / s->pixel - 0.5};
  const int last[2] = {s->section_width - 2, s->section_height - 2};
  int k[2];
  for (int d = 0; d < 2; ++d) {
    k[d] = (int)PetscMin(PetscMax(floor(at[d]), 0), (PetscReal)last[d]);
    beyond[d] = PetscMin(PetscMax(at[d] - k[d], 0), 1);
  }
  return k[1] * s->section_width + k[0];
}

/* Distance from the body in its section. Places outside of the section are farther than its edge. */
static PetscReal body_distance(const Solid *solid, PetscReal r, PetscReal y)
{
  PetscReal t[2];
  const int k = section_pixel(solid->scene, r, y, t);
  const float *a = solid->body + k, *b = a + solid->scene->section_width;
  return (1 - t[1]) * ((1 - t[0]) * a[0] + t[0] * a[1]) + t[1] * ((1 - t[0]) * b[0] + t[0] * b[1]);
}

static PetscReal distance(const Solid *solid, const PetscReal p[3], Face *face)
{
  const PetscReal body = body_distance(solid, hypot(p[0], p[2]), p[1]);
  const PetscReal x = solid->side[0] * p[0], z = solid->side[1] * p[2];
  *face = PetscMin(x, z) <= body ? FACE_BODY : x < z ? FACE_X : FACE_Z;
  return PetscMax(body, PetscMin(x, z));
}

typedef struct {
  PetscReal at[3]; /* right, up, towards the eye, m */
  PetscReal p[3];  /* the same place in the axes of the body */
  Face face;       /* the nearest one */
} Ray;

/* Follow the ray until it is `near` the body; PETSC_FALSE if it passes by. */
static PetscBool follow(const Solid *solid, PetscReal near, Ray *ray)
{
  const PetscReal *axis[] = {solid->scene->x, solid->scene->y, solid->scene->z};
  for (int leap = 0; leap < LEAPS && ray->at[2] > solid->far; ++leap) {
    for (int d = 0; d < 3; ++d) ray->p[d] = ray->at[0] * axis[d][0] + ray->at[1] * axis[d][1] + ray->at[2] * axis[d][2];
    const PetscReal free = distance(solid, ray->p, &ray->face);
    if (free < near) return PETSC_TRUE;
    ray->at[2] -= free;
  }
  return PETSC_FALSE;
}

static void normal_at(const Solid *solid, const PetscReal p[3], Face face, PetscReal n[3])
{
  const PetscReal r = PetscMax(hypot(p[0], p[2]), 1e-300), step = solid->scene->pixel;
  n[0] = n[1] = n[2] = 0;
  if (face != FACE_BODY) {
    n[face == FACE_X ? 0 : 2] = solid->side[face == FACE_X ? 0 : 1];
    return;
  }
  const PetscReal dr = body_distance(solid, r + step, p[1]) - body_distance(solid, r - step, p[1]),
                  dy = body_distance(solid, r, p[1] + step) - body_distance(solid, r, p[1] - step),
                  length = PetscMax(hypot(dr, dy), 1e-300);
  n[0] = dr / length * p[0] / r, n[1] = dy / length, n[2] = dr / length * p[2] / r;
}

/* How much light arrives, at most 1: from the upper left, in front, and from all round, of which
 * hollows get less. The planes of the cut keep the colours of the field nearly as they are. */
static PetscReal light_at(const Solid *solid, const PetscReal p[3], Face face, const PetscReal n[3])
{
  static const PetscReal towards[3] = {-0.35, 0.50, 0.79};
  const TurnedScene *s = solid->scene;
  const PetscReal reach = 0.06 * -s->section_min[0];
  PetscReal straight = 0, q[3];
  Face other;
  for (int k = 0; k < 3; ++k) straight += towards[k] * (n[0] * s->x[k] + n[1] * s->y[k] + n[2] * s->z[k]);
  for (int d = 0; d < 3; ++d) q[d] = p[d] + reach * n[d];
  const PetscReal open = PetscMin(PetscMax(distance(solid, q, &other) / reach, 0), 1);
  return face == FACE_BODY ? (0.75 + 0.25 * open) * (0.52 + 0.48 * PetscMax(straight, 0))
                           : (0.88 + 0.12 * open) * (0.90 + 0.10 * PetscMax(straight, 0) / 0.65);
}

/* Add the colour of the body where the ray arrives. */
static PetscBool add_colour(const Solid *solid, const Ray *ray, PetscReal sum[3])
{
  const TurnedScene *s = solid->scene;
  PetscReal n[3], beyond[2];
  normal_at(solid, ray->p, ray->face, n);
  const PetscReal light = light_at(solid, ray->p, ray->face, n);
  const int k = section_pixel(s, hypot(ray->p[0], ray->p[2]), ray->p[1], beyond);
  const int at = solid->colour[k + (beyond[0] > 0.5) + (beyond[1] > 0.5) * s->section_width];
  if (at < 0) return PETSC_FALSE;
  for (int c = 0; c < 3; ++c) sum[c] += light * s->section[4 * at + c];
  return PETSC_TRUE;
}

/* The ray through the middle of a pixel goes first: where it keeps away from the body so do all
 * rays of the pixel, and where it does not they begin there. */
static void draw_pixel(const Solid *solid, PetscReal u, PetscReal v, PetscReal pixel, unsigned char rgba[4])
{
  const PetscReal apart = pixel / RAYS, to_first = 0.5 * (apart - pixel);
  PetscReal sum[3] = {0};
  int hits = 0;
  Ray middle = {.at = {u, v, solid->eye}};
  const PetscBool any = follow(solid, pixel, &middle);
  for (int k = 0; k < RAYS * RAYS && any; ++k) {
    const int i = k % RAYS, j = k / RAYS;
    Ray ray = {.at = {u + to_first + i * apart, v + to_first + j * apart, middle.at[2]}};
    if (follow(solid, 0.2 * pixel, &ray)) hits += add_colour(solid, &ray, sum);
  }
  for (int c = 0; c < 3; ++c) rgba[c] = (unsigned char)lround(hits ? PetscMin(sum[c] / hits, 255) : 255);
  rgba[3] = (unsigned char)(hits * 255 / (RAYS * RAYS));
}

PetscErrorCode TurnedDraw(const TurnedScene *scene, unsigned char *rgba)
{
  const PetscReal pixel = (scene->max[0] - scene->min[0]) / scene->width;
  Solid solid;

  PetscFunctionBeginUser;
  PetscCall(SolidCreate(scene, &solid));
  for (int row = 0; row < scene->height; ++row)
    for (int column = 0; column < scene->width; ++column)
      draw_pixel(&solid, scene->min[0] + (column + 0.5) * pixel, scene->min[1] + (row + 0.5) * pixel, pixel,
                 rgba + 4 * ((size_t)row * (size_t)scene->width + (size_t)column));
  PetscCall(PetscFree2(solid.body, solid.colour));
  PetscFunctionReturn(0);
}
