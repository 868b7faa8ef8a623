/* cli/text.h: small work on texts, and numbers in them. */
#ifndef APP_CLI_TEXT_H
#define APP_CLI_TEXT_H

#include <stdbool.h>
#include <stdio.h>

#include "cli/macros.h"

/* In upper case or lower. */
bool text_ends_with(const char *text, const char *suffix);
/* What stands behind the last slash of a path. */
const char *text_file_name(const char *path);
/* Adds to a text in an array of so many bytes; what does not fit is cut. */
void text_add(char *text, size_t size, const char *format, ...) PRINTF(3, 4);
/* Makes a list: "a, b, c". */
void text_list(char *text, size_t size, const char *const *words, int count);
/* Prints a string of a file to stdout, with ? for control characters. */
void text_print_plain(const char *text);
/* Writes a space and a word, quoted so that a POSIX shell reads it as one. No control
 * characters that a terminal would obey are written: the shell gets them of printf. */
void text_shell_word(FILE *out, const char *word);
/* Takes the next word of a list "a,b,c" from *list; a longer one is cut. False: the list is at
 * its end, where *list becomes null. */
bool text_take_word(const char **list, char *word, size_t size);
/* Reads `count` finite numbers separated by commas, and nothing else. */
bool parse_numbers(const char *text, int count, double *values);

#endif
