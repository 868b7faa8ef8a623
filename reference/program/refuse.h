/* refuse.h: errors that name what this renderer cannot do, and where the file asks for it. */
#pragma once
#include <stdbool.h>
#include <velo/velo.h>

/* Always false. what: "a texture with vertex colours"; it "is not part of the reference renderer". */
bool refuse(vlError *error, vlSource source, const char *what);
/* The same for a kind of a family ("textures"), named as in files. */
bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind);
