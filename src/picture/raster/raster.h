/* Points drawn as balls that hide what lies behind them, into an image of colours. */
#pragma once
#include <petscsys.h>

/* Red, green, blue (0 to 255) of a value in [0, 1], dark blue over green to yellow; `palette_stops`
 * of them at equal distances. */
#define PALETTE_STOPS 10
extern const unsigned char palette_stops[PALETTE_STOPS][3];
void palette_colour(PetscReal value, PetscReal rgb[3]);

typedef struct {
  PetscInt n;
  const PetscReal *x;      /* n x 3: right, up, towards the eye, m */
  const PetscReal *radius; /* n, m */
  const PetscReal *value;  /* n, in [0, 1]; NaN is grey */
  PetscBool shaded;        /* as balls in space; otherwise flat */
  /* m; gaps between balls up to twice this wide are filled (flat images only) */
  PetscReal gap;
  PetscReal min[2], max[2]; /* what the image shows, m */
  int width, height;        /* pixels */
} RasterScene;

/* rgba: width x height x 4, from the lower left corner row by row, smooth at the edges, transparent
 * where there is nothing. */
PetscErrorCode RasterDraw(const RasterScene *scene, unsigned char *rgba);
