/* cli/signals.h: SIGINT, SIGTERM, SIGHUP (a connection that drops) and SIGXCPU (a limit of CPU time). The first one
 * asks the render to stop and to write what is there; a second one gives up what still takes time after that; a third
 * one ends the program at once. Signals within two seconds count as one: a dropped connection sends several. Before the
 * render begins there is nothing to save: then the first one already ends it. A signal that was ignored when the
 * program started (nohup) stays ignored. */
#ifndef APP_CLI_SIGNALS_H
#define APP_CLI_SIGNALS_H

#include <stdbool.h>

void signals_install(void);
/* From now on a signal is remembered instead of ending the program. */
void signals_remember(void);
/* The first remembered signal, 0 if none. */
int signals_pending(void);
/* How many were remembered. */
int signals_count(void);

#endif
