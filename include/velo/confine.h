/** @file
 * velo/confine.h: lets the operating system confine the process before it reads files of
 * strangers. The sandbox of a context (vlContextDef.sandbox) checks names; a fault in a library
 * that decodes images can get around it. This is a second wall, outside of the program. */
#ifndef VELO_CONFINE_H
#define VELO_CONFINE_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Which parts of vl_confine this system could do. Where a part is false, nothing changed. */
typedef struct vlConfined {
  bool files;    /**< files can be opened in the given folders only (Landlock, Linux 5.13) */
  bool network;  /**< no new sockets (seccomp, Linux on x86-64 and aarch64) */
  bool programs; /**< no other program can be started (seccomp or Landlock) */
  uint32_t landlock; /**< the kernel's version of Landlock's interface; 0: none */
} vlConfined;

/** Confines the calling thread and the threads that it creates afterwards, so it belongs before
 * vl_context_create. It cannot be undone; a second call can only forbid more. What is forbidden
 * fails with EACCES or EPERM, the process goes on. Files that are open stay usable.
 *
 * read: paths of files and folders. A folder stands for all below it. The system's libraries
 * and its facts about this machine (/proc/self, /sys) stay readable, too. write: paths of files
 * that will be written. Files in their folders and below can be read, written, made, renamed
 * and removed. A path to a pipe or device allows itself only. A name with % (out_%04d.exr)
 * stands for the folder before it. Paths of either list that do not exist are left out.
 * sockets: new sockets stay allowed, for a server.
 *
 * A system without such means is no error: the result says so. Any thread; takes no memory. */
VL_API vlConfined vl_confine(const char *const *read, uint32_t read_count,
                             const char *const *write, uint32_t write_count, bool sockets);

#ifdef __cplusplus
}
#endif

#endif
