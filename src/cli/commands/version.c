#include <hdf5.h>
#include <petscsys.h>
#include <stdio.h>
#include <string.h>
#include "cli/cli.h"
#include "talus_version.h"

const CliUsage cli_version_usage = {
  .usage = "talus version",
  .help = "Prints the versions of talus, PETSc, MPI and HDF5.",
  .examples = "talus version\ntalus --version",
};

static void print_mpi(void)
{
  char library[MPI_MAX_LIBRARY_VERSION_STRING];
  int length, major, minor;
  MPI_Get_library_version(library, &length);
  MPI_Get_version(&major, &minor);
  library[strcspn(library, "\n,")] = '\0';
  printf("MPI %d.%d (%s)\n", major, minor, library);
}

PetscErrorCode CliVersion(int argc, char **argv, int *exit_code)
{
  CliArguments arguments;
  PetscBool go_on;
  PetscInt major, minor, subminor;
  unsigned h5[3];

  PetscFunctionBeginUser;
  PetscCall(CliParse(&cli_version_usage, argc, argv, &arguments, &go_on, exit_code));
  if (!go_on || !cli_prints()) PetscFunctionReturn(0);
  PetscCall(PetscGetVersionNumber(&major, &minor, &subminor, NULL));
  H5get_libversion(&h5[0], &h5[1], &h5[2]);
  printf("talus %s\n", TALUS_VERSION);
  printf("PETSc %" PetscInt_FMT ".%" PetscInt_FMT ".%" PetscInt_FMT "\n", major, minor, subminor);
  print_mpi();
  printf("HDF5 %u.%u.%u\n", h5[0], h5[1], h5[2]);
  fflush(stdout);
  PetscFunctionReturn(0);
}
