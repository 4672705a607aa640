talus_test(verify/test_verify_reference)
talus_test(verify/test_verify RANKS 1 2 3)
talus_test(verify/test_idle)
if(COMMAND talus_cli)
  talus_cli(verify 0 "8 of 8 rows pass" verify ${PROJECT_SOURCE_DIR}/cases/cantilever --out ${PROJECT_BINARY_DIR}/tests/verify)
  talus_cli(verify_help 0 "usage: talus verify CASE_DIR" verify --help)
  talus_cli(verify_nothing 2 "reference.yaml: error: there is no such file" verify ${PROJECT_SOURCE_DIR}/src)
  talus_cli(verify_only 2 "did you mean 'convergence'" verify ${PROJECT_SOURCE_DIR}/cases/cantilever --only convergance
    --out ${PROJECT_BINARY_DIR}/tests/verify_only)
  talus_cli(verify_no_run 2 "is no run directory" verify ${PROJECT_SOURCE_DIR}/cases/cantilever --run ${PROJECT_SOURCE_DIR}/src)
  talus_cli(verify_run_full 2 "--run writes nothing and runs nothing" verify ${PROJECT_SOURCE_DIR}/cases/cantilever --run x --full)
  talus_cli(run_compared 0 "1 of 1 within what is allowed" run ${PROJECT_SOURCE_DIR}/cases/cantilever/case.yaml
    --out ${PROJECT_BINARY_DIR}/tests/run_compared --force)
endif()
