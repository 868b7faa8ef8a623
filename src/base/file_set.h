/* base/file_set.h: a file and those beside it that it names: all of them are replaced, or none.
 * The others are written first, under names that no file has, so the earlier main file and its
 * files are whole until the new main file takes its place, which comes last. */
#ifndef BASE_FILE_SET_H
#define BASE_FILE_SET_H

#include "base/array.h"
#include "base/file.h"

typedef VL_ARRAY(char *) vlPathList;

typedef struct vlFileSet {
  vlContext *context;
  const char *main; /* path; it stays valid */
  char *earlier; /* the bytes of the file that is replaced, zero-terminated; null: there is none
                  */
  size_t earlier_size;
  vlPathList made;    /* paths of the files that have free names */
  vlPathList passed;  /* paths of other files that had the names which were wanted */
  vlPathList written; /* those of `made` that may be there */
  vlPathList folders; /* that were made, the outer ones first */
} vlFileSet;

/* Zero-initialises *set. Whether the earlier file can be read is of no importance. */
void vl_file_set_begin(vlFileSet *set, vlContext *context, const char *main);
/* Chooses the name of a file, relative to the main file's folder: where another file has the
 * name, `name`, an array of `size` bytes, becomes a free one ("room-2.bin"). A file that has
 * these bytes already is taken as it is. MEMORY, IO. */
vlResult vl_file_set_name(vlFileSet *set, char *name, size_t size, const void *data,
                          size_t bytes, vlError *error);
/* Writes a file of that name, and the folders above it, below that of the main file; nothing if
 * it was taken as it is. */
vlResult vl_file_set_write(vlFileSet *set, const char *name, const void *data, size_t bytes,
                           vlError *error);
/* Writes the main file: the last one. */
vlResult vl_file_set_main(vlFileSet *set, const void *data, size_t bytes, vlError *error);
/* After a failure, removes what was written. After success, removes the files of the replaced
 * scene that had the names of the new ones and that it mentions; none that was read. Frees the
 * lists. */
void vl_file_set_end(vlFileSet *set, bool good);

#endif
