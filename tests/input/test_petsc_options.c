/* What a case file may say to PETSc: solvers, tolerances, words on the terminal; nothing that
 * writes, draws, connects, loads or starts. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>
#include "input/petsc_options.h"

typedef struct {
  const char *name, *value;
} Option;

static PetscBool allowed(const Option *o)
{
  const PetscOptionKind kind = petsc_option_kind(o->name);
  return kind != PETSC_OPTION_UNKNOWN && !petsc_option_refusal(kind, o->value);
}

static void WhatSolvesIsAllowed(void **state)
{
  static const Option good[] = {{"snes_rtol", "1e-9"},
                                {"snes_type", "newtonls"},
                                {"snes_linesearch_type", "bt"},
                                {"snes_monitor", ""},
                                {"snes_monitor", "true"},
                                {"snes_view", "ascii"},
                                {"snes_view", "::ascii_info_detail"},
                                {"ksp_view_mat", "ascii::ascii_info"},
                                {"ksp_type", "cg"},
                                {"ksp_max_it", "10"},
                                {"ksp_converged_reason", "true"},
                                {"pc_type", "gamg"},
                                {"pc_gamg_threshold", "-0.1,0.2"},
                                {"pc_fieldsplit_0_fields", "0,1"},
                                {"pc_hypre_boomeramg_relax_type_all", "symmetric-SOR/Jacobi"},
                                {"pc_factor_mat_solver_type", "mumps"},
                                {"mat_mumps_icntl_14", "50"},
                                {"mat_mumps_cntl_1", "1e-6"},
                                {"sub_pc_factor_levels", "2"},
                                {"sub_0_pc_type", "ilu"},
                                {"mg_levels_ksp_type", "chebyshev"},
                                {"mg_levels_2_esteig_ksp_max_it", "20"},
                                {"mg_coarse_redundant_pc_type", "lu"},
                                {"fieldsplit_pressure_pc_type", "jacobi"},
                                {"fieldsplit_0_mg_levels_1_ksp_rtol", "1e-3"}};
  (void)state;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(good); ++i)
    if (!allowed(&good[i])) fail_msg("-%s %s is refused", good[i].name, good[i].value);
}

static void WhatActsIsNot(void **state)
{
  static const Option bad[] = {{"snes_monitor", "draw::draw_lg"},
                               {"snes_monitor", "draw"},
                               {"snes_monitor", ":file"},
                               {"snes_monitor", "ascii:file"},
                               {"snes_monitor", "ascii:file:ascii_info"},
                               {"snes_monitor", "::ascii_info:append"},
                               {"snes_monitor", "file"},
                               {"snes_view", ":/any/file"},
                               {"snes_view", "binary"},
                               {"snes_view", "binary:file"},
                               {"snes_view", "hdf5:file"},
                               {"snes_view", "socket"},
                               {"snes_view", "socket:host:5000"},
                               {"snes_view", "saws"},
                               {"snes_view", "matlab:file"},
                               {"snes_view", "vtk:file.vtu"},
                               {"ksp_view_mat", "binary"},
                               {"sub_ksp_view", ":file"},
                               {"mg_levels_1_ksp_monitor", ":file"},
                               {"ksp_gmres_krylov_monitor", "true"},
                               {"ksp_monitor_python", "m.py"},
                               {"snes_monitor_python", "m.py"},
                               {"snes_mf_noise_file", "file"},
                               {"snes_type", "python"},
                               {"snes_python_type", "m.f"},
                               {"ksp_type", "python"},
                               {"pc_type", "python"},
                               {"sub_pc_type", "python"},
                               {"pc_python_type", "m.f"},
                               {"pc_factor_mat_solver_type", "matlab"},
                               {"pc_hypre_type", "euclid"},
                               {"pc_mg_dump_matlab", ""},
                               {"pc_mg_dump_binary", ""},
                               {"mat_mumps_icntl_1", "10"},
                               {"mat_mumps_icntl_2", "10"},
                               {"mat_mumps_icntl_3", "10"},
                               {"mat_mumps_icntl_22", "1"},
                               {"sub_mat_mumps_icntl_22", "1"},
                               {"mat_mumps_ooc_tmpdir", "/"},
                               {"mat_view", "true"},
                               {"ksp_rtol", "$(date)"},
                               {"draw_save", "m$(touch PWNED)"},
                               {"draw_save", "some/dir"},
                               {"draw_type", "image"},
                               {"draw_save_movie", ".gif"},
                               {"display", ":0"},
                               {"viewer_socket_machine", "host"},
                               {"viewer_binary_filename", "file"},
                               {"dll_append", "./lib.so"},
                               {"dll_prepend", "./lib.so"},
                               {"options_file", "file"},
                               {"options_file_yaml", "file"},
                               {"options_monitor", ""},
                               {"prefix_push", "x_"},
                               {"log_view", ":file"},
                               {"log_trace", "file"},
                               {"log_all", "file"},
                               {"info", ":file"},
                               {"history", "file"},
                               {"malloc_dump", ""},
                               {"malloc_view", "file"},
                               {"on_error_attach_debugger", "sh"},
                               {"start_in_debugger", "sh"},
                               {"debugger_nodes", "0"},
                               {"saws_options", ""},
                               {"python", ""},
                               {"mpi_linear_solver_server", ""},
                               {"SNES_RTOL", "1"},
                               {"", "1"},
                               {"sub_", "1"}};
  (void)state;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(bad); ++i)
    if (allowed(&bad[i])) fail_msg("-%s %s is allowed", bad[i].name, bad[i].value);
}

static void NearestNames(void **state)
{
  char best[64];
  (void)state;
  assert_true(petsc_option_nearest("snes_monitr", best));
  assert_string_equal(best, "snes_monitor");
  assert_true(petsc_option_nearest("mg_levels_1_kps_type", best));
  assert_string_equal(best, "ksp_type");
  assert_false(petsc_option_nearest("draw_save", best));
  assert_false(petsc_option_nearest("dll_append", best));
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(WhatSolvesIsAllowed), cmocka_unit_test(WhatActsIsNot),
                                     cmocka_unit_test(NearestNames)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
