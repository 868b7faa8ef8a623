/* render/again.h: `velo render --again IMAGE.exr`: the command in an image's receipt is rendered again, if everything
 * that makes the image is as it was. */
#ifndef APP_RENDER_AGAIN_H
#define APP_RENDER_AGAIN_H

#include "render/receipt.h"

typedef struct Again {
  const char *path; /* of the image; null: the render is not made again */
  vlContext *context;
  vlReceipt *receipt;
  Arguments arguments; /* of the command, with what may be given beside it; texts live in the receipt */
  ReceiptCamera camera;
  bool is_ours; /* made by the version and commit of this program */
} Again;

/* Reads the image's receipt and replaces *arguments by those of its command. Returns -1 or the exit code. */
int again_open(Again *again, const Arguments **arguments);
/* Whether what is about to be rendered is what the receipt describes; with_camera: the camera, too. Returns -1, or the
 * exit code after naming the differences. */
int again_check(const Again *again, const ReceiptPlan *plan, vlContext *context, const Job *job,
                const ReceiptImage *which, bool with_camera);
void again_close(Again *again);

#endif
