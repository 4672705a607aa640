/* Rigid walls in pictures of the plane: grey where they are, over the body, with an outline. */
#pragma once
#include "picture/scene/scene.h"

/* The walls of the run's case into the scene; none, where it has none or they cannot be had (which
 * is told). */
PetscErrorCode PlotWallsOpen(const char *run, Diag *diag, PlotScene *scene);
PetscErrorCode PlotWallsClose(PlotScene *scene);
/* Let the scene reach to the ends of its walls, as far as the grid goes. */
void plot_walls_extend(PlotScene *scene);
/* Draw them into the image of a frame: behind what is there, their outline before it. */
void plot_walls_draw(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba);
