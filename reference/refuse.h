/* refuse.h: errors that name what this renderer cannot do, and where the file asks for it; and memory. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <velo/velo.h>

/* Always false. what: "a texture with vertex colours"; it "is not part of the reference renderer". */
bool refuse(vlError *error, vlSource source, const char *what);
/* The same for a kind of a family ("textures"), named as in files. */
bool refuse_kind(vlError *error, vlSource source, const char *family, uint32_t kind);

/* An array of `count` elements whose first ones are those of `array`, which may be null. Ends the program without
 * memory. */
void *resize(void *array, size_t count, size_t size);
