/* view/engine_film.c: the film of --film, with a receipt, so that `velo render --continue` adds
 * samples to it. The receipt's command is that of `velo render` for the last image: its tracer,
 * its crop, and its camera, which is written into a file beside the film, unless it is still
 * the scene's. */
#include <stdio.h>
#include <string.h>

#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/attributes.h"
#include "render/channels.h"
#include "render/lens_options.h"
#include "render/receipt.h"
#include "velo/camera_file.h"
#include "view/engine_answers.h"

/* The texts of the command's options, as long as it is used. */
typedef struct FilmCommand {
  Arguments arguments;
  char camera[4200], resolution[40], crop[60];
} FilmCommand;

static void set_option(FilmCommand *c, int option, const char *text) {
  c->arguments.values[option].given = text != NULL;
  c->arguments.values[option].text = text;
}

/* Whether the camera is the scene's. An edit that changes no number may make it seem another
 * one. */
static bool is_scenes_own(const Engine *e) {
  const ViewCamera *a = &e->now.camera, *b = &e->scene_camera;
  return memcmp(&a->def, &b->def, sizeof a->def) == 0 &&
         memcmp(&a->made, &b->made, sizeof a->made) == 0;
}

void engine_film_camera(const char *film_path, char *path, size_t size) {
  snprintf(path, size, "%s.camera.json", film_path);
}

/* Writes the camera, and replaces the options that give it. Returns -1, or the exit code after
 * reporting the error. */
static int take_camera(const Engine *e, FilmCommand *c) {
  static const int replaced[] = {RENDER_FRAME,       RENDER_SIZE,           RENDER_TURN,
                                 RENDER_FOCUS_PIXEL, RENDER_FOCUS_DISTANCE, RENDER_LENS_RADIUS,
                                 RENDER_F_NUMBER,    RENDER_RESOLUTION,     RENDER_ISO,
                                 RENDER_SECONDS};
  const vlCamera *made = &e->now.camera.made;
  const vlCameraDef *own = &e->now.camera.def;
  vlError error = {0};
  engine_film_camera(e->def.film_path, c->camera, sizeof c->camera);
  TRY(report_error(&error, engine_write_camera(e, c->camera, VL_CAMERA_DIALECT_VELO, &error),
                   c->camera));
  for (size_t i = 0; i < LENGTH(replaced); i++)
    set_option(c, replaced[i], NULL);
  set_option(c, RENDER_CAMERA, c->camera);
  text_set(c->resolution, "%ux%u", made->width, made->height);
  if (own->width != made->width || own->height != made->height)
    set_option(c, RENDER_RESOLUTION, c->resolution);
  return -1;
}

/* Makes the receipt and the header attributes; null if the scene's files have changed since the
 * image began. Returns -1, or the exit code. */
static int make_receipt(const Engine *e, FilmCommand *c, vlReceipt **receipt,
                        vlImage **attributes) {
  Job job = e->model.job;
  vlSceneDefs defs = engine_present_defs(e);
  const uint32_t *crop = e->now.crop;
  const ReceiptPlan plan = {.arguments = &c->arguments, .opening = &e->model.opening};
  if (e->model.load != e->reload.loads) {
    report_warning(
        "%s has no receipt and cannot be continued: the scene's files changed during its last "
        "image",
        e->def.film_path);
    return -1;
  }
  c->arguments = *e->def.arguments;
  text_set(c->crop, "%u,%u,%u,%u", crop[0], crop[1], crop[2], crop[3]);
  if (is_scenes_own(e)) {
    defs.camera = job.defs->camera;
    if (memcmp(crop, job.defs->film.crop, sizeof job.defs->film.crop) != 0)
      set_option(c, RENDER_CROP, c->crop);
  } else {
    const bool whole = crop_is_whole(crop, defs.film.width, defs.film.height);
    set_option(c, RENDER_CROP, whole ? NULL : c->crop);
    TRY(take_camera(e, c));
  }
  set_option(c, RENDER_TRAJECTORY, NULL);
  set_option(c, RENDER_CHANNELS, "error"); /* the film has their sums */
  defs.film.errors = true;
  defs.render.spp = e->now.spp > defs.render.spp ? e->now.spp : defs.render.spp;
  job.defs = &defs;
  job.camera = e->now.camera.made;
  job.raced = true; /* the command names the tracer */
  const ReceiptImage which = {.samples = defs.render.spp};
  vlResult result = receipt_make(&plan, &job, &which, receipt);
  if (result == VL_OK)
    result = attributes_make(&job, NULL, attributes);
  const Channels channels = {.bits = VL_CHANNEL_ERROR};
  if (result == VL_OK)
    result = channels_describe_mode(&channels, *attributes);
  return report_reason(result, e->def.film_path, "the film's receipt cannot be made");
}

int engine_write_film(Engine *e) {
  static FilmCommand command;
  const char *path = e->def.film_path;
  vlReceipt *receipt = NULL;
  vlImage *attributes = NULL;
  vlError error = {0};
  if (e->now.channel == CHANNEL_CAMERA)
    return report_failure(STATUS_OTHER,
                          "%s is not written: the last image was a sensor's; --film has images "
                          "that are shown without one",
                          path);
  if (!engine_spp(e))
    return report_failure(STATUS_OTHER, "%s is not written: the last image has no samples yet",
                          path);
  int status = make_receipt(e, &command, &receipt, &attributes);
  vlFilmWriteDef def = vl_default_film_write_def();
  def.receipt = receipt ? vl_receipt_text(receipt) : NULL;
  def.lock = e->def.film_lock;
  def.attributes = attributes;
  vlResult result = status < 0 ? vl_film_write(e->film, &def, path, &error) : VL_OK;
  vl_receipt_destroy(receipt);
  vl_image_destroy(attributes);
  return status < 0 ? report_finish(&error, result, path) : status;
}
