/* Energy that the run took or made: between points and grid, in stresses, in what should have come back. */
#include "method/transfer/transfer.h"
#include "run/report/warn/warn.h"

/* likewise: a tenth of the strain, or a set of about 0.005 of the way */
#define KEPT_ALLOWED 0.01
/* times all that came in */
#define MOTION_ALLOWED 10
#define PARTING_ALLOWED 2

PetscBool energy_counts(const Model *m, PetscReal energy)
{
  return (PetscBool)(m->most_energy > 0 && PetscMax(m->most_energy, PetscAbsReal(energy)) > energy_unresolved(m));
}

PetscReal energy_share(const Model *m, PetscReal energy)
{
  return energy_counts(m, energy) ? energy / m->most_energy : 0;
}

/* What the transfer has taken. Bossak's scheme lets what touches leave a step with another velocity than impulses then
 * give it: what they take stands there, the same made in the damping, and their sum counts. */
static PetscReal taken_by_transfer(const Model *m)
{
  const PetscReal sum = m->transfer_energy + m->numerical_energy;
  const PetscBool cancels =
    (PetscBool)(m->contact && !m->c->stabilisation.room && PetscAbsReal(sum) < PetscAbsReal(m->transfer_energy));
  return cancels ? sum : m->transfer_energy;
}

/* Statics of points of no extent, where these could have one. */
static PetscBool loses_at_lines(const Model *m)
{
  return (PetscBool)(m->method->restores_grid && case_is_static(&m->c->analysis) && m->grid->box &&
                     !strcmp(m->c->basis.kind, "cell"));
}

/* Clouds that choose their nodes anew have other forces than those that accelerations balanced, and in short steps that
 * rings more often: what damps it best. */
static const char *damps_clouds(const Model *m)
{
  const AnalysisSpec *a = &m->c->analysis;
  if (strcmp(m->c->basis.kind, "lme") != 0) return "`basis: {lme: {}}`, or ";
  if (a->bossak > -0.1) return "`analysis: {bossak: -0.1}`, or ";
  return a->bossak > -0.3 ? "`analysis: {bossak: -0.3}`, or " : "";
}

static void hint_of_clouds(const Model *m, Diag *diag)
{
  diag_hint(diag,
            "clouds that change where material is pressed flat or flows past what holds it make it, and shorter "
            "steps more: %smethods mpm and fem (docs/guide/limits.md)",
            damps_clouds(m));
}

/* Of forces by a table: is there one when that begins? Gravity that bodies begin in balance with does no work then. */
typedef struct {
  const Case *c;
  PetscBool any;
} AtOnce;

static void note_at_once(void *context, const Amplitude *table, TableUse use, const char *path)
{
  AtOnce *found = context;
  (void)path;
  if (table == &found->c->gravity_amplitude && case_starts_with_gravity(found->c)) return;
  found->any |= use == TABLE_FORCE && amplitude_value(table, table->origin, 0) != 0;
}

/* Is a load there at once, in statics? Without a table it grows, but for the weight of walls where bodies begin with
 * theirs. */
static PetscBool acts_at_once(const Model *m)
{
  AtOnce found = {.c = m->c};
  if (!case_is_static(&m->c->analysis)) return PETSC_FALSE;
  case_visit_tables(m->c, note_at_once, &found);
  for (PetscInt k = 0; k < m->c->n_walls; ++k)
    found.any |= m->c->walls[k].has_mass && !m->c->walls[k].absent && case_starts_with_gravity(m->c);
  return found.any;
}

/* What came in should be out again when nothing acts. */
static PetscBool keeps(const Model *m) { return (PetscBool)(energy_share(m, m->kept_energy) > KEPT_ALLOWED); }

/* Of elastic statics whose functions are made anew where material is. */
static const char hint_of_cycles[] =
  "functions that are made anew in every step do not give back all that they took, and bodies that loads come to and "
  "go from keep more each time: shorter steps lessen it, method fem gives all back (docs/guide/limits.md)";

static PetscBool is_moved_anew(const Model *m)
{
  const PetscBool anew = (PetscBool)(m->method->restores_grid || m->method->clouds);
  return (PetscBool)(anew && case_is_static(&m->c->analysis) && !materials_yield(m->c->n_materials, m->materials));
}

/* Of what was at rest and nothing acts on: no share of that tells. */
static void warn_of_made(const Model *m, PetscReal taken, Diag *diag)
{
  if (m->most_energy > 0 || !(-taken > energy_unresolved(m))) return;
  diag_warning(diag, NULL,
               "the transfer between points and grid gave %.4g J, and no energy had come in: the run made it",
               (double)-taken);
  diag_hint(diag, "measure {energy: transfer} shows when (docs/theory.md, Energy)");
}

static void hint_of_statics_at_once(const Model *m, Diag *diag)
{
  diag_hint(diag,
            "a load that is there at once works twice what the body stores in statics, and the half of it stands "
            "here; what was found is right. Without an amplitude it grows over the steps%s",
            m->contact ? ". What contact that opens, closes or slides has in it, shorter steps lessen" : "");
}

/* Of the transfer that stands for points and nodes of implicit dynamics; PETSC_FALSE: none. */
static PetscBool hint_of_scheme(const Model *m, PetscReal share, Diag *diag)
{
  const PetscBool implicit = (PetscBool)(m->method->restores_grid && m->c->analysis.type == ANALYSIS_DYNAMIC);
  if (!implicit || m->space->transfer != transfers[0]) return PETSC_FALSE;
  if (!materials_yield(m->c->n_materials, m->materials))
    diag_hint(
      diag,
      m->formulation->pressure
        ? "elastic bodies keep it with `analysis: {transfer: consistent}` (docs/theory.md, Energy)"
        : "elastic bodies keep it with `analysis: {transfer: consistent, scheme: midpoint}` (docs/theory.md, Energy)");
  else if (share < 0)
    diag_hint(diag, "steps much shorter than a wave takes through a cell make it: longer ones%s (docs/guide/limits.md)",
              m->formulation->cells ? "" : ", or `analysis: {transfer: consistent}`");
  return (PetscBool)(share < 0 || !materials_yield(m->c->n_materials, m->materials));
}

/* Within a step a body is flat to another one (docs/theory.md, section 84). */
static const char *contact_takes(const Model *m, PetscReal share)
{
  if (m->c->analysis.type == ANALYSIS_EXPLICIT && share < 0)
    return "what substeps make where points hardly reach a node, shorter ones lessen: `analysis: {courant: 0.4}`, or "
           "`basis: gimp`; measure {energy: transfer} shows when (docs/theory.md, sections 34 and 73)";
  if (m->c->analysis.type == ANALYSIS_EXPLICIT)
    return "springs of what touches store a part of it, and their dashpots take what swings until it rests; "
           "smaller cells lessen it; measure {energy: transfer} shows when (docs/theory.md, section 34)";
  if (m->method->restores_grid)
    return "steps in which contact opens, closes or begins to slide count its work by the mean of their ends: shorter "
           "ones lessen it, smaller cells what is lost beside; measure {energy: transfer} shows when (docs/theory.md, "
           "Energy)";
  if (m->c->staged && case_is_static(&m->c->analysis))
    return "steps in which contact opens, closes or begins to slide, or in which a stage brings or takes something at "
           "once, count its work by the mean of their ends: shorter ones lessen it; measure {energy: transfer} shows "
           "when (docs/theory.md, Energy)";
  if (m->c->n_interfaces > 0 && m->scheme->inertia)
    return "steps in which contact opens, closes or begins to slide count its work by the mean of their ends, and "
           "round faces of bodies drive what slides along them by v dt / (2 R) of its force: shorter ones lessen it; "
           "measure {energy: transfer} shows when (docs/guide/limits.md)";
  return "steps in which contact opens, closes or begins to slide count its work by the mean of their ends: shorter "
         "ones lessen it; measure {energy: transfer} shows when (docs/theory.md, Energy)";
}

/* PETSC_FALSE: none. What mpm loses in dynamics, or at lines of the grid, is another thing. */
static PetscBool hint_of_contact(const Model *m, PetscReal share, Diag *diag)
{
  const PetscBool by_points = (PetscBool)(m->method->restores_grid && m->c->analysis.type != ANALYSIS_EXPLICIT);
  if (!m->contact || (by_points && (m->scheme->inertia || loses_at_lines(m)))) return PETSC_FALSE;
  diag_hint(diag, "%s", contact_takes(m, share));
  return PETSC_TRUE;
}

static void hint_of_grid(const Model *m, Diag *diag)
{
  const PetscBool meet = (PetscBool)(m->contact || m->c->n_bodies > 1);
  if (loses_at_lines(m))
    diag_hint(diag,
              "points that cross lines of the grid lose it, more of them with smaller cells and steps: `basis: "
              "{gimp: {}}` (docs/guide/choose.md)");
  else if (!is_moved_anew(m) || meet)
    diag_hint(diag,
              "smaller cells%s and smaller steps lessen it; measure {energy: transfer} shows when (docs/theory.md, "
              "Energy)",
              meet ? " where bodies meet" : "");
  else if (!keeps(m)) diag_hint(diag, "%s", hint_of_cycles); /* which that says */
}

static void warn_of_transfer(const Model *m, Diag *diag)
{
  const PetscReal taken = taken_by_transfer(m), share = energy_share(m, taken);
  /* what a stage took away, unless contact has a part in it */
  if (!m->contact && !m->method->restores_grid && m->c->staged && case_is_static(&m->c->analysis)) return;
  warn_of_made(m, taken, diag);
  if (PetscAbsReal(share) <= TRANSFER_ALLOWED) return;
  diag_warning(
    diag, NULL,
    "%s %s %.2g %% of the energy that came in (%.4g of %.4g J): an energy balance near 0 does "
    "not show it",
    m->method->restores_grid ? "the transfer between points and grid" : "the transfer to what stops or holds it",
    share > 0 ? "took" : "gave", (double)(100 * PetscAbsReal(share)), (double)PetscAbsReal(taken),
    (double)m->most_energy);
  if (m->method->clouds && share < 0) hint_of_clouds(m, diag);
  else if (!m->method->restores_grid && acts_at_once(m) && share > 0) hint_of_statics_at_once(m, diag);
  else if (!hint_of_scheme(m, share, diag) && !hint_of_contact(m, share, diag)) hint_of_grid(m, diag);
}

/* Elastic bodies give all back; those that have snapped through to another shape do not, and are few. */
static void warn_of_kept(const Model *m, Diag *diag)
{
  if (!keeps(m)) return;
  diag_warning(diag, NULL,
               "elastic bodies kept %.2g %% of the energy that came in (%.4g of %.4g J) when nothing acted on them any "
               "more",
               (double)(100 * energy_share(m, m->kept_energy)), (double)m->kept_energy, (double)m->most_energy);
  if (is_moved_anew(m)) diag_hint(diag, "%s", hint_of_cycles);
  else diag_hint(diag, "bodies that have snapped through to another shape do; others do not");
}

/* Where steps leave open more than came in the transfer means nothing, and motion alone tells what was made. */
static PetscErrorCode WarnOfRunaway(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  if (case_is_static(&m->c->analysis) || !(m->most_energy > m->least_energy)) PetscFunctionReturn(0);
  if (!(e.kinetic > MOTION_ALLOWED * m->most_energy)) PetscFunctionReturn(0);
  if (energy_share(m, taken_by_transfer(m)) < -TRANSFER_ALLOWED) PetscFunctionReturn(0); /* which says it */
  diag_warning(diag, NULL, "what moves has %.2g times all the energy that came in (%.4g of %.4g J): the run made it",
               (double)(e.kinetic / m->most_energy), (double)e.kinetic, (double)m->most_energy);
  if (m->method->clouds) hint_of_clouds(m, diag);
  else diag_hint(diag, "measure {energy: kinetic} shows when; shorter steps, or smaller cells there");
  PetscFunctionReturn(0);
}

/* Stress that acts at the end of a step and not at its start, or the other way round, has half its
 * work over the whole step: on what comes apart within a step, more than had been stored. */
static PetscErrorCode WarnOfGain(Model *m, Diag *diag)
{
  Energies e;

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(m, &e));
  const PetscReal share = energy_share(m, -e.dissipated);
  if (case_is_static(&m->c->analysis) || !(share > TRANSFER_ALLOWED)) PetscFunctionReturn(0);
  diag_warning(diag, NULL, "stresses gave %.4g J more than had been put into them, %.2g %% of the %.4g J that came in",
               (double)-e.dissipated, (double)(100 * share), (double)m->most_energy);
  diag_hint(
    diag, "%s",
    m->c->analysis.type == ANALYSIS_EXPLICIT
      ? "shorter substeps (`analysis: {courant: 0.4}`), or `basis: gimp` where points hang on a corner of a cell"
      : "steps must see an impact: no longer than a wave takes through a cell, size / sqrt((lambda + 2 mu) / "
        "density), or with `analysis: {bossak: -0.3}` (docs/theory.md, Energy)");
  PetscFunctionReturn(0);
}

/* What parts points makes about as much as gravity gives where grains flow far. */
static void warn_of_room(const Model *m, Diag *diag)
{
  const PetscReal share = energy_share(m, -m->numerical_energy);
  if (!m->c->stabilisation.room || !(share > PARTING_ALLOWED)) return;
  diag_warning(diag, "stabilisation.room",
               "parting what flows made %.4g J, %.2g %% of the energy that came in: it may drive the flow",
               (double)-m->numerical_energy, (double)(100 * share));
  diag_hint(diag,
            "leave it out where what flows is nearly fluid, or beside an axis; more points a cell, displacements with "
            "`basis: gimp` and explicit dynamics need less of it (docs/guide/limits.md)");
}

PetscErrorCode WarnOfEnergy(Model *m, Diag *diag)
{
  PetscFunctionBeginUser;
  warn_of_room(m, diag);
  warn_of_transfer(m, diag);
  warn_of_kept(m, diag);
  PetscCall(WarnOfRunaway(m, diag));
  PetscCall(WarnOfGain(m, diag));
  PetscFunctionReturn(0);
}
