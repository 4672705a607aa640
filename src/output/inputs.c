#include "output/inputs.h"
#include <dirent.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/text.h"
#include "grid/gmsh/msh.h"
#include "material/plugin/plugin.h"
#include "output/directory/run_dir_files.h"

#define FILES "files.txt"
#define LAW "law."

static void add_seal(FileSeal *sum, const FileSeal *one)
{
  sum->bytes += one->bytes;
  sum->crc = (sum->crc + one->crc) & 0xffffffff;
}

/* What other runs may start from: the ends of stages, and the newest state. */
static void seal_states(const char *folder, FileSeal *sum)
{
  char path[CHECKPOINT_PATH + 256];
  FileSeal one;
  DIR *listing = opendir(folder);
  for (struct dirent *e; listing && (e = readdir(listing));) {
    if (fnmatch("stage_[0-9]*.h5", e->d_name, 0)) continue;
    snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
    if (!file_seal(path, &one)) add_seal(sum, &one);
  }
  if (listing) closedir(listing);
  PetscCallAbort(PETSC_COMM_SELF, RunDirNewest(PETSC_COMM_SELF, folder, path));
  if (path[0] && !file_seal(path, &one)) add_seal(sum, &one);
}

static PetscBool is_folder(const char *path)
{
  struct stat info;
  return (PetscBool)(!stat(path, &info) && S_ISDIR(info.st_mode));
}

static PetscBool seal_path(const char *path, FileSeal *seal)
{
  char kept[FILE_PATH];
  const PetscBool run = is_folder(path);
  snprintf(kept, sizeof kept, run ? "%s/case.yaml" : "%s", path);
  if (file_seal_whole(kept, seal)) return PETSC_FALSE;
  if (run) seal_states(path, seal);
  return PETSC_TRUE;
}

/* --- writing --- */

typedef struct {
  FILE *out;
  const CaseFile *file;
} Listing;

static void write_line(FILE *out, const char *key, const FileSeal *seal, const char *path)
{
  fprintf(out, "%s = %08llx %lld %s\n", key, (unsigned long long)seal->crc, (long long)seal->bytes, path);
}

static void list_file(FILE *out, const char *key, const char *path)
{
  FileSeal seal;
  if (!strchr(path, '\n') && seal_path(path, &seal)) write_line(out, key, &seal, path);
}

/* grid.mesh, part.geo = ... */
static void list_included(void *context, const char *path)
{
  const Listing *listing = context;
  const char *slash = strrchr(path, '/');
  char key[512];
  if (!strcmp(listing->file->path, path)) return;
  snprintf(key, sizeof key, "%s, %.200s", listing->file->key, slash ? slash + 1 : path);
  list_file(listing->out, key, path);
}

static void list_case_file(FILE *out, const CaseFile *file)
{
  list_file(out, file->key, file->path);
  geo_files(file->path, list_included, &(Listing){out, file});
}

static PetscBool has_law(const Case *c, const char *law)
{
  for (PetscInt m = 0; m < c->n_materials; ++m)
    if (!strcmp(c->materials[m].law, law)) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool runs_law(const Case *whole, const char *law)
{
  PetscBool has = has_law(whole, law);
  for (PetscInt k = 0; k < whole->n_stages && !has; ++k) has = has_law(whole->stage_case[k], law);
  return has;
}

static PetscErrorCode ListInputs(FILE *out, RunDir *dir, const Case *whole)
{
  char key[128];

  PetscFunctionBeginUser;
  (void)dir;
  for (PetscInt k = 0; k < whole->n_files; ++k) list_case_file(out, &whole->files[k]);
  for (PetscInt k = 0; k < PLUGIN_MOST; ++k) {
    if (!plugins[k].file[0] || !runs_law(whole, plugins[k].name)) continue;
    snprintf(key, sizeof key, LAW "%s", plugins[k].name);
    list_file(out, key, plugins[k].file);
  }
  PetscFunctionReturn(0);
}

/* Of rank 0: what `list` writes becomes the file, unless it is nothing. */
static PetscErrorCode Write(MPI_Comm comm, RunDir *dir, PetscErrorCode (*list)(FILE *, RunDir *, const Case *),
                            const Case *whole)
{
  TextStream stream;
  PetscMPIInt rank;
  char *text;
  int any;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_rank(comm, &rank));
  PetscCall(TextOpen(&stream));
  if (!rank) PetscCall(list(stream.out, dir, whole));
  PetscCall(TextClose(&stream, &text));
  any = text[0] != '\0';
  PetscCallMPI(MPI_Bcast(&any, 1, MPI_INT, 0, comm));
  const PetscErrorCode code = any ? RunDirWriteText(dir, FILES, text) : 0;
  PetscCall(PetscFree(text));
  PetscFunctionReturn(code);
}

PetscErrorCode InputsWrite(MPI_Comm comm, RunDir *dir, const Case *whole)
{
  PetscFunctionBeginUser;
  const PetscErrorCode code = Write(comm, dir, ListInputs, whole);
  PetscFunctionReturn(code);
}

static PetscErrorCode ListMoved(FILE *out, RunDir *dir, const Case *whole)
{
  Inputs inputs;

  PetscFunctionBeginUser;
  PetscCall(InputsRead(run_dir_path(dir), &inputs));
  inputs_move(&inputs, whole);
  for (const Input *i = inputs.input; i < inputs.input + inputs.n; ++i) write_line(out, i->key, &i->seal, i->path);
  PetscCall(InputsClear(&inputs));
  PetscFunctionReturn(0);
}

PetscErrorCode InputsMoved(MPI_Comm comm, RunDir *dir, const Case *whole)
{
  PetscFunctionBeginUser;
  const PetscErrorCode code = Write(comm, dir, ListMoved, whole);
  PetscFunctionReturn(code);
}

/* --- reading --- */

/* A line of files.txt; PETSC_FALSE: it is none. */
static PetscBool parse(char *line, Input *input)
{
  char *path, *end, *sum = strstr(line, " = ");
  if (!sum || (size_t)(sum - line) >= sizeof input->key) return PETSC_FALSE;
  line[strcspn(line, "\n")] = '\0';
  snprintf(input->key, sizeof input->key, "%.*s", (int)(sum - line), line);
  input->seal.crc = (PetscInt64)strtoull(sum + 3, &end, 16);
  input->seal.bytes = (PetscInt64)strtoll(end, &path, 10);
  if (path == end || path[0] != ' ' || path[1] != '/') return PETSC_FALSE;
  return (PetscBool)(snprintf(input->path, sizeof input->path, "%s", path + 1) < (int)sizeof input->path);
}

PetscErrorCode InputsRead(const char *folder, Inputs *inputs)
{
  char path[FILE_PATH], line[PETSC_MAX_PATH_LEN + 256];
  Input one;

  PetscFunctionBeginUser;
  *inputs = (Inputs){0};
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/" FILES, folder));
  FILE *in = file_open_read(path);
  while (in && fgets(line, sizeof line, in)) {
    if (!parse(line, &one)) continue;
    PetscCall(PetscRealloc((size_t)(inputs->n + 1) * sizeof(Input), &inputs->input));
    inputs->input[inputs->n++] = one;
  }
  if (in) fclose(in);
  PetscFunctionReturn(0);
}

PetscErrorCode InputsClear(Inputs *inputs)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(inputs->input));
  inputs->n = 0;
  PetscFunctionReturn(0);
}

/* Length of the folder of a path, with its slash. */
static size_t folder_length(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash + 1 - path) : 0;
}

/* A file of that key, or one that this includes. */
static void move(Input *input, const CaseFile *file, const char *old)
{
  const size_t key = strlen(file->key), folder = folder_length(old);
  char path[PETSC_MAX_PATH_LEN];
  if (!strcmp(input->key, file->key)) PetscStrncpy(input->path, file->path, sizeof input->path);
  if (strncmp(input->key, file->key, key) || input->key[key] != ',' || strncmp(input->path, old, folder)) return;
  const int n = snprintf(path, sizeof path, "%.*s%s", (int)folder_length(file->path), file->path, input->path + folder);
  if (n < (int)sizeof path) PetscStrncpy(input->path, path, sizeof input->path);
}

void inputs_move(Inputs *inputs, const Case *c)
{
  char old[PETSC_MAX_PATH_LEN] = "";
  for (PetscInt f = 0; f < c->n_files; ++f) {
    for (PetscInt k = 0; k < inputs->n; ++k)
      if (!strcmp(inputs->input[k].key, c->files[f].key)) PetscStrncpy(old, inputs->input[k].path, sizeof old);
    for (PetscInt k = 0; k < inputs->n; ++k) move(&inputs->input[k], &c->files[f], old);
  }
}

/* A law is the library that the command line names now. */
static const char *path_now(const Input *input)
{
  const char *law = strncmp(input->key, LAW, strlen(LAW)) ? NULL : input->key + strlen(LAW);
  for (PetscInt k = 0; law && k < PLUGIN_MOST; ++k)
    if (plugins[k].file[0] && !strcmp(plugins[k].name, law)) return plugins[k].file;
  return input->path;
}

PetscBool input_changed(const Input *input)
{
  FileSeal now;
  if (!seal_path(path_now(input), &now)) return PETSC_FALSE;
  return (PetscBool)(now.bytes != input->seal.bytes || now.crc != input->seal.crc);
}

PetscBool input_is_run(const Input *input) { return is_folder(input->path); }
