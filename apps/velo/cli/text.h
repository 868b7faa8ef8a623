/* cli/text.h: small work on texts. */
#ifndef APP_CLI_TEXT_H
#define APP_CLI_TEXT_H

#include <stdbool.h>

/* In upper case or lower. */
bool text_ends_with(const char *text, const char *suffix);
/* Prints a string of a file to stdout, with ? for control characters. */
void text_print_plain(const char *text);

#endif
