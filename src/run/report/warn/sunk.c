/* What has sunk into walls and other bodies: contact of explicit dynamics is a spring about as stiff as a cell. */
#include "run/report/warn/warn.h"

#define SUNK_ALLOWED 0.01   /* of a cell, where the run ends: by so much of a cell too much does the body give way */
#define DEEP_ON_THE_WAY 0.5 /* cells: blows on flat walls go in by 0.15 to 0.3 */
#define STIFFER 10          /* springs that hold what was ten times as fast as what these hold */

static void warn_of_partner(const Case *c, PetscInt k, PetscReal deep, PetscBool goes_on, Diag *diag)
{
  const PetscBool wall = k < c->n_walls;
  AnalysisSpec stiffer = c->analysis;
  char path[32];
  stiffer.contact = PetscMin(100, PetscCeilReal(c->analysis.contact * deep / SUNK_ALLOWED));
  snprintf(path, sizeof path, wall ? "walls[%d]" : "interfaces[%d]", (int)(wall ? k : k - c->n_walls));
  diag_warning(
    diag, path,
    "at the end material is %.2g of a cell deep in %s '%s': contact of explicit dynamics is about as soft as "
    "a cell, and what is pressed there gives way by so much more%s",
    (double)deep, wall ? "wall" : "interface", wall ? c->walls[k].name : c->interfaces[k - c->n_walls].name,
    goes_on ? ", in the stages that follow, too" : "");
  diag_hint(
    diag,
    "`analysis: {contact_stiffness: %g}` leaves about %.2g of a cell of it, in %.1f times as many substeps; smaller "
    "cells lessen it, too, and implicit dynamics has none of it (docs/theory.md, section 34)",
    (double)stiffer.contact, (double)(deep * c->analysis.contact / stiffer.contact),
    (double)(case_courant(&c->analysis) / case_courant(&stiffer)));
}

static void warn_of_way(const Case *c, PetscInt k, PetscReal deep, Diag *diag)
{
  const PetscBool wall = k < c->n_walls;
  char path[32];
  snprintf(path, sizeof path, wall ? "walls[%d]" : "interfaces[%d]", (int)(wall ? k : k - c->n_walls));
  diag_warning(diag, path,
               "on the way material was %.2g cells deep in %s '%s': contact of explicit dynamics is about as soft as a "
               "cell, and gave way by so much to a blow, or at a tip or an edge",
               (double)deep, wall ? "wall" : "interface", wall ? c->walls[k].name : c->interfaces[k - c->n_walls].name);
  diag_hint(diag,
            "`type: dynamic` has none of it; a blunt tip, or `contact_stiffness`, lessens it (docs/theory.md, "
            "section 34)");
}

static void warn_of_crossed(const Model *m, PetscInt k, Diag *diag)
{
  AnalysisSpec stiffer = m->c->analysis;
  char path[32];
  stiffer.contact = PetscMin(100, PetscCeilReal(STIFFER * stiffer.contact));
  snprintf(path, sizeof path, "walls[%d]", (int)k);
  diag_warning(diag, path,
               "%.3g kg of material have gone through wall '%s', which is open: it gave way there by more than a cell, "
               "and its forces are too small",
               (double)m->contact->crossed[k], m->c->walls[k].name);
  diag_hint(
    diag,
    "`analysis: {contact_stiffness: %g}` gives way by less, in %.1f times as many substeps; nothing goes through "
    "a closed shape (a box, a polygon) two cells thick, or with `type: dynamic` (docs/theory.md, section 34)",
    (double)stiffer.contact, (double)(case_courant(&m->c->analysis) / case_courant(&stiffer)));
}

void warn_of_sunk(const Model *m, PetscBool goes_on, Diag *diag)
{
  const Contact *s = m->contact;
  if (m->c->analysis.type != ANALYSIS_EXPLICIT) return;
  for (PetscInt k = 0; s && k < s->n_partners; ++k) {
    const PetscReal deep = s->wall[k].deepest / m->grid->smallest;
    if (deep > SUNK_ALLOWED) warn_of_partner(m->c, k, deep, goes_on, diag);
    if (s->sunk[k] > DEEP_ON_THE_WAY * m->grid->smallest && s->sunk[k] > s->wall[k].deepest)
      warn_of_way(m->c, k, s->sunk[k] / m->grid->smallest, diag);
    if (s->crossed[k] > 0) warn_of_crossed(m, k, diag);
  }
}
