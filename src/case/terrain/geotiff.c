/* gdal_translate writes the head of a GeoTIFF as a VRT, a text, and then its heights as an ESRI
 * ASCII grid. Only GDAL's driver for TIFF may open the file: what others do with a stranger's
 * file (some follow links into the network) is not asked. */
#include "case/terrain/geotiff.h"
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "base/process/child.h"
#include "base/process/environment.h"

#define MOST_WORDS 16

PetscBool geotiff_begins(const char *data, size_t length)
{
  static const char *const begins[] = {"II*\0", "MM\0*", "II+\0", "MM\0+"};
  for (int k = 0; k < 4 && length >= 4; ++k)
    if (!memcmp(data, begins[k], 4)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* All of a file that has been written, and a 0 behind it. */
static PetscErrorCode Load(FILE *file, char **text, size_t *length)
{
  PetscFunctionBeginUser;
  (void)fseek(file, 0, SEEK_END);
  const long end = ftell(file);
  rewind(file);
  *length = end > 0 ? (size_t)end : 0;
  PetscCall(PetscMalloc1(*length + 1, text));
  *length = fread(*text, 1, *length, file);
  (*text)[*length] = '\0';
  PetscFunctionReturn(0);
}

/* GDAL's first error, or the first thing it said. */
static void quote_error(FILE *complaints, const char *path, int status, size_t size, char *message)
{
  char line[256], said[256];
  child_first_line(complaints, sizeof said, said);
  rewind(complaints);
  while (fgets(line, sizeof line, complaints))
    if (!strncmp(line, "ERROR", 5)) {
      (void)snprintf(said, sizeof said, "%.*s", (int)strcspn(line, "\n"), line);
      break;
    }
  if (!said[0] || status < 256) child_end(status, sizeof said, said);
  (void)snprintf(message, size, "%s: gdal_translate cannot read it: %s", path, said);
}

/* One more run of gdal_translate: what it writes to its output. */
static PetscErrorCode Translate(const char *path, const char *const *words, char **text, size_t *length, size_t size,
                                char *message)
{
  char file[PETSC_MAX_PATH_LEN + 2], **environment;
  const char *arguments[MOST_WORDS] = {"gdal_translate", "-q", "-if", "GTiff", "-b", "1"};
  int n = 6, status = 0;
  FILE *output = tmpfile(), *complaints = tmpfile();

  PetscFunctionBeginUser;
  *text = NULL;
  PetscCall(EnvironmentForChild(0, &environment));
  (void)snprintf(file, sizeof file, "%s%s", path[0] == '/' ? "" : "./", path); /* no option, no driver's prefix */
  for (int k = 0; words[k]; ++k) arguments[n++] = words[k];
  arguments[n++] = file;
  arguments[n++] = "/vsistdout/";
  arguments[n] = NULL;
  int error = EMFILE;
  if (output && complaints) error = child_run((char *const *)arguments, environment, NULL, output, complaints, &status);
  if (error == ENOENT)
    (void)snprintf(message, size,
                   "%s: a GeoTIFF is read by GDAL's program gdal_translate, which is not in PATH (apt install "
                   "gdal-bin); or, where it is: gdal_translate -of AAIGrid %s terrain.asc",
                   path, path);
  else if (error) (void)snprintf(message, size, "%s: cannot run gdal_translate: %s", path, strerror(error));
  else if (status) quote_error(complaints, path, status, size, message);
  else PetscCall(Load(output, text, length));
  if (output) (void)fclose(output);
  if (complaints) (void)fclose(complaints);
  PetscCall(PetscFree(environment));
  PetscFunctionReturn(0);
}

/* The text of an element of the head, up to its end; NULL if it is not there. */
static const char *element(const char *head, const char *name, size_t *length)
{
  char begin[32];
  (void)snprintf(begin, sizeof begin, "<%s", name);
  const char *at = strstr(head, begin);
  const char *text = at ? strchr(at, '>') : NULL;
  if (!text) return NULL;
  *length = strcspn(++text, "<");
  return text;
}

/* North up and square. */
static PetscBool check_cells(const char *head, const char *path, size_t size, char *message)
{
  double g[6] = {0, 0, 0, 0, 0, 0}; /* x = g0 + g1 column + g2 row, y = g3 + g4 column + g5 row */
  size_t length;
  int n = 0;
  char *end;
  for (const char *at = element(head, "GeoTransform", &length); at && n < 6; at = *end == ',' ? end + 1 : NULL)
    g[n++] = strtod(at, &end);
  if (n < 6) (void)snprintf(message, size, "%s: the TIFF does not say where its cells are: it is no GeoTIFF", path);
  else if (g[2] != 0 || g[4] != 0 || !(g[1] > 0) || !(g[5] < 0))
    (void)snprintf(message, size, "%s: its rows do not go from north to south: gdalwarp %s straight.tif turns it", path,
                   path);
  else if (fabs(g[1] + g[5]) > 1e-6 * g[1])
    (void)snprintf(message, size,
                   "%s: its cells are %g x %g and not square: gdalwarp -r bilinear -tr %g %g %s square.tif", path, g[1],
                   -g[5], g[1], g[1], path);
  else return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Metres in the unit of the last UNIT["name",metres] of a text of WKT; 0: none is told. */
static double last_unit(const char *text, size_t length, char name[64])
{
  double metres = 0;
  for (const char *at = text; (at = strstr(at, "UNIT[")) && at < text + length; ++at) {
    const char *word = at + strlen("UNIT[");
    /* quotes are written as they are, or as XML wants them */
    const char *quote = *word == '"' ? "\"" : "&quot;";
    if (strncmp(word, quote, strlen(quote))) continue;
    word += strlen(quote);
    const char *end = strstr(word, quote);
    if (!end) break;
    (void)snprintf(name, 64, "%.*s", (int)PetscMin(end - word, 60), word);
    end += strlen(quote);
    metres = strtod(end + strspn(end, ", "), NULL);
  }
  return metres;
}

/* Metres in the unit of heights, as GDAL has it from the file; 0: it is not known. */
static double unit_of_heights(const char *head, double otherwise, char name[64])
{
  static const struct {
    const char *name;
    double metres;
  } units[] = {{"m", 1},
               {"metre", 1},
               {"meter", 1},
               {"metres", 1},
               {"meters", 1},
               {"ft", 0.3048},
               {"foot", 0.3048},
               {"feet", 0.3048},
               {"US survey foot", 1200.0 / 3937.0},
               {"us-ft", 1200.0 / 3937.0}};
  size_t length;
  const char *text = element(head, "UnitType", &length);
  if (!text || !length) return otherwise;
  (void)snprintf(name, 64, "%.*s", (int)PetscMin(length, 60), text);
  for (size_t k = 0; k < sizeof units / sizeof *units; ++k)
    if (!strcasecmp(name, units[k].name)) return units[k].metres;
  return 0;
}

/* The first place of a word of WKT 1, or of its name in WKT 2, in a text; NULL: it has neither. */
static const char *part(const char *text, size_t length, const char *name, const char *newer)
{
  const char *at = text ? strstr(text, name) : NULL;
  if (text && !(at && at < text + length)) at = strstr(text, newer);
  return at && at < text + length ? at : NULL;
}

/* x, y and heights in metres, or in one other unit that the user knows of. Without a system:
 * metres. */
static PetscBool check_units(const char *head, PetscReal scale, const char *path, size_t size, char *message)
{
  char name[64] = "an unknown unit", high[64] = "an unknown unit";
  size_t length = 0;
  const char *system = element(head, "SRS", &length);
  if (system && !part(system, length, "PROJCS[", "PROJCRS[") && !part(system, length, "LOCAL_CS[", "ENGCRS[")) {
    (void)snprintf(
      message, size,
      "%s: its coordinates are degrees, not metres: gdalwarp -r bilinear -t_srs EPSG:NUMBER %s metres.tif, "
      "with the number of a map projection (UTM zones in the north: 32601 to 32660)",
      path, path);
    return PETSC_FALSE;
  }
  /* A compound system has its heights behind. */
  const char *vertical = part(system, length, "VERT_CS[", "VERTCRS[");
  const double metres = system ? last_unit(system, vertical ? (size_t)(vertical - system) : length, name) : 1;
  if (!vertical) (void)snprintf(high, sizeof high, "%s", name);
  const double same = vertical ? last_unit(vertical, (size_t)(system + length - vertical), high) : metres;
  const double heights = unit_of_heights(head, same, high);
  if (!(metres > 0) || !(heights > 0) || fabs(metres - heights) > 1e-5 * metres)
    (void)snprintf(message, size, "%s: its x and y are in %s, its heights in %s: make one of both first", path,
                   system ? name : "metres", high);
  else if (fabs(metres - 1) > 1e-9 && scale == 1)
    (void)snprintf(message, size, "%s: it is in %s, not in metres: scale: %.10g makes metres of it", path, name,
                   metres);
  else return PETSC_TRUE;
  return PETSC_FALSE;
}

PetscErrorCode GeotiffText(const char *path, PetscReal scale, char **text, size_t *length, size_t size, char *message)
{
  static const char *const head_words[] = {"-of", "VRT", NULL};
  static const char *const grid_words[] = {"-unscale", "-ot", "Float64", "-of", "AAIGrid", NULL};
  char *head;

  PetscFunctionBeginUser;
  *text = NULL;
  PetscCall(Translate(path, head_words, &head, length, size, message));
  if (!head) PetscFunctionReturn(0);
  if (check_cells(head, path, size, message) && check_units(head, scale, path, size, message))
    PetscCall(Translate(path, grid_words, text, length, size, message));
  PetscCall(PetscFree(head));
  if (*text) { /* behind the grid comes its .prj, the only thing with a bracket */
    *length = strcspn(*text, "[");
    if ((*text)[*length])
      while (*length && (isalnum((unsigned char)(*text)[*length - 1]) || (*text)[*length - 1] == '_')) --*length;
    (*text)[*length] = '\0';
  }
  PetscFunctionReturn(0);
}
