/* render/again.h: `velo render --again IMAGE.exr`: repeats the command in an image's receipt,
 * if everything that determines the image is unchanged. */
#ifndef APP_RENDER_AGAIN_H
#define APP_RENDER_AGAIN_H

#include "render/receipt.h"
#include "velo/receipt.h"

typedef struct Again {
  const char *path; /* path of the image; null: --again is not given */
  vlContext *context;
  vlReceipt *receipt;
  Arguments arguments; /* the command's arguments and those given beside --again; the receipt
                          owns their texts */
  ReceiptCamera camera;
  bool is_ours; /* the receipt is from this version and commit of velo */
} Again;

/* Reads the image's receipt and replaces *arguments by those of its command. Returns -1 or the
 * exit code. */
int again_open(Again *again, const Arguments **arguments);
/* Checks that the planned render is the one that the receipt describes. with_camera: also
 * compares the camera. Returns -1, or the exit code after naming the differences. */
int again_check(const Again *again, const ReceiptPlan *plan, const Job *job,
                const ReceiptImage *which, bool with_camera);
void again_close(Again *again);

#endif
