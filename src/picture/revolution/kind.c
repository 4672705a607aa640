#include <string.h>
#include "case/kinematics/kinematics.h"
#include "input/case_file.h"
#include "input/yaml/yaml.h"
#include "output/directory/run_dir_files.h"
#include "picture/revolution/revolution.h"

PetscErrorCode PlotIsRevolution(const char *run, PetscBool *is)
{
  char path[FILE_PATH], reason[256], *text;
  size_t size;
  YamlDocument *document = NULL;
  Diag *ignored; /* a run may be drawn whatever became of its case */

  PetscFunctionBeginUser;
  *is = PETSC_FALSE;
  PetscCall(PetscSNPrintf(path, sizeof path, "%s/case.yaml", run));
  PetscCall(FileReadEverywhere(PETSC_COMM_SELF, path, &size, &text, reason));
  if (!reason[0]) {
    PetscCall(DiagCreate(&ignored));
    PetscCall(YamlCreate(path, text, size, ignored, &document));
    const YamlNode *word = yaml_find(document->root, "kinematics");
    const Kinematics *kinematics = word && word->kind == YAML_SCALAR ? kinematics_find(word->text) : NULL;
    *is = kinematics && kinematics->hoop;
    PetscCall(YamlDestroy(&document));
    PetscCall(DiagDestroy(&ignored));
  }
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}
