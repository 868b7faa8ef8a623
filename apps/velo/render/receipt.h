/* render/receipt.h: the receipt of a rendered image (velo/receipt.h, docs/receipts.md), its
 * header attribute. */
#ifndef APP_RENDER_RECEIPT_H
#define APP_RENDER_RECEIPT_H

#include "render/job.h"
#include "render/scene_options.h"
#include "velo/receipt.h"

/* The name of the attribute. */
#define RECEIPT_ATTRIBUTE "velo.receipt"
enum { RECEIPT_MAX_WORD = 4096 }; /* longest word of a receipt's command, bytes with the zero */

/* Settings shared by all receipts of a command. */
typedef struct ReceiptPlan {
  const Arguments *arguments;
  const SceneOpening *opening;
  const vlReceipt *again; /* receipt of --again, copied to the new images; null: none */
  bool again_is_ours;     /* that receipt is from this version and commit of velo */
} ReceiptPlan;

/* The image of which a receipt is made, besides its job. */
typedef struct ReceiptImage {
  const char *eye;  /* "left", "right": the file holds this eye alone; null: what --eye says */
  bool is_frame;    /* the image is a frame of a trajectory */
  uint32_t frame;   /* its number */
  uint32_t samples; /* samples per pixel */
  const char *const *outputs; /* for a film: the image files of its render; null: none */
  uint32_t output_count;
} ReceiptImage;

/* Returns whether the option changes the content of an image. Other options choose output
 * paths, speed or messages. */
bool receipt_option_counts(const Arguments *arguments, int option);
vlResult receipt_make(const ReceiptPlan *plan, const Job *job, const ReceiptImage *which,
                      vlReceipt **receipt);
/* Sets the attribute. Does nothing with --no-receipt. */
vlResult receipt_set(const Job *job, const ReceiptImage *which, vlImage *image);
/* Finds the receipt in a header. Returns -1, or the exit code after reporting that there is
 * none or that it is wrong. */
int receipt_of_image(vlContext *context, const vlImage *image, const char *path,
                     vlReceipt **receipt);
/* Prints the version and commit of velo. */
void receipt_print_version(const vlReceipt *receipt);
/* Takes the given scene, or else that of a receipt, whose path must be that of a file. what,
 * owner: the file that holds the receipt, for messages; option: that by which it was given.
 * Returns -1 or the exit code. */
int receipt_take_scene(Arguments *arguments, const Arguments *given, const char *path,
                       const char *what, const char *owner, const char *option);

#endif
