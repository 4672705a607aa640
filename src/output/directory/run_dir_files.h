/* Files that are written whole or not at all. Each function is of one process and returns 0 or an
 * errno. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

/* What a file is called until it is complete. */
#define FILE_UNFINISHED ".tmp-unfinished"
/* Room for a path and what is hung on it. */
#define FILE_PATH (PETSC_MAX_PATH_LEN + 64)

/* mkdir -p; an existing directory is fine. */
int file_make_folders(const char *path);
/* Is there such a file (or folder)? */
PetscBool file_exists(const char *folder, const char *name);
/* A plain file for reading; NULL, with errno, for all else: a pipe would be waited for. */
FILE *file_open_read(const char *path);
/* Fill n bytes from the offset. The file may have become shorter: EIO. */
int file_read_at(int fd, void *bytes, size_t n, off_t offset);
/* Write all n bytes at the offset. */
int file_write_at(int fd, const void *bytes, size_t n, off_t offset);
/* Flush fd to the disk and close it, also after an error. */
int file_finish(int fd);
/* Flush and close a stream; tells of anything that failed before. */
int file_finish_stream(FILE *file);
/* Flush the folder in which this file stands, so that its name is on the disk too. */
int file_sync_folder(const char *path);
/* `path` gets the text, atomically. */
int file_write_text(const char *path, const char *text);
/* Let `unfinished` become `path` (which may be there, but no device and no pipe), or remove it if
 * `error` is not 0. Returns error, or that of the
 * renaming. */
int file_commit(const char *unfinished, const char *path, int error);

/* Shortest decimal number that reads back as exactly this value. */
void file_format_real(PetscReal value, char text[32]);
