/** @file
 * velo/receipt.h: a receipt describes what makes an image: version, command, files with
 * digests, camera, settings, samples. It is a JSON text (docs/receipts.md), stored in images
 * and films. Two receipts can be compared. The same image has the same receipt: a receipt holds
 * no time, no host name and no number of threads. */
#ifndef VELO_RECEIPT_H
#define VELO_RECEIPT_H

#include "velo/camera.h"
#include "velo/load.h"
#include "velo/own.h"
#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A receipt. It never changes, and any thread may read it. Its context must outlive it. */
typedef struct vlReceipt vlReceipt;

/** What a receipt is made from. Pointers are read during the call only. All but defs may be
 * null; the receipt then lacks that part. */
typedef struct vlReceiptDef {
  uint32_t cookie;
  const char *commit; /**< git commit of the program's source */
  const char *scene;  /**< path of the scene's file; paths of recorded files below its folder
                         become relative to it */
  /** words of the command line that makes the image, without options that do not affect the
   * pixels (outputs, threads, ...) */
  const char *const *command;
  uint32_t command_count;     /**< length of command */
  const char *const *outputs; /**< paths of the images that a complete film is written to; for
                                 receipts of films */
  uint32_t output_count;      /**< length of outputs */
  const vlSceneDefs *defs;    /**< settings and camera; required */
  const vlLoadDef *load;      /**< how the scene was loaded */
  const vlCompleteDef *complete; /**< what was added to the scene: camera, lights
                                    (vl_scene_completed) */
  uint32_t samples; /**< samples per pixel that the image has; defs->render.spp is the planned
                       number */
  double focus_distance; /**< scene units, as found by autofocus; VL_UNSET (default): that of
                            defs->camera */
} vlReceiptDef;
/** The default def. */
VL_API vlReceiptDef vl_default_receipt_def(void);
/** Makes a receipt, owned by the caller. Its files are those that the context recorded
 * (vl_context_record_files). Errors: ARGUMENT, MEMORY. */
VL_API vlResult vl_receipt_make(vlContext *context, const vlReceiptDef *def,
                                vlReceipt **receipt, vlError *error);
/** Makes a receipt, owned by the caller, from `size` bytes of JSON text. Errors: ARGUMENT,
 * MEMORY; SCENE: the text is not a receipt; UNSUPPORTED: it has a later format version. */
VL_API vlResult vl_receipt_parse(vlContext *context, const char *text, size_t size,
                                 vlReceipt **receipt, vlError *error);
/** From a film's receipt, makes the receipt of the image that the film has at `samples` samples
 * per pixel, owned by the caller. It is a copy without outputs, in which this number replaces
 * the samples, render.spp and the value of --spp in the command. The image of a continued or
 * merged film thus has the same receipt as that of an uninterrupted render. Errors: ARGUMENT,
 * MEMORY. */
VL_API vlResult vl_receipt_of_image(const vlReceipt *film, uint32_t samples,
                                    vlReceipt **receipt, vlError *error);
/** Frees a receipt. Null is allowed. */
VL_API void vl_receipt_destroy(vlReceipt *receipt);

/** The receipt as JSON text. For a parsed receipt it is the text that was parsed, byte for
 * byte. Valid as long as the receipt, as are all its strings. */
VL_API const char *vl_receipt_text(const vlReceipt *receipt);
/** The path of the scene's file; null if it is not in the receipt. */
VL_API const char *vl_receipt_scene(const vlReceipt *receipt);
/** Word `index` of the command, from 0; null past the end. */
VL_API const char *vl_receipt_command(const vlReceipt *receipt, uint32_t index);
/** Path `index` of the outputs, from 0; null past the end. */
VL_API const char *vl_receipt_output(const vlReceipt *receipt, uint32_t index);
/** Samples per pixel that the image has. *planned: the number planned for the render; may be
 * null. */
VL_API uint32_t vl_receipt_samples(const vlReceipt *receipt, uint32_t *planned);
/** The threshold of adaptive sampling (vlRenderDef.noise); 0: none. */
VL_API double vl_receipt_noise(const vlReceipt *receipt);
/** The image's exposure (vlDevelopDef.exposure); 1 if it is not in the receipt. */
VL_API float vl_receipt_exposure(const vlReceipt *receipt);
/** Recorded file `index`, from 0: fills *record and returns it; null past the end. */
VL_API const vlFileRecord *vl_receipt_file(const vlReceipt *receipt, uint32_t index,
                                           vlFileRecord *record);
/** The name of the code of one's own of this kind that makes the image; null: none. A receipt
 * has only the name: the program with that code makes the image again. */
VL_API const char *vl_receipt_own(const vlReceipt *receipt, vlOwnKind kind);
/** The version of velo and the commit that the program was built from, each "" if it is not in
 * the receipt. */
VL_API const char *vl_receipt_version(const vlReceipt *receipt, const char **commit);
/** The camera as its file or scene describes it, with the image size of that description; every
 * number is exact. size: width and height of the rendered image in pixels (vl_camera_resize
 * fits the camera to it). crop: as in vlFilmDef. Both may be null. Errors: SCENE: the contents
 * are wrong; UNSUPPORTED: the camera has a lens of many elements or an image as its aperture,
 * of which the receipt has only digests, or it is a camera of one's own. */
VL_API vlResult vl_receipt_camera(const vlReceipt *receipt, vlCameraDef *camera,
                                  uint32_t size[2], uint32_t crop[4], vlError *error);

/** Parts of a receipt, for vl_receipt_compare. */
enum {
  VL_RECEIPT_VERSION = 1,   /**< velo's version and commit */
  VL_RECEIPT_SEQUENCE = 2,  /**< velo's sample sequence: a difference means other samples */
  VL_RECEIPT_FILES = 4,     /**< scene and assets: size and digest */
  VL_RECEIPT_CAMERA = 8,    /**< the camera */
  VL_RECEIPT_SETTINGS = 16, /**< load, complete, film, build, render but for spp and adaptive;
                               fast bits: Embree's instruction set */
  VL_RECEIPT_SAMPLES =
      32, /**< the samples that the image has, render.spp and render.adaptive */
  VL_RECEIPT_DEVELOP = 64,  /**< develop */
  VL_RECEIPT_COMMAND = 128, /**< command and path of the scene */
  VL_RECEIPT_OUTPUTS = 256, /**< outputs */
  VL_RECEIPT_ALL = 511      /**< everything */
};
/** Called for each difference, with one line of text: "the file textures/wood.png changed",
 * "spp is 64, was 16", "camera differs: fov is 0.5, was 0.6". Return false to end the
 * comparison. */
typedef bool vlReceiptFn(void *user, const char *difference);
/** Compares these parts (an OR of VL_RECEIPT_...) of the receipt `now` with those of an earlier
 * one, `then`. Calls fn, which may be null, for each difference. Returns the number of
 * differences found. */
VL_API uint32_t vl_receipt_compare(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                                   vlReceiptFn *fn, void *user);

/** The number of velo's sample sequence. It changes with every release in which the same scene
 * and settings give other samples. Films of different sequences cannot be merged or
 * continued. */
VL_API uint32_t vl_sample_sequence(void);
#ifdef __cplusplus
}
#endif
#endif
