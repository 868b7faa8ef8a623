/* view/browser.h: opens the page in a browser, by xdg-open. The browser gets a file that only
 * its owner can read and that leads to the page: the address has the token, and every user of
 * the machine can see the arguments of a program. */
#ifndef APP_VIEW_BROWSER_H
#define APP_VIEW_BROWSER_H

#include <stdbool.h>
#include <sys/types.h>

/* A process that waits for the address, made before this one is confined (cli/confine.h). {0}:
 * none. */
typedef struct Browser {
  pid_t child;
  int pipe;
} Browser;

/* Makes the process where there is a display; to be called before threads start. */
void browser_prepare(Browser *browser);
/* Lets it open the address. What is {0} stays so. */
void browser_open(Browser *browser, const char *address);
/* Collects the process when it has ended early, and says why, such as that there is no
 * xdg-open. */
void browser_collect(Browser *browser);
/* Ends the process, which removes the file. */
void browser_end(Browser *browser);

#endif
