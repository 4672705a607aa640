/* The members of a sweep: the product of its axes. Each case is read once before anything is run, so
 * that a mistake in the last member does not show after an hour. */
#include <ctype.h>
#include <string.h>
#include "input/case_file.h"
#include "sweep/sweep_private.h"

const SweepKey *sweep_key(const SweepSpecification *sweep, PetscInt k, PetscInt *axis)
{
  for (*axis = 0; *axis < sweep->n_axes; ++*axis) {
    const SweepAxis *a = &sweep->axes[*axis];
    if (k == 0) return &a->key;
    if (k <= a->n_along) return &a->along[k - 1];
    k -= 1 + a->n_along;
  }
  return NULL;
}

PetscInt sweep_at(const SweepSpecification *sweep, PetscInt member, PetscInt axis)
{
  for (PetscInt a = sweep->n_axes - 1; a > axis; --a) member /= sweep->axes[a].key.n;
  return member % sweep->axes[axis].key.n;
}

static PetscErrorCode ExpandAxis(SweepRun *s, SweepAxis *axis)
{
  const YamlDocument *document = s->sweeps->document;

  PetscFunctionBeginUser;
  PetscCall(SweepKeyExpand(&axis->key, s->options->quick, document, s->diag));
  sweep_key_check_twice(&axis->key, document, s->diag);
  for (PetscInt k = 0; k < axis->n_along; ++k) {
    SweepKey *along = &axis->along[k];
    const PetscInt before = diag_errors(s->diag);
    PetscCall(SweepKeyExpand(along, s->options->quick, document, s->diag));
    if (diag_errors(s->diag) == before && along->n != axis->key.n)
      sweep_key_error(along, document, s->diag,
                      "%s has %" PetscInt_FMT " values, %s along which it varies has %" PetscInt_FMT, along->key,
                      along->n, axis->key.key, axis->key.n);
  }
  PetscFunctionReturn(0);
}

/* The product has a size, and no key stands there twice. */
static void check_axes(SweepRun *s, PetscInt *n)
{
  PetscInt axis, other;
  const SweepKey *a, *b;
  double product = 1;
  for (PetscInt i = 0; i < s->sweep->n_axes; ++i) product *= (double)s->sweep->axes[i].key.n;
  for (PetscInt i = 0; (a = sweep_key(s->sweep, i, &axis)); ++i)
    for (PetscInt k = 0; k < i && (b = sweep_key(s->sweep, k, &other)); ++k)
      if (!strcmp(a->key, b->key)) sweep_key_error(a, s->sweeps->document, s->diag, "%s is varied twice", a->key);
  if (product > SWEEP_MOST_MEMBERS)
    diag_error(s->diag, NULL, "the sweep would have %g members; %d are allowed", product, SWEEP_MOST_MEMBERS);
  *n = (PetscInt)PetscMin(product, (double)SWEEP_MOST_MEMBERS);
}

PetscBool sweep_is_ambiguous(const SweepSpecification *sweep, const SweepKey *key)
{
  const SweepKey *other;
  PetscInt axis;
  for (PetscInt k = 0; (other = sweep_key(sweep, k, &axis)); ++k)
    if (other != key && !strcmp(sweep_short_key(other), sweep_short_key(key))) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* friction_angle=35,cohesion=10: what does not belong into a path becomes '_', and a name that
 * would be too long ends with the member's number. */
static void name_member(const SweepSpecification *sweep, PetscInt member, char name[256])
{
  const SweepKey *key;
  PetscInt axis;
  size_t used = 0;
  for (PetscInt k = 0; (key = sweep_key(sweep, k, &axis)) && used < 200; ++k)
    used += (size_t)snprintf(name + used, 256 - used, "%s%.80s=%.60s", k ? "," : "",
                             sweep_is_ambiguous(sweep, key) ? key->key : sweep_short_key(key),
                             key->value[sweep_at(sweep, member, axis)]);
  for (char *c = name; *c; ++c)
    if (!isalnum((unsigned char)*c) && !strchr("._-+=,", *c)) *c = '_';
  if (used >= 200) snprintf(name + 200, 56, "-%" PetscInt_FMT, member);
}

static PetscErrorCode Settings(const SweepRun *s, PetscInt member, SettingList *set)
{
  const SweepKey *key;
  PetscInt axis;
  char *text;

  PetscFunctionBeginUser;
  PetscCall(SettingListAppend(set, &s->sweep->set, NULL, NULL));
  if (s->options->quick) PetscCall(SettingListAppend(set, &s->sweep->quick, NULL, NULL));
  for (PetscInt i = 0; i < s->options->n_set; ++i) PetscCall(SettingListAdd(set, s->options->set[i]));
  for (PetscInt k = 0; (key = sweep_key(s->sweep, k, &axis)); ++k) {
    const char *value = key->value[sweep_at(s->sweep, member, axis)];
    const size_t size = strlen(key->key) + strlen(value) + 2;
    PetscCall(PetscMalloc1(size, &text));
    PetscCall(PetscSNPrintf(text, size, "%s=%s", key->key, value));
    PetscCall(SettingListAdd(set, text));
    PetscCall(PetscFree(text));
  }
  PetscFunctionReturn(0);
}

/* Without a word on measures all that the case has are taken at the end; their names belong to the
 * sweep then. */
static PetscErrorCode TakeAll(SweepRun *s, PetscInt n_set, char **set)
{
  Case *c;

  PetscFunctionBeginUser;
  PetscCall(CaseRead(PETSC_COMM_SELF, s->file, n_set, (const char *const *)set, s->diag, &c));
  if (!c) PetscFunctionReturn(0);
  PetscCall(PetscCalloc1(case_columns(c), &s->sweep->measures));
  for (; s->sweep->n_measures < case_columns(c); ++s->sweep->n_measures) {
    Taken *taken = &s->sweep->measures[s->sweep->n_measures].taken;
    taken->times = 1;
    PetscCall(PetscStrallocpy(case_column(c, s->sweep->n_measures)->name, &taken->measure));
  }
  if (!case_columns(c))
    diag_error(s->diag, NULL, "'%s' has no measures: there is nothing that a sweep could show", s->file);
  PetscCall(CaseDestroy(&c));
  PetscFunctionReturn(0);
}

static PetscErrorCode TakenOf(SweepRun *s)
{
  SettingList set = {0};

  PetscFunctionBeginUser;
  PetscCall(Settings(s, 0, &set));
  if (!s->sweep->n_measures) PetscCall(TakeAll(s, set.n, set.text));
  PetscCall(SettingListClear(&set));
  if (diag_errors(s->diag))
    sweep_key_error(&s->sweep->axes[0].key, s->sweeps->document, s->diag, "the members of this sweep cannot be run");
  s->n_taken = s->sweep->n_measures;
  PetscCall(PetscMalloc1(s->n_taken, &s->taken));
  for (PetscInt k = 0; k < s->n_taken; ++k) s->taken[k] = s->sweep->measures[k].taken;
  PetscFunctionReturn(0);
}

/* A member that cannot be read: which, behind what is wrong with it. */
static void tell_bad_member(SweepRun *s, const Member *m)
{
  const SweepKey *key = &s->sweep->axes[0].key;
  sweep_key_error(key, s->sweeps->document, s->diag, "the member %s cannot be run", m->name);
}

static PetscBool is_taken(const Members *members, const char *name)
{
  for (PetscInt i = 0; i < members->n; ++i)
    if (!strcmp(members->member[i].name, name)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* Values that differ in nothing that a directory's name may have get a number. */
static void number_member(const Members *members, char name[256])
{
  char first[256];
  (void)snprintf(first, sizeof first, "%s", name);
  for (int k = 2; is_taken(members, name); ++k) (void)snprintf(name, 256, "%.240s-%d", first, k);
}

PetscErrorCode SweepPlan(SweepRun *s)
{
  char name[256];
  PetscInt n = 0;
  Member *m;

  PetscFunctionBeginUser;
  for (PetscInt a = 0; a < s->sweep->n_axes; ++a) PetscCall(ExpandAxis(s, &s->sweep->axes[a]));
  if (!diag_errors(s->diag)) check_axes(s, &n);
  if (!diag_errors(s->diag)) PetscCall(TakenOf(s));
  for (PetscInt i = 0; !diag_errors(s->diag) && i < n; ++i) {
    name_member(s->sweep, i, name);
    number_member(&s->members, name);
    PetscCall(MembersAdd(&s->members, s->out, name, s->file, s->n_taken, s->taken, &m));
    PetscCall(Settings(s, i, &m->set));
    PetscCall(MemberPlan(&s->members, m, s->diag));
    if (diag_errors(s->diag)) tell_bad_member(s, m);
  }
  PetscFunctionReturn(0);
}
