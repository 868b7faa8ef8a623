/** @file
 * velo/receipt.h: a receipt describes what makes an image: version, command, files with digests, camera, settings,
 * samples. It is a JSON text (docs/receipts.md) that images and films carry; two of them can be compared. The same
 * image has the same receipt: it holds no time, no host name, no number of threads. */
#ifndef VELO_RECEIPT_H
#define VELO_RECEIPT_H

#include "velo/camera.h"
#include "velo/render.h"
#include "velo/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A receipt. Constant: any thread may read it. Its context must outlive it. */
typedef struct vlReceipt vlReceipt;

/** What a receipt is made of. Pointers are read during the call only; all but defs may be null, and what is null is not
 * in the receipt. */
typedef struct vlReceiptDef {
  uint32_t cookie;
  const char *commit; /**< of the program's source */
  const char *scene;  /**< path of the scene's file; recorded files below its folder have paths relative to it */
  const char *const *command; /**< words of the command line that makes the image, without those that do not determine
                               * it (output, threads, ...) */
  uint32_t command_count;     /**< length of command */
  const char *const *outputs; /**< paths of images to be written, for a film that is continued */
  uint32_t output_count;      /**< length of outputs */
  const vlSceneDefs *defs;    /**< settings and camera; required */
  const vlLoadDef *load;      /**< how the scene was loaded */
  const vlCompleteDef *complete; /**< what was added to it */
  uint32_t samples;              /**< per pixel that the image has; render.spp is the number planned */
  double focus_distance;         /**< where autofocus found it, scene units; unset: as in defs->camera */
} vlReceiptDef;
/** The default def. */
VL_API vlReceiptDef vl_default_receipt_def(void);
/** Makes a receipt. Its files are those that the context recorded (vl_context_record_files). Errors: ARGUMENT, MEMORY.
 */
VL_API vlResult vl_receipt_make(vlContext *context, const vlReceiptDef *def, vlReceipt **receipt, vlError *error);
/** Reads a receipt from `size` bytes of text. Errors: ARGUMENT, MEMORY; SCENE: it is not a receipt; UNSUPPORTED: of a
 * later format version. */
VL_API vlResult vl_receipt_parse(vlContext *context, const char *text, size_t size, vlReceipt **receipt,
                                 vlError *error);
/** The receipt of the image that a film with this receipt has at `samples` per pixel: with these samples in place of
 * its own, also as render.spp and after --spp in the command, and without outputs. The image of a continued or merged
 * film so has the receipt of a render without pause. Errors: ARGUMENT, MEMORY. */
VL_API vlResult vl_receipt_of_image(const vlReceipt *film, uint32_t samples, vlReceipt **receipt, vlError *error);
/** Null is allowed. */
VL_API void vl_receipt_destroy(vlReceipt *receipt);

/** The receipt as JSON: the text of a parsed receipt, byte by byte. Lives as long as the receipt. */
VL_API const char *vl_receipt_text(const vlReceipt *receipt);
/** The path of the scene's file; null: not in the receipt. Lives as long as the receipt, as all its strings. */
VL_API const char *vl_receipt_scene(const vlReceipt *receipt);
/** Word `index` of the command, from 0; null past the end. */
VL_API const char *vl_receipt_command(const vlReceipt *receipt, uint32_t index);
/** Path `index` of the outputs, from 0; null past the end. */
VL_API const char *vl_receipt_output(const vlReceipt *receipt, uint32_t index);
/** Samples per pixel that the image has; *planned (may be null): of the render. */
VL_API uint32_t vl_receipt_samples(const vlReceipt *receipt, uint32_t *planned);
/** The exposure of its development, vlDevelopDef.exposure; 1: it is not in the receipt. */
VL_API float vl_receipt_exposure(const vlReceipt *receipt);
/** Recorded file `index`, from 0; null past the end. *record is filled and returned. */
VL_API const vlFileRecord *vl_receipt_file(const vlReceipt *receipt, uint32_t index, vlFileRecord *record);
/** The version of velo and the commit that the program was built from, both "" where they are not in the receipt. */
VL_API const char *vl_receipt_version(const vlReceipt *receipt, const char **commit);
/** The camera, at the size of its description; every number is exact. *size: width and height of the image, pixels, to
 * which vl_camera_resize fits the camera; crop: as in vlFilmDef; both may be null. Errors: SCENE (wrong contents);
 * UNSUPPORTED: a lens of many elements or an image as aperture, which the receipt describes by digests alone. */
VL_API vlResult vl_receipt_camera(const vlReceipt *receipt, vlCameraDef *camera, uint32_t size[2], uint32_t crop[4],
                                  vlError *error);

/** Parts of a receipt, for vl_receipt_compare. */
enum {
  VL_RECEIPT_VERSION = 1,   /**< velo's version and commit */
  VL_RECEIPT_SEQUENCE = 2,  /**< velo's sample sequence: a difference means other samples */
  VL_RECEIPT_FILES = 4,     /**< scene and assets: size and digest */
  VL_RECEIPT_CAMERA = 8,    /**< the camera */
  VL_RECEIPT_SETTINGS = 16, /**< load, complete, film, build and render but for its spp; Embree's set with fast bits */
  VL_RECEIPT_SAMPLES = 32,  /**< the samples that the image has, and render.spp */
  VL_RECEIPT_DEVELOP = 64,  /**< develop */
  VL_RECEIPT_COMMAND = 128, /**< command and path of the scene */
  VL_RECEIPT_OUTPUTS = 256, /**< outputs */
  VL_RECEIPT_ALL = 511      /**< everything */
};
/** Called for each difference with one line in words: "the file textures/wood.png changed", "spp is 64, was 16",
 * "camera differs: fov is 0.5, was 0.6". Return false to end the comparison. */
typedef bool vlReceiptFn(void *user, const char *difference);
/** Compares a receipt (now) with an earlier one (then) in these parts. Returns the number of differences found; fn may
 * be null. */
VL_API uint32_t vl_receipt_compare(const vlReceipt *then, const vlReceipt *now, uint32_t parts, vlReceiptFn *fn,
                                   void *user);

/** The number of velo's sample sequence. It changes with every release in which the same scene and settings give other
 * samples; films and images of different sequences do not belong together. */
VL_API uint32_t vl_sample_sequence(void);
#ifdef __cplusplus
}
#endif
#endif
