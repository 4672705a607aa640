/* Rigid walls: in the plane grey where they are, over the body, with an outline; in space as lines. */
#pragma once
#include "picture/scene/scene.h"
#include "wall/facets/mesh.h"

/* The walls of the run's case into the scene; none, where it has none or they cannot be had (which
 * is told). */
PetscErrorCode PlotWallsOpen(const char *run, Diag *diag, PlotScene *scene);
PetscErrorCode PlotWallsClose(PlotScene *scene);
/* Let the scene reach to the ends of its walls, as far as the grid goes. */
void plot_walls_extend(PlotScene *scene);
/* In space: their edges, outlines and faces into the frames; faces.c: the pieces of a mesh that turn to the eye. */
PetscErrorCode PlotWallsLines(PlotScene *scene);
/* How far walls that end there are seen beside the view along axis d: not up and down, since sides of terrain go far
 * down. */
PetscReal walls_beside(const PlotScene *scene, const WallView *view, int d);
PetscErrorCode PlotWallsFaces(const PlotScene *scene, const WallMesh *mesh, const WallView *view, PlotFrame *frame);
/* Lines where the grid is held, in the plane. */
void plot_floor_draw(FILE *out, const PlotScene *scene, const PlotPage *page);
/* In the plane: is a wall in each pixel of a frame? To be freed; NULL: there are none. */
PetscErrorCode PlotWallsMask(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page,
                             unsigned char **mask);
/* Draw them into the image of a frame: behind what is there, their outline before it. */
void plot_walls_draw(const PlotScene *scene, const PlotFrame *frame, const PlotPage *page, unsigned char *rgba);
