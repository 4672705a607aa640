/* talus plot: pictures of a run. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include "cli/cli.h"
#include "picture/plot.h"

static const CliOption options_known[] = {
  {"field", "FIELD", "the field that gives the colours (default: displacement)"},
  {"component", "COMPONENT",
   "x y z, xx yy zz xy yz zx, magnitude, mean, mises (default of stresses), deviatoric (default of strains)"},
  {"time", "T[,T...]",
   "the states nearest to these times in seconds, or 'all'; several stand side by side (default: the last, and six on "
   "the way to it)"},
  {"columns", "N", "of several states (default: what makes a picture as wide as a screen)"},
  {"grid", NULL, "draw the grid as well"},
  {"bare", NULL, "without the outline that bodies had at first, and without lines where the grid is held"},
  {"profile", "WALL", "instead: the pressure and the shear of a wall, as a picture and a table (profile_WALL.csv)"},
  {"arrows", NULL, "of a vector field in the plane: arrows, too"},
  {"smooth", NULL, "means of the points around each, over about a cell: without what scatters from point to point"},
  {"range", "A:B", "values of the first and the last colour"},
  {"size", "WxH", "pixels, for example 1200x800 (default: to suit the body)"},
  {"up", "x|y|z", "the axis that points up in a picture in space (default: that of gravity)"},
  {"half", NULL, "of an axisymmetric run: one side of the axis alone"},
  {"turned", NULL, "of an axisymmetric run: the whole body in space, with a quarter cut out"},
  {"animate", NULL, "instead: all states one after the other, as a GIF, or a film with --format mp4 (ffmpeg)"},
  {"y", "MEASURE",
   "instead: this measure over --x; again for more curves (those of a second unit have the right axis)"},
  {"x", "MEASURE", "of --y: time, step or a measure (default: time)"},
  {"legend", "names|keys",
   "of several runs: by their names, or by the keys in which their cases differ (default: keys, where there are two "
   "at most)"},
  {"format", "png|svg|pdf|gif|mp4", "of the pictures (default: png); gif or mp4 of an animation (default: gif)"},
  {"out", "FILE", "the picture (default: RUN_DIR/pictures/...); its ending is the format"},
  {NULL, NULL, NULL},
};

const CliUsage cli_plot_usage = {
  .usage = "talus plot RUN_DIR [RUN_DIR...] [options]",
  .help =
    "Draws a state of a run coloured by a field, or several side by side, and the histories of its measures, as PNG\n"
    "pictures in RUN_DIR/pictures. Of an axisymmetric run both sides of the axis are shown. With --y, the histories\n"
    "of one or several runs over each other.",
  .examples =
    "talus plot runs/cantilever\n"
    "talus plot runs/slope --field stress --component yy --range -2e5:0\n"
    "talus plot runs/collapse --time 0,0.2,0.4 --columns 3 --out collapse.png\n"
    "talus plot runs/a runs/b --x settlement --y load",
  .options = options_known,
  .min_words = 1,
  .max_words = PLOT_MAX_CURVES,
};

static PetscBool plot_number(const char *text, PetscReal *value)
{
  char *end;
  *value = (PetscReal)strtod(text, &end);
  return end != text && !*end && !PetscIsInfOrNanReal(*value);
}

static PetscBool plot_range(const char *text, PetscReal range[2])
{
  char first[64];
  const size_t n = strcspn(text, ":");
  if (!text[n] || n == 0 || n >= sizeof first) return PETSC_FALSE;
  memcpy(first, text, n);
  first[n] = 0;
  return plot_number(first, &range[0]) && plot_number(text + n + 1, &range[1]) && range[0] < range[1];
}

static PetscBool plot_size(const char *text, int *width, int *height)
{
  char *end;
  const long w = strtol(text, &end, 10);
  if (*end != 'x' || w < 200 || w > 10000) return PETSC_FALSE;
  const long h = strtol(end + 1, &end, 10);
  if (*end || h < 150 || h > 10000) return PETSC_FALSE;
  *width = (int)w;
  *height = (int)h;
  return PETSC_TRUE;
}

/* "0,0.1,0.2", "last", "all" */
static PetscBool plot_times(const char *text, PlotOptions *options)
{
  char *end;
  options->all_times = !strcmp(text, "all");
  if (options->all_times || !strcmp(text, "last")) return PETSC_TRUE;
  for (;; text = end + 1) {
    const PetscReal time = (PetscReal)strtod(text, &end);
    if (end == text || PetscIsInfOrNanReal(time) || options->n_times == PLOT_MAX_STATES) return PETSC_FALSE;
    options->times[options->n_times++] = time;
    if (*end != ',') return !*end;
  }
}

static PetscBool plot_columns(const char *text, PetscInt *columns)
{
  char *end;
  *columns = (PetscInt)strtol(text, &end, 10);
  return end != text && !*end && *columns >= 1 && *columns <= PLOT_MAX_STATES;
}

/* From words to options; a complaint and PETSC_FALSE in *ok if they make no sense. */
static PetscErrorCode Understand(const CliArguments *arguments, PlotOptions *options, PetscBool *ok, int *exit_code)
{
  const char *time = cli_value(arguments, "time"), *range = cli_value(arguments, "range"),
             *size = cli_value(arguments, "size");
  const char *up = cli_value(arguments, "up"), *columns = cli_value(arguments, "columns");

  PetscFunctionBeginUser;
  *ok = PETSC_FALSE;
  options->run = arguments->words[0];
  options->field = cli_value(arguments, "field");
  options->component = cli_value(arguments, "component");
  options->out = cli_value(arguments, "out");
  options->format = cli_value(arguments, "format");
  options->grid = cli_flag(arguments, "grid");
  options->bare = cli_flag(arguments, "bare");
  options->arrows = cli_flag(arguments, "arrows");
  options->smooth = cli_flag(arguments, "smooth");
  options->animate = cli_flag(arguments, "animate");
  options->profile = cli_value(arguments, "profile");
  options->half = cli_flag(arguments, "half");
  options->turned = cli_flag(arguments, "turned");
  options->has_range = range != NULL;
  options->up = up ? tolower((unsigned char)up[0]) - 'x' : -1;
  if (time && !plot_times(time, options))
    PetscCall(
      CliUsageError(exit_code, "for example --time 0,0.5,1", "--time wants seconds, 'last' or 'all', not '%s'", time));
  else if (columns && !plot_columns(columns, &options->columns))
    PetscCall(
      CliUsageError(exit_code, NULL, "--columns wants a number from 1 to %d, not '%s'", PLOT_MAX_STATES, columns));
  else if (range && !plot_range(range, options->range))
    PetscCall(CliUsageError(exit_code, "for example --range 0:2.5e6",
                            "--range wants two numbers A:B with A < B, not '%s'", range));
  else if (size && !plot_size(size, &options->width, &options->height))
    PetscCall(
      CliUsageError(exit_code, "from 200x150 to 10000x10000", "--size wants pixels as in 1200x800, not '%s'", size));
  else if (cli_flag(arguments, "animate") && (time || columns || options->profile))
    PetscCall(CliUsageError(exit_code, NULL, "--animate shows all states, without --time, --columns or --profile"));
  else if (options->half && options->turned)
    PetscCall(CliUsageError(exit_code, NULL, "--half and --turned: a picture shows the one or the other"));
  else if (up && (options->up < 0 || options->up > 2 || up[1]))
    PetscCall(CliUsageError(exit_code, NULL, "--up wants x, y or z, not '%s'", up));
  else *ok = PETSC_TRUE;
  PetscFunctionReturn(0);
}

static PetscBool is_one_of(const char *word, const char *const *words)
{
  while (*words && strcasecmp(word, *words) != 0) ++words;
  return *words != NULL;
}

/* Where pictures go, and as what. */
static PetscErrorCode UnderstandOutput(const CliArguments *arguments, PetscBool *ok, int *exit_code)
{
  const char *out = cli_value(arguments, "out"), *format = cli_value(arguments, "format");
  const char *slash = out ? strrchr(out, '/') : NULL, *ending = out ? strrchr(slash ? slash : out, '.') : NULL;
  const PetscBool film = cli_flag(arguments, "animate");
  const char *const *known = film ? plot_films : plot_formats;

  PetscFunctionBeginUser;
  PetscCall(CliOneOf("format", format, known, ok, exit_code));
  if (!*ok) PetscFunctionReturn(0);
  *ok = PETSC_FALSE;
  if (out && format && !(ending && !strcasecmp(ending + 1, format)))
    PetscCall(CliUsageError(exit_code, NULL, "--out and --format: the ending of '%s' is the format", out));
  else if ((ending && ending != out && !is_one_of(ending + 1, known)) || (film && out && !ending))
    PetscCall(CliUsageError(exit_code, film ? "there are .gif and .mp4" : "there are .png, .svg and .pdf",
                            "no %s is drawn as '%s'", film ? "animation" : "picture", ending ? ending : out));
  else *ok = PETSC_TRUE;
  PetscFunctionReturn(0);
}

/* What pictures of histories take no notice of, and what those of states do not. */
static PetscErrorCode UnderstandCurves(const CliArguments *arguments, PetscBool curves, PetscBool *ok, int *exit_code)
{
  static const char *const of_states[] = {"field",  "component", "time",   "columns", "grid",
                                          "bare",   "profile",   "range",  "up",      "half",
                                          "turned", "animate",   "arrows", "smooth",  NULL};
  static const char *const of_curves[] = {"x", "legend", NULL};

  PetscFunctionBeginUser;
  PetscCall(CliOneOf("legend", cli_value(arguments, "legend"), plot_legends, ok, exit_code));
  for (const char *const *name = curves ? of_states : of_curves; *name && *ok; ++name) {
    if (!cli_value(arguments, *name)) continue;
    if (curves) PetscCall(CliUsageError(exit_code, NULL, "--y draws histories, which have no --%s", *name));
    else PetscCall(CliUsageError(exit_code, "for example --y load", "--%s is of histories: there is no --y", *name));
    *ok = PETSC_FALSE;
  }
  if (*ok && !curves && arguments->n_words > 1) {
    PetscCall(CliUsageError(exit_code, "for example --y load; talus compare takes all measures",
                            "several runs are drawn with --y MEASURE alone"));
    *ok = PETSC_FALSE;
  }
  PetscFunctionReturn(0);
}

static void say(const char *path) { printf("picture = %s\n", path); }

/* Who asks for nothing special sees the course of the run as well. */
static PetscErrorCode DrawCourse(const PlotOptions *options, Diag *diag)
{
  PlotOptions course = *options;
  char picture[PETSC_MAX_PATH_LEN];

  PetscFunctionBeginUser;
  if (options->n_times || options->all_times || options->out) PetscFunctionReturn(0);
  course.even = 6;
  PetscCall(PlotState(&course, diag, picture));
  if (picture[0]) say(picture);
  PetscFunctionReturn(0);
}

/* Histories over each other. */
static PetscErrorCode DrawCurves(const CliArguments *arguments, const PlotOptions *options, PetscInt n_y,
                                 const char *const *y, int *exit_code)
{
  const PlotXYOptions curves = {.n_runs = arguments->n_words,
                                .n_y = n_y,
                                .runs = arguments->words,
                                .x = cli_value(arguments, "x"),
                                .y = y,
                                .legend = cli_value(arguments, "legend"),
                                .out = options->out,
                                .format = options->format,
                                .width = options->width,
                                .height = options->height};
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  PetscCall(PlotXY(&curves, diag, say));
  *exit_code = diag_errors(diag) ? CLI_BAD_INPUT : CLI_DONE;
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

static PetscErrorCode Draw(const PlotOptions *options, int *exit_code)
{
  char picture[PETSC_MAX_PATH_LEN] = "";
  struct stat status;
  Diag *diag;

  PetscFunctionBeginUser;
  PetscCall(DiagCreate(&diag));
  if (stat(options->run, &status) || !S_ISDIR(status.st_mode))
    diag_error(diag, NULL, "there is no run directory '%s'", options->run);
  else if (options->profile) PetscCall(PlotProfile(options, diag, say));
  else if (options->animate) PetscCall(PlotAnimate(options, diag, say));
  else PetscCall(PlotState(options, diag, picture));
  if (picture[0]) {
    say(picture);
    PetscCall(DrawCourse(options, diag));
  }
  if (!options->profile && !options->animate && !diag_errors(diag)) {
    PetscCall(PlotHistories(options, diag, say));
    PetscCall(PlotFactor(options, diag, say));
    PetscCall(PlotLimit(options, diag, say));
  }
  *exit_code = diag_errors(diag) ? CLI_BAD_INPUT : CLI_DONE;
  PetscCall(DiagFlush(diag, stderr));
  PetscCall(DiagDestroy(&diag));
  PetscFunctionReturn(0);
}

PetscErrorCode CliPlot(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PlotOptions options = {0};
  const char *y[CLI_MAX_ARGUMENTS];
  PetscBool go_on;

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_plot_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  PetscCall(Understand(&arguments, &options, &go_on, exit_code));
  const PetscInt n_y = cli_values(&arguments, "y", y);
  if (go_on) PetscCall(UnderstandOutput(&arguments, &go_on, exit_code));
  if (go_on) PetscCall(UnderstandCurves(&arguments, n_y > 0, &go_on, exit_code));
  if (!go_on) PetscFunctionReturn(0);
  /* one process draws, the others learn how it went */
  if (cli_prints() && n_y) PetscCall(DrawCurves(&arguments, &options, n_y, y, exit_code));
  else if (cli_prints()) PetscCall(Draw(&options, exit_code));
  PetscCallMPI(MPI_Bcast(exit_code, 1, MPI_INT, 0, PETSC_COMM_WORLD));
  PetscFunctionReturn(0);
}
