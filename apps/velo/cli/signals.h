/* cli/signals.h: handles SIGINT, SIGTERM, SIGHUP (closed connection), SIGXCPU (CPU time limit), SIGUSR1 and SIGUSR2
 * (warnings of batch systems). The first signal
 * asks the render to stop and write its image, the second one aborts the work after that, the third one ends the
 * program. Signals within two seconds count as one, since a closed connection sends several. Before the render begins,
 * the first signal ends the program. A signal that was ignored when the program started (nohup) stays ignored. */
#ifndef APP_CLI_SIGNALS_H
#define APP_CLI_SIGNALS_H

#include <stdbool.h>

void signals_install(void);
/* From now on signals are recorded instead of ending the program. */
void signals_remember(void);
/* The first recorded signal; 0: none. */
int signals_pending(void);
/* The number of recorded signals. */
int signals_count(void);

#endif
