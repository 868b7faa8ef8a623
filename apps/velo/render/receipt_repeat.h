/* render/receipt_repeat.h: repeats the command in a receipt, for --again and --continue. */
#ifndef APP_RENDER_RECEIPT_REPEAT_H
#define APP_RENDER_RECEIPT_REPEAT_H

#include "cli/options.h"
#include "velo/receipt.h"

/* Parses the words after "velo render". `path` (of the receipt's file) is for messages; the
 * receipt owns the texts of `arguments`. A command with an option that does not change the
 * image is refused, so that a file cannot decide where files are written. Returns -1 or the
 * exit code. */
int receipt_parse_command(const vlReceipt *receipt, const char *path, Arguments *arguments);
/* Replaces the output names and folders by those that were given. */
void receipt_take_names(Arguments *arguments, const Arguments *given);
/* Names the differences of two receipts in `parts` (VL_RECEIPT_*) in one line. False: there are
 * none. */
bool receipt_differences(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                         char *text, size_t size);
/* Compares two receipts in `parts` (VL_RECEIPT_*). Returns -1 if they are equal, or the exit
 * code after naming the differences in one line. */
int receipt_report_differences(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                               const char *path);

#endif
