/* Another program, run without a shell. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

/* Runs a program that is looked for in PATH, with these files as its input (NULL: nothing),
 * output and complaints (both may be one), and waits for it. `environment` as that of
 * EnvironmentForChild. Returns 0 with its wait status, or the errno of what kept it from
 * starting. */
int child_run(char *const *arguments, char *const *environment, FILE *input, FILE *output, FILE *complaints,
              int *status);
/* "it was killed by signal 9 (Killed)", "it ended with code 3", or "" where it ended well. */
void child_end(int status, size_t size, char *text);
/* The first line that is not blank of what it wrote, without its end; "" if there is none. */
void child_first_line(FILE *complaints, size_t size, char *text);
