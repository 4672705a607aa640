/* Laws from shared libraries that the command line names: include/talus/law.h is what their authors
 * see, docs/plugin.md tells it. Each has a slot, and a Law whose functions know their slot. */
#pragma once
#include "base/diag/diag.h"
#include "material/law.h"
#include "material/plugin/umat.h"
#include "talus/law.h"

#define PLUGIN_MOST 8
#define PLUGIN_STEP 2 /* packed parameters begin with time and dt of the step */

typedef struct Plugin {
  char name[64], file[PETSC_MAX_PATH_LEN], spec[PETSC_MAX_PATH_LEN]; /* as after --law or --umat, with a full path */
  TalusLaw user;
  Umat umat;           /* call is NULL unless it is one */
  PetscInt kept;       /* numbers of the state that talus keeps before the law's own */
  PetscInt own, given; /* numbers of the law's own state, parameters of its own */
  Law law;
  LawParameter parameters[TALUS_LAW_MAX_PARAMETERS + 1];
  LawField fields[TALUS_LAW_MAX_STATE + 8];
  /* names that a umat has none for: of PROPS, F, the place, STATEV */
  char words[TALUS_LAW_MAX_PARAMETERS + 9 + 3 + UMAT_MOST_STATEV][16];
} Plugin;

/* One point. parameters: packed; c NULL: not wanted; old, state: the whole state. */
LawStatus plugin_gradient_point(const Plugin *plugin, const PetscReal *parameters, const PetscReal dF[9],
                                const PetscReal *old, PetscReal *state, PetscReal tau[6], PetscReal *c);
LawStatus plugin_strain_point(const Plugin *plugin, const PetscReal *parameters, const PetscReal dF[9],
                              const PetscReal *old, PetscReal *state, PetscReal tau[6], PetscReal *c);
/* b of a law of strains that carries the stress, Cauchy's or Kirchhoff's, without flow of its own state; PETSC_FALSE
 * if there is none. */
PetscBool plugin_strain_stress(const Plugin *plugin, const PetscReal *parameters, PetscBool cauchy,
                               const PetscReal stress[6], PetscReal *state);
/* Logarithmic strain of b. */
void plugin_strain_of(const PetscReal b[6], PetscReal strain[6]);

/* The law whose library has been called and has not come back (plugin_guard.c); NULL: none. */
extern const Plugin *volatile plugin_busy;
/* Once: should a library end the process, that is said, and the exit code is not that of success. */
void plugin_watch(void);
/* Fill in the law of a slot from its library (user or umat, name). */
void plugin_fill(PetscInt slot);
extern Plugin plugins[PLUGIN_MOST];

/* Not collective. Load NAME=FILE.so (`umat`: NAME=FILE.so,NPROPS,NSTATV); what is wrong goes to
 * diag. From then on the law is one of `laws`. */
PetscErrorCode PluginLoad(const char *spec, PetscBool umat, Diag *diag);
/* The words that load them again, in another process: "--law=...", NULL behind the last; *words
 * stays ours. */
const char *const *plugin_words(void);
