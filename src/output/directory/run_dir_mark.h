/* Whose a directory is: talus signs those that it fills, and touches nothing in others.
 *
 * The signature is a file of its own, written before all else. A directory that an earlier version
 * filled has none; it is known by its version.txt, in which only talus names itself so. Functions
 * of one process. */
#pragma once
#include <petscsys.h>

#define RUN_DIR_SIGNATURE "made-by-talus.txt"

/* Is it signed, or of an earlier version? */
PetscBool run_dir_is_ours(const char *path);
/* Is the signature itself there? */
PetscBool run_dir_is_signed(const char *path);
/* Put the signature there; 0 or an errno. */
int run_dir_sign(const char *path);

/* Files that a run would write and that are there: their number, and the first two in words
 * ("a.txt, b.txt and 3 more"). */
PetscInt run_dir_in_the_way(const char *path, size_t size, char *names);
/* Is the file one of these? */
PetscBool run_dir_holds_as_its_own(const char *path, const char *file);
/* Would a run write a file of this name in the directory, other than its log? */
PetscBool run_dir_names_as_its_own(const char *path, const char *file);
/* Is there something at this path that is no log of talus, and that would be lost if it became
 * one? */
PetscBool run_dir_spoils(const char *log);
/* A file of these that is a link or a pipe, through which talus would write elsewhere; "" if there
 * is none. */
void run_dir_find_link(const char *path, char name[256]);

/* Remove what a run has left, its signature last; nothing if the directory is not ours. 0 or an
 * errno. */
int run_dir_remove(const char *path);
/* Remove the states (.hdf) alone. */
int run_dir_remove_states(const char *path);
