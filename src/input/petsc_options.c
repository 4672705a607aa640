/* The list, and how a name is looked up in it. A '#' stands for a number. */
#include "input/petsc_options.h"
#include <ctype.h>
#include <string.h>
#include "base/diag/diag.h"

/* One value: a word, numbers, true or nothing. */
static const char values[] =
  "snes_anderson_beta snes_anderson_m snes_anderson_restart snes_anderson_restart_it snes_anderson_restart_type "
  "snes_atol snes_check_jacobian_domain_error snes_composite_damping snes_composite_rtol snes_composite_stol "
  "snes_composite_type snes_convergence_estimate snes_convergence_test snes_divergence_tolerance "
  "snes_error_if_not_converged snes_fd snes_force_iteration snes_function_type snes_ksp_ew snes_ksp_ew_alpha "
  "snes_ksp_ew_alpha2 snes_ksp_ew_gamma snes_ksp_ew_rtol0 snes_ksp_ew_rtolmax snes_ksp_ew_threshold "
  "snes_ksp_ew_version snes_lag_jacobian snes_lag_jacobian_persists snes_lag_preconditioner "
  "snes_lag_preconditioner_persists snes_linesearch_alpha snes_linesearch_atol snes_linesearch_damping "
  "snes_linesearch_keeplambda snes_linesearch_ltol snes_linesearch_max_it snes_linesearch_maxstep "
  "snes_linesearch_minlambda snes_linesearch_norms snes_linesearch_order snes_linesearch_precheck_picard "
  "snes_linesearch_precheck_picard_angle snes_linesearch_rtol snes_linesearch_type snes_max_fail snes_max_funcs "
  "snes_max_it snes_max_linear_solve_fail snes_mf snes_mf_operator snes_ncg_type snes_ngmres_approxfunc "
  "snes_ngmres_candidate snes_ngmres_deltaB snes_ngmres_epsilonB snes_ngmres_gammaA snes_ngmres_gammaC "
  "snes_ngmres_m snes_ngmres_restart snes_ngmres_restart_fm_rise snes_ngmres_restart_it snes_ngmres_restart_type "
  "snes_ngmres_select_type snes_ngmres_single_reduction snes_norm_schedule snes_npc_side snes_qn_m "
  "snes_qn_powell_gamma snes_qn_restart_type snes_qn_scale_type snes_qn_type snes_rtol snes_stol snes_test_err "
  "snes_test_jacobian snes_test_jacobian_display snes_test_jacobian_display_threshold snes_tr_delta0 snes_tr_delta1 "
  "snes_tr_delta2 snes_tr_delta3 snes_tr_eta snes_tr_mu snes_tr_sigma snes_trtol snes_type ksp_atol "
  "ksp_bcgsl_cxpoly ksp_bcgsl_ell ksp_bcgsl_mrpoly ksp_bcgsl_pinv ksp_bcgsl_xres ksp_cg_dtype ksp_cg_radius "
  "ksp_cg_single_reduction ksp_chebyshev_eigenvalues ksp_chebyshev_esteig ksp_chebyshev_esteig_noisy "
  "ksp_chebyshev_esteig_steps ksp_check_norm_iteration ksp_compute_eigenvalues ksp_compute_eigenvalues_explicitly "
  "ksp_compute_singularvalues ksp_constant_null_space ksp_converged_maxits ksp_converged_rate "
  "ksp_converged_rate_type ksp_converged_use_initial_residual_norm ksp_converged_use_min_initial_residual_norm "
  "ksp_convergence_test ksp_diagonal_scale ksp_diagonal_scale_fix ksp_divtol ksp_error_if_not_converged "
  "ksp_ew_alpha ksp_ew_alpha2 ksp_ew_gamma ksp_ew_rtol0 ksp_ew_rtolmax ksp_ew_threshold ksp_ew_v4_m1 ksp_ew_v4_m2 "
  "ksp_ew_v4_m3 ksp_ew_v4_m4 ksp_ew_v4_p1 ksp_ew_v4_p2 ksp_ew_v4_p3 ksp_ew_version ksp_fcg_mmax ksp_fcg_nprealloc "
  "ksp_fcg_truncation_type ksp_final_residual ksp_gcr_restart ksp_gmres_breakdown_tolerance "
  "ksp_gmres_cgs_refinement_type ksp_gmres_classicalgramschmidt ksp_gmres_haptol ksp_gmres_modifiedgramschmidt "
  "ksp_gmres_preallocate ksp_gmres_restart ksp_guess_type ksp_initial_guess_nonzero ksp_knoll ksp_lag_norm "
  "ksp_lcd_haptol ksp_lcd_restart ksp_lsqr_compute_standard_error ksp_lsqr_exact_mat_norm ksp_max_it ksp_norm_type "
  "ksp_pc_side ksp_pipefcg_mmax ksp_pipefcg_nprealloc ksp_pipefcg_truncation_type ksp_pipefgmres_shift "
  "ksp_pipegcr_mmax ksp_pipegcr_nprealloc ksp_pipegcr_truncation_type ksp_pipegcr_unroll_w ksp_reuse_preconditioner "
  "ksp_richardson_scale ksp_richardson_self_scale ksp_rtol ksp_test_null_space ksp_type ksp_use_explicittranspose "
  "pc_asm_blocks pc_asm_local_blocks pc_asm_local_type pc_asm_overlap pc_asm_print_subdomains pc_asm_type "
  "pc_bjacobi_blocks pc_bjacobi_local_blocks pc_composite_pcs pc_composite_type pc_deflation_compute_space "
  "pc_deflation_compute_space_size pc_deflation_correction pc_deflation_correction_factor pc_deflation_init_only "
  "pc_deflation_levels pc_deflation_reduction_factor pc_deflation_space_extend pc_eisenstat_no_diagonal_scaling "
  "pc_eisenstat_omega pc_factor_column_pivot pc_factor_diagonal_fill pc_factor_fill pc_factor_in_place "
  "pc_factor_levels pc_factor_mat_ordering_type pc_factor_mat_solver_type pc_factor_nonzeros_along_diagonal "
  "pc_factor_pivot_in_blocks pc_factor_reuse_fill pc_factor_reuse_ordering pc_factor_shift_amount "
  "pc_factor_shift_type pc_factor_zeropivot pc_fieldsplit_#_fields pc_fieldsplit_#_fields_col "
  "pc_fieldsplit_block_size pc_fieldsplit_default pc_fieldsplit_detect_coupling pc_fieldsplit_detect_saddle_point "
  "pc_fieldsplit_diag_use_amat pc_fieldsplit_gkb_delay pc_fieldsplit_gkb_maxit pc_fieldsplit_gkb_monitor "
  "pc_fieldsplit_gkb_nu pc_fieldsplit_gkb_tol pc_fieldsplit_off_diag_use_amat pc_fieldsplit_schur_fact_type "
  "pc_fieldsplit_schur_factorization_type pc_fieldsplit_schur_precondition pc_fieldsplit_schur_scale "
  "pc_fieldsplit_type pc_gamg_agg_nsmooths pc_gamg_aggressive_coarsening pc_gamg_asm_use_agg "
  "pc_gamg_classical_interp_threshold pc_gamg_classical_nsmooths pc_gamg_classical_type pc_gamg_coarse_eq_limit "
  "pc_gamg_coarse_grid_layout_type pc_gamg_cpu_pin_coarse_grids pc_gamg_eigenvalues pc_gamg_process_eq_limit "
  "pc_gamg_rank_reduction_factors pc_gamg_repartition pc_gamg_reuse_interpolation pc_gamg_square_graph "
  "pc_gamg_threshold pc_gamg_threshold_scale pc_gamg_type pc_gamg_use_parallel_coarse_grid_solver "
  "pc_gamg_use_sa_esteig pc_hypre_boomeramg_Adroptol pc_hypre_boomeramg_Adroptype pc_hypre_boomeramg_P_max "
  "pc_hypre_boomeramg_agg_nl pc_hypre_boomeramg_agg_num_paths pc_hypre_boomeramg_coarsen_type "
  "pc_hypre_boomeramg_cycle_type pc_hypre_boomeramg_filterthresholdR pc_hypre_boomeramg_grid_sweeps_all "
  "pc_hypre_boomeramg_grid_sweeps_coarse pc_hypre_boomeramg_grid_sweeps_down pc_hypre_boomeramg_grid_sweeps_up "
  "pc_hypre_boomeramg_interp_refine pc_hypre_boomeramg_interp_type pc_hypre_boomeramg_keeptranspose "
  "pc_hypre_boomeramg_max_coarse_size pc_hypre_boomeramg_max_iter pc_hypre_boomeramg_max_levels "
  "pc_hypre_boomeramg_max_row_sum pc_hypre_boomeramg_measure_type pc_hypre_boomeramg_min_coarse_size "
  "pc_hypre_boomeramg_no_CF pc_hypre_boomeramg_nodal_coarsen pc_hypre_boomeramg_nodal_coarsen_diag "
  "pc_hypre_boomeramg_nodal_relaxation pc_hypre_boomeramg_numfunctions pc_hypre_boomeramg_outer_relax_weight_all "
  "pc_hypre_boomeramg_outer_relax_weight_level pc_hypre_boomeramg_parasails_sym pc_hypre_boomeramg_relax_type_all "
  "pc_hypre_boomeramg_relax_type_coarse pc_hypre_boomeramg_relax_type_down pc_hypre_boomeramg_relax_type_up "
  "pc_hypre_boomeramg_relax_weight_all pc_hypre_boomeramg_relax_weight_level pc_hypre_boomeramg_restriction_type "
  "pc_hypre_boomeramg_smooth_num_levels pc_hypre_boomeramg_smooth_type pc_hypre_boomeramg_strong_threshold "
  "pc_hypre_boomeramg_strongthresholdR pc_hypre_boomeramg_tol pc_hypre_boomeramg_truncfactor "
  "pc_hypre_boomeramg_vec_interp_qmax pc_hypre_boomeramg_vec_interp_smooth pc_hypre_boomeramg_vec_interp_variant "
  "pc_hypre_parasails_filter pc_hypre_parasails_loadbal pc_hypre_parasails_nlevels pc_hypre_parasails_reuse "
  "pc_hypre_parasails_sym pc_hypre_parasails_thresh pc_hypre_pilut_factorrowsize pc_hypre_pilut_maxiter "
  "pc_hypre_pilut_tol pc_hypre_type pc_jacobi_abs pc_jacobi_fixdiagonal pc_jacobi_type pc_lsc_scale_diag "
  "pc_mg_cycle_type pc_mg_distinct_smoothup pc_mg_galerkin pc_mg_levels pc_mg_multiplicative_cycles pc_mg_type "
  "pc_redundant_number pc_sor_backward pc_sor_diagonal_shift pc_sor_forward pc_sor_its pc_sor_lits "
  "pc_sor_local_backward pc_sor_local_forward pc_sor_local_symmetric pc_sor_omega pc_sor_symmetric pc_svd_ess_rank "
  "pc_svd_zero_sing pc_telescope_reduction_factor pc_telescope_subcomm_type pc_telescope_use_coarse_dm pc_type "
  "pc_use_amat mat_cholmod_dbound mat_cholmod_default_nesdis mat_cholmod_factor mat_cholmod_final_asis "
  "mat_cholmod_final_ll mat_cholmod_final_monotonic mat_cholmod_final_pack mat_cholmod_final_resymbol "
  "mat_cholmod_final_super mat_cholmod_grow0 mat_cholmod_grow1 mat_cholmod_grow2 mat_cholmod_maxrank "
  "mat_cholmod_nmethods mat_cholmod_nrelax mat_cholmod_pack mat_cholmod_prefer_upper mat_cholmod_print "
  "mat_cholmod_supernodal_switch mat_cholmod_zrelax mat_coarsen_misk_distance mat_coarsen_type mat_klu_ordering "
  "mat_klu_pivot_tol mat_klu_row_scale mat_klu_use_btf mat_mffd_err mat_mffd_type mat_mumps_cntl_# "
  "mat_mumps_icntl_# mat_mumps_use_omp_threads mat_mumps_view_info mat_ordering_amd_aggressive "
  "mat_ordering_amd_dense mat_schur_complement_ainv_type mat_superlu_colperm mat_superlu_conditionnumber "
  "mat_superlu_diagpivotthresh mat_superlu_dist_3d mat_superlu_dist_c mat_superlu_dist_colperm mat_superlu_dist_d "
  "mat_superlu_dist_equil mat_superlu_dist_fact mat_superlu_dist_iterrefine mat_superlu_dist_parsymbfact "
  "mat_superlu_dist_r mat_superlu_dist_replacetinypivot mat_superlu_dist_rowperm mat_superlu_dist_statprint "
  "mat_superlu_equil mat_superlu_ilu_droprull mat_superlu_ilu_droptol mat_superlu_ilu_fillfactor "
  "mat_superlu_ilu_filltol mat_superlu_ilu_milu mat_superlu_ilu_norm mat_superlu_iterrefine mat_superlu_pivotgrowth "
  "mat_superlu_printstat mat_superlu_replacetinypivot mat_superlu_rowperm mat_superlu_symmetricmode "
  "mat_umfpack_aggressive mat_umfpack_alloc_init mat_umfpack_amd_dense mat_umfpack_dense_col mat_umfpack_dense_row "
  "mat_umfpack_droptol mat_umfpack_fixq mat_umfpack_front_alloc_init mat_umfpack_irstep mat_umfpack_ordering "
  "mat_umfpack_pivot_tolerance mat_umfpack_prl mat_umfpack_scale mat_umfpack_strategy "
  "mat_umfpack_sym_pivot_tolerance";

/* Printed on the terminal. */
static const char views[] =
  "snes_anderson_monitor snes_converged_reason snes_linesearch_monitor snes_linesearch_monitor_solution_update "
  "snes_monitor snes_monitor_field snes_monitor_fields snes_monitor_ksp snes_monitor_range snes_monitor_ratio "
  "snes_monitor_residual snes_monitor_short snes_monitor_solution snes_monitor_solution_update snes_ncg_monitor "
  "snes_ngmres_monitor snes_qn_monitor snes_test_jacobian_view snes_view snes_view_pre snes_view_solution "
  "ksp_converged_reason ksp_lsqr_monitor ksp_monitor ksp_monitor_error ksp_monitor_max ksp_monitor_range "
  "ksp_monitor_short ksp_monitor_singular_value ksp_monitor_solution ksp_monitor_true_residual ksp_view "
  "ksp_view_diagonal_scale ksp_view_eigenvalues_explicit ksp_view_mat ksp_view_mat_explicit ksp_view_pmat "
  "ksp_view_pre ksp_view_preconditioned_operator_explicit ksp_view_rhs ksp_view_solution pc_svd_monitor";

/* Solvers within solvers; '#' is a number, '*' a word. */
static const char *const prefixes[] = {
  "sub_#_",    "sub_",   "fieldsplit_*_", "mg_levels_#_", "mg_levels_", "mg_coarse_", "mg_fine_",
  "inner_",    "upper_", "redundant_",    "telescope_",   "esteig_",    "deflation_", "smoothdown_",
  "smoothup_", "npc_",   "lsc_",          "ksp_",         NULL};

/* MUMPS: units that it prints to, which may be files, and factors on the disk. */
static const char *const apart[] = {"mat_mumps_icntl_1", "mat_mumps_icntl_2", "mat_mumps_icntl_3", "mat_mumps_icntl_22",
                                    NULL};

/* Types that run what stands elsewhere: Python, Matlab, and a preconditioner that reads a file
 * `database`. */
static const char *const foreign[] = {"python", "matlab", "euclid", NULL};

static PetscBool is_among(const char *word, const char *const *list)
{
  while (*list && strcmp(word, *list)) ++list;
  return *list != 0;
}

/* How much of `text` the pattern of n characters takes, 0 if it does not fit. */
static size_t matched(const char *pattern, size_t n, const char *text)
{
  const char *c = text;
  for (size_t i = 0; i < n; ++i) {
    const char *start = c;
    if (pattern[i] == '#')
      while (isdigit((unsigned char)*c)) ++c;
    else if (pattern[i] == '*')
      while (isalnum((unsigned char)*c)) ++c;
    else if (*c == pattern[i]) ++c;
    if (c == start) return 0;
  }
  return (size_t)(c - text);
}

static PetscBool is_listed(const char *list, const char *name)
{
  for (size_t n; *list; list += n + (list[n] == ' ')) {
    n = strcspn(list, " ");
    const size_t length = matched(list, n, name);
    if (length && !name[length]) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* The name without its first prefix, NULL if it has none. */
static const char *without_prefix(const char *name)
{
  for (const char *const *p = prefixes; *p; ++p) {
    const size_t n = matched(*p, strlen(*p), name);
    if (n) return name + n;
  }
  return NULL;
}

PetscOptionKind petsc_option_kind(const char *name)
{
  for (; name; name = without_prefix(name)) {
    if (is_among(name, apart)) return PETSC_OPTION_UNKNOWN;
    if (is_listed(values, name)) return PETSC_OPTION_VALUE;
    if (is_listed(views, name)) return PETSC_OPTION_VIEW;
  }
  return PETSC_OPTION_UNKNOWN;
}

/* PETSc writes a viewer as type:file:format. */
static PetscBool prints_on_terminal(const char *value)
{
  static const char *const plain[] = {"", "true", "false", "yes", "no", "on", "off", "1", "0", "ascii", NULL};
  if (is_among(value, plain)) return PETSC_TRUE;
  if (!strncmp(value, "ascii", 5)) value += 5;
  if (strncmp(value, "::", 2)) return PETSC_FALSE;
  return !value[2 + strspn(value + 2, "abcdefghijklmnopqrstuvwxyz_")];
}

const char *petsc_option_refusal(PetscOptionKind kind, const char *value)
{
  if (kind == PETSC_OPTION_VIEW)
    return prints_on_terminal(value) ? NULL : "what a case file asks to be shown goes to the terminal and nowhere else";
  if (is_among(value, foreign)) return "it would run what stands in other files";
  for (const char *c = value; *c; ++c)
    if (!isalnum((unsigned char)*c) && !strchr("_.,+-/", *c)) return "a number or a word is needed";
  return NULL;
}

/* Let `best` be the nearer one of itself and the words of the list; it may be empty. */
static void keep_nearest(const char *name, const char *list, char best[64])
{
  char word[64];
  for (size_t n; *list; list += n + (list[n] == ' ')) {
    n = strcspn(list, " ");
    (void)snprintf(word, sizeof word, "%.*s", (int)n, list);
    const char *const pair[] = {best[0] ? best : word, word, NULL};
    const char *nearest = diag_nearest(name, pair);
    if (nearest && nearest != best) memcpy(best, word, sizeof word);
  }
}

PetscBool petsc_option_nearest(const char *name, char best[64])
{
  best[0] = 0;
  for (; name && !best[0]; name = without_prefix(name)) {
    keep_nearest(name, values, best);
    keep_nearest(name, views, best);
  }
  return best[0] && !strchr(best, '#');
}
