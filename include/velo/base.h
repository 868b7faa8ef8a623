/** @file
 * velo/base.h: the ground every other public header stands on: results, errors, the context (allocator, log,
 * threads, instruction set), small value types.
 *
 * Conventions of the whole library
 *   - Functions that can fail return a vlResult; those that read files also fill an optional vlError.
 *   - Description structs ("defs") come from vl_default_*_def(); a cookie catches a def that skipped it. A null def
 * stands for the default wherever vl_default_*_def() takes no arguments (context, load, write, build, develop, render);
 * what has a size or kind needs its def.
 *   - In defs, zero is a value. A double that is not given is VL_UNSET (a NaN); an id that is not given has index 0.
 *   - Matrices are row-major double[16] acting on column vectors: p' = M p; `a_from_b` maps b to a.
 *   - Units inside: metres, seconds, radians. World right-handed. Camera x right, y down, z forward. First pixel's
 *     centre at (0.5, 0.5), rows counted from the top.
 *   - The library never exits, aborts or prints. Warnings go to the context's log callback. */
#ifndef VELO_BASE_H
#define VELO_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Stands before every function that the library exports. */
#if defined(__GNUC__)
#define VL_API __attribute__((visibility("default")))
#else
#define VL_API
#endif

/** Version of these headers (semantic versioning). The build reads it here. */
#define VL_VERSION_MAJOR 0
#define VL_VERSION_MINOR 1
#define VL_VERSION_PATCH 0
/** Version of the binary interface: sizes and fields of structs, numbers of enumerators, signatures. It changes with
 * the minor version before 1.0, with the major version from then on; the shared library's SONAME changes with it
 * (libvelo.so.0.1). Each def's cookie carries it: a def of another ABI version is VL_ERROR_ARGUMENT. */
#define VL_ABI_VERSION (VL_VERSION_MAJOR ? VL_VERSION_MAJOR << 8 : VL_VERSION_MINOR)

/** What the library that runs was built as. All strings are constant. */
typedef struct vlVersion {
  uint32_t major, minor, patch;
  uint32_t abi;                 /**< VL_ABI_VERSION; differs from the headers' if a program runs with another library */
  const char *text;             /**< "0.1.0" */
  const char *compiler;         /**< "gcc 12.2.0" */
  const char *instruction_sets; /**< that it has code for: "x86-64-v2, x86-64-v3, x86-64-v4" */
} vlVersion;
/** Never null. May be called from any thread, before there is a context. */
VL_API const vlVersion *vl_version(void);
/** The libraries that libvelo was built with, index from 0; null past the end. version is that of their headers, ""
 * where they name none. Constant. */
typedef struct vlLibrary {
  const char *name, *version; /**< "Embree", "3.13.5" */
} vlLibrary;
VL_API const vlLibrary *vl_version_library(uint32_t index);

/** What a fallible call returns. The numbers are stable. */
typedef enum vlResult {
  VL_OK = 0,
  VL_ERROR_ARGUMENT = 1,    /**< the caller broke the contract: null, def without cookie, value out of range */
  VL_ERROR_MEMORY = 2,      /**< the allocator said no; the object is as before the call */
  VL_ERROR_SCENE = 3,       /**< a file or scene is wrong: the error names the place */
  VL_ERROR_MISSING = 4,     /**< a file that the scene names does not exist */
  VL_ERROR_IO = 5,          /**< reading or writing failed: no such folder, disk full, permission */
  VL_ERROR_UNSUPPORTED = 6, /**< understood as valid, not implemented */
  VL_CANCELLED = 7          /**< the caller's callback asked to stop; what was rendered is kept */
} vlResult;

VL_API const char *vl_result_name(vlResult result);

/** Filled by calls that read or build; all strings are zero-terminated and truncated when too long.
 * file is empty and line 0 when the place is not known; line and column count from 1. */
typedef struct vlError {
  vlResult code;
  uint32_t line;
  uint32_t column;
  char file[512];
  char message[512];
} vlError;

typedef struct vlVec2 {
  float x, y;
} vlVec2;
typedef struct vlVec3 {
  float x, y, z;
} vlVec3;

typedef enum vlLogLevel { VL_LOG_ERROR = 0, VL_LOG_WARNING = 1, VL_LOG_INFO = 2, VL_LOG_DEBUG = 3 } vlLogLevel;

/** A warning or note. `where` is null or carries file, line and column (its message is not used). Called from any
 * thread, never from two at once. */
typedef void vlLogFn(void *user, vlLogLevel level, const vlError *where, const char *message);

/** All memory of the library goes through this. Thread-safe. */
typedef struct vlAllocator {
  void *user;
  void *(*allocate)(void *user, size_t size); /**< aligned as malloc */
  void (*release)(void *user, void *block);
} vlAllocator;

/** Runs body(loop_user, index, worker) for each index in [0, count); worker < worker_count passed to the context. */
typedef void vlParallelFn(void *loop_user, uint32_t index, uint32_t worker);
typedef void vlParallelForFn(void *user, uint32_t count, vlParallelFn *body, void *loop_user);

/** Instruction sets of the hot loops. Every one gives the same bits. */
typedef enum vlIsa { VL_ISA_AUTO = 0, VL_ISA_V2 = 2, VL_ISA_V3 = 3, VL_ISA_V4 = 4 } vlIsa;

/** Asked about ten times a second by calls that take long, on the thread that called: true to give up. */
typedef bool vlStopFn(void *user);

typedef struct vlContext vlContext;

typedef struct vlContextDef {
  uint32_t cookie;
  vlAllocator allocator;
  vlLogFn *log;
  void *log_user;
  uint32_t threads;              /**< workers; default: the machine's */
  vlIsa isa;                     /**< default VL_ISA_AUTO; the environment variable VELO_ISA=v2|v3|v4 overrides AUTO */
  vlParallelForFn *parallel_for; /**< null: the built-in pool */
  void *parallel_for_user;
  size_t max_memory;           /**< bytes that may be held, Embree's included; beyond it VL_ERROR_MEMORY. 0: no limit */
  uint64_t max_texture_pixels; /**< of one image that a scene names, before it is decoded; default 2^28. 0: no limit */
  /** Folders, copied: files that a scene names must lie beneath one of them once symbolic links are followed. Files
   * given by the caller himself (the scene's own, cameras, vl_image_read) may lie anywhere. Default: no restriction. */
  const char *const *sandbox;
  uint32_t sandbox_count;
} vlContextDef;

/** abi: VL_ABI_VERSION of the headers that the program was compiled with, which the cookie carries: vl_context_create
 * refuses a program that was compiled for another ABI version than the library's. C and C++ write
 * vl_default_context_def(). */
VL_API vlContextDef vl_default_context_def_abi(uint32_t abi);
#define vl_default_context_def() vl_default_context_def_abi(VL_ABI_VERSION)
/** Fails with ARGUMENT (a def of another ABI version, too), MEMORY,
 * MISSING (a folder of the sandbox) or UNSUPPORTED (an isa that this machine lacks). */
VL_API vlResult vl_context_create(const vlContextDef *def, vlContext **context);
/** All objects made from the context must be gone. Null is allowed. */
VL_API void vl_context_destroy(vlContext *context);
VL_API vlIsa vl_context_isa(const vlContext *context);
VL_API uint32_t vl_context_threads(const vlContext *context);
/** Bytes held now and at most: what came from the allocator, and Embree's. */
VL_API size_t vl_context_memory(const vlContext *context, size_t *peak);

/** Writes a file whole or not at all, as every writer of the library does: to a temporary beside it, synced, renamed.
 * A symbolic link is followed, permissions of a file that is replaced are kept. IO; error may be null. */
VL_API vlResult vl_write_file(const char *path, const void *data, size_t size, vlError *error);
/** Files are written to a temporary (.velo-PID-N.tmp) in the folder of the target and then renamed. This removes those
 * that writers left which ended in the middle (killed, power lost) from the folder of `path` (of the file that a link
 * leads to); those under way in any living process stay. */
VL_API void vl_remove_leftovers(const char *path);

/** "Not given" for a double in a def. */
#define VL_UNSET ((double)__builtin_nanf(""))

#ifdef __cplusplus
}
#endif
#endif
