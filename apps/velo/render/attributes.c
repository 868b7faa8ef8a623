/* render/attributes.c: see attributes.h. velo/header.h makes most of them. */
#include "render/attributes.h"

#include <math.h>

#include "cli/macros.h"
#include "image/image.h"
#include "render/receipt.h"
#include "velo/header.h"

static vlHeaderDef header_def(const Job *job) {
  vlHeaderDef def = vl_default_header_def();
  def.camera = &job->camera;
  def.defs = job->defs;
  def.time = job_channels_time(job);
  return def;
}

vlResult attributes_set(vlImage *image, const Job *job, uint32_t spp) {
  vlHeaderDef def = header_def(job);
  const vlReceipt *again = job->receipt ? job->receipt->again : NULL;
  def.scene = again ? vl_receipt_scene(again) : NULL;
  if (!def.scene)
    def.scene = job->path;
  def.samples = spp;
  return vl_image_set_header(image, &def);
}

vlResult attributes_set_view(vlImage *image, const Job *job, const char *view) {
  vlHeaderDef def = header_def(job);
  def.view = view;
  return vl_image_set_header(image, &def);
}

vlResult attributes_set_frame(vlImage *image, uint32_t number, const char *name, double time) {
  const vlAttribute attributes[3] = {
      {.name = "velo.frame", .type = VL_ATTRIBUTE_INT, .numbers = {number}},
      {.name = "velo.frameTime", .type = VL_ATTRIBUTE_DOUBLE, .numbers = {time + 0.0}},
      {.name = "velo.frameName", .type = VL_ATTRIBUTE_STRING, .string = name}};
  const bool has[3] = {true, !isnan(time), name && *name};
  for (int i = 0; i < 3; i++)
    if (has[i])
      TRY_RESULT(vl_image_set_attribute(image, &attributes[i]));
  return VL_OK;
}

vlResult attributes_add_layer(vlImage *image, const vlImage *layer) {
  return layer ? vl_image_add_attributes(image, layer) : VL_OK;
}

vlResult attributes_make(const Job *job, const char *eye, vlImage **image) {
  TRY_RESULT(image_make(job->context, 1, 1, 1, NULL, image));
  TRY_RESULT(attributes_set(*image, job, job->defs->render.spp));
  return eye ? image_set_text(*image, "view", eye) : VL_OK;
}
