/* render/plain_command.h: the command that renders a first image (first_image.h) without
 * denoising. */
#ifndef APP_RENDER_PLAIN_COMMAND_H
#define APP_RENDER_PLAIN_COMMAND_H

#include "cli/options.h"

/* The command line that renders the same image with the usual samples and without denoising,
 * quoted for a shell. False: it does not fit. */
bool plain_command(const Arguments *arguments, char *text, size_t size);

#endif
