/* Texts of a picture that is smaller than they are. */
#pragma once
#include <petscsys.h>
#include <stdio.h>

/* Quoted for gnuplot. What has more than `most` letters is cut with "…" in the middle: a unit in
 * brackets, else the last quarter, stays readable. */
void label_write(FILE *out, const char *text, PetscInt most);

/* By how much letters and margins of a picture of this size are smaller than in one that has room:
 * at most 1. */
double label_scale(int width, int height);
