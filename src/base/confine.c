/* base/confine.c: vl_confine by two means of Linux: Landlock (files by folder) and seccomp
 * (system calls). Raw system calls; the interface of Landlock is written out here, since the
 * headers of older kernels lack parts of it. */
#include "velo/confine.h"

#include <fcntl.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/text.h"

#if defined(__linux__)

#include <errno.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>

/* ---- Landlock (linux/landlock.h; Documentation/userspace-api/landlock.rst of Linux) ------ */

/* Numbers of system calls, the same on all processors. */
enum { CREATE_RULESET = 444, ADD_RULE = 445, RESTRICT_SELF = 446 };
enum { VERSION_FLAG = 1, RULE_PATH_BENEATH = 1 };
enum {
  FS_EXECUTE = 1 << 0,
  FS_WRITE_FILE = 1 << 1,
  FS_READ_FILE = 1 << 2,
  FS_READ_DIR = 1 << 3,
  FS_REMOVE_FILE = 1 << 5,
  FS_MAKE_DIR = 1 << 7,
  FS_MAKE_REG = 1 << 8,
  FS_ALL = (1 << 13) - 1,
  FS_REFER = 1 << 13,    /* version 2 */
  FS_TRUNCATE = 1 << 14, /* version 3 */
  FS_READ = FS_READ_FILE | FS_READ_DIR,
  FS_WRITE = FS_READ | FS_WRITE_FILE | FS_REMOVE_FILE | FS_MAKE_DIR | FS_MAKE_REG | FS_REFER |
             FS_TRUNCATE,
  FS_OF_FILES = FS_EXECUTE | FS_WRITE_FILE | FS_READ_FILE |
                FS_TRUNCATE /* those that a rule of one file may have */
};

typedef struct Ruleset {
  uint64_t handled; /* what is forbidden unless a rule allows it */
} Ruleset;

typedef struct __attribute__((packed)) PathBeneath {
  uint64_t allowed;
  int32_t folder;
} PathBeneath;

/* A ruleset that is being made. */
typedef struct Rules {
  int ruleset;
  uint64_t handled;
} Rules;

static void allow(const Rules *rules, const char *path, uint64_t access) {
  struct stat info;
  int fd = open(path, O_PATH | O_CLOEXEC);
  if (fd < 0)
    return;
  if (fstat(fd, &info) == 0) {
    if (!S_ISDIR(info.st_mode))
      access &= FS_OF_FILES;
    const PathBeneath rule = {access & rules->handled, fd};
    /* refuses pipes, which are not confined */
    syscall(ADD_RULE, rules->ruleset, RULE_PATH_BENEATH, &rule, 0);
  }
  close(fd);
}

/* What the program itself reads: shared libraries that are loaded late, the time zone, the
 * number of processors, memory in use and its limit. */
static void allow_system(const Rules *rules) {
  static const char *const paths[] = {"/lib",
                                      "/lib64",
                                      "/usr/lib",
                                      "/usr/lib64",
                                      "/usr/local/lib",
                                      "/usr/share/zoneinfo",
                                      "/etc/localtime",
                                      "/etc/ld.so.cache",
                                      "/proc/self",
                                      "/proc/cpuinfo",
                                      "/proc/meminfo",
                                      "/sys/devices/system",
                                      "/sys/fs/cgroup/memory.max",
                                      "/dev/null",
                                      "/dev/urandom"};
  for (size_t i = 0; i < VL_LENGTH(paths); i++)
    allow(rules, paths[i], FS_READ | (vl_text_is(paths[i], "/dev/null") ? FS_WRITE_FILE : 0));
  const char *libraries = getenv("LD_LIBRARY_PATH");
  while (libraries && *libraries) {
    char folder[4096];
    size_t length = strcspn(libraries, ":");
    if (length && length < sizeof folder) {
      memcpy(folder, libraries, length);
      folder[length] = 0;
      allow(rules, folder, FS_READ);
    }
    libraries += length + (libraries[length] == ':');
  }
}

/* Allows writing a file: in its folder, since files are replaced by renaming others. */
static void allow_output(const Rules *rules, const char *path) {
  char target[4096];
  struct stat info;
  if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) {
    allow(rules, path, FS_WRITE);
    return;
  }
  if (!vl_follow_links(path, target, sizeof target))
    return;
  target[strcspn(target, "%")] = 0;
  target[vl_folder_length(target)] = 0;
  allow(rules, *target ? target : ".", FS_WRITE);
}

static uint32_t confine_files(const char *const *read, uint32_t read_count,
                              const char *const *write, uint32_t write_count) {
  long version = syscall(CREATE_RULESET, NULL, (size_t)0, VERSION_FLAG);
  if (version < 1)
    return 0;
  Rules rules = {.handled =
                     FS_ALL | (version >= 2 ? FS_REFER : 0) | (version >= 3 ? FS_TRUNCATE : 0)};
  const Ruleset def = {rules.handled};
  rules.ruleset = (int)syscall(CREATE_RULESET, &def, sizeof def, 0);
  if (rules.ruleset < 0)
    return 0;
  allow_system(&rules);
  for (uint32_t i = 0; i < read_count; i++)
    allow(&rules, read[i], FS_READ);
  for (uint32_t i = 0; i < write_count; i++)
    allow_output(&rules, write[i]);
  bool good = syscall(RESTRICT_SELF, rules.ruleset, 0) == 0;
  close(rules.ruleset);
  return good ? (uint32_t)version : 0;
}

/* ---- seccomp ----------------------------------------------------------------------------- */

#if defined(__x86_64__)
#define NATIVE AUDIT_ARCH_X86_64
#elif defined(__aarch64__) && defined(__AARCH64EL__)
#define NATIVE AUDIT_ARCH_AARCH64
#endif

#if defined(NATIVE)

/* Values in memory order are little-endian here, so the low half of an argument comes first. */
#define LOAD(member) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, member))
#define RETURN(what) BPF_STMT(BPF_RET | BPF_K, what)
#define REFUSE RETURN(SECCOMP_RET_ERRNO | EPERM)
#define REFUSE_CALL(number) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1), REFUSE
enum {
  X32 = 0x40000000,    /* the bit of calls of x86's x32 variant */
  IO_URING_SETUP = 425 /* io_uring opens sockets, too */
};

static bool install(struct sock_filter *program, size_t count) {
  const struct sock_fprog filter = {(unsigned short)count, program};
  return prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter, 0, 0) == 0;
}

static bool forbid_programs(void) {
  struct sock_filter program[] = {
      LOAD(arch),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, NATIVE, 1, 0),
      REFUSE, /* calls of another processor, whose numbers mean other things */
      LOAD(nr),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, X32, 0, 1),
      REFUSE,
      REFUSE_CALL(SYS_execve),
      REFUSE_CALL(SYS_execveat),
      REFUSE_CALL(IO_URING_SETUP),
      RETURN(SECCOMP_RET_ALLOW),
  };
  return install(program, VL_LENGTH(program));
}

/* local: sockets of this machine stay allowed. */
static bool forbid_sockets(bool local) {
  struct sock_filter program[] = {
      LOAD(nr),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 1, 0),
      RETURN(SECCOMP_RET_ALLOW),
      LOAD(args[0]),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, local ? AF_UNIX : UINT32_MAX, 0, 1),
      RETURN(SECCOMP_RET_ALLOW),
      REFUSE,
  };
  return install(program, VL_LENGTH(program));
}

#else

static bool forbid_programs(void) {
  return false;
}

static bool forbid_sockets(VL_UNUSED bool local) {
  return false;
}

#endif

vlConfined vl_confine(const char *const *read, uint32_t read_count, const char *const *write,
                      uint32_t write_count, bool sockets) {
  vlConfined done = {0};
  struct stat info;
  bool local = false;
  for (uint32_t i = 0; i < write_count; i++)
    local |= stat(write[i], &info) == 0 && S_ISSOCK(info.st_mode);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
    return done; /* both means require it */
  done.landlock = confine_files(read, read_count, write, write_count);
  done.files = done.landlock > 0;
  done.programs = forbid_programs();
  done.network = done.programs && !sockets && forbid_sockets(local);
  done.programs |= done.files;
  return done;
}

#else

vlConfined vl_confine(VL_UNUSED const char *const *read, VL_UNUSED uint32_t read_count,
                      VL_UNUSED const char *const *write, VL_UNUSED uint32_t write_count,
                      VL_UNUSED bool sockets) {
  return (vlConfined){0};
}

#endif
