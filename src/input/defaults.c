/* Defaults that depend on the whole case. */
#include "input/defaults.h"
#include "material/law.h"
#include "method/method.h"
#include "method/transfer/transfer.h"

static PetscBool anything_yields(const Case *c)
{
  for (PetscInt m = 0; m < c->n_materials; ++m) {
    const Law *law = c->materials[m].law ? law_find(c->materials[m].law) : NULL;
    if (law && law->yields) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Do points hand over all that they have? */
static PetscBool keeps_all(const Case *c)
{
  const Transfer *transfer = transfer_find(c->analysis.transfer);
  const Basis *basis = basis_find(c->basis.kind);
  return c->analysis.type == ANALYSIS_DYNAMIC && transfer && transfer->slopes && basis && basis->domains;
}

/* Statics in which nodes follow others, and no stage comes before or after. */
static PetscBool stands_alone(const Case *c) { return case_is_static(&c->analysis) && !c->spec && !case_is_mixed(c); }

/* Measured (docs/theory.md, section 9): elastic bodies keep angular momentum and energy best
 * with a tenth of the mass lumped and no tie, while at the front of a flow, where yielded points
 * carry next to nothing, only both keep Newton's method alive. Where points have domains,
 * curvature is held instead, and without lumped mass the transfer loses no angular momentum at
 * all (section 16). Where nodes follow others Newton's method takes up to a fifth more iterations
 * for what swings; but what has come to rest in a stage before must find the same nodes. Where statics
 * yields those follow, too, that are reached a little more (section 62). */
void default_stabilisation(const YamlNode *given, Case *c)
{
  const PetscBool yields = anything_yields(c), exact = keeps_all(c), stands = stands_alone(c);
  if (!yaml_find(given, "mass")) c->stabilisation.mass = yields ? 1 : exact ? 0 : 0.1;
  if (!yaml_find(given, "inertia")) c->stabilisation.inertia = yields ? 0.01 : 0;
  if (!yaml_find(given, "curvature")) c->stabilisation.curvature = exact ? 0.1 : !stands ? 0.01 : yields ? 1e-4 : 1e-3;
  if (!yaml_find(given, "follow")) c->stabilisation.follow = c->spec ? 0.02 : !stands ? 0 : yields ? 0.1 : 0.02;
}

/* Explicit steps lose half of an elastic disk's spin in a revolution without the gradients that points carry, and
 * what flows goes too far with them (docs/theory.md, "Gradients that points carry"). */
PetscErrorCode DefaultTransfer(Case *c)
{
  const AnalysisSpec *a = &c->analysis;
  const PetscBool turns = a->type == ANALYSIS_EXPLICIT && a->update == EXPLICIT_MUSL && !anything_yields(c);

  PetscFunctionBeginUser;
  if (!a->transfer) PetscCall(PetscStrallocpy(turns ? "consistent" : "thesis", &c->analysis.transfer));
  PetscFunctionReturn(0);
}

/* An acceleration that points carry is out of balance on the next grid (docs/theory.md, "The
 * midpoint rule"). */
PetscErrorCode DefaultScheme(Case *c)
{
  PetscFunctionBeginUser;
  if (keeps_all(c) && !c->analysis.scheme && c->analysis.bossak == 0)
    PetscCall(PetscStrallocpy("midpoint", &c->analysis.scheme));
  PetscFunctionReturn(0);
}
