#include "output/directory/run_dir_mark.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <fnmatch.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "output/directory/run_dir_files.h"

static const char signature[] =
  "directory of talus\n\n"
  "talus has made this directory, or found nothing of its own names in it, and signs it with this file: --force\n"
  "replaces what talus wrote here, and leaves alone all else. Without this file talus touches nothing here.\n";

static const char unfinished[] = "*" FILE_UNFINISHED;
#define STATE_FILES                                                                                      \
  "points_[0-9]*.hdf", "grid_[0-9]*.hdf", "walls_[0-9]*.hdf", "contact_[0-9]*.hdf", "points.hdf.series", \
    "grid.hdf.series", "walls.hdf.series", "contact.hdf.series"
#define TABLES "history.csv", "events.csv", "factor.csv", "limit.csv", "stages.csv"
#define CHECKPOINTS "checkpoint_[0-9]*.h5", "stage_[0-9]*.h5", "checkpoint_[0-9]*.h5.damaged"
/* What a run leaves behind, and what `--force` removes. */
static const char *const run_files[] = {"case.yaml",   "files.txt", "functions.txt", "log.txt",   "version.txt",
                                        "timings.txt", TABLES,      STATE_FILES,     CHECKPOINTS, unfinished,
                                        NULL};
static const char *const state_files[] = {STATE_FILES, NULL};
static const char *const picture_files[] = {
  "state_*.png", "history_*.png", "profile_*.png", "profile_*.csv", "factor.png", unfinished, NULL};

/* Does the plain file begin so? */
static PetscBool begins(const char *folder, const char *name, const char *words)
{
  char path[FILE_PATH], head[128] = "";
  struct stat info;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  const int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return PETSC_FALSE;
  const ssize_t n = !fstat(fd, &info) && S_ISREG(info.st_mode) ? read(fd, head, sizeof head - 1) : -1;
  close(fd);
  return n > 0 && !strncmp(head, words, strlen(words));
}

PetscBool run_dir_is_signed(const char *path) { return begins(path, RUN_DIR_SIGNATURE, "directory of talus\n"); }

PetscBool run_dir_is_ours(const char *path)
{
  return run_dir_is_signed(path) || begins(path, "version.txt", "talus = ");
}

int run_dir_sign(const char *path)
{
  char file[FILE_PATH];
  if (run_dir_is_signed(path)) return 0;
  snprintf(file, sizeof file, "%s/%s", path, RUN_DIR_SIGNATURE);
  return file_write_text(file, signature);
}

/* Is it the signature of a run that was killed while it signed: a beginning of it, or nothing yet? */
static PetscBool is_begun_signature(const char *path, const char *name)
{
  char text[sizeof signature];
  struct stat info;
  if (strcmp(name, RUN_DIR_SIGNATURE FILE_UNFINISHED)) return PETSC_FALSE;
  const int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return PETSC_FALSE;
  const ssize_t n = !fstat(fd, &info) && S_ISREG(info.st_mode) ? read(fd, text, sizeof text) : -1;
  close(fd);
  return n >= 0 && n < (ssize_t)sizeof text && !memcmp(text, signature, (size_t)n);
}

static PetscBool matches_any(const char *name, const char *const *patterns)
{
  for (int i = 0; patterns[i]; ++i)
    if (!fnmatch(patterns[i], name, 0)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The next entry of the listing that fits, with its path. NULL at the end. */
static const char *next_file(DIR *listing, const char *folder, const char *const *patterns, char path[FILE_PATH])
{
  for (struct dirent *entry = listing ? readdir(listing) : NULL; entry; entry = readdir(listing)) {
    if (!matches_any(entry->d_name, patterns) && strcmp(entry->d_name, RUN_DIR_SIGNATURE)) continue;
    snprintf(path, FILE_PATH, "%s/%s", folder, entry->d_name);
    return entry->d_name;
  }
  return NULL;
}

PetscInt run_dir_in_the_way(const char *folder, size_t size, char *names)
{
  char path[FILE_PATH];
  PetscInt n = 0;
  size_t used = 0;
  DIR *listing = opendir(folder);
  names[0] = '\0';
  for (const char *name; (name = next_file(listing, folder, run_files, path));) {
    if (is_begun_signature(path, name)) continue;
    if (n < 2 && used < size) used += (size_t)snprintf(names + used, size - used, "%s%s", n ? ", " : "", name);
    ++n;
  }
  if (n > 2 && used < size) snprintf(names + used, size - used, " and %" PetscInt_FMT " more", n - 2);
  if (listing) closedir(listing);
  return n;
}

PetscBool run_dir_holds_as_its_own(const char *folder, const char *file)
{
  char path[FILE_PATH];
  struct stat wanted, info;
  PetscBool found = PETSC_FALSE;
  DIR *listing = stat(file, &wanted) ? NULL : opendir(folder);
  while (!found && next_file(listing, folder, run_files, path))
    found = !stat(path, &info) && info.st_dev == wanted.st_dev && info.st_ino == wanted.st_ino;
  if (listing) closedir(listing);
  return found;
}

PetscBool run_dir_names_as_its_own(const char *folder, const char *file)
{
  char parent[FILE_PATH];
  struct stat here, there;
  const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
  snprintf(parent, sizeof parent, "%.*s", slash ? (int)PetscMax(slash - file, 1) : 1, slash ? file : ".");
  if (!matches_any(name, run_files) || !strcmp(name, "log.txt") || stat(folder, &here) || stat(parent, &there))
    return PETSC_FALSE;
  return here.st_dev == there.st_dev && here.st_ino == there.st_ino;
}

PetscBool run_dir_spoils(const char *log)
{
  struct stat info;
  char real[PATH_MAX];
  if (!realpath(log, real) || stat(real, &info) || !S_ISREG(info.st_mode) || info.st_size == 0) return PETSC_FALSE;
  return !begins("", real, "talus = ");
}

void run_dir_find_link(const char *folder, char found[256])
{
  char path[FILE_PATH];
  struct stat info;
  DIR *listing = opendir(folder);
  found[0] = '\0';
  for (const char *name; !found[0] && (name = next_file(listing, folder, run_files, path));)
    if (!lstat(path, &info) && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)) snprintf(found, 256, "%s", name);
  if (listing) closedir(listing);
}

/* A link goes, not what it leads to. */
static int remove_files(const char *folder, const char *const *patterns)
{
  char path[FILE_PATH];
  int error = 0;
  DIR *listing = opendir(folder);
  if (!listing) return errno == ENOENT || errno == ENOTDIR ? 0 : errno;
  for (const char *name; !error && (name = next_file(listing, folder, patterns, path));)
    if (strcmp(name, RUN_DIR_SIGNATURE) && unlink(path)) error = errno;
  closedir(listing);
  return error;
}

int run_dir_remove(const char *folder)
{
  char path[FILE_PATH];
  struct stat info;
  if (!run_dir_is_ours(folder)) return 0;
  /* one of an earlier version that is half removed must be known, too */
  int error = run_dir_sign(folder);
  if (!error || error == ENOSPC) error = remove_files(folder, run_files);
  snprintf(path, sizeof path, "%s/pictures", folder);
  if (!error && !lstat(path, &info) && S_ISDIR(info.st_mode)) error = remove_files(path, picture_files);
  snprintf(path, sizeof path, "%s/%s", folder, RUN_DIR_SIGNATURE);
  return error ? error : unlink(path) && errno != ENOENT ? errno : 0;
}

int run_dir_remove_states(const char *folder)
{
  return run_dir_is_ours(folder) ? remove_files(folder, state_files) : 0;
}
