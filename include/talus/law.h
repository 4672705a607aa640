/**
 * @file law.h
 * @brief A material law of one's own, from a shared library: `talus run --law NAME=FILE.so`.
 *
 * The library has one function that talus looks for, talus_law(), which returns a #TalusLaw: what
 * the law is called in help, its parameters, its state, and a function that turns an increment of
 * deformation into stress. docs/plugin.md has the tour, docs/example/law a law that works.
 *
 * - **Units** are SI, angles radians. Stress is positive in tension. Symmetric tensors are stored
 *   in the order xx yy zz xy yz zx, tensors row by row.
 * - **What is a function of what.** The same arguments must give the same numbers: a step is tried
 *   several times, in any order, on any rank. Nothing may be kept between calls but in the state.
 * - **Where.** Laws are three-dimensional; plane strain and bodies of revolution embed theirs.
 */
#ifndef TALUS_LAW_H
#define TALUS_LAW_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Rises when a library built for an earlier one would no longer be understood. */
#define TALUS_LAW_VERSION 1

/** Most parameters, and most numbers of a state. */
#define TALUS_LAW_MAX_PARAMETERS 24
#define TALUS_LAW_MAX_STATE 32

/** What an update says. */
typedef enum TalusLawStatus {
  TALUS_LAW_OK = 0,
  /** No answer for this increment: the step is tried again with half of it. */
  TALUS_LAW_NOT_CONVERGED = 1
} TalusLawStatus;

/** What is true of a law, in TalusLaw::flags. */
enum {
  /** Two of the case file's elastic constants belong to it; bulk and shear modulus (Pa) come first
   *  among the numbers that it gets, before its own parameters. */
  TALUS_LAW_ELASTIC = 1,
  TALUS_LAW_TANGENT = 2,   /**< It gives the tangent; otherwise talus takes central differences. */
  TALUS_LAW_SYMMETRIC = 4, /**< The tangent is symmetric. */
  TALUS_LAW_YIELDS = 8     /**< It can lose its stiffness. */
};

/** Bounds that are themselves excluded, in TalusLawParameter::open. */
enum { TALUS_LAW_OPEN_MIN = 1, TALUS_LAW_OPEN_MAX = 2 };

/** A key of the material in the case file. */
typedef struct TalusLawParameter {
  const char *name; /**< Lower-case letters, digits and underscores. NULL ends the list. */
  const char *unit; /**< "Pa", "" if none; "deg": the file has degrees, the law gets radians. */
  const char *help; /**< A few words. */
  double min, max;  /**< Range. */
  double fallback;  /**< What counts where it is not given; NAN: it must be given. */
  unsigned open;    /**< Which bounds are excluded. */
} TalusLawParameter;

/** A number, or a symmetric tensor, that a point keeps; also a field of the output. */
typedef struct TalusLawState {
  const char *name, *unit, *help; /**< As of a parameter. */
  int components;                 /**< 1, or 6: a symmetric tensor (TalusLaw::update alone). */
  double initial[6];              /**< Where nothing has happened. */
} TalusLawState;

/** The step that is tried. */
typedef struct TalusLawStep {
  double time; /**< At its start, s (of the statics' own time in statics). */
  /** Length, s. 0: only the stress of a state is asked, which must not flow. */
  double dt;
} TalusLawStep;

/** A law. Members that are NULL are not there. */
typedef struct TalusLaw {
  int version; /**< #TALUS_LAW_VERSION. */
  size_t size; /**< sizeof(TalusLaw): members that come later are NULL in older libraries. */
  const char *help;
  const TalusLawParameter *parameters; /**< NULL: none. */
  const TalusLawState *state;          /**< Ended by name = NULL. NULL: none. */
  unsigned flags;

  /**
   * Stress from the increment of the deformation gradient. This or update_strain.
   *
   * @param parameters  [bulk, shear,] then those of the list, as it goes
   * @param dF     x at the end of the step by x at its start, 3 x 3
   * @param old    state at the start; must not be touched
   * @param state  to be written: state at the end
   * @param tau    to be written: Kirchhoff stress, J times Cauchy's, Pa (6)
   * @param c      to be written unless NULL: 6 x 6 with L_v tau = c : d, engineering shear; Pa
   */
  int (*update)(const double *parameters, const TalusLawStep *step, const double dF[9], const double *old,
                double *state, double tau[6], double *c);

  /**
   * Stress from the trial elastic strain: talus keeps the elastic left Cauchy-Green tensor and
   * brings it to the end of the step, as if nothing flowed. For laws that are isotropic in it;
   * their own state has scalars alone. Such a law has initial stresses and, if #TALUS_LAW_ELASTIC,
   * the mixed formulation.
   *
   * @param strain   ln of the trial elastic left stretch: tensor components (6)
   * @param tau      to be written: Kirchhoff stress, Pa (6)
   * @param elastic  elastic strain after the flow (6); holds `strain` when called
   * @param D        to be written unless NULL: 6 x 6, d tau / d strain, engineering shear; Pa
   */
  int (*update_strain)(const double *parameters, const TalusLawStep *step, const double strain[6], const double *old,
                       double *state, double tau[6], double elastic[6], double *D);

  /** Elastic energy of a state by undeformed volume, J/m3; for a law of strains `strain` is the
   *  elastic strain, otherwise NULL. Without it energies are nan. */
  double (*energy)(const double *parameters, const double strain[6], const double *state);
  /** Bulk and shear modulus that stand for it (speeds of waves, stiffness of contacts) where the
   *  case file gives no elastic constants. Without it they are read from its tangent at rest. */
  void (*moduli)(const double *parameters, double bulk_and_shear[2]);
  /** What is wrong with parameters that are each in their range, a sentence, or NULL. Angles in
   *  radians, without bulk and shear. */
  const char *(*check)(const double *given);
  /** Only with `update`: a state that carries the Cauchy stress sigma; 0 if there is none. `state`
   *  holds the natural one. Without it bodies of the law cannot begin under a stress. */
  int (*initial_stress)(const double *parameters, const double sigma[6], double *state);
  /** The parameters (without bulk and shear) with the strength over a factor > 0; 0: endless
   *  strength. Without it there is no factor of safety. */
  void (*reduce)(const double *given, double factor, double *reduced);
} TalusLaw;

/** What talus looks for in the library. */
const TalusLaw *talus_law(void);

#ifdef __cplusplus
}
#endif
#endif
