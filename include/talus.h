/**
 * @file talus.h
 * @brief talus, an implicit large-deformation solver for solids and granular matter, as a library.
 *
 * A case file becomes a #TalusCase. It is run as a whole with TalusRunCase(), which writes the same
 * directory of results as `talus run`, or it becomes a #TalusModel that the caller advances step by
 * step and looks into.
 *
 * - **Errors.** Every function that can fail returns an `int`: #TALUS_OK (0) or one of #TalusError;
 *   talus_error_string() says it in words. After an error the results asked for are untouched,
 *   except that handles to be created are NULL. A solver that gives up is no error but an outcome.
 * - **Mistakes in a case** are told with file, line and column. Functions that find them take
 *   `messages`: NULL prints the text to the standard error stream (on the first rank), otherwise
 *   the caller gets it (NULL if there is nothing to say; warnings come with #TALUS_OK) and gives it
 *   back with TalusTextFree().
 * - **Handles** are opaque. What creates one sets the pointer, what destroys one sets it to NULL
 *   and does nothing for NULL.
 * - **Parallel runs.** A case is opened on a communicator, which its runs and models share:
 *   MPI_COMM_WORLD, or a part of it, so that a program can let several cases work side by side or
 *   keep ranks for itself. Functions marked collective must be called by all ranks of the case with
 *   the same arguments; the others work on this rank alone. The first rank is the first of the
 *   case's. Messages of talus cannot meet the program's own. Not thread-safe: one thread at a time.
 * - **Units** are SI. Stress is positive in tension, pressure in compression; symmetric tensors are
 *   stored in the order xx yy zz xy yz zx. Plane strain has unit thickness.
 * - **Numbers in texts** have a point, whatever the program's locale: calls work in the "C" locale of
 *   their thread, as do the functions of the program that they ask, and give the other one back.
 *
 * @example ten_lines.c
 * Runs the case file that its argument names and prints the final value of every measure.
 */
#ifndef TALUS_H
#define TALUS_H

#include <mpi.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What a function returns. */
typedef enum TalusError {
  TALUS_OK = 0, /**< Done. */
  /** An argument is NULL, out of range, or too small to hold the result. */
  TALUS_ERROR_ARGUMENT = 1,
  /** TalusInitialize() is missing, or came twice, or after TalusFinalize(). */
  TALUS_ERROR_STATE = 2,
  /** The case has mistakes, or the run directory cannot be used; the messages say which. */
  TALUS_ERROR_INPUT = 3,
  TALUS_ERROR_UNKNOWN = 4, /**< There is no measure or field of this name. */
  /** A result could not be written; log.txt in the run directory says why. */
  TALUS_ERROR_OUTPUT = 5,
  TALUS_ERROR_MEMORY = 6,   /**< No memory. */
  TALUS_ERROR_INTERNAL = 7, /**< A fault of talus or of a library; PETSc has printed where. */
  /** A model or a run is at work: a function that it asks cannot step, change or close it. */
  TALUS_ERROR_BUSY = 8
} TalusError;

/** How a run ended. */
typedef enum TalusOutcome {
  TALUS_DONE = 0, /**< The end time was reached. */
  /** No convergence, a point left the grid, the disk refused, or a signal came. */
  TALUS_GAVE_UP = 1
} TalusOutcome;

/** What became of a step. */
typedef enum TalusStep {
  TALUS_STEP_ACCEPTED = 0, /**< The model is one step further. */
  /** The case's end time, or a condition of its `analysis.until`, was reached before; nothing happened. */
  TALUS_STEP_AT_END = 1,
  /** No convergence down to the smallest step; the model is as it was. */
  TALUS_STEP_TOO_SMALL = 2,
  TALUS_STEP_POINTS_LOST = 3 /**< Accepted, but points left the grid and the case says to stop. */
} TalusStep;

/** Flags of TalusRunCase(), to be combined with `|`. */
enum TalusRunFlag {
  TALUS_RUN_FORCE = 1, /**< Replace a run that is in the directory already. */
  TALUS_RUN_QUIET = 2, /**< Nothing on the terminal; the log is written all the same. */
  /** Go on with the run in the directory from its newest checkpoint, on any number of ranks. */
  TALUS_RUN_RESUME = 4
};

/** A validated case. */
typedef struct TalusCase TalusCase;
/** A run that has ended: its outcome and the final values of its measures. */
typedef struct TalusRun TalusRun;
/** The state of a case in time. */
typedef struct TalusModel TalusModel;

/**
 * @brief Body force per mass besides gravity, m/s2.
 * @param context  what was handed to TalusModelSetBodyForce()
 * @param X        undeformed position, m; X[2] = 0 in plane strain
 * @param t        time, s
 * @param b        result, zero on entry; b[2] counts for nothing in plane strain
 */
typedef void (*TalusBodyForce)(void *context, const double X[3], double t, double b[3]);

/**
 * @brief The same for all points of this rank at once, m/s2.
 * @param context  what was handed over with the function
 * @param n        number of points; 0 on a rank that has none
 * @param X        undeformed positions, m, n x 3; the third is 0 in plane strain
 * @param x        positions at the start of the step, m, n x 3
 * @param t        time, s
 * @param b        result, n x 3, zero on entry
 */
typedef void (*TalusBodyForces)(void *context, int n, const double *X, const double *x, double t, double *b);

/**
 * @brief A load that varies from place to place: factors for all places of this rank that bear it.
 * @param context  what was handed over with the function
 * @param n        number of places; 0 on a rank that has none
 * @param X        undeformed positions, m, n x 3; the third is 0 in plane strain
 * @param x        positions at the start of the step, m, n x 3 (of a traction on the grid itself: X)
 * @param t        time, s
 * @param f        result, n x 3, ones on entry: factors of the three components of the load's
 *   `value`; a pressure has one number, and takes f[0] of each place
 */
typedef void (*TalusLoadFactors)(void *context, int n, const double *X, const double *x, double t, double *f);

/**
 * @brief Told of every step of a run, on every rank.
 * @param context  what was handed to TalusCaseSetProgress()
 * @param step     number of steps so far
 * @param time     s
 * @param end      end time of the case, s
 * @return 0 to go on; anything else, on any rank, ends the run as a signal does: state and
 *   checkpoint are written, the outcome is #TALUS_GAVE_UP
 */
typedef int (*TalusProgress)(void *context, int step, double time, double end);

/** @name Session
 * @{ */

/**
 * @brief Start MPI and PETSc, unless the program did. Collective over MPI_COMM_WORLD.
 *
 * PETSc's options (`-snes_monitor`, `-log_view`) are read from the command line and PETSC_OPTIONS,
 * not from `petscrc` and `.petscrc`: a working directory must not set them (`-options_file FILE`
 * reads one). A program that calls PetscInitialize itself calls neither this nor TalusFinalize();
 * one that has only called MPI_Init calls both.
 * @param argc  of main, or NULL
 * @param argv  of main, or NULL
 * @return #TALUS_OK, or #TALUS_ERROR_STATE if PETSc runs already or has been finalised
 */
int TalusInitialize(int *argc, char ***argv);

/**
 * @brief End what TalusInitialize() started; all handles must be gone. Collective over
 * MPI_COMM_WORLD.
 * @return #TALUS_OK, or #TALUS_ERROR_STATE if PETSc does not run
 */
int TalusFinalize(void);

/**
 * @brief This process among those of a communicator. Not collective.
 * @param comm  MPI_COMM_WORLD, or what a case was opened on
 * @param rank  result, from 0, or NULL
 * @param size  result, number of ranks, or NULL
 */
int TalusRanks(MPI_Comm comm, int *rank, int *size);

/** @brief Version of the library, "major.minor.patch". Needs no TalusInitialize(). */
const char *TalusVersion(void);

/** @brief A #TalusError in words, never NULL. Needs no TalusInitialize(). */
const char *talus_error_string(int error);

/**
 * @brief Fields of material points and nodes, those of `talus list fields`. Needs no
 * TalusInitialize().
 * @param i           from 0
 * @param name        result, which the library keeps, or NULL
 * @param unit        result, "" if it has none, or NULL
 * @param components  result, numbers a point, 0 if points do not have it, or NULL
 * @return #TALUS_OK, or #TALUS_ERROR_ARGUMENT past the last one
 */
int TalusField(int i, const char **name, const char **unit, int *components);

/** @brief Give back a text that the library handed out; *text becomes NULL. */
void TalusTextFree(char **text);

/** @}
 * @name Case
 * @{ */

/**
 * @brief Read and validate a case file. Collective over `comm`.
 * @param comm      the ranks that will work on it; it must outlive the case
 * @param file      the case file
 * @param n_set     number of entries in set
 * @param set       n_set strings "path.to.key=value" that change the case before it is validated, as
 *                  `--set` does; or NULL
 * @param c         result; NULL after an error
 * @param messages  NULL to print, or result; see above
 * @return #TALUS_OK; #TALUS_ERROR_INPUT: unreadable, or mistakes in it
 */
int TalusCaseOpen(MPI_Comm comm, const char *file, int n_set, const char *const *set, TalusCase **c, char **messages);

/**
 * @brief Validate a case that stands in memory. Collective over `comm`.
 *
 * As TalusCaseOpen(), of a text in place of a file.
 * @param comm      the ranks that will work on it; it must outlive the case
 * @param file      the name that messages give it; files that the case names are looked for from
 *   its folder. It need not be there.
 * @param text      YAML or JSON, the same on all ranks
 * @param n_set     number of entries in set
 * @param set       changes, or NULL
 * @param c         result; NULL after an error
 * @param messages  NULL to print, or result
 * @return #TALUS_OK; #TALUS_ERROR_INPUT: mistakes in it
 */
int TalusCaseParse(MPI_Comm comm, const char *file, const char *text, int n_set, const char *const *set, TalusCase **c,
                   char **messages);

/**
 * @brief The resolved case as YAML: every key with its value, defaults too, as case.yaml of a run
 * has it. Not collective.
 * @param c     the case
 * @param text  result, to be given back with TalusTextFree()
 */
int TalusCaseText(const TalusCase *c, char **text);

/**
 * @brief Body forces besides gravity, of the runs and models of the case made from now on. Not
 * collective, but the same on every rank.
 *
 * When they are asked for, TalusModelSetBodyForce() tells. A run that is resumed needs them again,
 * and is refused without them.
 * @param c        the case
 * @param force    the function, called on every rank for its points, or NULL for none
 * @param context  handed to it
 */
int TalusCaseSetBodyForces(TalusCase *c, TalusBodyForces force, void *context);

/**
 * @brief Let a traction, a pressure or a point force of the case vary from place to place, in the
 * runs and models made from now on. Not collective, but the same on every rank.
 *
 * What the function returns multiplies `value` and `amplitude` of the case file: with a value of 1
 * it is the load itself, in N/m2 of undeformed surface (tractions), in Pa of the present one
 * (pressures), or in N (points). When it is asked, TalusModelSetBodyForce() tells. A run that is
 * resumed needs it again, and is refused without it; a case with stages is refused by
 * TalusRunCase().
 * @param c        the case
 * @param load     "tractions[0]", "pressures[1]", "points[0]": the load's place in `loads`
 * @param factors  the function, or NULL for none
 * @param context  handed to it
 * @return #TALUS_OK, or #TALUS_ERROR_UNKNOWN if the case has no such load
 */
int TalusCaseSetLoadFactors(TalusCase *c, const char *load, TalusLoadFactors factors, void *context);

/**
 * @brief Be told of the steps of TalusRunCase(). Not collective, but the same on every rank.
 * @param c         the case
 * @param progress  the function, or NULL for none
 * @param context   handed to it
 */
int TalusCaseSetProgress(TalusCase *c, TalusProgress progress, void *context);

/** @brief Forget a case; its models must be gone before it. Collective. */
int TalusCaseClose(TalusCase **c);

/**
 * @brief Let the Gmsh script (.geo) of the case run programs and write files, as `--trust` does.
 * Not collective.
 *
 * Without it a script that does so is refused when the model is made. Before TalusModelCreate() and
 * TalusRunCase(), on every rank.
 * @param c  the case
 */
int TalusCaseTrust(TalusCase *c);

/**
 * @brief Number of measures that the case asks for. Not collective.
 * @param c  the case
 * @param n  result
 */
int TalusCaseCountMeasures(const TalusCase *c, int *n);

/**
 * @brief Name and unit of a measure. Not collective.
 * @param c     the case, which owns both strings
 * @param i     0 to the number of measures less one
 * @param name  result, or NULL
 * @param unit  result, such as "m", or NULL
 */
int TalusCaseMeasureName(const TalusCase *c, int i, const char **name, const char **unit);

/** @}
 * @name Running a case as a whole
 * @{ */

/**
 * @brief Run a case from start to end and write its directory of results, as `talus run` does.
 * Collective.
 *
 * SIGINT, SIGTERM, SIGQUIT, SIGHUP, SIGUSR1, SIGUSR2 and SIGXCPU end the run with its state
 * written; a step that has not converged by then is given up. The program's own handlers are back
 * when the function returns.
 *
 * With #TALUS_RUN_RESUME the run that is in `out` goes on, as with `talus run --resume`; c is then
 * the file case.yaml in `out`, opened with TalusCaseOpen() (its `set` may change `checkpoint`,
 * `newton`, `linear`, `petsc`, `analysis.smallest`, `analysis.largest`, `grid.outside` and, in
 * dynamics, `analysis.end`), and #TALUS_RUN_FORCE makes no sense beside it. A run without a
 * checkpoint starts again; one that is complete and has left none is #TALUS_DONE with NaN for its
 * measures.
 * @param c         the case
 * @param out       directory of results, made if it is not there
 * @param flags     of #TalusRunFlag, or 0
 * @param run       result; NULL after an error
 * @param messages  NULL to print, or result; see above
 * @return #TALUS_OK, also if the solver gave up; #TALUS_ERROR_INPUT: mistakes that show only when
 *   the case
 * is set up, or a directory that cannot be used (nothing is written then)
 */
int TalusRunCase(TalusCase *c, const char *out, unsigned flags, TalusRun **run, char **messages);

/** @brief How the run ended. Not collective. */
int TalusRunOutcome(const TalusRun *run, TalusOutcome *outcome);

/**
 * @brief Final value of a measure of the case. Not collective: every rank knows it.
 * @param run    the run
 * @param name   name of the measure in the case
 * @param value  result, in the measure's unit
 * @return #TALUS_OK, or #TALUS_ERROR_UNKNOWN
 */
int TalusRunMeasure(const TalusRun *run, const char *name, double *value);

/** @brief Forget a run; its files stay. Not collective. */
int TalusRunDestroy(TalusRun **run);

/** @}
 * @name Stepping a model
 * @{ */

/**
 * @brief Set a case up at its start time. Nothing is written to disk. Collective.
 * @param c         the case, which must outlive the model
 * @param model     result; NULL after an error
 * @param messages  NULL to print, or result; see above
 * @return #TALUS_OK; #TALUS_ERROR_INPUT: mistakes that show only here, such as a body outside its
 *   grid
 */
int TalusModelCreate(TalusCase *c, TalusModel **model, char **messages);

/** @brief Forget a model. Collective. */
int TalusModelDestroy(TalusModel **model);

/**
 * @brief Add a body force to gravity, from the next step on. Collective.
 *
 * It is called for every material point with the time of the balance that is solved: the middle of the
 * step with the midpoint scheme, the start of each substep in explicit dynamics, else the end of the
 * step. Calls for what a step begins with come besides, and each try of a step has its own. Set before
 * the first step of a dynamic case it also enters the initial acceleration. X and x are not there any
 * more when the function has returned.
 * @param model    the model
 * @param force    the function, called on every rank for its points, or NULL for none
 * @param context  handed to it
 */
int TalusModelSetBodyForce(TalusModel *model, TalusBodyForce force, void *context);

/** @brief The same with a function for all points at once. Collective. */
int TalusModelSetBodyForces(TalusModel *model, TalusBodyForces force, void *context);

/** @brief As TalusCaseSetLoadFactors(), of a model, from its next step on. Collective. */
int TalusModelSetLoadFactors(TalusModel *model, const char *load, TalusLoadFactors factors, void *context);

/**
 * @brief Advance by one step, halved until Newton's method converges. Collective.
 * @param model  the model
 * @param limit  s, the longest step to take, even beyond the end of the case and what its
 *   `analysis.until` asks for; 0: as the case's step control chooses, and up to its end
 * @param step   result; anything but #TALUS_STEP_ACCEPTED ends the loop of most programs
 * @return #TALUS_OK, also where the step failed; #TALUS_ERROR_ARGUMENT for a limit that is negative
 *   or no
 * number
 */
int TalusModelStep(TalusModel *model, double limit, TalusStep *step);

/** @brief Why the last step failed, or which condition of `analysis.until` has ended the case, in
 * words; "" else. The model owns it until its next step. */
const char *TalusModelReason(const TalusModel *model);

/**
 * @brief Time of the present state. Not collective.
 * @param model  the model
 * @param time   result, s, or NULL
 * @param end    result, the end time of the case, s, or NULL
 */
int TalusModelTime(const TalusModel *model, double *time, double *end);

/**
 * @brief Value of a measure of the case now. Collective; every rank gets it.
 * @param model  the model
 * @param name   name of the measure in the case
 * @param value  result, in the measure's unit
 * @return #TALUS_OK, or #TALUS_ERROR_UNKNOWN
 */
int TalusModelMeasure(const TalusModel *model, const char *name, double *value);

/**
 * @brief A field of this rank's material points. Not collective.
 *
 * Fields are those of `talus list fields`, and "position": position, displacement, velocity,
 * acceleration (3 components, also in plane strain), stress (6), deformation_gradient (9, row by
 * row), and mass, volume, density, pressure, mises, energy, id, body, material and others (1). The
 * order of points changes from step to step, and in parallel runs points change ranks; "id" tells
 * them apart.
 * @param model       the model
 * @param field       name of the field
 * @param n           result, number of points of this rank, or NULL
 * @param components  result, numbers a point, or NULL
 * @param buffer      result, n times components numbers, point by point; NULL to ask for the sizes
 *   only
 * @param capacity    how many numbers buffer holds
 * @return #TALUS_OK; #TALUS_ERROR_UNKNOWN; #TALUS_ERROR_ARGUMENT if buffer is too small (n and
 *   components
 * are set, buffer is not)
 */
int TalusModelPoints(const TalusModel *model, const char *field, int *n, int *components, double *buffer,
                     size_t capacity);

/**
 * @brief The model's own array of this rank's points: nothing is copied. Not collective.
 *
 * It is the model's until its next step, after which it must be asked for anew: points come, go and
 * change their order. Arrays, with dim components for vectors (2 in the plane and in axisymmetry):
 * position, displacement (m), velocity (m/s), acceleration (m/s2), mass (kg), deformation_gradient
 * (9 row by row in 3D, else xx xy yx yy zz), kirchhoff_stress (Pa; 6 in 3D, else xx yy zz xy), state
 * (what the law remembers, as many numbers as the largest law of the case needs).
 *
 * What may be written, is followed by TalusModelChanged(): state, with any method; velocity and
 * acceleration, where points carry the motion (mpm; with fem and gmm nodes keep theirs). The
 * model's energies do not count what that gives or takes.
 * @param model       the model
 * @param name        one of the above
 * @param data        result
 * @param n           result, number of points of this rank, or NULL
 * @param components  result, numbers a point (0: the case has no such array), or NULL
 * @param writable    result, may it be written?, or NULL
 * @return #TALUS_OK, or #TALUS_ERROR_UNKNOWN
 */
int TalusModelArray(const TalusModel *model, const char *name, double **data, int *n, int *components, int *writable);

/**
 * @brief Arrays of the points have been written: the nodes learn again from them. Collective.
 *
 * Before the first step of a dynamic case accelerations are found anew, whatever was written. Gradients of the
 * velocity that points carry beside it (`transfer: consistent` with linear functions, explicit dynamics) stay what
 * they are: what a new field turns by or strains within a cell is not in them.
 */
int TalusModelChanged(TalusModel *model);

/** @} */

#ifdef __cplusplus
}
#endif

#endif
