/* cli/signals.h: handles SIGINT, SIGTERM, SIGHUP (closed connection), SIGXCPU (CPU time limit),
 * SIGUSR1 and SIGUSR2 (warnings of batch systems). The first signal asks the render to stop and
 * write its image, the second one aborts the work after that, the third one ends the program.
 * Signals within two seconds count as one, since a closed connection sends several. Before the
 * render begins, the first signal ends the program. A signal that ends the program removes the
 * lock files and the temporary files of the contexts that are watched. A signal that was
 * ignored when the program started (nohup) stays ignored. */
#ifndef APP_CLI_SIGNALS_H
#define APP_CLI_SIGNALS_H

#include "velo/base.h"

void signals_install(void);
/* A context whose files are removed; at most 8 at a time, and others are not watched. */
void signals_watch(vlContext *context);
/* Before the context is destroyed. Null is allowed. */
void signals_forget(vlContext *context);
/* From now on signals are recorded instead of ending the program. */
void signals_remember(void);
/* The first recorded signal; 0: none. */
int signals_pending(void);
/* The exit code after the pending signal: 128 + its number. */
int signals_status(void);
/* The number of recorded signals. */
int signals_count(void);

#endif
