/* How the tables of the language are written: one KEY a line.
 *
 *   KEY("radius", NUMBER, "m", "radius", REQUIRED, ABOVE(0), AT(Shape, radius))
 *
 * reads: the key `radius` holds a number in m, greater than 0, that must be given and is stored in
 * Shape.radius. */
#pragma once
#include <math.h>
#include <string.h>
#include "input/schema/schema.h"

#define KEY(name, kind, in, text, ...)                                      \
  {                                                                         \
    .key = name, .type = TYPE_##kind, .unit = in, .help = text, __VA_ARGS__ \
  }
#define ABOVE(low) .bounded = PETSC_TRUE, .min = (low), .min_open = PETSC_TRUE, .max = INFINITY, .max_open = PETSC_TRUE
#define AT_LEAST(low) .bounded = PETSC_TRUE, .min = (low), .max = INFINITY, .max_open = PETSC_TRUE
#define BETWEEN(low, high) .bounded = PETSC_TRUE, .min = (low), .max = (high)
#define AT(type, member) .offset = offsetof(type, member)
#define GIVEN(type, member) .present = 1 + offsetof(type, member)
#define TAG(value) .tagged = PETSC_TRUE, .tag = (value)
#define ITEMS(value) .items_tagged = PETSC_TRUE, .tag = (value)
#define REQUIRED .required = PETSC_TRUE
#define ALWAYS .always = PETSC_TRUE
#define ONLY_2D .only_2d = PETSC_TRUE
#define ONLY_3D .only_3d = PETSC_TRUE
#define TURNS .turns = PETSC_TRUE
#define INPUT_ONLY .input_only = PETSC_TRUE
#define SPELLED .spelled = PETSC_TRUE
#define STAGED .staged = PETSC_TRUE
/* Of a stage, and of a case that starts from another run. */
#define RELEASE(type, ...)                                                                                            \
  KEY("release", NUMBER, "s",                                                                                         \
      "what is out of balance when it begins (a body is gone, a strength has fallen) is held by forces on nodes, "    \
      "which fade in proportion to time over so long; 0: at once. What walls and interfaces that come there bear is " \
      "theirs from the start",                                                                                        \
      .note = "statics: all of it; dynamics: 0", AT_LEAST(0), AT(type, release), GIVEN(type, has_release),            \
      __VA_ARGS__)

/* Tables that others name. */
extern const SchemaTable schema_shape, schema_wall_shape, schema_selector, schema_grid, schema_body, schema_motion,
  schema_components, schema_rotation, schema_wall, schema_interface, schema_loads, schema_basis, schema_measure,
  schema_stage, schema_strength;
/* From support/bases.inc (registry.c), and the tables that it names. */
extern const SchemaEntry schema_bases[];
extern const SchemaGroup schema_basis_groups[];
extern const SchemaTable schema_keys_none, schema_keys_gimp, schema_keys_mls, schema_keys_lme;
