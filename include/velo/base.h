/** @file
 * velo/base.h: what every other public header uses: results, errors, the context (allocator, log, threads, instruction
 * set), small value types.
 *
 * Conventions of the whole library
 *   - Functions that can fail return a vlResult; those that read files also fill an optional vlError.
 *   - Description structs ("defs") come from vl_default_*_def(). The field `cookie` marks a def that did; a def without
 *     it is VL_ERROR_ARGUMENT. A null def stands for the default wherever vl_default_*_def() takes no arguments
 *     (context, load, write, build, develop, render); a def with a size or kind is required.
 *   - In defs, zero is a value. A double that is not given is VL_UNSET (a NaN); an id that is not given has index 0.
 *   - A parameter `error` may be null.
 *   - Objects (vlX made by vl_X_create or the like) belong to the caller, who destroys them with vl_X_destroy; null is
 *     allowed there. Strings and arrays in a def are the caller's; the call copies what it keeps.
 *   - Constant objects may be read from any number of threads; an object is changed by one thread at a time.
 *   - Matrices are row-major double[16] acting on column vectors: p' = M p; `a_from_b` maps b to a.
 *   - Units: metres (scene units), seconds, radians. World right-handed. Camera x right, y down, z forward. The first
 *     pixel's centre is at (0.5, 0.5), rows are counted from the top.
 *   - The library never exits, aborts or prints. Warnings go to the context's log callback. */
#ifndef VELO_BASE_H
#define VELO_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Marks every function that the library exports. */
#if defined(__GNUC__)
#define VL_API __attribute__((visibility("default")))
#else
#define VL_API
#endif

/** Version of these headers (semantic versioning): the major number. CMakeLists.txt reads the three numbers here. */
#define VL_VERSION_MAJOR 0
/** The minor number. */
#define VL_VERSION_MINOR 1
/** The patch number. */
#define VL_VERSION_PATCH 0
/** Version of the binary interface: sizes and fields of structs, numbers of enumerators, signatures. It changes with
 * the minor version before 1.0, with the major version from then on; the shared library's SONAME changes with it
 * (libvelo.so.0.1). Each def's cookie carries it: a def of another ABI version is VL_ERROR_ARGUMENT. */
#define VL_ABI_VERSION (VL_VERSION_MAJOR ? VL_VERSION_MAJOR << 8 : VL_VERSION_MINOR)

/** Version and build of the library that is running. All strings are constant. */
typedef struct vlVersion {
  uint32_t major, minor, patch; /**< semantic versioning */
  uint32_t abi;         /**< VL_ABI_VERSION; differs from the headers' if the program runs with another library */
  const char *text;     /**< "0.1.0" */
  const char *compiler; /**< "gcc 12.2.0" */
  const char *instruction_sets; /**< those it has code for: "x86-64-v2, x86-64-v3, x86-64-v4"; elsewhere "base" */
} vlVersion;
/** The version of the running library. Never null. Callable from any thread, before any context is created. */
VL_API const vlVersion *vl_version(void);
/** A library that libvelo was built with. */
typedef struct vlLibrary {
  const char *name, *version; /**< "Embree", "3.13.5"; the version is that of its headers, "" where they have none */
} vlLibrary;
/** The libraries that libvelo was built with, index from 0; null past the end. Constant; any thread. */
VL_API const vlLibrary *vl_version_library(uint32_t index);

/** What a fallible call returns. The numbers are stable. */
typedef enum vlResult {
  VL_OK = 0,                /**< success */
  VL_ERROR_ARGUMENT = 1,    /**< the caller broke the contract: null, def without cookie, value out of range */
  VL_ERROR_MEMORY = 2,      /**< an allocation failed; the object is as before the call */
  VL_ERROR_SCENE = 3,       /**< a file or scene is wrong: the error names the place */
  VL_ERROR_MISSING = 4,     /**< a file that the scene names does not exist */
  VL_ERROR_IO = 5,          /**< reading or writing failed: no such folder, disk full, permission */
  VL_ERROR_UNSUPPORTED = 6, /**< valid, but not implemented */
  VL_CANCELLED = 7          /**< the caller's callback stopped the call; whole passes already rendered are kept */
} vlResult;

/** "ok", "bad argument", ... for messages; a constant string, never null. */
VL_API const char *vl_result_name(vlResult result);

/** Filled by calls that read or build. All strings are zero-terminated, and truncated when too long. */
typedef struct vlError {
  vlResult code;     /**< what the call returned */
  uint32_t line;     /**< in `file`, from 1; 0: not known */
  uint32_t column;   /**< in `line`, from 1; 0: not known */
  char file[512];    /**< path; empty: not known */
  char message[512]; /**< one line, without the place */
} vlError;

/** A pair of numbers. */
typedef struct vlVec2 {
  float x, y; /**< components */
} vlVec2;
/** A point, vector or colour of three numbers. */
typedef struct vlVec3 {
  float x, y, z; /**< components */
} vlVec3;

/** Importance of a log message, most important first. */
typedef enum vlLogLevel { VL_LOG_ERROR = 0, VL_LOG_WARNING = 1, VL_LOG_INFO = 2, VL_LOG_DEBUG = 3 } vlLogLevel;

/** Receives a log message. `where` is null or carries file, line and column (its message is not used). Called from any
 * thread, never from two at once. The strings live until the callback returns. */
typedef void vlLogFn(void *user, vlLogLevel level, const vlError *where, const char *message);

/** The source of all memory of the library. Both functions are called from any thread, also from several at once. */
typedef struct vlAllocator {
  void *user;                                 /**< passed to both functions */
  void *(*allocate)(void *user, size_t size); /**< bytes, aligned as by malloc; null on failure */
  void (*release)(void *user, void *block);   /**< frees what allocate returned */
} vlAllocator;

/** Body of a parallel loop: runs iteration `index` on worker `worker`, which is less than the context's threads. */
typedef void vlParallelFn(void *loop_user, uint32_t index, uint32_t worker);
/** A parallel loop: calls body(loop_user, index, worker) once for each index in [0, count) and returns when all are
 * done. No two calls with the same worker run at once. */
typedef void vlParallelForFn(void *user, uint32_t count, vlParallelFn *body, void *loop_user);

/** Instruction sets of the hot loops. Every one gives the same bits. AUTO: the widest that the machine has. BASE: the
 * lowest that the library has, everywhere: V2 on x86-64, the only one on other machines. V2, V3, V4: levels of x86-64.
 */
typedef enum vlIsa { VL_ISA_AUTO = 0, VL_ISA_BASE = 1, VL_ISA_V2 = 2, VL_ISA_V3 = 3, VL_ISA_V4 = 4 } vlIsa;

/** Called about ten times a second by long calls, on the thread that made the call. Return true to stop the call. */
typedef bool vlStopFn(void *user);

/** The environment of all objects: memory, log, worker threads, instruction set. Any thread may use it. */
typedef struct vlContext vlContext;

/** How to create a context. */
typedef struct vlContextDef {
  uint32_t cookie;
  vlAllocator allocator; /**< default: malloc and free */
  vlLogFn *log;          /**< default null: messages are dropped */
  void *log_user;        /**< passed to log */
  uint32_t threads;      /**< number of workers; default: the machine's processors */
  vlIsa isa;             /**< default VL_ISA_AUTO; the environment variable VELO_ISA=base|v2|v3|v4 overrides AUTO */
  vlParallelForFn *parallel_for; /**< runs the parallel loops; null: the built-in pool of threads */
  void *parallel_for_user;       /**< passed to parallel_for */
  size_t max_memory; /**< bytes that may be held, Embree's included; beyond it VL_ERROR_MEMORY. 0: no limit */
  uint64_t
      max_texture_pixels; /**< of one image that a scene names, checked before decoding; default 2^28. 0: no limit */
  /** Folders: files that a scene names must lie beneath one of them once symbolic links are followed. Files that the
   * caller names (the scene's own, cameras, vl_image_read) may lie anywhere. Default: no restriction. */
  const char *const *sandbox;
  uint32_t sandbox_count; /**< length of sandbox */
} vlContextDef;

/** The default def. abi: VL_ABI_VERSION of the headers that the program was compiled with; the cookie carries it, and
 * vl_context_create refuses another one than the library's. C and C++ write vl_default_context_def(). */
VL_API vlContextDef vl_default_context_def_abi(uint32_t abi);
/** The default def for these headers: vlContextDef vl_default_context_def(void). */
#define vl_default_context_def() vl_default_context_def_abi(VL_ABI_VERSION)
/** Creates a context. Errors: ARGUMENT (also a def of another ABI version), MEMORY, MISSING (a folder of the sandbox),
 * UNSUPPORTED (an instruction set that this machine lacks). */
VL_API vlResult vl_context_create(const vlContextDef *def, vlContext **context);
/** Ends the workers and frees the context. All objects made from it must be destroyed before. Null is allowed. */
VL_API void vl_context_destroy(vlContext *context);
/** The set in use: V2, V3 or V4 on x86-64, BASE on other machines. */
VL_API vlIsa vl_context_isa(const vlContext *context);
/** The number of workers. */
VL_API uint32_t vl_context_threads(const vlContext *context);
/** Bytes held now, from the allocator and by Embree; *peak: the most so far (may be null). */
VL_API size_t vl_context_memory(const vlContext *context, size_t *peak);

/** A file that a context read. */
typedef struct vlFileRecord {
  const char *path; /**< as it was opened */
  uint64_t size;    /**< bytes of the file */
  /** MurmurHash3_x64_128 of these bytes, of a compressed file before it is unpacked: tells whether a file changed, and
   * is no protection against forgery. */
  uint8_t digest[16];
} vlFileRecord;
/** From now on records the files that are read (on), or does not (off, the default): scenes with all that they name,
 * camera files, images. A path that is read again replaces its record. Any thread. */
VL_API void vl_context_record_files(vlContext *context, bool on);
/** The recorded files, by path, index from 0; null past the end. Lives until the next file is read. */
VL_API const vlFileRecord *vl_context_file(vlContext *context, uint32_t index);

/** Writes a file whole or not at all, as every writer of the library does: to a temporary file in the same folder,
 * synced, renamed. A symbolic link is followed; a replaced file keeps its permissions. Errors: IO. */
VL_API vlResult vl_write_file(const char *path, const void *data, size_t size, vlError *error);
/** Removes temporary files (.velo-PID-N.tmp) of interrupted writers (killed, power lost) from the folder of `path` (of
 * the file that a link leads to). Those of living processes stay. */
VL_API void vl_remove_leftovers(const char *path);

/** "Not given" for a double in a def. */
#define VL_UNSET ((double)__builtin_nanf(""))

#ifdef __cplusplus
}
#endif
#endif
