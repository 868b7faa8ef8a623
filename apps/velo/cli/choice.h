/* cli/choice.h: a name that an option accepts, and the value that the name means. */
#ifndef APP_CLI_CHOICE_H
#define APP_CLI_CHOICE_H

typedef struct Choice {
  const char *name; /* null ends the list */
  int value;        /* names with the same value are aliases of the first */
} Choice;

#endif
