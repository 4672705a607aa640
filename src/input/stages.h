/* A case with stages: the file as each of them changes it. */
#pragma once
#include "case/case.h"
#include "input/yaml/yaml.h"

/* Make the tree of stage k in document->stage, in the order of stages: that of the stage before (of
 * the first: the file's) with its words laid over it, without the list of stages. Every node keeps
 * its place in the file.
 *
 * A mapping is changed key by key, but one that says what it is (law, type) stands for itself. Of
 * `bodies`, `boundary`, `walls` and `interfaces` an entry takes the place of that of its name, or
 * comes behind the others; entries of `bodies`, and those that say no more than whether they are
 * there, change that one key by key. Any other value, such as a list of loads, is replaced. What is
 * repeated word for word is as old as it was. */
PetscErrorCode StageLay(YamlDocument *document, PetscInt k, Diag *diag);
/* What a stage changes of the case before it: those keys that differ, resolved, in full. */
PetscErrorCode StageText(const Case *before, const Case *stage, char **text);
/* When all stages are read: warn of tables over time that stage k repeats word for word, and which are over by then. */
void stage_advise_repeated(const Case *whole, PetscInt k, Diag *diag);
