/* cli/confine.h: --sandbox: confines the program by means of the operating system, too. */
#ifndef APP_CLI_CONFINE_H
#define APP_CLI_CONFINE_H

#include "cli/options.h"

enum { CONFINE_MAX_PATHS = 2 * MAX_TEXTS + MAX_OPTIONS };

/* What a command may open besides the folders of --sandbox. */
typedef struct Confine {
  /* paths; null ones are left out */
  const char *read[CONFINE_MAX_PATHS], *write[CONFINE_MAX_PATHS];
  uint32_t read_count, write_count;
  char folders[8][4096]; /* of files that are read with others beside them */
  uint32_t folder_count;
  bool sockets; /* it opens a port later */
  bool listens; /* a port is open already */
} Confine;

void confine_read(Confine *confine, const char *path);
/* Files beside this one are read, too. */
void confine_read_folder(Confine *confine, const char *path);
void confine_write(Confine *confine, const char *path);
/* Confines the program if --sandbox is given, and notes what was possible. To be called before
 * threads start. */
void confine_apply(Confine *confine, const Arguments *arguments);

#endif
