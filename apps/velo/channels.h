/* channels.h: ground truth beside the picture: which channels are wanted, their pass, and the file that says what the
 * ids stand for. */
#ifndef APP_CHANNELS_H
#define APP_CHANNELS_H

#include "job.h"

/* "Z,P,id.object" or "all" to bits of vlChannel. -1, or the exit code when all has been said. */
int channels_read(const char *list, uint32_t *channels);
/* Writes PATH.ids.json: type, name, material and place in its file of each id that the pictures hold. ids may be null:
 * nothing is written. Returns STATUS_OK or the exit code. */
int channels_write_ids(const vlWorld *world, const vlImage *ids, const char *path);

#endif
