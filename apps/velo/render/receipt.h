/* render/receipt.h: the receipt of a rendered image (velo/receipt.h, docs/receipts.md), its header attribute. */
#ifndef APP_RENDER_RECEIPT_H
#define APP_RENDER_RECEIPT_H

#include "render/job.h"
#include "render/scene_options.h"

/* The name of the attribute. */
#define RECEIPT_ATTRIBUTE "velo.receipt"

/* What the receipts of a command have in common. */
typedef struct ReceiptPlan {
  const Arguments *arguments;
  const SceneOpening *opening;
  const vlReceipt *again; /* of --again: its images have this very receipt; null: none */
  bool again_is_ours;     /* made by the version and commit of this program */
} ReceiptPlan;

/* The image of which a receipt is made, besides its job. */
typedef struct ReceiptImage {
  const char *eye;            /* "left", "right": the file holds this eye alone; null: what --eye says */
  bool is_frame;              /* of a trajectory */
  uint32_t frame;             /* its number */
  uint32_t samples;           /* per pixel */
  const char *const *outputs; /* of a film: the images of its render; null: none */
  uint32_t output_count;
} ReceiptImage;

/* Whether the option changes what an image holds. Others say where it goes, how fast it is made or what is printed. */
bool receipt_option_counts(int option);
vlResult receipt_make(const ReceiptPlan *plan, vlContext *context, const Job *job, const ReceiptImage *which,
                      vlReceipt **receipt);
/* Sets the attribute. Does nothing with --no-receipt. */
vlResult receipt_set(vlContext *context, const Job *job, const ReceiptImage *which, vlImage *image);
/* Finds the receipt in a header. Returns -1, or the exit code after reporting that there is none or that it is wrong.
 */
int receipt_of_image(vlContext *context, const vlImage *image, const char *path, vlReceipt **receipt);

#endif
