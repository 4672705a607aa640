#include "picture/scene/scene.h"
#include <math.h>
#include "picture/label.h"

/* The eye looks down from the front right: azimuth -55 degrees, elevation 22 degrees. */
void plot_project(const PlotScene *scene, const PetscReal *x, PetscReal shown[3])
{
  const PetscReal azimuth = -55 * PETSC_PI / 180, elevation = 22 * PETSC_PI / 180;
  const PetscReal ca = cos(azimuth), sa = sin(azimuth), ce = cos(elevation), se = sin(elevation);
  if (scene->dim == 2) {
    shown[0] = x[0], shown[1] = x[1], shown[2] = 0;
    return;
  }
  const PetscReal a = x[(scene->up + 1) % 3], b = x[(scene->up + 2) % 3], c = x[scene->up];
  shown[0] = -sa * a + ca * b;
  shown[1] = -se * (ca * a + sa * b) + ce * c;
  shown[2] = ce * (ca * a + sa * b) + se * c;
}

double plot_tick_step(PetscReal range, double all, double pixels)
{
  const double least = (double)range * pixels / all, power = pow(10, floor(log10(least))), share = least / power;
  return power * (share <= 1 ? 1 : share <= 2 ? 2 : share <= 5 ? 5 : 10);
}

/* What the corners of the box span on the page. */
static void extent(const PlotScene *scene, PetscReal min[2], PetscReal max[2])
{
  for (int corner = 0; corner < 8; ++corner) {
    PetscReal x[3], shown[3];
    for (int d = 0; d < 3; ++d) x[d] = corner >> d & 1 ? scene->box_max[d] : scene->box_min[d];
    plot_project(scene, x, shown);
    for (int d = 0; d < 2; ++d) {
      min[d] = corner ? PetscMin(min[d], shown[d]) : shown[d];
      max[d] = corner ? PetscMax(max[d], shown[d]) : shown[d];
    }
  }
}

/* Air around what is shown; in space more, for the ticks. */
static void add_air(const PlotScene *scene, PetscReal min[2], PetscReal max[2])
{
  const PetscReal longest = PetscMax(max[0] - min[0], max[1] - min[1]), size = longest > 1e-200 ? longest : 1;
  const PetscReal share[2] = {scene->dim == 3 ? 0.13 : 0.04, scene->dim == 3 ? 0.11 : 0.04};
  for (int d = 0; d < 2; ++d) {
    const PetscReal air = PetscMax(share[d] * size, 0.5 * (0.02 * size - (max[d] - min[d])));
    min[d] -= air, max[d] += air;
  }
}

/* Rows above and below, columns left and right of the fields. */
static void margins(const PlotPage *page, PetscBool space, int margin[4])
{
  const PetscBool several = page->columns * page->rows > 1;
  margin[0] = space ? 45 : several ? 90 : 120;                 /* left */
  margin[1] = page->bar_below ? 40 : 165;                      /* right */
  margin[2] = (space ? 15 : 80) + (page->bar_below ? 105 : 0); /* bottom */
  margin[3] = several ? 45 : 55;                               /* top */
  for (int k = 0; k < 4; ++k) margin[k] = (int)lround(page->scale * margin[k]);
}

/* Between fields; above each stands its title. */
static int gap_x(const PlotScene *scene, const PlotPage *page)
{
  return (int)lround(page->scale * (scene->dim == 3 ? 50 : 25));
}

static int gap_y(const PlotPage *page) { return (int)lround(page->scale * 42); }

/* Columns that make a page of several fields about as wide as a screen. */
static int choose_columns(PetscInt n, PetscReal aspect)
{
  int best = 1;
  PetscReal least = PETSC_MAX_REAL;
  for (int columns = 1; columns <= n; ++columns) {
    const int rows = ((int)n + columns - 1) / columns;
    const PetscReal off = fabs(log(aspect * columns / rows / 1.5)) + 0.5 * (columns * rows - (int)n);
    if (off < least) least = off, best = columns;
  }
  return best;
}

/* Equal scales: the fields take the shape of what they show, in the middle of the room that they
 * have. */
static void place_fields(PlotPage *page, const int margin[4], int gap)
{
  const PetscReal wide = page->max[0] - page->min[0], high = page->max[1] - page->min[1];
  const int room_w = PetscMax(page->width - margin[0] - margin[1] - (page->columns - 1) * gap, 50 * page->columns),
            room_h = PetscMax(page->height - margin[2] - margin[3] - (page->rows - 1) * gap_y(page), 30 * page->rows);
  const PetscReal scale = PetscMin(room_w / (page->columns * wide), room_h / (page->rows * high));
  page->w = PetscMax((int)floor(wide * scale + 0.5 / page->columns), 2);
  page->h = PetscMax((int)floor(high * scale + 0.5 / page->rows), 2);
  page->left = margin[0] + (room_w - page->columns * page->w) / 2;
  page->bottom = margin[2] + (room_h - page->rows * page->h) / 2;
  page->step_x = page->w + gap;
  page->step_y = page->h + gap_y(page);
  /* whole pixels: the upper bounds follow the field */
  page->max[0] = page->min[0] + page->w / scale;
  page->max[1] = page->min[1] + page->h / scale;
}

/* Pixels by which the longest number along y is wider than four figures. */
static int wide_numbers(const PlotScene *scene, const PlotPage *page)
{
  const double step = plot_tick_step(page->max[1] - page->min[1], page->h, page->scale * LEAST_TICK_Y);
  int most = 4;
  if (scene->dim == 3 || scene->n_frames == 1) return 0;
  for (double k = ceil((double)page->min[1] / step); k * step <= (double)page->max[1]; ++k)
    most = PetscMax(most, snprintf(NULL, 0, "%g", k * step));
  return (int)lround(10 * page->scale) * (most - 4);
}

void plot_lay_out(const PlotScene *scene, int width, int height, PlotPage *page)
{
  int margin[4];
  extent(scene, page->min, page->max);
  add_air(scene, page->min, page->max);
  const PetscReal field = (page->max[0] - page->min[0]) / (page->max[1] - page->min[1]);
  page->columns =
    scene->columns ? (int)PetscMin(scene->columns, scene->n_frames) : choose_columns(scene->n_frames, field);
  page->rows = ((int)scene->n_frames + page->columns - 1) / page->columns;
  const PetscReal aspect = field * page->columns / page->rows;
  page->bar_below = aspect > 2.2 || scene->n_frames > 1;
  page->width = width ? width : 1200;
  page->height = height;
  page->scale = label_scale(page->width, height ? height : page->width);
  margins(page, scene->dim == 3, margin);
  const int beside_w = margin[0] + margin[1] + (page->columns - 1) * gap_x(scene, page),
            beside_h = margin[2] + margin[3] + (page->rows - 1) * gap_y(page);
  if (!height) {
    const PetscReal high = (page->width - beside_w) / aspect, most = scene->n_frames > 1 ? 1200 : 800;
    page->height = PetscMin(PetscMax((int)lround(high), 60), (int)most) + beside_h;
    if (!width && high > most) page->width = PetscMax((int)lround(most * aspect), 300) + beside_w;
  }
  place_fields(page, margin, gap_x(scene, page));
  margin[0] += wide_numbers(scene, page);
  place_fields(page, margin, gap_x(scene, page));
}
