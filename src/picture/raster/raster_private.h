/* The samples of an image. */
#pragma once
#include "picture/raster/raster.h"

/* Several samples a pixel along each axis make edges smooth. */
enum { SAMPLES = 3 };

/* What a sample shows: ball p as p, triangle t as n + t, face k as n + n_triangles + k, a line as CANVAS_LINE, nothing
 * as -1. */
#define CANVAS_LINE (-2)

typedef struct {
  int width, height; /* samples */
  PetscReal scale;   /* samples a metre */
  float *front;      /* what is nearest to the eye, in samples */
  PetscInt *point;
  float *light; /* of each pixel, on what balls in space make together; NULL: flat */
  float *value; /* of each pixel, of balls that go over into each other; NULL: each has its own */
} Canvas;

/* A position in samples: right, up, towards the eye. */
static inline void canvas_place(const RasterScene *scene, const Canvas *canvas, const PetscReal *x, PetscReal at[3])
{
  at[0] = (x[0] - scene->min[0]) * canvas->scale - 0.5;
  at[1] = (x[1] - scene->min[1]) * canvas->scale - 0.5;
  at[2] = x[2] * canvas->scale;
}

/* Of a ball, in samples; never so small that it falls between them. */
static inline PetscReal canvas_radius(const RasterScene *scene, const Canvas *canvas, PetscInt p)
{
  return PetscMax(scene->radius[p] * canvas->scale, 0.6 * SAMPLES);
}

static inline size_t canvas_at(const Canvas *canvas, int i, int j)
{
  return (size_t)j * (size_t)canvas->width + (size_t)i;
}

/* On a surface with this normal, of any length: from the upper left, in front. */
static inline PetscReal canvas_light(PetscReal a, PetscReal b, PetscReal c)
{
  return 0.72 + 0.28 * PetscMax((-0.35 * a + 0.50 * b + 0.79 * c) / PetscSqrtReal(a * a + b * b + c * c), 0);
}

/* blur.c: the value of each pixel that shows balls. */
PetscErrorCode CanvasBlur(const RasterScene *scene, const Canvas *canvas, float *value);
/* relief.c: the light on each pixel of what balls in space show. */
PetscErrorCode CanvasRelief(const RasterScene *scene, const Canvas *canvas, float *light);
/* shape.c: from balls to the body that they fill. */
PetscErrorCode CanvasShape(const RasterScene *scene, Canvas *canvas);
/* triangles.c */
/* Visit the samples of a triangle (corner: 3 x 3) that are in the image. */
void canvas_each(const RasterScene *scene, const Canvas *canvas, const PetscReal *corner,
                 void (*visit)(void *context, int i, int j, float front), void *context);
void canvas_triangles(const RasterScene *scene, Canvas *canvas);
void canvas_lines(const RasterScene *scene, Canvas *canvas);
/* Value of triangle t at a sample, whether one of its lines runs there; and the light on one. */
PetscReal triangle_value(const RasterScene *scene, const Canvas *canvas, PetscInt t, int i, int j, PetscBool *line);
PetscReal triangle_light(const RasterScene *scene, const PetscReal *corner);
/* faces.c */
void canvas_faces(const RasterScene *scene, Canvas *canvas);
