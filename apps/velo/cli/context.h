/* cli/context.h: creates the context of a command, and names its instruction set. */
#ifndef APP_CLI_CONTEXT_H
#define APP_CLI_CONTEXT_H

#include "cli/options.h"
#include "cli/report.h"

/* Creates a context whose messages are reported by `def->log`. Returns -1 on success. Otherwise
 * it reports the reason (a folder of --sandbox, the environment variable VELO_ISA, memory or
 * threads) and returns the exit code. */
int context_open(const vlContextDef *def, vlContext **context);
/* The def of a command's context: messages are reported, and --threads and --sandbox obeyed. */
vlContextDef context_def(const Arguments *arguments);
/* Opens a context of one thread. */
int context_open_one(vlContext **context);
/* Opens the context that the command of the arguments has. --sandbox confines the program to
 * its folders, the first operand (read) and the folder of the second (written). log: gets the
 * messages, as in vlContextDef. */
int context_open_for(const Arguments *arguments, vlLogFn *log, void *log_user,
                     vlContext **context);
/* Destroys a context that context_open created. Null is allowed. */
void context_close(vlContext *context);
/* The instruction set that the context's kernels use: "x86-64-v3", or "base" on other
 * processors. */
const char *context_isa_name(const vlContext *context);

#endif
