/* Keys of the shape functions of clouds of nodes. */
#include "input/schema/schema_keys.h"

static const SchemaWord order_words[] = {
  {"linear", ORDER_LINEAR, "1, x, y"},
  {"bilinear", ORDER_BILINEAR, "and xy"},
  {"quadratic", ORDER_QUADRATIC, "all of second order"},
  {NULL, 0, NULL},
};
static const SchemaWord weight_words[] = {
  {"gaussian", WEIGHT_GAUSSIAN, "exp(-(r / (effective_radius h))^2)"},
  {"cubic-spline", WEIGHT_CUBIC_SPLINE, "ends at the effective radius"},
  {NULL, 0, NULL},
};
static const SchemaWord cloud_words[] = {
  {"adaptive", CLOUD_CHOICE_ADAPTIVE, "the least radius that gives a good basis, and no link through a gap"},
  {"nearest", CLOUD_CHOICE_NEAREST, "one more of the next nearest nodes after the other (thesis 4.5.3)"},
  {"fixed", CLOUD_CHOICE_FIXED, "those within the radius, whatever comes out"},
  {NULL, 0, NULL},
};
static const SchemaWord essential_words[] = {
  {"auto", ESSENTIAL_AUTO, "constraints for mls, direct for lme"},
  {"direct", ESSENTIAL_DIRECT,
   "on the unknowns of the nodes: exact where shape functions of inner nodes vanish on the boundary"},
  {"constraints", ESSENTIAL_CONSTRAINTS,
   "on the field at the nodes' places, by Lagrange multipliers: exact for every basis"},
  {NULL, 0, NULL},
};

/* What both bases have. */
#define CLOUD                                                                                                        \
  KEY("cloud", WORD, NULL, "which nodes carry a point", .words = cloud_words, .fallback = "adaptive",                \
      AT(BasisSpec, choice)),                                                                                        \
    KEY("radius", NUMBER, NULL, "of a cloud, over the cell size", .fallback = "2", ABOVE(0), AT(BasisSpec, radius)), \
    KEY("max_radius", NUMBER, NULL, "to which it may grow, over the cell size", .fallback = "3.5", ABOVE(0),         \
        AT(BasisSpec, max_radius)),                                                                                  \
    KEY("condition", NUMBER, NULL, "of a basis that needs no more nodes", .fallback = "50", ABOVE(1),                \
        AT(BasisSpec, condition)),                                                                                   \
    KEY("minimum", INTEGER, NULL, "least number of nodes; 0: what the basis needs", .fallback = "0", BETWEEN(0, 64), \
        AT(BasisSpec, minimum)),                                                                                     \
    KEY("gap", NUMBER, NULL, "nodes farther apart are parts of different pieces, over the cell size; 0: no limit",   \
        .fallback = "2", AT_LEAST(0), AT(BasisSpec, gap))
#define ESSENTIAL                                                                                          \
  KEY("essential", WORD, NULL, "how prescribed motion acts", .words = essential_words, .fallback = "auto", \
      AT(BasisSpec, essential))

static const SchemaEntry mls_entries[] = {
  CLOUD,
  KEY("effective_radius", NUMBER, NULL, "dilation of the weight function, over the cell size", .fallback = "1",
      ABOVE(0), AT(BasisSpec, effective_radius)),
  KEY("order", WORD, NULL, "polynomials that are reproduced", .words = order_words, .fallback = "linear",
      AT(BasisSpec, order)),
  KEY("weight", WORD, NULL, "weight function", .words = weight_words, .fallback = "gaussian", AT(BasisSpec, weight)),
  ESSENTIAL,
  {.key = NULL},
};
static const SchemaTable mls = {
  .name = "mls", .help = "Moving least squares.", .entries = mls_entries, .size = sizeof(BasisSpec)};

static const SchemaEntry lme_entries[] = {
  KEY("gamma", NUMBER, NULL, "locality: 0.6 spreads wide, from 4 on nearly linear finite elements", .fallback = "1.8",
      ABOVE(0), AT(BasisSpec, gamma)),
  CLOUD,
  ESSENTIAL,
  {.key = NULL},
};
static const SchemaTable lme = {
  .name = "lme", .help = "Local maximum entropy.", .entries = lme_entries, .size = sizeof(BasisSpec)};

static const SchemaEntry basis_entries[] = {
  KEY("mls", TABLE, NULL, "moving least squares", .table = &mls, TAG(BASIS_MLS)),
  KEY("lme", TABLE, NULL, "local maximum entropy", .table = &lme, TAG(BASIS_LME)),
  {.key = NULL},
};
static const SchemaGroup basis_groups[] = {{GROUP_AT_MOST_ONE, {"mls", "lme", NULL}}, {GROUP_NONE, {NULL}}};

static PetscErrorCode CheckBasis(SchemaReader *r, const YamlNode *mapping, void *target)
{
  BasisSpec *basis = target;

  (void)r;
  PetscFunctionBeginUser;
  if (!yaml_find(mapping, "mls") && !yaml_find(mapping, "lme"))
    *basis = (BasisSpec){.kind = BASIS_LME, .gamma = 1.8, .radius = 2, .max_radius = 3.5, .condition = 50, .gap = 2};
  PetscFunctionReturn(0);
}

static PetscBool hide_in_basis(const SchemaEntry *e, const void *source)
{
  return ((const BasisSpec *)source)->kind != (BasisKind)e->tag;
}

const SchemaTable schema_basis = {
  .name = "basis",
  .help =
    "Shape functions of gmm; without it lme with its defaults. Lengths are counted in cells of the grid "
    "that gives the nodes.",
  .entries = basis_entries,
  .groups = basis_groups,
  .tag_offset = offsetof(BasisSpec, kind),
  .check = CheckBasis,
  .hide = hide_in_basis};
