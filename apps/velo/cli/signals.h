/* cli/signals.h: SIGINT and SIGTERM. The first one asks the render to stop and to write what is there; a second one
 * ends the program at once. Before the render begins there is nothing to save: then the first one already ends it. */
#ifndef APP_CLI_SIGNALS_H
#define APP_CLI_SIGNALS_H

#include <stdbool.h>

void signals_install(void);
/* From now on a signal is remembered instead of ending the program. */
void signals_remember(void);
/* The remembered signal, 0 if none. */
int signals_pending(void);

#endif
