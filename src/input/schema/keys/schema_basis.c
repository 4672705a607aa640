/* Keys of the bases. Which basis takes which of these tables says support/bases.inc. */
#include "input/schema/keys/schema_keys.h"
#include "method/method.h"

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

/* What both bases of clouds have. */
#define CLOUD(usual)                                                                                                 \
  KEY("cloud", WORD, NULL, "which nodes carry a point", .words = cloud_words, .fallback = "adaptive",                \
      AT(BasisSpec, choice)),                                                                                        \
    KEY("radius", NUMBER, NULL, "of a cloud, over the cell size" usual, .fallback = "2", ABOVE(0),                   \
        AT(BasisSpec, radius)),                                                                                      \
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
  CLOUD("; 3 for order quadratic"),
  KEY("effective_radius", NUMBER, NULL,
      "dilation of the weight function, over the cell size; 1 for order quadratic, 2 for weight cubic-spline",
      .fallback = "0.75", ABOVE(0), AT(BasisSpec, effective_radius)),
  KEY("order", WORD, NULL, "polynomials that are reproduced", .words = order_words, .fallback = "linear",
      AT(BasisSpec, order)),
  KEY("weight", WORD, NULL, "weight function", .words = weight_words, .fallback = "gaussian", AT(BasisSpec, weight)),
  ESSENTIAL,
  {.key = NULL},
};

/* Weights that the radius cuts while they still count are integrated badly by the points of a cell; more functions want
 * more nodes (docs/theory.md, "Meshfree bases"). */
static PetscErrorCode CheckMls(SchemaReader *r, const YamlNode *mapping, void *target)
{
  BasisSpec *basis = target;

  PetscFunctionBeginUser;
  (void)r;
  if (!yaml_find(mapping, "radius") && basis->order == ORDER_QUADRATIC) basis->radius = 3;
  if (!yaml_find(mapping, "effective_radius")) {
    if (basis->order == ORDER_QUADRATIC) basis->effective_radius = 1;
    if (basis->weight == WEIGHT_CUBIC_SPLINE) basis->effective_radius = 2;
  }
  PetscFunctionReturn(0);
}

const SchemaTable schema_keys_mls = {
  .name = "mls", .help = "Moving least squares.", .entries = mls_entries, .size = sizeof(BasisSpec), .check = CheckMls};

static const SchemaEntry lme_entries[] = {
  KEY("gamma", NUMBER, NULL, "locality: 0.6 spreads wide, from 4 on nearly linear finite elements", .fallback = "1.8",
      ABOVE(0), AT(BasisSpec, gamma)),
  CLOUD(""),
  ESSENTIAL,
  {.key = NULL},
};
const SchemaTable schema_keys_lme = {
  .name = "lme", .help = "Local maximum entropy.", .entries = lme_entries, .size = sizeof(BasisSpec)};

static const SchemaEntry gimp_entries[] = {
  KEY("split", NUMBER, NULL,
      "a point is split in two where material is stretched so that its neighbours stand farther than so many cells "
      "away: 0.55 with nine points a cell, 0.75 with four; 0: never. Else no domain is longer than a cell, and what is "
      "stretched beyond has gaps",
      .fallback = "0", BETWEEN(0, 1), AT(BasisSpec, split)),
  {.key = NULL},
};
const SchemaTable schema_keys_gimp = {.name = "gimp",
                                      .help = "Linear functions, averaged over the points' domains.",
                                      .entries = gimp_entries,
                                      .size = sizeof(BasisSpec)};

static const SchemaEntry no_entries[] = {{.key = NULL}};
const SchemaTable schema_keys_none = {
  .name = "no keys", .help = "For a basis without numbers of its own.", .entries = no_entries};

/* Those that the method takes. */
static void hint_bases(SchemaReader *r, const Method *method)
{
  char list[256] = "";
  for (const BasisName *b = basis_names; b->name; ++b) {
    const size_t used = strlen(list);
    if (method_takes(method, b->basis))
      snprintf(list + used, sizeof list - used, "%s'%s'", used ? " or " : "", b->name);
  }
  diag_hint(r->diag, "it takes %s", list);
}

static PetscErrorCode CheckBasis(SchemaReader *r, const YamlNode *mapping, void *target)
{
  const Method *method = r->c->method ? method_find(r->c->method) : NULL;
  const YamlNode none = {.kind = YAML_MAPPING};
  BasisSpec *basis = target;

  PetscFunctionBeginUser;
  for (const BasisName *b = basis_names; b->name; ++b)
    if (yaml_find(mapping, b->name)) basis->kind = b->name;
  if (!method) PetscFunctionReturn(0);
  if (basis->kind) {
    const YamlNode *node = yaml_find(mapping, basis->kind);
    if (method_takes(method, basis_find(basis->kind))) PetscFunctionReturn(0);
    SchemaKeyError(r, node, "method %s does not take the basis '%s'", method->name, basis->kind);
    hint_bases(r, method);
    PetscFunctionReturn(0);
  }
  basis->kind = method_basis(method, r->c);
  basis->by_default = PETSC_TRUE;
  for (const SchemaEntry *e = schema_bases; e->key; ++e)
    if (!strcmp(e->key, basis->kind)) PetscCall(SchemaReadTable(r, e->table, &none, basis));
  PetscFunctionReturn(0);
}

static PetscBool hide_in_basis(const SchemaEntry *e, const void *source)
{
  return basis_find(((const BasisSpec *)source)->kind) != basis_find(e->key);
}

const SchemaTable schema_basis = {
  .name = "basis",
  .help =
    "Shape functions. Without it mpm has gimp in boxes of quadrilaterals and hexahedra, and cell where that does not "
    "go (other grids, formulation mean-dilatation, in space formulation mixed; a named transfer consistent with "
    "formulation mixed, bossak, or another scheme than midpoint); fem has cell, gmm lme. Lengths are counted in cells "
    "of the grid that gives the nodes.",
  .entries = schema_bases,
  .groups = schema_basis_groups,
  .check = CheckBasis,
  .hide = hide_in_basis};
