/* What a case file asks for in vain. */
#pragma once
#include "case/case.h"
#include "input/yaml/yaml.h"

/* One warning that names keys of dynamics, as the top of the file has them, where no stage is dynamic. */
PetscErrorCode TellIdleKeys(const YamlDocument *document, const Case *c, Diag *diag);
