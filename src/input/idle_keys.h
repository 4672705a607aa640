/* What a case file asks for in vain. */
#pragma once
#include "case/case.h"
#include "input/yaml/yaml.h"

/* A warning for each key that has no effect in this case, in any of its stages that have the key, unless it says what
 * is so anyway. The document is laid for all stages. */
PetscErrorCode TellIdleKeys(const YamlDocument *document, const Case *c, Diag *diag);
