/* The body that balls fill: grown by the gap that may be between them, then shrunk by that and by what balls reach
 * beyond the material. Growing and shrinking a straight edge or a corner gives it back, so that outlines have neither
 * the bumps of balls nor their round corners. */
#include <math.h>
#include "picture/raster/distance.h"
#include "picture/raster/raster_private.h"

/* Points of cells stand half a ball's radius from the border: 0.49 of it with 2 x 2 Gauss points, 0.39 with 3 x 3,
 * 0.67 in a lattice of points that each are in the middle of what is theirs. */
#define WITHIN 0.5
/* Of a ball's radius: it touches a wall that is no farther from it. */
#define TOUCHES 0.6

/* Samples with a margin into which the body may grow. */
typedef struct {
  int width, height, margin;
  unsigned char *in, *touches; /* touches: between a ball and a wall that do */
  float *distance, *lean;      /* from what is empty; as if walls were of the body */
  int *nearest, *owner;        /* owner: the ball, counted from 1 where the sample is of the body; 0 */
} Room;

static PetscErrorCode RoomCreate(const Canvas *canvas, PetscReal gap, Room *room)
{
  PetscFunctionBeginUser;
  room->margin = (int)ceil(gap) + 2;
  room->width = canvas->width + 2 * room->margin;
  room->height = canvas->height + 2 * room->margin;
  const size_t n = (size_t)room->width * (size_t)room->height;
  PetscCall(PetscMalloc4(n, &room->in, n, &room->touches, n, &room->distance, n, &room->nearest));
  PetscCall(PetscCalloc2(n, &room->owner, n, &room->lean));
  for (int j = 0; j < canvas->height; ++j)
    for (int i = 0; i < canvas->width; ++i) {
      const PetscInt p = canvas->point[canvas_at(canvas, i, j)];
      room->owner[(size_t)(j + room->margin) * (size_t)room->width + (size_t)(i + room->margin)] = (int)p + 1;
    }
  PetscFunctionReturn(0);
}

/* Let the body grow by the gap; what is added is of the nearest ball. */
static PetscErrorCode Grow(PetscReal gap, Room *room)
{
  const size_t n = (size_t)room->width * (size_t)room->height;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < n; ++i) room->in[i] = room->owner[i] > 0;
  PetscCall(DistanceTo(room->width, room->height, room->in, room->distance, room->nearest));
  for (size_t i = 0; i < n; ++i)
    if (!room->in[i] && room->nearest[i] >= 0 && room->distance[i] <= gap) room->owner[i] = -room->nearest[i] - 1;
  /* places first, owners then: a place that was added must not give what it has just got */
  for (size_t i = 0; i < n; ++i)
    if (room->owner[i] < 0) room->owner[i] = room->owner[-room->owner[i] - 1];
  PetscFunctionReturn(0);
}

/* Where points know the outline: is a sample shown that is drawn back, `in`, or not? Where others than the outermost
 * have come to a surface, flow has made it. */
static PetscBool shows(const RasterScene *scene, const Canvas *canvas, PetscInt p, int i, int j, PetscBool in)
{
  const PetscReal x[3] = {(i + 0.5) / canvas->scale + scene->min[0], (j + 0.5) / canvas->scale + scene->min[1], 0};
  if (scene->shaded) return (PetscBool)(canvas->point[canvas_at(canvas, i, j)] >= 0); /* balls are cut */
  const RasterHeld held = scene->holds(scene->of, p, x);
  const PetscBool covered = (PetscBool)(in || canvas->point[canvas_at(canvas, i, j)] >= 0);
  return held == RASTER_OWN ? PETSC_TRUE : held == RASTER_NEAR ? covered : held == RASTER_DEEP ? in : PETSC_FALSE;
}

/* Between balls the body is as far in front as their middles. */
static void show(const RasterScene *scene, Canvas *canvas, int i, int j, PetscInt p)
{
  const size_t at = canvas_at(canvas, i, j);
  PetscReal middle[3];
  if (p >= 0 && canvas->point[at] < 0) {
    canvas_place(scene, canvas, scene->x + 3 * p, middle);
    canvas->front[at] = (float)middle[2];
  }
  canvas->point[at] = p;
}

/* How far each place of the grown body is from what is empty. */
static PetscErrorCode Empty(Room *room)
{
  const size_t n = (size_t)room->width * (size_t)room->height;

  PetscFunctionBeginUser;
  for (size_t i = 0; i < n; ++i) room->in[i] = room->owner[i] == 0;
  PetscCall(DistanceTo(room->width, room->height, room->in, room->distance, room->nearest));
  PetscFunctionReturn(0);
}

static PetscBool is_solid(const RasterScene *scene, int i, int j)
{
  return (PetscBool)(scene->solid &&
                     scene->solid[(size_t)(j / SAMPLES) * (size_t)scene->width + (size_t)(i / SAMPLES)]);
}

/* What touches a wall reaches to it. After Grow, which leaves how far balls are. */
static PetscErrorCode Lean(const RasterScene *scene, const Canvas *canvas, Room *room)
{
  const size_t n = (size_t)room->width * (size_t)room->height;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(room->touches, n));
  if (!scene->solid) PetscFunctionReturn(0);
  for (int j = 0; j < room->height; ++j)
    for (int i = 0; i < room->width; ++i) {
      const int a = PetscMin(PetscMax(i - room->margin, 0), canvas->width - 1),
                b = PetscMin(PetscMax(j - room->margin, 0), canvas->height - 1);
      room->in[(size_t)j * (size_t)room->width + (size_t)i] = is_solid(scene, a, b);
    }
  PetscCall(DistanceTo(room->width, room->height, room->in, room->lean, room->nearest));
  for (size_t at = 0; at < n; ++at) {
    const PetscInt p = room->owner[at] - 1;
    const PetscReal apart = room->distance[at] + room->lean[at];
    room->touches[at] = p >= 0 && apart <= TOUCHES * canvas_radius(scene, canvas, p);
    room->in[at] = room->owner[at] == 0 && !room->in[at];
  }
  PetscCall(DistanceTo(room->width, room->height, room->in, room->lean, room->nearest));
  PetscFunctionReturn(0);
}

PetscErrorCode CanvasShape(const RasterScene *scene, Canvas *canvas)
{
  const PetscReal gap = PetscMin(scene->gap * canvas->scale, 30 * SAMPLES);
  Room room;

  PetscFunctionBeginUser;
  PetscCall(RoomCreate(canvas, gap, &room));
  PetscCall(Grow(gap, &room));
  PetscCall(Lean(scene, canvas, &room));
  PetscCall(Empty(&room));
  for (int j = 0; j < canvas->height; ++j)
    for (int i = 0; i < canvas->width; ++i) {
      const size_t at = (size_t)(j + room.margin) * (size_t)room.width + (size_t)(i + room.margin);
      const PetscInt p = room.owner[at] - 1;
      const PetscReal back = p < 0 ? 0 : gap + (1 - WITHIN) * canvas_radius(scene, canvas, p);
      PetscBool in = (PetscBool)(p >= 0 && (room.distance[at] > back || (room.touches[at] && room.lean[at] > back)));
      const PetscReal deep = p < 0 ? 0 : back + canvas_radius(scene, canvas, p); /* surfaces that met are no more */
      if (p >= 0 && scene->knows && scene->knows[p] && room.distance[at] <= deep)
        in = shows(scene, canvas, p, i, j, in);
      show(scene, canvas, i, j, in ? p : -1);
    }
  PetscCall(PetscFree4(room.in, room.touches, room.distance, room.nearest));
  PetscCall(PetscFree2(room.owner, room.lean));
  PetscFunctionReturn(0);
}
