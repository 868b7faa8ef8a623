/* render/shard.h: which part of a film a command renders: samples A to B - 1, or a rectangle of
 * its blocks. */
#ifndef APP_RENDER_SHARD_H
#define APP_RENDER_SHARD_H

#include "render/job.h"
#include "velo/tracer.h"

enum { FILM_BLOCK = 32 }; /* side of a film block in pixels (docs/film-files.md) */

/* Checks --samples, --tiles, --shard, --shard-by. Returns -1 or the exit code. */
int shard_check(const Arguments *arguments);
/* Parses I/N, where I counts from 1. Returns false if the text has another form. */
bool shard_read(const Arguments *arguments, uint32_t *index, uint32_t *count);
/* Whether --shard I/N divides the image by tiles. */
bool shard_is_by_tiles(const Arguments *arguments);
/* The pixels of a rectangle of the film's blocks, x0, y0, x1, y1, that are in the crop. */
void shard_block_window(const uint32_t blocks[4], const uint32_t crop[4], uint32_t window[4]);
/* Restricts the defs of film and render to the part. Returns -1 or the exit code. */
int shard_apply(const Arguments *arguments, vlFilmDef *film, vlRenderDef *render);
/* Whether the tracer follows paths from the lights. */
bool tracer_has_light_paths(vlTracer tracer);
/* Warns of a part by tiles, if the tracer traces light paths for the whole image. */
void shard_warn(const Arguments *arguments, vlTracer tracer);

#endif
