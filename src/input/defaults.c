/* Defaults that depend on the whole case. */
#include "input/defaults.h"
#include "material/law.h"
#include "method/method.h"
#include "method/transfer/transfer.h"

#define BOSSAK_OF_CLOUDS (-0.1)

/* Do points hand over more than a mean, */
static PetscBool keeps_slopes(const Case *c)
{
  const Transfer *transfer = transfer_find(c->analysis.transfer);
  return c->analysis.type == ANALYSIS_DYNAMIC && transfer && transfer->slopes;
}

/* and all that they have? */
static PetscBool keeps_all(const Case *c)
{
  const Basis *basis = basis_find(c->basis.kind);
  return keeps_slopes(c) && basis && basis->domains;
}

/* Statics in which nodes follow others, and no stage comes before or after. */
static PetscBool stands_alone(const Case *c) { return case_is_static(&c->analysis) && !c->spec && !case_is_mixed(c); }

/* Nodes that follow others make a matrix without lumped mass well conditioned, and take less energy than what holds
 * them to linear motion; with lumped mass they cost what swings a fifth more iterations. What has come to rest in a
 * stage before must find the same nodes. Where statics yields those follow, too, that are reached a little more
 * (docs/theory.md, section 62). What is bonded asks for more of fewer nodes then, and creeps (section 73). */
static PetscReal share_that_follows(const Case *c)
{
  const PetscBool yields = specs_yield(c->n_materials, c->materials);
  if (c->spec) return 0.02;
  if (stands_alone(c)) return yields ? 0.1 : 0.02;
  if (!keeps_all(c) || yields) return 0;
  return case_has_contact(c, CONTACT_BONDED) ? 0.02 : 0.3;
}

/* Measured (docs/theory.md, section 9): elastic bodies keep angular momentum and energy best
 * with a tenth of the mass lumped and no tie, but points that carry gradients come off corners
 * then, and keep as much with three tenths (docs/experiments/basis.md, "Defaults once more");
 * while at the front of a flow, where yielded points carry next to nothing, only both keep
 * Newton's method alive. Where points have domains, curvature is held instead, and without
 * lumped mass the transfer loses no angular momentum at all (section 16). */
void default_stabilisation(const YamlNode *given, Case *c)
{
  const PetscBool yields = specs_yield(c->n_materials, c->materials), exact = keeps_all(c), stands = stands_alone(c);
  if (!yaml_find(given, "mass")) c->stabilisation.mass = yields ? 1 : exact ? 0 : keeps_slopes(c) ? 0.3 : 0.1;
  if (!yaml_find(given, "inertia")) c->stabilisation.inertia = yields ? 0.01 : 0;
  if (!yaml_find(given, "curvature")) c->stabilisation.curvature = exact ? 0.1 : !stands ? 0.01 : yields ? 1e-4 : 1e-3;
  if (!yaml_find(given, "follow")) c->stabilisation.follow = share_that_follows(c);
}

/* What only swings, turns and bounces keeps its energy by gradients that points carry (docs/experiments/basis.md,
 * "Defaults once more"), and in explicit steps its spin; what flows gains nothing, and explicitly goes too far. What
 * slides with friction and nothing that damps it squeals, and then slides too easily; but splines that hand over means
 * shake where they rub, even at rest (docs/theory.md, section 93). */
const char *default_transfer(const Case *c, const char **why)
{
  const AnalysisSpec *a = &c->analysis;
  const Method *method = c->method ? method_find(c->method) : NULL;
  const Transfer *thesis = transfers[0], *slopes = transfer_find("consistent");
  const Basis *basis = basis_find(c->basis.kind);
  const PetscBool implicit = a->type == ANALYSIS_DYNAMIC, rubs = implicit && case_has_contact(c, CONTACT_FRICTION);
  const char *ignored;
  if (!why) why = &ignored;
  *why = "";
  if (case_is_static(a) || a->keep_velocity || !method || !method->restores_grid) return thesis->name;
  if (a->type == ANALYSIS_EXPLICIT && a->update != EXPLICIT_MUSL) return thesis->name;
  *why = ", the default where a law yields";
  if (specs_yield(c->n_materials, c->materials)) return thesis->name;
  *why = ", the default with friction";
  if (rubs && !(basis && basis->ends_at_held)) return thesis->name;
  *why = "; consistent, which keeps more energy, goes with scheme midpoint";
  if (implicit && !method_transfers(c, slopes, basis)) return thesis->name;
  *why = implicit && !rubs ? ", the default where no law yields and nothing rubs" : ", the default where no law yields";
  return slopes->name;
}

PetscErrorCode DefaultTransfer(Case *c)
{
  PetscFunctionBeginUser;
  if (!c->analysis.transfer) PetscCall(PetscStrallocpy(default_transfer(c, &c->transfer_why), &c->analysis.transfer));
  PetscFunctionReturn(0);
}

/* Clouds that choose their nodes anew put accelerations out of balance, and the trapezoidal rule lets that ring for
 * ever: what flows makes energy by it (docs/theory.md, section 6). */
static PetscBool rings_in_clouds(const YamlNode *given, const Case *c)
{
  const AnalysisSpec *a = &c->analysis;
  const Method *method = c->method ? method_find(c->method) : NULL;
  if (a->type != ANALYSIS_DYNAMIC || !method || !method->clouds || a->scheme) return PETSC_FALSE;
  if (yaml_find(given, "bossak") || yaml_find(given, "beta") || yaml_find(given, "gamma")) return PETSC_FALSE;
  return specs_yield(c->n_materials, c->materials);
}

/* An acceleration that points carry is out of balance on the next grid (docs/theory.md, "The
 * midpoint rule"); that of what is bonded, with all functions. */
PetscErrorCode DefaultScheme(const YamlNode *given, Case *c)
{
  AnalysisSpec *a = &c->analysis;

  PetscFunctionBeginUser;
  if (rings_in_clouds(given, c)) {
    c->damps_clouds = PETSC_TRUE;
    a->bossak = BOSSAK_OF_CLOUDS;
    a->beta = analysis_usual_beta(a);
    a->gamma = analysis_usual_gamma(a);
  }
  const PetscBool bonded = keeps_slopes(c) && case_has_contact(c, CONTACT_BONDED);
  if ((keeps_all(c) || bonded) && !a->scheme && a->bossak == 0 && !analysis_tunes_newmark(a))
    PetscCall(PetscStrallocpy("midpoint", &c->analysis.scheme));
  PetscFunctionReturn(0);
}
