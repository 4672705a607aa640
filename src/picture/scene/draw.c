#include <math.h>
#include "picture/gnuplot.h"
#include "picture/label.h"
#include "picture/raster/raster.h"
#include "picture/scene/scene.h"
#include "picture/walls/walls.h"

#define NARROW 450 /* pixels */
#define LOW 160
#define LETTER 9 /* pixels of one, about */

/* How many of them have room. */
static PetscInt letters(const PlotPage *page, int pixels) { return (PetscInt)(pixels / (LETTER * page->scale)); }

/* Digits that tell neighbouring numbers of the bar apart. */
static int bar_digits(PetscReal low, PetscReal high)
{
  const PetscReal most = PetscMax(fabs(low), fabs(high)), across = high - low;
  return most > across && across > 0 ? PetscMin(PetscMax(4, 2 + (int)ceil(log10(most / across))), 6) : 4;
}

static void write_palette(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  fputs("set palette defined (", out);
  for (int i = 0; i < PALETTE_STOPS; ++i)
    fprintf(out, "%s%d '#%02x%02x%02x'", i ? ", " : "", i, palette_stops[i][0], palette_stops[i][1],
            palette_stops[i][2]);
  fprintf(out, ") maxcolors 0\nset cbrange [%.15g:%.15g]\nset format cb '%%.%dg'\nset cblabel ", (double)scene->low,
          (double)scene->high, bar_digits(scene->low, scene->high));
  label_write(out, scene->label, letters(page, page->bar_below ? page->width : page->height));
}

/* The legend of names stands where the bar does; entries only for those that are drawn. */
static void write_names(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  const double w = page->width, h = page->height;
  if (page->bar_below) {
    const double all = page->w + (page->columns - 1) * page->step_x;
    fprintf(out, "set key at screen %.6f,%.6f center top horizontal", (page->left + 0.5 * all) / w,
            (page->bottom - page->scale * (scene->dim == 3 ? 15 : 65)) / h);
  } else
    fprintf(out, "set key at screen %.6f,%.6f left top vertical", (page->left + page->w + 10) / w,
            (page->bottom + page->h) / h);
  fputs(" Left reverse samplen 1 spacing 1.3 width 0 nobox\n", out);
}

/* What the key shows: squares of the colours of names. */
static void write_entries(FILE *out, const PlotScene *scene)
{
  PetscBool there[PLOT_MAX_NAMES];
  char name[64];
  plot_find_names(scene, there);
  for (PetscInt k = 0; k < PLOT_MAX_NAMES; ++k) {
    const unsigned char *c = palette_names[k % PALETTE_NAMES];
    if (!there[k]) continue;
    fprintf(out, ", keyentry with points pt 5 ps 2 lc rgb '#%02x%02x%02x' title ", c[0], c[1], c[2]);
    gnuplot_quote(out, plot_name(scene, k, name));
  }
}

/* The bar is as long as the field is wide or high, within reason. */
static void write_colour_bar(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  const double w = page->width, h = page->height, middle = page->bottom + 0.5 * page->h, s = page->scale;
  write_palette(out, scene, page);
  if (page->bar_below) {
    const double all = page->w + (page->columns - 1) * page->step_x, length = PetscMin(all, 620),
                 left = page->left + 0.5 * (all - length), top = page->bottom - s * (scene->dim == 3 ? 15 : 75);
    fprintf(out, "\nset colorbox horizontal user origin screen %.6f,%.6f size screen %.6f,%.6f\n", left / w,
            (top - s * 16) / h, length / w, s * 16 / h);
  } else {
    const double length = PetscMin(PetscMax(page->h, s * 160), page->height - s * 80), right = page->left + page->w;
    fprintf(out, " offset 1,0\nset colorbox vertical user origin screen %.6f,%.6f size screen %.6f,%.6f\n",
            (right + s * 20) / w, (middle - 0.5 * length) / h, s * 18 / w, length / h);
  }
}

/* The lower left corner of a frame's field; frames are read as words are. */
static void draw_corner(const PlotPage *page, PetscInt frame, int *left, int *bottom)
{
  const int row = (int)frame / page->columns, column = (int)frame % page->columns;
  *left = page->left + column * page->step_x;
  *bottom = page->bottom + (page->rows - 1 - row) * page->step_y;
}

/* Radii are counted from the axis, which is drawn, to both sides. */
static void write_radii(FILE *out, const PlotPage *page, double step, PetscBool named)
{
  const int first = (int)ceil((double)page->min[0] / step);
  char radius[32];
  fputs("set xtics (", out);
  for (int k = first; k * step <= (double)page->max[0]; ++k) {
    snprintf(radius, sizeof radius, "%.6g", abs(k) * step);
    fprintf(out, "%s'%s' %.9g", k > first ? ", " : "", named ? radius : "", k * step);
  }
  fputs(")\nset arrow from 0, graph 0 to 0, graph 1 nohead front dt '_._' lw 1 lc rgb '#707070'\n", out);
}

/* gnuplot's own are for a page, and would run into one another beside a flat body and below a
 * slender one. */
static void write_tick_steps(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  const PetscBool several = scene->n_frames > 1;
  if (several || page->w < NARROW)
    fprintf(out, "set xtics %.6g\n",
            plot_tick_step(page->max[0] - page->min[0], page->w, page->scale * (several ? 45 : 60)));
  if (several || page->h < LOW)
    fprintf(out, "set ytics %.6g\n", plot_tick_step(page->max[1] - page->min[1], page->h, page->scale * LEAST_TICK_Y));
}

/* Names of the axes where they are nobody else's: at the left, and where no field lies below. */
static void write_axes(FILE *out, const PlotScene *scene, const PlotPage *page, PetscInt frame)
{
  const PetscBool left = frame % page->columns == 0, last = frame + page->columns >= scene->n_frames;
  if (scene->dim == 3) {
    fputs("unset border\nunset tics\nset cbtics out nomirror scale 0.6\n", out);
    return;
  }
  fprintf(out,
          "set border 15 lw 1 lc rgb '#444444'\nset tics out nomirror scale 0.6 textcolor rgb '#000000'\nset xlabel "
          "'%s' offset 0,0.4\nset "
          "ylabel '%s'\nset format x '%s'\nset format y '%s'\n",
          !last               ? ""
          : scene->revolution ? "radius x [m]"
                              : "x [m]",
          left ? "y [m]" : "", last ? "%g" : "", left ? "%g" : "");
  write_tick_steps(out, scene, page);
  if (scene->mirrored)
    write_radii(out, page,
                plot_tick_step(page->max[0] - page->min[0], page->w, page->scale * (scene->n_frames > 1 ? 45 : 70)),
                last);
}

/* A title stands over the middle of its field, and may be wider. */
static int title_room(const PlotScene *scene, const PlotPage *page)
{
  const int middle = page->left + page->w / 2;
  return scene->n_frames > 1 ? PetscMax(page->step_x, page->w) : 2 * PetscMin(middle, page->width - middle);
}

static void write_field(FILE *out, const PlotScene *scene, const PlotPage *page, PetscInt frame)
{
  const double w = page->width, h = page->height;
  int left, bottom;
  draw_corner(page, frame, &left, &bottom);
  fprintf(
    out,
    "set lmargin at screen %.9f\nset rmargin at screen %.9f\nset bmargin at screen %.9f\nset tmargin at screen %.9f\n",
    left / w, (left + page->w) / w, bottom / h, (bottom + page->h) / h);
  fprintf(out, "set xrange [%.15g:%.15g]\nset yrange [%.15g:%.15g]\nset title ", (double)page->min[0],
          (double)page->max[0], (double)page->min[1], (double)page->max[1]);
  label_write(out, scene->frames[frame].title, letters(page, title_room(scene, page)));
  fprintf(out, " offset 0,%g\nunset key\n", scene->n_frames > 1 ? -0.5 : 0.);
  if (scene->named && frame == 0) write_names(out, scene, page);
  write_axes(out, scene, page, frame);
}

static void write_edges(FILE *out, const PlotFrame *f)
{
  fputs("$grid << EOD\n", out);
  for (PetscInt i = 0; i < f->n_edges; ++i) {
    const PetscReal *e = f->edges + 4 * i;
    fprintf(out, "%.7g %.7g\n%.7g %.7g\n\n", (double)e[0], (double)e[1], (double)e[2], (double)e[3]);
  }
  fputs("EOD\n", out);
}

static void write_arrows(FILE *out, const PlotFrame *f)
{
  fputs("$arrows << EOD\n", out);
  for (PetscInt i = 0; i < f->n_arrows; ++i) {
    const PetscReal *a = f->arrow + 4 * i;
    fprintf(out, "%.7g %.7g %.7g %.7g\n", (double)a[0], (double)a[1], (double)a[2], (double)a[3]);
  }
  fputs("EOD\n", out);
}

/* The image is made to lie on the pixels of the field; the invisible point brings the colour
 * bar. */
static void write_plot(FILE *out, const PlotScene *scene, const PlotFrame *f, const PlotPage *page,
                       const unsigned char *rgba)
{
  const double dx = (double)(page->max[0] - page->min[0]) / page->w,
               dy = (double)(page->max[1] - page->min[1]) / page->h;
  if (f->n_edges) write_edges(out, f);
  if (f->n_arrows) write_arrows(out, f);
  fputs("plot ", out);
  if (f->n_edges) fputs("$grid with lines lw 0.7 lc rgb '#b8b8b8' notitle, ", out);
  fprintf(out,
          "'-' binary array=(%d,%d) origin=(%.15g,%.15g) dx=%.15g dy=%.15g format='%%uchar' using 1:2:3:4 with "
          "rgbalpha notitle",
          page->w, page->h, (double)page->min[0] + 0.5 * dx, (double)page->min[1] + 0.5 * dy, dx, dy);
  if (f->n_arrows)
    fputs(", $arrows using 1:2:3:4 with vectors head filled size screen 0.006,20 lw 0.8 lc rgb '#202020' notitle", out);
  if (!scene->named) fputs(", '+' using (NaN):(NaN):(0) with points palette notitle", out);
  else if (f == scene->frames) write_entries(out, scene);
  fputc('\n', out);
  fwrite(rgba, 4, (size_t)page->w * (size_t)page->h, out);
  fputc('\n', out);
}

void plot_draw_around(FILE *out, const PlotScene *scene, const PlotPage *page)
{
  if (!scene->named) write_colour_bar(out, scene, page);
  if (scene->dim == 3) plot_draw_box(out, scene, page);
  plot_floor_draw(out, scene, page);
}

PetscErrorCode PlotDrawFrame(FILE *out, const PlotScene *scene, PetscInt frame, const PlotPage *page,
                             unsigned char *rgba)
{
  PetscFunctionBeginUser;
  PetscCall(PlotImage(scene, &scene->frames[frame], page, rgba));
  if (frame == 1) fputs("unset colorbox\n", out); /* one serves all */
  write_field(out, scene, page, frame);
  write_plot(out, scene, &scene->frames[frame], page, rgba);
  PetscFunctionReturn(0);
}

PetscErrorCode PlotDraw(PlotScene *scene, int width, int height, const char *path, Diag *diag, PetscBool *done)
{
  GnuplotScript script;
  PlotPage page;
  unsigned char *rgba;

  PetscFunctionBeginUser;
  plot_lay_out(scene, width, height, &page);
  PetscCall(PetscMalloc1((size_t)page.w * (size_t)page.h * 4, &rgba));
  PetscCall(GnuplotBegin(&script, path, page.width, page.height));
  plot_draw_around(script.out, scene, &page);
  if (scene->n_frames > 1) fputs("set multiplot\n", script.out);
  for (PetscInt k = 0; k < scene->n_frames; ++k) PetscCall(PlotDrawFrame(script.out, scene, k, &page, rgba));
  if (scene->n_frames > 1) fputs("unset multiplot\n", script.out);
  PetscCall(PetscFree(rgba));
  PetscCall(GnuplotEnd(&script, path, diag, done));
  PetscFunctionReturn(0);
}
