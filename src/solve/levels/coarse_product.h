/* What the coarse nodes of a box make of a tangent: A_c = P^T A P. */
#pragma once
#include "solve/levels/coarse_box.h"
#include "solve/system/forms/gathered.h"

/* Collective. Of the tangent as it is now. fixed (n_nodes x dim): what is prescribed, on whose diagonals something
 * stands that is no stiffness. Displacements of coarse nodes that no unknown follows stand alone. */
PetscErrorCode CoarseProduct(const Gathered *tangent, const CoarseBox *box, const unsigned char *fixed, Mat *product);
