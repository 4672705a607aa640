#include "output/vtk/vtk_dataset.h"

#define MOST_COMPONENTS 4096

/* An object of this file: a link to another one is not followed. */
static hid_t dataset_open(hid_t root, const char *name)
{
  H5L_info_t link;
  if (H5Lget_info(root, name, &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD) return -1;
  return H5Dopen2(root, name, H5P_DEFAULT);
}

/* One piece of the file itself, without filters. */
static PetscBool is_one_piece(hid_t set)
{
  const hid_t plan = H5Dget_create_plist(set);
  if (plan < 0) return PETSC_FALSE;
  const PetscBool plain = H5Pget_layout(plan) == H5D_CONTIGUOUS && H5Pget_external_count(plan) == 0;
  H5Pclose(plan);
  return plain;
}

/* Bytes of one number of a kind that talus or ParaView writes; 0: it is none. */
static PetscInt64 number_bytes(hid_t set)
{
  const hid_t known[] = {H5T_IEEE_F64LE, H5T_IEEE_F32LE, H5T_STD_I64LE, H5T_STD_I32LE, H5T_STD_U8LE};
  const hid_t type = H5Dget_type(set);
  PetscInt64 bytes = 0;
  if (type < 0) return 0;
  for (size_t i = 0; i < sizeof known / sizeof *known; ++i)
    if (H5Tequal(type, known[i]) > 0) bytes = (PetscInt64)H5Tget_size(known[i]);
  H5Tclose(type);
  return bytes;
}

static PetscBool extent(hid_t set, PetscInt64 bytes, hsize_t size[2])
{
  const hid_t space = H5Dget_space(set);
  if (space < 0) return PETSC_FALSE;
  const int dims = H5Sget_simple_extent_ndims(space);
  size[0] = 0, size[1] = 1;
  const PetscBool known = (dims == 1 || dims == 2) && H5Sget_simple_extent_dims(space, size, NULL) == dims;
  H5Sclose(space);
  return known && size[0] <= (hsize_t)bytes && size[1] >= 1 && size[1] <= MOST_COMPONENTS;
}

/* Do its numbers stand in the file? Beyond the end HDF5 would make zeros up. */
static PetscBool is_inside(hid_t set, PetscInt64 bytes, const hsize_t size[2])
{
  const PetscInt64 needed = (PetscInt64)(size[0] * size[1]) * number_bytes(set);
  if (number_bytes(set) == 0) return PETSC_FALSE;
  if (size[0] == 0) return PETSC_TRUE;
  const haddr_t place = H5Dget_offset(set);
  return place != HADDR_UNDEF && place <= (haddr_t)bytes && needed <= bytes - (PetscInt64)place;
}

static PetscInt64 h5_rows(hid_t root, const char *name, PetscInt64 bytes, PetscInt *components)
{
  hsize_t size[2];
  const hid_t set = dataset_open(root, name);
  if (set < 0) return -1;
  const PetscBool good = is_one_piece(set) && extent(set, bytes, size) && is_inside(set, bytes, size);
  H5Dclose(set);
  if (good && components) *components = (PetscInt)size[1];
  return good ? (PetscInt64)size[0] : -1;
}

PetscInt64 dataset_rows(hid_t root, const char *name, PetscInt64 bytes, PetscInt *components)
{
  PetscInt64 rows;
  H5E_BEGIN_TRY { rows = h5_rows(root, name, bytes, components); }
  H5E_END_TRY
  return rows;
}

static herr_t h5_read(hid_t root, const char *name, hid_t type, PetscInt64 n, void *values)
{
  const hid_t set = dataset_open(root, name);
  if (set < 0) return -1;
  const hid_t space = H5Dget_space(set);
  const hssize_t there = space < 0 ? -1 : H5Sget_simple_extent_npoints(space);
  const herr_t status = there == n ? H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) : -1;
  if (space >= 0) H5Sclose(space);
  H5Dclose(set);
  return status;
}

PetscBool dataset_read(hid_t root, const char *name, hid_t type, PetscInt64 n, void *values)
{
  herr_t status;
  H5E_BEGIN_TRY { status = h5_read(root, name, type, n, values); }
  H5E_END_TRY
  return status >= 0;
}

/* A single one: HDF5 would write as many as the file has. */
static PetscBool is_single(hid_t attribute)
{
  const hid_t space = H5Aget_space(attribute);
  if (space < 0) return PETSC_FALSE;
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  H5Sclose(space);
  return n == 1;
}

void dataset_string(hid_t object, const char *name, char *text, size_t n)
{
  text[0] = 0;
  if (H5Aexists(object, name) <= 0) return;
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return;
  const hid_t stored = H5Aget_type(attribute);
  if (is_single(attribute) && stored >= 0 && H5Tget_class(stored) == H5T_STRING && H5Tis_variable_str(stored) == 0) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, n);
    if (H5Aread(attribute, type, text) < 0) text[0] = 0;
    text[n - 1] = 0;
    H5Tclose(type);
  }
  if (stored >= 0) H5Tclose(stored);
  H5Aclose(attribute);
}
