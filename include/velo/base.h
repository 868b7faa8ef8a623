/** @file
 * velo/base.h: what every other public header uses: results, errors, small value types, and the
 * context, which holds allocator, log, threads and instruction set.
 *
 * Conventions of the whole library
 *   - Functions that can fail return a vlResult. Functions that read files also fill a vlError.
 *   - Description structs ("defs") are made by vl_default_*_def(), which sets their field
 *     `cookie`. A def without this cookie is VL_ERROR_ARGUMENT. Where vl_default_*_def() takes
 *     no arguments (context, load, write, build, develop, render), a null def stands for the
 *     default; otherwise the def is required.
 *   - In defs, 0 is an ordinary value. A double that is not given is VL_UNSET (a NaN). An id
 *     that is not given has index 0.
 *   - Every parameter named `error` may be null.
 *   - Objects (vlX, made by vl_X_create and similar calls) belong to the caller, who destroys
 *     them with vl_X_destroy. vl_X_destroy(NULL) does nothing. Strings and arrays in a def
 *     belong to the caller; the call copies what it keeps.
 *   - Constant objects may be read from any number of threads; an object is changed by one
 *     thread at a time.
 *   - Matrices are row-major double[16] acting on column vectors: p' = M p; `a_from_b` maps b
 *     to a.
 *   - Units: metres (scene units), seconds, radians. The world is right-handed. The camera's x
 *     axis points right, y down, z forward. The first pixel's centre is at (0.5, 0.5); rows are
 *     counted from the top.
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

/** The major version number of these headers (semantic versioning). CMakeLists.txt reads the
 * three numbers from here. */
#define VL_VERSION_MAJOR 0
/** The minor version number. */
#define VL_VERSION_MINOR 1
/** The patch version number. */
#define VL_VERSION_PATCH 0
/** Version of the binary interface (ABI): sizes and fields of structs, values of enumerators,
 * signatures. Before version 1.0 it changes with the minor version, from then on with the major
 * version. The shared library's SONAME contains it (libvelo.so.0.1), and so does each def's
 * cookie: a def of another ABI version is VL_ERROR_ARGUMENT. */
#define VL_ABI_VERSION (VL_VERSION_MAJOR ? VL_VERSION_MAJOR << 8 : VL_VERSION_MINOR)

/** Version and build of the library that is running. All strings are constant. */
typedef struct vlVersion {
  uint32_t major, minor, patch; /**< semantic versioning */
  uint32_t abi; /**< VL_ABI_VERSION of the library; it differs from the headers' if the program
                   was compiled for another version */
  const char *text;             /**< "0.1.0" */
  const char *compiler;         /**< "gcc 12.2.0" */
  const char *instruction_sets; /**< instruction sets that it has code for: "x86-64-v2,
                                   x86-64-v3, x86-64-v4"; "base" on other machines */
} vlVersion;
/** The version of the running library. Never null. Callable from any thread, before any context
 * is created. */
VL_API const vlVersion *vl_version(void);
/** A library that libvelo was built with. */
typedef struct vlLibrary {
  /** "Embree", "3.13.5"; the version comes from the library's headers; "" if they have none */
  const char *name, *version;
} vlLibrary;
/** Library `index`, from 0, of those that libvelo was built with; null past the end. The result
 * is constant. Callable from any thread. */
VL_API const vlLibrary *vl_version_library(uint32_t index);

/** What a fallible call returns. The numbers are stable. */
typedef enum vlResult {
  VL_OK = 0,             /**< success */
  VL_ERROR_ARGUMENT = 1, /**< the call is not valid: a null pointer, a def without cookie, a
                            value out of range */
  VL_ERROR_MEMORY = 2,   /**< an allocation failed; the object is as before the call */
  VL_ERROR_SCENE =
      3, /**< the contents of a file or scene are wrong; the error names the line */
  VL_ERROR_MISSING = 4, /**< a file that the scene names does not exist */
  VL_ERROR_IO = 5,      /**< reading or writing failed: no such folder, disk full, permission */
  VL_ERROR_UNSUPPORTED = 6, /**< valid, but not implemented */
  VL_CANCELLED = 7 /**< the caller's callback stopped the call; finished passes are kept */
} vlResult;

/** The name of a result for messages: "ok", "bad argument" and so on. A constant string, never
 * null. */
VL_API const char *vl_result_name(vlResult result);

/** The description of an error, filled by calls that read or build. Strings that are too long
 * are truncated; all end with a zero byte. */
typedef struct vlError {
  vlResult code;     /**< what the call returned */
  uint32_t line;     /**< line in `file`, from 1; 0: not known */
  uint32_t column;   /**< column in `line`, from 1; 0: not known */
  char file[512];    /**< path; empty: not known */
  char message[512]; /**< one line of text, without file, line and column */
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
typedef enum vlLogLevel {
  VL_LOG_ERROR = 0,
  VL_LOG_WARNING = 1,
  VL_LOG_INFO = 2,
  VL_LOG_DEBUG = 3
} vlLogLevel;

/** A name or value out of a file, as messages show it. */
typedef struct vlShortText {
  char text[64]; /**< UTF-8, zero-terminated */
} vlShortText;
/** The first 12 characters of `text`; "…" follows if there are more. Control characters,
 * invisible characters and bytes that are not UTF-8 become "?". A message must show no more of
 * an untrusted file. Null is "". Any thread. */
VL_API vlShortText vl_short_text(const char *text);

/** Receives a log message. `where` is null or carries file, line and column (its message is not
 * used); its code is MISSING if the message is about a missing file that is done without.
 * Called from any thread, never from two at once. The strings live until the callback returns.
 */
typedef void vlLogFn(void *user, vlLogLevel level, const vlError *where, const char *message);

/** The source of all memory of the library. Both functions are called from any thread, also
 * from several at once. */
typedef struct vlAllocator {
  void *user; /**< passed to both functions */
  /** returns `size` bytes, aligned as by malloc; null on failure */
  void *(*allocate)(void *user, size_t size);
  void (*release)(void *user, void *block); /**< frees what allocate returned */
} vlAllocator;

/** Body of a parallel loop: runs iteration `index` on worker `worker`. Workers are numbered
 * from 0 to the context's number of threads - 1. */
typedef void vlParallelFn(void *loop_user, uint32_t index, uint32_t worker);
/** A parallel loop: calls body(loop_user, index, worker) once for each index in [0, count) and
 * returns when all are done. No two calls of a loop's body with the same worker run at once.
 * Several threads may each run a loop at the same time; the workers of each are numbered from
 * 0. */
typedef void vlParallelForFn(void *user, uint32_t count, vlParallelFn *body, void *loop_user);

/** Instruction sets of the hot loops. All of them give bitwise equal results. AUTO: the widest
 * set that the machine supports. BASE: the lowest set that the library has code for: V2 on
 * x86-64; on other machines it is the only one. V2, V3, V4: levels of x86-64. */
typedef enum vlIsa {
  VL_ISA_AUTO = 0,
  VL_ISA_BASE = 1,
  VL_ISA_V2 = 2,
  VL_ISA_V3 = 3,
  VL_ISA_V4 = 4
} vlIsa;

/** Called about ten times a second by long calls, on the thread that made the call. Return true
 * to stop the call. */
typedef bool vlStopFn(void *user);

/** The environment of all objects: memory, log, worker threads, instruction set. Any thread may
 * use it, also several at once: calls from different threads overlap. Each works on its own
 * thread, and the workers are divided evenly among the calls; calls of a higher priority
 * (vlRenderDef.priority and others) get all workers. */
typedef struct vlContext vlContext;

/** How to create a context. */
typedef struct vlContextDef {
  uint32_t cookie;
  vlAllocator allocator; /**< default: malloc and free */
  vlLogFn *log;          /**< default null: messages are dropped */
  void *log_user;        /**< passed to log */
  uint32_t threads;      /**< number of workers; default: the machine's processors */
  vlIsa isa; /**< default VL_ISA_AUTO; the environment variable VELO_ISA=base|v2|v3|v4 overrides
                AUTO */
  /** runs the parallel loops; null: the built-in pool of threads */
  vlParallelForFn *parallel_for;
  void *parallel_for_user; /**< passed to parallel_for */
  size_t max_memory; /**< limit of the bytes held, including Embree's; calls that need more
                        return VL_ERROR_MEMORY. 0: no limit */
  uint64_t max_texture_pixels; /**< limit of the pixels of one image that a scene names, checked
                                  before decoding; default 2^28. 0: no limit */
  /** Paths of folders. Each file that a scene names must be inside one of them after symbolic
   * links are followed. Files that the caller names (the scene file, cameras, vl_image_read)
   * may be anywhere. Default: no restriction. */
  const char *const *sandbox;
  uint32_t sandbox_count; /**< length of sandbox */
  /** Whether the context remembers the files that it reads, and no writer replaces one of them:
   * such a write is VL_ERROR_ARGUMENT. The same file is found by other names, too (links). A
   * film file may be replaced by the film that continues it. Default false. */
  bool keep_inputs;
  /** Asked while a write waits for the other end of a pipe or socket, about ten times a second,
   * on the writing thread. After it returns true, a write fails that the other end has not
   * taken for a second. Null: writes wait for ever. */
  vlStopFn *interrupted;
  void *interrupted_user; /**< passed to interrupted */
} vlContextDef;

/** The default def. abi: VL_ABI_VERSION of the headers that the program was compiled with. It
 * is stored in the cookie, and vl_context_create refuses a value other than the library's. C
 * and C++ programs call vl_default_context_def() instead. */
VL_API vlContextDef vl_default_context_def_abi(uint32_t abi);
/** The default def for these headers: vlContextDef vl_default_context_def(void). */
#define vl_default_context_def() vl_default_context_def_abi(VL_ABI_VERSION)
/** Creates a context. Errors: ARGUMENT (also a def of another ABI version), MEMORY, MISSING (a
 * folder of the sandbox), UNSUPPORTED (an instruction set that this machine lacks). */
VL_API vlResult vl_context_create(const vlContextDef *def, vlContext **context);
/** Ends the worker threads and frees the context. All objects made from it must be destroyed
 * first. Null is allowed. */
VL_API void vl_context_destroy(vlContext *context);
/** The instruction set in use: V2, V3 or V4 on x86-64, BASE on other machines. */
VL_API vlIsa vl_context_isa(const vlContext *context);
/** The number of workers. */
VL_API uint32_t vl_context_threads(const vlContext *context);
/** A request to stop, which one thread makes and the calls of other threads obey: load, build,
 * render, ground truth. A call stops within one batch of rays, some rows of a file, or one step
 * of a build, and returns VL_CANCELLED. All functions are callable from any thread. */
typedef struct vlCancel vlCancel;
/** Creates a request that is not made yet. ARGUMENT, MEMORY. */
VL_API vlResult vl_cancel_create(vlContext *context, vlCancel **cancel);
/** Must not be called while a call that refers to it runs. Null is allowed. */
VL_API void vl_cancel_destroy(vlCancel *cancel);
/** Makes the request: all calls that refer to it stop, and later ones stop at once. Safe in a
 * signal handler. */
VL_API void vl_cancel_request(vlCancel *cancel);
/** Withdraws the request, so that the object can be used again. To be called when the stopped
 * calls have returned. */
VL_API void vl_cancel_clear(vlCancel *cancel);
/** Whether the request is made. Null: false. */
VL_API bool vl_cancel_requested(const vlCancel *cancel);

/** The state of a load or a build. */
typedef struct vlStep {
  const char *name; /**< what is done now: "reading", "images", "shapes", "lights",
                       "accelerator"; a constant string */
  double fraction;  /**< the estimated share of the call that is done, 0 to 1 */
  double elapsed;   /**< seconds since the call began */
} vlStep;
/** Called at the first step of a load or a build, then about twenty times a second, on the
 * thread that made the call. Return false to stop the call with VL_CANCELLED. */
typedef bool vlStepFn(void *user, const vlStep *step);

/** The number of bytes that the context and Embree hold now. *peak, which may be null, is set
 * to the largest number so far. */
VL_API size_t vl_context_memory(const vlContext *context, size_t *peak);
/** The most bytes of memory that this process can have: the least of the machine's memory and
 * swap, of what its control group allows (Linux, version 2), and of the process's resource
 * limits. *who (may be null) is set to what sets the limit, for messages: "the machine has",
 * "the process may have". UINT64_MAX: not known. Any thread. */
VL_API uint64_t vl_memory_limit(const char **who);

/** Frees data that a function of the library returned to the caller (those that say so). Null
 * is allowed. */
VL_API void vl_release(vlContext *context, void *data);

/** A file that a context read. */
typedef struct vlFileRecord {
  const char *path; /**< the path with which it was opened */
  uint64_t size;    /**< bytes of the file */
  /** MurmurHash3_x64_128 of the file's bytes (of a compressed file: before it is unpacked). It
   * tells whether the file changed; it does not protect against forgery. */
  uint8_t digest[16];
} vlFileRecord;
/** Switches the recording of files on or off; it is off by default. While it is on, the context
 * records each file that it reads: scenes with all files that they name, camera files, images.
 * Reading a path again replaces its record. Callable from any thread. */
VL_API void vl_context_record_files(vlContext *context, bool on);
/** Recorded file `index`, from 0, in the order of paths; null past the end. Valid until the
 * next file is read. */
VL_API const vlFileRecord *vl_context_file(vlContext *context, uint32_t index);

/** Kinds of files that are written. */
typedef enum vlOutputKind {
  VL_OUTPUT_PLAIN = 0, /**< any file but a film */
  VL_OUTPUT_FILM = 1   /**< a film file, which may replace a film file that was read */
} vlOutputKind;
/** Remembers a file that the caller reads itself, as the context does with those that it reads
 * (keep_inputs). kind: VL_OUTPUT_FILM for films. ARGUMENT, IO (there is no such file), MEMORY.
 * Any thread. */
VL_API vlResult vl_note_input(vlContext *context, const char *path, vlOutputKind kind);
/** Checks whether a file of this kind can be written to `path`, without writing: long before
 * the write, or just before it, as all writers do. context may be null. Errors: IO (no such
 * folder, no permission, a folder, a loop of links, a name that is too long), ARGUMENT (the
 * context has read this file: keep_inputs). Any thread. */
VL_API vlResult vl_check_output(vlContext *context, const char *path, vlOutputKind kind,
                                vlError *error);
/** Which file a path means, whether it exists or not: two paths mean the same file if their ids
 * are equal, through links and other spellings. */
typedef struct vlFileId {
  uint64_t device, inode; /**< of the file; of its folder if there is no such file */
  char name[256];         /**< the name in the folder; empty if the file exists */
} vlFileId;
/** The id of the file at `path`. False, and *id is zero: there is no such folder. Any thread.
 */
VL_API bool vl_file_id(const char *path, vlFileId *id);

/** Writes a file whole or not at all: writes a temporary file in the same folder, syncs it and
 * renames it. All writers of the library do this. A symbolic link is followed; a replaced file
 * keeps its permissions. Pipes, sockets (the writer connects to them), devices and
 * "/dev/stdout" (the process' standard output) are written as streams, when the data is
 * complete. Errors: IO, ARGUMENT (vlContextDef.keep_inputs), MEMORY. */
VL_API vlResult vl_write_file(vlContext *context, const char *path, const void *data,
                              size_t size, vlError *error);
/** Removes the temporary files (.velo-PID-N.tmp) that interrupted writers left in the folder of
 * `path`; if `path` is a symbolic link, in the folder of its target. Files of running processes
 * are kept. */
VL_API void vl_remove_leftovers(const char *path);

/** The value of a double in a def that is not given: a NaN with bits of its own. Other NaN are
 * errors. */
#define VL_UNSET ((double)__builtin_nanf("0x5e7"))

#ifdef __cplusplus
}
#endif
#endif
