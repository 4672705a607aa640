/* GeoTIFF by GDAL's program: talus itself needs no library for it. */
#pragma once
#include <petscsys.h>

/* Does a file begin as TIFF or BigTIFF does? */
PetscBool geotiff_begins(const char *data, size_t length);

/* The first band of a GeoTIFF as the text of an ESRI ASCII grid and a 0 behind it, to be freed
 * with PetscFree: cells, corners and heights in the file's unit, of which `scale` makes metres.
 * It needs room for the text in /tmp (20 bytes a post). What the grid cannot say is
 * refused: degrees, feet while scale is 1, heights in another unit than x and y, cells that are
 * not square or turned. Then, or if there is no gdal_translate, or it fails, *text is NULL and
 * `message` says the reason. Not collective. */
PetscErrorCode GeotiffText(const char *path, PetscReal scale, char **text, size_t *length, size_t size, char *message);
