/* cli/sha256.h: SHA-256 (FIPS 180-4), as `sha256sum` prints it. */
#ifndef APP_CLI_SHA256_H
#define APP_CLI_SHA256_H

#include <stdbool.h>

enum { SHA256_TEXT = 65 }; /* 64 hexadecimal digits and the zero */

/* Of a file's bytes. False: it cannot be read; errno says why. */
bool sha256_file(const char *path, char text[SHA256_TEXT]);

#endif
