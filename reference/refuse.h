/* refuse.h: errors that name what this renderer cannot do, and where the file asks for it. */
#ifndef REFERENCE_REFUSE_H
#define REFERENCE_REFUSE_H

#include <stdbool.h>
#include <velo/velo.h>

/* Always false. what: "a texture with vertex colours"; why: null: "is not part of the reference renderer". */
bool refuse(vlError *error, vlSource source, const char *what, const char *why);
/* The same for a kind of a family ("textures"), named as in files. */
bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind);
bool refuse_memory(vlError *error);

#endif
