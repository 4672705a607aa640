#include "output/vtk/slab_layout.h"
#include <hdf5.h>
#include <stdlib.h>
#include <string.h>

/* A scalar string of fixed length: VTK reads no other. */
static herr_t write_string(hid_t object, const char *name, const char *text)
{
  const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
  H5Tset_size(type, strlen(text));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, type, text);
  if (attribute >= 0) status |= H5Aclose(attribute);
  H5Sclose(space);
  H5Tclose(type);
  return status;
}

static herr_t write_numbers(hid_t object, const char *name, hid_t type, hsize_t n, const void *values)
{
  const hid_t space = n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, NULL);
  const hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, type, values);
  if (attribute >= 0) status |= H5Aclose(attribute);
  H5Sclose(space);
  return status;
}

static hid_t memory_type(ColumnType type)
{
  const hid_t types[] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64, H5T_NATIVE_INT32, H5T_NATIVE_UINT8};
  return types[type];
}

static herr_t make_head(hid_t root, const SlabHead *head)
{
  herr_t status = 0;
  for (PetscInt i = 0; i < head->n_attributes; ++i) {
    const SlabAttribute *a = &head->attributes[i];
    status |= a->text ? write_string(root, a->name, a->text)
                      : write_numbers(root, a->name, memory_type(a->type), (hsize_t)a->n, a->values);
  }
  for (int i = 0; head->groups && head->groups[i]; ++i) {
    const hid_t group = H5Gcreate2(root, head->groups[i], H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    status |= group < 0 ? -1 : H5Gclose(group);
  }
  return status;
}

/* A contiguous dataset gets its place now, and no fill values: all of it is written. */
static herr_t place_slab(hid_t root, hid_t creation, const SlabHead *head, Slab *slab)
{
  const hsize_t size[2] = {(hsize_t)slab->total, (hsize_t)slab->components};
  const hid_t space = H5Screate_simple(slab->matrix || slab->components > 1 ? 2 : 1, size, NULL);
  const hid_t set = H5Dcreate2(root, slab->path, memory_type(slab->type), space, H5P_DEFAULT, creation, H5P_DEFAULT);
  herr_t status = set < 0 ? -1 : 0;
  slab->offset = -1;
  if (set >= 0) {
    const haddr_t place = slab->total > 0 ? H5Dget_offset(set) : 0;
    const PetscBool placed = place != HADDR_UNDEF && place >= head->user_block;
    if (slab->total > 0 && placed) slab->offset = (PetscInt64)place;
    if (slab->total > 0 && !placed) status = -1;
    if (slab->unit && slab->unit[0]) status |= write_string(set, "unit", slab->unit);
    if (head->checksums) status |= write_numbers(set, "crc32", H5T_NATIVE_UINT32, 1, &slab->crc);
    status |= H5Dclose(set);
  }
  H5Sclose(space);
  return status;
}

static herr_t fill_file(hid_t file, const SlabHead *head, PetscInt n, Slab *slabs)
{
  const hid_t root = H5Gcreate2(file, head->group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  if (root < 0) return -1;
  const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
  H5Pset_obj_track_times(creation, 0); /* the same state gives the same bytes */
  herr_t status = make_head(root, head);
  for (PetscInt i = 0; i < n; ++i) status |= place_slab(root, creation, head, &slabs[i]);
  H5Pclose(creation);
  return status | H5Gclose(root);
}

/* The memory of HDF5's file in memory is ours: it is there still when that file has been closed. */
static void *resize(void *bytes, size_t n, H5FD_file_image_op_t operation, void *context)
{
  SlabFrame *frame = context;
  void *grown = realloc(bytes, n);
  (void)operation;
  if (grown) frame->bytes = grown, frame->n = n;
  return grown;
}

static void *allocate(size_t n, H5FD_file_image_op_t operation, void *context)
{
  return resize(NULL, n, operation, context);
}

static herr_t keep(void *bytes, H5FD_file_image_op_t operation, void *context)
{
  (void)bytes, (void)operation, (void)context;
  return 0;
}

static void *share_context(void *context) { return context; }

static herr_t release_context(void *context)
{
  (void)context;
  return 0;
}

/* A file in memory with all that is not raw data in one block at its start, so that no memory is
 * spent on the numbers. */
static hid_t create_in_memory(PetscInt n_slabs, size_t user_block, SlabFrame *frame)
{
  H5FD_file_image_callbacks_t callbacks = {.image_malloc = allocate,
                                           .image_realloc = resize,
                                           .image_free = keep,
                                           .udata_copy = share_context,
                                           .udata_free = release_context,
                                           .udata = frame};
  const hsize_t block = 4096 + 1024 * (hsize_t)n_slabs;
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS), creation = H5Pcreate(H5P_FILE_CREATE);
  H5Pset_fapl_core(access, 16384, 0);
  H5Pset_file_image_callbacks(access, &callbacks);
  H5Pset_meta_block_size(access, block);
  if (user_block) H5Pset_userblock(creation, user_block);
  const hid_t file = H5Fcreate("talus-frame", H5F_ACC_TRUNC, creation, access);
  H5Pclose(creation);
  H5Pclose(access);
  return file;
}

static herr_t lay_out(const SlabHead *head, PetscInt n, Slab *slabs, SlabFrame *frame)
{
  hsize_t size = 0;
  const hid_t file = create_in_memory(n, head->user_block, frame);
  if (file < 0) return -1;
  herr_t status = fill_file(file, head, n, slabs);
  status |= H5Fget_filesize(file, &size);
  frame->size = (PetscInt64)size;
  return status | H5Fclose(file);
}

PetscBool slab_layout(const SlabHead *head, PetscInt n, Slab *slabs, SlabFrame *frame)
{
  H5E_auto2_t report;
  void *context;
  memset(frame, 0, sizeof *frame);
  H5Eget_auto2(H5E_DEFAULT, &report, &context);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  const herr_t status = lay_out(head, n, slabs, frame);
  H5Eset_auto2(H5E_DEFAULT, report, context);
  if (frame->n > (size_t)frame->size) frame->n = (size_t)frame->size;
  if (status >= 0 && frame->bytes) return PETSC_TRUE;
  free(frame->bytes);
  frame->bytes = NULL;
  return PETSC_FALSE;
}
