/* cli/context.h: contexts of commands. */
#ifndef APP_CLI_CONTEXT_H
#define APP_CLI_CONTEXT_H

#include "cli/report.h"

/* Creates a context whose messages are reported by `def->log`. Returns -1, or the exit code after reporting the reason:
 * a folder of --sandbox, the environment variable VELO_ISA, memory or threads. */
int context_open(const vlContextDef *def, vlContext **context);

#endif
