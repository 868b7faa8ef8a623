/* view/private_file.h: files that only their owner can read: $XDG_RUNTIME_DIR has them, or
 * where it is not set a folder of the user in that of temporary files. */
#ifndef APP_VIEW_PRIVATE_FILE_H
#define APP_VIEW_PRIVATE_FILE_H

#include <stdio.h>

#include "view/access.h"

enum { PRIVATE_PATH = 4200 };

/* Makes a new file for a page; path gets where it is. Null: it cannot be made. */
FILE *private_file_make(char path[PRIVATE_PATH]);
/* The token of the user's last `velo view --port PORT`, so that its pages find velo again;
 * where there is none, keeps this one for the next. */
void private_file_token(int port, char token[TOKEN_SIZE]);

#endif
