# The Python package, by the Python that has NumPy and h5py (Debian: python3-numpy, python3-h5py).
if(TALUS_PYTHON AND TARGET talus AND TARGET talus_shared AND NOT TALUS_SANITIZE)
  execute_process(COMMAND ${TALUS_PYTHON} -c "import numpy, h5py" RESULT_VARIABLE lacking OUTPUT_QUIET ERROR_QUIET)
  if(lacking)
    message(STATUS "${TALUS_PYTHON} has no numpy or no h5py: the Python package is not tested")
  else()
    set(python_environment ${TALUS_TEST_ENVIRONMENT} PYTHONDONTWRITEBYTECODE=1
      "PYTHONPATH=${PROJECT_SOURCE_DIR}/python:${CMAKE_CURRENT_LIST_DIR}:$ENV{PYTHONPATH}"
      TALUS_LIBRARY=${PROJECT_BINARY_DIR} TALUS_PROGRAM=$<TARGET_FILE:talus>)
    function(talus_python_test name)
      add_test(NAME python/${name} COMMAND ${ARGN})
      set_tests_properties(python/${name} PROPERTIES TIMEOUT 240 SKIP_RETURN_CODE 77 ENVIRONMENT "${python_environment}")
    endfunction()
    foreach(name reading running doctest examples)
      talus_python_test(${name} ${TALUS_PYTHON} -W error ${CMAKE_CURRENT_LIST_DIR}/test_${name}.py)
    endforeach()
    talus_python_test(ranks ${MPIEXEC_EXECUTABLE} --oversubscribe -n 2 ${TALUS_PYTHON} ${CMAKE_CURRENT_LIST_DIR}/test_ranks.py)
    talus_python_test(install sh ${CMAKE_CURRENT_LIST_DIR}/test_install.sh
      ${CMAKE_COMMAND} ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${TALUS_PYTHON})
    set_tests_properties(python/ranks PROPERTIES PROCESSORS 2)
  endif()
endif()
