/* render/frame_writer.c: see frame_writer.h. Two views become one OpenEXR file by its
 * "Multi-View" specification. The attribute multiView lists the views. Channels without a dot
 * belong to the first view ("R", "Z"); others have the view before the last part of their name
 * ("right.R", "N.left.X", "N.right.X"). */
#include "render/frame_writer.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "image/display.h"
#include "image/image.h"
#include "render/attributes.h"
#include "render/exposure.h"
#include "render/receipt.h"

enum { QUEUE = 4 }; /* images that wait to be written, and the one that is being written */

struct FrameWriter {
  vlContext *context;
  const Frames *frames;
  const Outputs *outputs, *denoised;
  pthread_t thread;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  FrameImage queue[QUEUE];
  uint32_t first, count; /* ring buffer: first entry and number of entries */
  bool closed;           /* no image will be put any more */
  bool metered;          /* exposure is known: that of the first image */
  float exposure;        /* stops */
  int status;
  uint32_t written;
};

void frame_image_free(FrameImage *image) {
  for (int v = 0; v < 2; v++) {
    vl_image_destroy(image->images[v]);
    channels_free(&image->channels[v]);
  }
  vl_image_destroy(image->clean);
}

/* ---- one image --------------------------------------------------------------------------- */

/* Renames "Z" to "right.Z" and "N.X" to "N.right.X". In the first view, names without a dot
 * stay. */
static vlResult add_view(vlImage *image, const char *view, bool first) {
  for (uint32_t i = 0; i < vl_image_channels(image); i++) {
    const char *name = vl_image_channel_name(image, i), *dot = strrchr(name, '.');
    char full[300];
    if (first && !dot)
      continue;
    text_set(full, "%.*s%s.%s", dot ? (int)(dot + 1 - name) : 0, name, view,
             dot ? dot + 1 : name);
    TRY_RESULT(vl_image_rename_channel(image, i, full));
  }
  return VL_OK;
}

/* Joins the colours of both eyes, R G B A each, in one image, so that --half applies to both.
 * The header is the first eye's. */
static vlResult join(vlContext *context, vlImage *const images[2], const char *view,
                     vlImage **both) {
  static const char *const plain[4] = {"R", "G", "B", "A"};
  char right[4][32];
  const char *names[8];
  for (int c = 0; c < 4; c++) {
    text_set(right[c], "%s.%s", view, plain[c]);
    names[c] = plain[c];
    names[4 + c] = right[c];
  }
  TRY_RESULT(
      denoised_join(context, (const vlImage *const[]){images[0], images[1]}, 2, names, both));
  for (uint32_t i = 0; i < vl_image_attribute_count(images[0]); i++) {
    vlAttribute attribute;
    vl_image_attribute(images[0], i, &attribute);
    if (strcmp(attribute.name, "view") != 0)
      TRY_RESULT(vl_image_set_attribute(*both, &attribute));
  }
  return VL_OK;
}

/* eye: the file holds this eye alone; null: both. */
static ReceiptImage receipt_image(const FrameWriter *w, const FrameImage *p, const char *eye) {
  return (ReceiptImage){.eye = eye,
                        .is_frame = w->frames->trajectory != NULL,
                        .frame = p->frame.number,
                        .samples = p->spp};
}

static vlWriteDef write_def(const Outputs *outputs) {
  vlWriteDef def = vl_default_write_def();
  def.half = outputs->half;
  def.alone = true;
  return def;
}

/* Names the layers of both eyes for a file that holds both. If that fails they are left out. */
static int name_views(const FrameWriter *w, FrameImage *p) {
  vlResult result = VL_OK;
  for (int v = 0; v < 2; v++)
    for (int k = 0; k < CHANNEL_LAYERS && result == VL_OK; k++)
      if (p->channels[v].layers[k])
        result = add_view(p->channels[v].layers[k], w->frames->view_names[v], v == 0);
  if (result == VL_OK)
    return STATUS_OK;
  for (int v = 0; v < 2; v++)
    channels_free(&p->channels[v]);
  p->stopped = true;
  return report_reason(result, w->outputs->paths[0], "the layers cannot be named");
}

/* Writes a file with both eyes, whose layers are named. */
static vlResult write_both(FrameWriter *w, FrameImage *p, const char *path, vlError *error) {
  vlImage *both = NULL;
  const vlImage *layers[1 + 2 * CHANNEL_LAYERS];
  uint32_t count = 1;
  char views[40];
  const char *const *names = w->frames->view_names;
  vlResult result = join(w->context, p->images, names[1], &both);
  text_set(views, "%s\n%s", names[0], names[1]);
  const vlAttribute multi = {
      .name = "multiView", .type = VL_ATTRIBUTE_STRINGS, .string = views};
  if (result == VL_OK)
    result = vl_image_set_attribute(both, &multi);
  if (result == VL_OK)
    result = attributes_set_view(both, &p->jobs[1], names[1]);
  const ReceiptImage which = receipt_image(w, p, NULL);
  if (result == VL_OK)
    result = receipt_set(&p->jobs[0], &which, both);
  for (int v = 0; v < 2; v++)
    for (int k = 0; k < CHANNEL_LAYERS; k++) {
      const vlImage *layer = p->channels[v].layers[k];
      if (layer)
        layers[count++] = layer;
    }
  layers[0] = both;
  if (result == VL_OK)
    result = output_write_layers(layers, count, path, write_def(w->outputs), error);
  vl_image_destroy(both);
  return result;
}

/* A trajectory is metered once, by its first image, so that frames do not flicker. */
static float exposure_of(FrameWriter *w, const vlImage *image) {
  if (!w->outputs->meter)
    return w->outputs->exposure;
  if (!w->metered) {
    w->exposure = exposure_meter(image);
    exposure_tell(w->exposure);
  }
  w->metered = true;
  return w->exposure;
}

/* Writes the image of a view, as display values or with its layers. clean: the denoised copy,
 * with the exposure of the image itself. */
static vlResult write_one(FrameWriter *w, FrameImage *p, int view, bool clean, const char *path,
                          vlError *error) {
  const Outputs *outputs = clean ? w->denoised : w->outputs;
  const vlImage *layers[1 + CHANNEL_LAYERS] = {clean ? p->clean : p->images[view]};
  uint32_t count = 1;
  vlImage *display = NULL;
  if (output_is_display(path)) {
    const bool alpha = outputs->transparent && output_holds_alpha(path);
    TRY_RESULT(display_image(w->context, layers[0], outputs->view,
                             exposure_of(w, p->images[view]), alpha, &display));
    layers[0] = display;
  }
  for (int k = 0; k < CHANNEL_LAYERS && !clean && output_holds_layers(path); k++)
    if (p->channels[view].layers[k])
      layers[count++] = p->channels[view].layers[k];
  const vlResult result = output_write_layers(layers, count, path, write_def(outputs), error);
  vl_image_destroy(display);
  return result;
}

/* A file of a frame. */
typedef struct FrameFile {
  char name[4096], part[4200];
  const char *path; /* one of the two: a stopped image is written to NAME.part.EXT */
} FrameFile;

static void find_file(const FrameWriter *w, const FrameImage *p, const char *pattern, int view,
                      FrameFile *file) {
  frames_path(w->frames, &p->frame, pattern, view, file->name, sizeof file->name);
  const bool part = p->stopped && output_part_path(file->name, file->part, sizeof file->part);
  file->path = part ? file->part : file->name;
}

/* Writes the names of the ids beside all files that hold layers. */
static int write_ids(const FrameWriter *w, const FrameImage *p) {
  int status = STATUS_OK;
  for (int i = 0; i < w->outputs->count; i++) {
    const char *pattern = w->outputs->paths[i];
    const Channels *right = frames_join(w->frames, pattern) ? &p->channels[1] : NULL;
    for (int view = 0; output_holds_layers(pattern) && view < frames_files(w->frames, pattern);
         view++) {
      FrameFile file;
      find_file(w, p, pattern, view, &file);
      status = first_failure(
          status, channels_write_ids(&p->channels[view], right, &p->jobs[view], file.path));
    }
  }
  return status;
}

/* Writes both eyes' files of one pattern, or one file with both. */
static int write_pattern(FrameWriter *w, FrameImage *p, const char *pattern) {
  int status = STATUS_OK;
  for (int view = 0; view < frames_files(w->frames, pattern); view++) {
    FrameFile file;
    vlError error = {0};
    find_file(w, p, pattern, view, &file);
    const vlResult result = frames_join(w->frames, pattern)
                                ? write_both(w, p, file.path, &error)
                                : write_one(w, p, view, false, file.path, &error);
    status = first_failure(status, report_finish(&error, result, file.path));
    if (result == VL_OK && p->stopped)
      report_note("the image under way is in %s", file.path);
    if (result == VL_OK && !p->stopped)
      output_remove_part(file.name);
  }
  return status;
}

static int write_clean(FrameWriter *w, FrameImage *p) {
  const vlTrajectoryFrame *pose = &p->frame.pose;
  char path[4096];
  vlError error = {0};
  vlResult result = attributes_set_frame(p->clean, p->frame.number, pose->name, pose->time);
  frames_path(w->frames, &p->frame, w->denoised->paths[0], 0, path, sizeof path);
  if (result == VL_OK)
    result = write_one(w, p, 0, true, path, &error);
  return report_finish(&error, result, path);
}

static vlResult set_header(const FrameWriter *w, const FrameImage *p, int view) {
  vlImage *image = p->images[view];
  const vlTrajectoryFrame *pose = &p->frame.pose;
  const char *eye = w->frames->view_names[view];
  TRY_RESULT(attributes_set(image, &p->jobs[view], p->spp));
  if (w->frames->trajectory)
    TRY_RESULT(attributes_set_frame(image, p->frame.number, pose->name, pose->time));
  if (*eye)
    TRY_RESULT(image_set_text(image, "view", eye));
  TRY_RESULT(channels_describe(&p->channels[view], image));
  const ReceiptImage which = receipt_image(w, p, *eye ? eye : NULL);
  return receipt_set(&p->jobs[view], &which, image);
}

/* An image without its whole header is kept as a stopped one. */
static int write_image(FrameWriter *w, FrameImage *p) {
  int status = STATUS_OK;
  for (int v = 0; v < w->frames->views && status == STATUS_OK; v++) {
    const vlResult result = set_header(w, p, v);
    if (result == VL_OK)
      continue;
    status = report_reason(result, w->outputs->paths[0], "the image's header cannot be made");
    p->stopped = true;
  }
  status = first_failure(status, write_ids(w, p));
  const Outputs *outputs = w->outputs;
  bool joined = false;
  for (int i = 0; i < outputs->count; i++)
    if (frames_join(w->frames, outputs->paths[i]))
      joined = true;
    else
      status = first_failure(status, write_pattern(w, p, outputs->paths[i]));
  if (joined) /* these come last, since the layers' names change */
    status = first_failure(status, name_views(w, p));
  for (int i = 0; i < outputs->count && joined; i++)
    if (frames_join(w->frames, outputs->paths[i]))
      status = first_failure(status, write_pattern(w, p, outputs->paths[i]));
  return p->clean ? first_failure(status, write_clean(w, p)) : status;
}

/* ---- the thread -------------------------------------------------------------------------- */

static void *work(void *user) {
  FrameWriter *w = user;
  pthread_mutex_lock(&w->mutex);
  for (;;) {
    while (w->count == 0 && !w->closed)
      pthread_cond_wait(&w->changed, &w->mutex);
    if (w->count == 0)
      break;
    /* still counted as queued, so that its slot is not reused */
    FrameImage *image = &w->queue[w->first];
    pthread_mutex_unlock(&w->mutex);
    int status = write_image(w, image);
    bool stopped = image->stopped;
    frame_image_free(image);
    pthread_mutex_lock(&w->mutex);
    w->written += status == STATUS_OK && !stopped;
    w->status = first_failure(w->status, status);
    w->first = (w->first + 1) % QUEUE;
    w->count--;
    pthread_cond_signal(&w->changed);
  }
  pthread_mutex_unlock(&w->mutex);
  return NULL;
}

FrameWriter *frame_writer_start(vlContext *context, const Frames *frames,
                                const Outputs *outputs, const Outputs *denoised) {
  FrameWriter *w = calloc(1, sizeof *w);
  if (!w)
    return NULL;
  w->context = context;
  w->frames = frames;
  w->outputs = outputs;
  w->denoised = denoised;
  pthread_mutex_init(&w->mutex, NULL);
  pthread_cond_init(&w->changed, NULL);
  if (pthread_create(&w->thread, NULL, work, w) == 0)
    return w;
  pthread_mutex_destroy(&w->mutex);
  pthread_cond_destroy(&w->changed);
  free(w);
  return NULL;
}

void frame_writer_put(FrameWriter *w, const FrameImage *image) {
  pthread_mutex_lock(&w->mutex);
  while (w->count == QUEUE)
    pthread_cond_wait(&w->changed, &w->mutex);
  w->queue[(w->first + w->count) % QUEUE] = *image;
  w->count++;
  pthread_cond_signal(&w->changed);
  pthread_mutex_unlock(&w->mutex);
}

int frame_writer_finish(FrameWriter *w, uint32_t *written) {
  pthread_mutex_lock(&w->mutex);
  w->closed = true;
  pthread_cond_signal(&w->changed);
  pthread_mutex_unlock(&w->mutex);
  pthread_join(w->thread, NULL);
  int status = w->status;
  *written = w->written;
  pthread_mutex_destroy(&w->mutex);
  pthread_cond_destroy(&w->changed);
  free(w);
  return status;
}
