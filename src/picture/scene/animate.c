/* All states one after the other, in one set of colours and on one page. Each is read twice, so that no more than one
 * is in memory: first for the range of its values and the room that it takes, then to be drawn. */
#include <string.h>
#include "output/directory/run_dir_files.h"
#include "picture/gnuplot.h"
#include "picture/scene/scene.h"

/* Of more states than these some are left out, evenly. */
#define MOST_FRAMES 300
/* Pixels, unless others are asked for: films are looked at on screens, and every frame is an image. */
#define WIDTH 900

typedef struct {
  PlotOptions options;
  PetscReal min[3], max[3];
  PetscBool any;
} Film;

static void widen_arrows(PlotOptions *options, const PlotScene *scene)
{
  if (scene->arrow_most <= 0) return;
  options->arrow_scale =
    options->arrow_most > 0 ? PetscMin(options->arrow_scale, scene->arrow_scale) : scene->arrow_scale;
  options->arrow_most = PetscMax(options->arrow_most, scene->arrow_most);
}

static PetscErrorCode Widen(Film *film, const VtkState *state, Diag *diag, PlotSubject *subject)
{
  const PetscBool given = film->options.has_range && !film->any;
  PlotScene scene = {0};

  PetscFunctionBeginUser;
  PlotOptions options = film->options;
  options.has_range = given;
  options.arrow_most = 0;
  PetscCall(PlotSceneFill(&options, 1, state, subject, diag, &scene));
  if (!film->options.contours) film->options.contours = scene.contours, scene.contours = NULL;
  if (!diag_errors(diag)) {
    for (int d = 0; d < 3; ++d) {
      film->min[d] = film->any ? PetscMin(film->min[d], scene.box_min[d]) : scene.box_min[d];
      film->max[d] = film->any ? PetscMax(film->max[d], scene.box_max[d]) : scene.box_max[d];
    }
    const PetscReal low = scene.low / scene.factor, high = scene.high / scene.factor;
    PetscReal *range = film->options.range;
    range[0] = film->any ? PetscMin(range[0], low) : low;
    range[1] = film->any ? PetscMax(range[1], high) : high;
    widen_arrows(&film->options, &scene);
    film->any = PETSC_TRUE;
  }
  PetscCall(PlotSceneFree(&scene));
  PetscFunctionReturn(0);
}

/* The next frame; the first one begins the script. */
static PetscErrorCode Add(Film *film, const VtkState *state, const char *path, GnuplotScript *script, PlotPage *page,
                          Diag *diag)
{
  PlotScene scene = {0};
  PlotSubject subject;
  unsigned char *rgba;

  PetscFunctionBeginUser;
  PetscCall(PlotSceneFill(&film->options, 1, state, &subject, diag, &scene));
  if (!diag_errors(diag)) {
    for (int d = 0; d < 3; ++d) scene.box_min[d] = film->min[d], scene.box_max[d] = film->max[d];
    if (!script->out) {
      plot_lay_out(&scene, film->options.width ? film->options.width : WIDTH, film->options.height, page);
      PetscCall(GnuplotBegin(script, path, page->width, page->height));
      plot_draw_around(script->out, &scene, page);
    }
    PetscCall(PetscMalloc1((size_t)page->w * (size_t)page->h * 4, &rgba));
    PetscCall(PlotDrawFrame(script->out, &scene, 0, page, rgba));
    PetscCall(PetscFree(rgba));
  }
  PetscCall(PlotSceneFree(&scene));
  PetscFunctionReturn(0);
}

static PetscErrorCode DrawAll(Film *film, PetscInt n, const VtkState *states, Diag *diag,
                              void (*said)(const char *path))
{
  GnuplotScript script = {NULL};
  PlotSubject subject;
  PlotPage page;
  PetscBool done = PETSC_FALSE;
  char path[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  const PetscInt frames = PetscMin(n, MOST_FRAMES);
  const PetscBool given = film->options.has_range;
  const PetscReal range[2] = {film->options.range[0], film->options.range[1]};
  for (PetscInt k = 0; k < frames && !diag_errors(diag); ++k)
    PetscCall(Widen(film, &states[k * (n - 1) / PetscMax(frames - 1, 1)], diag, &subject));
  if (diag_errors(diag)) PetscFunctionReturn(0);
  film->options.has_range = PETSC_TRUE;
  if (given) film->options.range[0] = range[0], film->options.range[1] = range[1];
  plot_picture_name(&film->options, "animation", 2, states, &subject, path);
  for (PetscInt k = 0; k < frames && !diag_errors(diag); ++k)
    PetscCall(Add(film, &states[k * (n - 1) / PetscMax(frames - 1, 1)], path, &script, &page, diag));
  if (script.out && diag_errors(diag)) fclose(script.out);
  else if (script.out) PetscCall(GnuplotEnd(&script, path, diag, &done));
  if (done && said) said(path);
  PetscFunctionReturn(0);
}

PetscErrorCode PlotAnimate(const PlotOptions *options, Diag *diag, void (*said)(const char *path))
{
  Film film = {.options = *options};
  VtkSeries series;
  PetscInt empty;
  const char *ending = options->out ? strrchr(options->out, '.') : NULL;

  PetscFunctionBeginUser;
  if (!options->format) film.options.format = "gif";
  if (!strcmp(ending ? ending + 1 : film.options.format, "mp4") && !gnuplot_has_program("ffmpeg")) {
    diag_error(diag, NULL, "there is no ffmpeg, which makes films of pictures");
    diag_hint(diag, "apt install ffmpeg, or a GIF: --format gif");
    PetscFunctionReturn(0);
  }
  PetscCall(PlotSeriesRead(options, diag, &series, &empty));
  if (diag_errors(diag)) PetscFunctionReturn(0);
  if (series.n < 2) {
    diag_error(diag, NULL, "the run '%s' has %s: nothing moves", options->run,
               series.n ? "a single state"
               : empty  ? "no states with points"
                        : "no states");
    diag_hint(diag, "output: {every: ...} says when states are written");
  } else if (options->out || plot_folder(options->run, diag))
    PetscCall(DrawAll(&film, series.n, series.states, diag, said));
  PetscCall(PlotContoursDestroy(&film.options.contours));
  PetscCall(VtkSeriesFree(&series));
  PetscFunctionReturn(0);
}
