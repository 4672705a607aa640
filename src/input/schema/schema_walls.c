/* Keys of rigid walls. */
#include "input/schema/schema_keys.h"

static const SchemaWord contact_words[] = {
  {"frictionless", CONTACT_FRICTIONLESS, "material slides along the wall and leaves it freely"},
  {"friction", CONTACT_FRICTION, "Coulomb: it slides where the tangential force reaches friction times the normal one"},
  {"stick", CONTACT_STICK, "it does not slide while in contact, and leaves the wall freely"},
  {"bonded", CONTACT_BONDED, "what is in contact at the start stays there"},
  {NULL, 0, NULL},
};

static const SchemaEntry wall_entries[] = {
  KEY("name", NAME, NULL, "how `measures` and messages call it", REQUIRED, AT(WallSpec, name)),
  KEY("shape", TABLE, NULL, "where the wall is", .table = &schema_shape, REQUIRED, AT(WallSpec, shape)),
  KEY("inside", BOOLEAN, NULL, "a container: material is inside the shape, the wall is all around it",
      .fallback = "false", AT(WallSpec, inside)),
  KEY("contact", WORD, NULL, "law of the interface", .words = contact_words,
      .note = "friction if `friction` or `adhesion` is given, else frictionless", AT(WallSpec, contact)),
  KEY("friction", NUMBER, NULL, "coefficient of friction, the tangent of its angle", .fallback = "0", AT_LEAST(0),
      AT(WallSpec, friction)),
  KEY("adhesion", NUMBER, "N/m2", "tangential stress that contact bears without pressure", .fallback = "0", AT_LEAST(0),
      AT(WallSpec, adhesion)),
  {.key = NULL},
};
const SchemaTable schema_wall = {.name = "wall",
                                 .help = "A rigid body that material meets anywhere in the grid.",
                                 .entries = wall_entries,
                                 .size = sizeof(WallSpec),
                                 .check = SchemaCheckWall};

PetscErrorCode SchemaCheckWall(SchemaReader *r, const YamlNode *mapping, void *target)
{
  WallSpec *w = target;
  char path[512];

  PetscFunctionBeginUser;
  const PetscBool rubs = w->friction > 0 || w->adhesion > 0;
  if (!yaml_find(mapping, "contact")) w->contact = rubs ? CONTACT_FRICTION : CONTACT_FRICTIONLESS;
  else if (w->contact != CONTACT_FRICTION && rubs)
    SchemaError(r, yaml_find(mapping, "contact"),
                "%s: friction and adhesion mean something with `contact: friction` "
                "alone",
                yaml_path(mapping, path, sizeof(path)));
  PetscFunctionReturn(0);
}
