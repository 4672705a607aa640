/* The contents list of a checkpoint: text at the start of the file. */
#pragma once
#include "base/table/table.h"

#define CONTENTS_MAX 65536 /* bytes of the list at most */

typedef struct {
  char table[TABLE_NAME], column[TABLE_NAME];
  ColumnType type;
  PetscInt components;
  PetscBool everywhere;
  PetscInt64 rows, offset;
  uint32_t crc;
} ContentsEntry;

typedef struct {
  PetscInt64 file_bytes;
  PetscInt n;
  ContentsEntry *entries; /* of malloc */
} Contents;

extern const char *const contents_types[]; /* real int64 int32 byte, by ColumnType */

/* As text, NUL-terminated, of malloc; NULL without memory. */
char *contents_write(const Contents *contents);
/* Read n bytes (which need no NUL) of a file of file_bytes bytes. PETSC_FALSE with a reason if they
 * are no list of this version, if anything in it is damaged, or if it does not fit the file.
 * contents->entries is to be freed after success. Not collective. */
PetscBool contents_read(const char *bytes, size_t n, PetscInt64 file_bytes, Contents *contents, char reason[256]);
