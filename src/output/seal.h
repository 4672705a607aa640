/* Seals tell later whether a file is still the one that was written. */
#pragma once
#include <petscsys.h>

typedef struct {
  PetscInt64 bytes; /* length of the file; -1: not known */
  /* CRC-32 of the whole file up to 256 KiB, of 64 samples of 4 KiB spread over a longer one */
  PetscInt64 crc;
} FileSeal;

/* Of one process; returns 0 or an errno. */
int file_seal(const char *path, FileSeal *seal);
/* The same with the CRC-32 of all of the file, however long it is: of one that somebody may edit. */
int file_seal_whole(const char *path, FileSeal *seal);
/* Empty if the file is there and has the seal, else what is wrong with it. A seal that is not known
 * fits any file. */
void file_check_seal(const char *path, const FileSeal *seal, char reason[128]);
