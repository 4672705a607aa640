/* Defaults that depend on the whole case: on its laws, its basis and its stages. */
#pragma once
#include "case/case.h"
#include "input/yaml/yaml.h"

/* Of what `given`, the mapping of that name or NULL, has no key for. */
void default_stabilisation(const YamlNode *given, Case *c);
/* By its name; why: words that go on behind it, may be NULL. */
const char *default_transfer(const Case *c, const char **why);
/* Where the case names none. */
PetscErrorCode DefaultTransfer(Case *c);
/* given: the mapping `analysis`, or NULL. */
PetscErrorCode DefaultScheme(const YamlNode *given, Case *c);
