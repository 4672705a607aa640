/* Keys of stages, and of strength that is divided. */
#include "input/schema/keys/schema_keys.h"

static const SchemaWord reset_words[] = {
  {"displacement", 0, "displacements are measured from here"},
  {"velocity", 1, "everything stands still here"},
  {NULL, 0, NULL},
};

#define RESET(type)                                                                                                \
  KEY("reset", FLAGS, NULL, "what begins anew: [displacement, velocity]", .note = "nothing", .words = reset_words, \
      AT(type, reset))
#define PART_OF(name, text) KEY(name, PART, NULL, text, INPUT_ONLY)

static const SchemaEntry stage_entries[] = {
  KEY("name", NAME, NULL, "how messages and `initial` of other cases call it", REQUIRED, AT(StageSpec, name)),
  RESET(StageSpec),
  RELEASE(StageSpec, .with = NULL),
  PART_OF("analysis",
          "with `type` it stands for itself, without it changes single keys; `end` counts from the start "
          "of the stage"),
  PART_OF(
    "bodies",
    "entries change those of their name key by key (another material, `absent`; all else only of bodies that come), or "
    "come behind them"),
  PART_OF("materials", "with `law` a material stands for itself, without it single parameters change"),
  PART_OF("boundary",
          "entries take the place of those of their name, or come behind them; {name: ..., absent: true} "
          "takes one away, [] all. Those without a name stay"),
  PART_OF("walls",
          "likewise; walls that come later are `absent` at the top. A wall that is given anew begins where its shape "
          "is, not where its motion has brought it (left out it stays there; an amplitude that begins with 1 moves it "
          "by all of its way once more). One with mass that was there stays where it is, as long as its "
          "shape is in the same words, and keeps its velocity and spin, whatever its mass is now, unless the stage "
          "says others; its load goes on as it was if `mass` is in the same words, and else, in statics, from what the "
          "wall bore to the new value; one that comes begins as it is said"),
  PART_OF("interfaces", "likewise, of another law; which bodies meet stays"),
  PART_OF(
    "loads",
    "single keys; a list takes the place of the one before, named or not: what it leaves out acts no more. A load "
    "on a body that is there acts on the surface that this had undeformed, wherever that has moved"),
  PART_OF("measures",
          "entries take the place of those of their name, or come behind them; NAME: {absent: true} drops one. Cells "
          "of history.csv are empty where a measure is not there"),
  PART_OF("strength", "divided by a factor"),
  PART_OF("newton", "single keys"),
  PART_OF("linear", "linear solver"),
  PART_OF("stabilisation", "single keys"),
  PART_OF("output", "single keys"),
  {.key = NULL},
};

static PetscErrorCode WriteChanges(FILE *out, int indent, const Case *c, const void *source)
{
  const char *line = ((const StageSpec *)source)->text;

  (void)c;
  PetscFunctionBeginUser;
  while (line && *line) {
    const int n = (int)strcspn(line, "\n");
    fprintf(out, "%*s%.*s\n", indent, "", n, line);
    line += n + (line[n] == '\n');
  }
  PetscFunctionReturn(0);
}

const SchemaTable schema_stage = {
  .name = "stage",
  .help =
    "What a stage changes: all else is as in the stage before, of the first as at the top of the file. Times of "
    "what it brings count from its start; what it repeats word for word goes on, and begins anew "
    "with a further point of its amplitude.",
  .entries = stage_entries,
  .size = sizeof(StageSpec),
  .write_open = WriteChanges};

static const SchemaEntry strength_entries[] = {
  KEY("factor", NUMBER, NULL, "c, tan phi and their like are divided by it, as in a search for the factor of safety",
      ABOVE(0), AT(StrengthSpec, factor)),
  KEY("beyond_failure", NUMBER, NULL,
      "instead: so many times the smallest factor for which the stage before, a search, found no equilibrium",
      AT_LEAST(1), AT(StrengthSpec, beyond_failure)),
  KEY("bodies", REFERENCES, NULL,
      "bodies whose strength is divided, with the friction and adhesion of what they meet: walls and other bodies",
      .note = "all", .target = "bodies", AT(StrengthSpec, bodies), .count = offsetof(StrengthSpec, n_bodies)),
  {.key = NULL},
};
static const SchemaGroup strength_groups[] = {{GROUP_ONE, {"factor", "beyond_failure", NULL}}, {GROUP_NONE, {NULL}}};
static PetscBool hide_in_strength(const SchemaEntry *e, const void *source)
{
  const StrengthSpec *s = source;
  return !strcmp(e->key, s->factor > 0 ? "beyond_failure" : "factor");
}
const SchemaTable schema_strength = {.name = "strength",
                                     .help = "Strength divided by a factor from the start.",
                                     .entries = strength_entries,
                                     .groups = strength_groups,
                                     .hide = hide_in_strength};
