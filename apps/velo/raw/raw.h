/* raw/raw.h: declarations shared by the raw commands. */
#ifndef APP_RAW_RAW_H
#define APP_RAW_RAW_H

#include "velo/raw.h"

/* Reads a raw image. Returns -1, or the exit code after reporting the error. */
int raw_load(vlContext *context, const char *path, vlRaw **raw);

#endif
