/* Defaults that depend on the whole case: on its laws, its basis and its stages. */
#pragma once
#include "case/case.h"
#include "input/yaml/yaml.h"

/* Of what `given`, the mapping of that name or NULL, has no key for. */
void default_stabilisation(const YamlNode *given, Case *c);
const char *default_transfer(const Case *c);
/* Where the case names none. */
PetscErrorCode DefaultTransfer(Case *c);
PetscErrorCode DefaultScheme(Case *c);
