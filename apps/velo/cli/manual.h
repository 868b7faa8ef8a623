/* cli/manual.h: manual pages, made from the tables of the commands: `velo help --man`. */
#ifndef APP_CLI_MANUAL_H
#define APP_CLI_MANUAL_H

#include "cli/options.h"

/* Prints the page velo(1), which lists the commands, or the page of one command, such as
 * velo-render(1), in man's format to stdout. SOURCE_DATE_EPOCH in the environment gives the
 * page's date. commands: null ends them. */
void manual_print_program(const Command *const *commands);
void manual_print_command(const Command *command);

#endif
