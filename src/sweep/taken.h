/* A number that is taken from the history of a run: a measure at the end, or what it was over a
 * while. */
#pragma once
#include "input/schema/keys/schema_keys.h"
#include "output/history.h"

typedef enum { TAKE_END, TAKE_MAX, TAKE_MIN, TAKE_MEAN, TAKE_SLOPE } Take;
extern const SchemaWord take_words[];

typedef struct {
  char *measure; /* of the case */
  Take take;
  PetscBool has_window;
  PetscReal from, to; /* s; without a window the whole run */
  PetscReal times;    /* what is taken is shown times this, ... */
  char *unit;         /* ...in this unit; NULL: the measure's own */
  char *label;        /* in pictures; NULL: its name */
} Taken;

/* The keys of such a number, in the tables of whoever holds one. */
#define TAKEN_KEYS(owner, member)                                                                                    \
  KEY("measure", NAME, NULL, "a measure of the case", REQUIRED, AT(owner, member.measure)),                          \
    KEY("take", WORD, NULL, "what of it", .words = take_words, .fallback = "end", AT(owner, member.take)),           \
    KEY("window", INTERVAL, "s", "between these moments", AT(owner, member.from),                                    \
        .second = offsetof(owner, member.to), GIVEN(owner, member.has_window)),                                      \
    KEY("times", NUMBER, NULL, "shown times this number", .fallback = "1", .with = "unit", AT(owner, member.times)), \
    KEY("unit", TEXT, NULL, "its unit then", .with = "times", AT(owner, member.unit)),                               \
    KEY("label", TEXT, NULL, "what pictures call it", AT(owner, member.label))

/* "flow", or "flow mean" */
const char *taken_name(const Taken *taken, char name[128]);
/* Its name among n that stand beside each other: "flow mean 0 to 0.2 s" where another window is taken of the same. */
const char *taken_name_among(const Taken *taken, PetscInt n, const Taken *others, char name[128]);
/* Its unit, from that of the measure. Returns buffer. */
const char *taken_unit(const Taken *taken, const char *measure, char unit[64]);
/* In which stages (one: the case itself) a measure is a mean over steps: a row of it is that since the row before. */
typedef struct {
  PetscInt n;
  const PetscBool *is;
} TakenMeans;

#define TAKEN_WHY 192
/* Between rows a measure goes along a line, but one that is a mean has a row's value all the way to that row. The ends
 * of a window cut these lines: the mean over time, largest, smallest and last value are theirs; the slope (per second)
 * is by least squares over the rows, two at least. NaN where the history has no such number, and why; of a window that
 * reaches beyond the history what is in it, and that it does. why: "" else. */
PetscReal taken_value(const Taken *taken, const TakenMeans *means, const History *history, char why[TAKEN_WHY]);
