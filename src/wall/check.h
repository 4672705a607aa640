/* Mistakes of walls that only their geometry shows. */
#pragma once
#include "wall/form.h"

/* path: of its shape. */
void wall_check(const Case *c, const WallSpec *wall, const Form *form, const char *path, Diag *diag);
