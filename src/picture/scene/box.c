/* Axes of a picture in space. The eye looks from +a, -b and above, where a, b, c are the axes with
 * c upwards: so the edges that meet at (+a, -b, +c) stand in front of the body and are not drawn,
 * and the outline below and at the left carries the ticks. */
#include <math.h>
#include "picture/scene/scene.h"

/* A corner of the box from its sides along a, b, c. */
static void box_corner(const PlotScene *scene, int a, int b, int c, PetscReal x[3])
{
  const int side[3] = {a, b, c};
  for (PetscInt k = 0; k < 3; ++k) {
    const PetscInt d = (scene->up + 1 + k) % 3;
    x[d] = side[k] ? scene->box_max[d] : scene->box_min[d];
  }
}

static void line(FILE *out, const PlotScene *scene, const PetscReal *from, const PetscReal *to, const char *colour)
{
  PetscReal p[3], q[3];
  plot_project(scene, from, p);
  plot_project(scene, to, q);
  fprintf(out, "set arrow from %.9g,%.9g to %.9g,%.9g nohead back lw 1 lc rgb '%s'\n", (double)p[0], (double)p[1],
          (double)q[0], (double)q[1], colour);
}

/* Ticks along axis d that starts at `from`; they point away along -b (0), +a (1) or to the left of
 * the page. pixel: m. */
static void box_ticks(FILE *out, const PlotScene *scene, PetscInt k, const PetscReal *from, PetscReal size,
                      PetscReal pixel)
{
  static const char *const names[] = {"x [m]", "y [m]", "z [m]"};
  static const PetscReal away[3][2] = {{-0.3, -1}, {0.5, -1}, {-1, 0}};
  /* pixels: where the name stands, beyond the ticks' numbers wherever those are */
  static const PetscReal beyond[3][2] = {{-14, -44}, {42, -42}, {-68, 0}};
  static const char *const sides[] = {"right", "left", "right"};
  /* in characters: numbers of a and b at their common corner stay apart */
  static const char *const offsets[] = {"-0.5,-0.5", "0.5,-0.5", "-0.4,0"};
  const PetscInt d = (scene->up + 1 + k) % 3;
  const PetscReal length = scene->box_max[d] - scene->box_min[d];
  PetscReal x[3] = {from[0], from[1], from[2]}, p[3], end[3];
  if (!(length > 1e-9 * size)) return;
  plot_project(scene, x, p);
  x[d] = scene->box_max[d];
  plot_project(scene, x, end);
  /* five ticks, but none nearer to the next than their names are wide */
  const double along = hypot((double)(end[0] - p[0]), (double)(end[1] - p[1])) / (double)pixel;
  const double step = plot_tick_step(length, along, PetscMax(k == 2 ? 28 : 44, along / 5));
  for (PetscReal t = ceil(scene->box_min[d] / step - 1e-9); t * step <= scene->box_max[d] + 1e-9 * step; t += 1) {
    x[d] = t * step;
    plot_project(scene, x, p);
    const double a = (double)(p[0] + 7 * pixel * away[k][0]), b = (double)(p[1] + 7 * pixel * away[k][1]);
    fprintf(out, "set arrow from %.9g,%.9g to %.9g,%.9g nohead front lw 1 lc rgb '#444444'\n", (double)p[0],
            (double)p[1], a, b);
    fprintf(out, "set label '%.6g' at %.9g,%.9g %s front offset %s\n",
            (double)(fabs(t * step) < 1e-9 * step ? 0 : t * step), a, b, sides[k], offsets[k]);
  }
  x[d] = 0.5 * (scene->box_min[d] + scene->box_max[d]);
  plot_project(scene, x, p);
  fprintf(out, "set label '%s' at %.9g,%.9g %s%s front\n", names[d], (double)(p[0] + pixel * beyond[k][0]),
          (double)(p[1] + pixel * beyond[k][1]), k == 2 ? "center" : sides[k], k == 2 ? " rotate by 90" : "");
}

void plot_draw_box(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  const PetscReal pixel = (page->max[0] - page->min[0]) / page->w;
  PetscReal from[3], to[3], size = 0;
  for (int d = 0; d < 3; ++d) size = PetscMax(size, scene->box_max[d] - scene->box_min[d]);
  for (int corner = 0; corner < 8; ++corner)
    for (int k = 0; k < 3; ++k) {
      const int side[3] = {corner & 1, corner >> 1 & 1, corner >> 2 & 1};
      int other[3] = {side[0], side[1], side[2]};
      if (side[k]) continue;
      other[k] = 1;
      /* not the three edges at the corner next to the eye */
      if ((other[0] == 1 && other[1] == 0 && other[2] == 1) || (side[0] == 1 && side[1] == 0 && side[2] == 1)) continue;
      box_corner(scene, side[0], side[1], side[2], from);
      box_corner(scene, other[0], other[1], other[2], to);
      line(out, scene, from, to, "#c4c4c4");
    }
  box_corner(scene, 0, 0, 0, from);
  box_ticks(out, scene, 0, from, size, pixel);
  box_ticks(out, scene, 2, from, size, pixel);
  box_corner(scene, 1, 0, 0, from);
  box_ticks(out, scene, 1, from, size, pixel);
}
