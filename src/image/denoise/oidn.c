/* image/denoise/oidn.c: denoises by Intel Open Image Denoise, if it is installed. The library
 * is loaded at run time. Only functions of its C interface that versions 1 and 2 have in common
 * are called, some of them under two names. */
#include <dlfcn.h>
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "image/denoise/denoise.h"

typedef struct Oidn {
  void *library;
  void *(*new_device)(int type);
  void (*commit_device)(void *device);
  void (*release_device)(void *device);
  int (*device_error)(void *device, const char **message);
  void (*set_device_int)(void *device, const char *name, int value);
  void *(*new_filter)(void *device, const char *type);
  void (*set_image)(void *filter, const char *name, void *pixels, int format, size_t width,
                    size_t height, size_t offset, size_t pixel_bytes, size_t row_bytes);
  void (*set_bool)(void *filter, const char *name, bool value);
  void (*commit_filter)(void *filter);
  void (*execute)(void *filter);
  void (*release_filter)(void *filter);
} Oidn;

enum { DEFAULT_DEVICE = 0, FORMAT_FLOAT3 = 3 };

static vlResult load(Oidn *o, const char *library, vlError *error) {
  static const char *const usual[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                      "libOpenImageDenoise.so.0", "libOpenImageDenoise.so"};
  if (library)
    o->library = dlopen(library, RTLD_NOW | RTLD_LOCAL);
  for (size_t i = 0; i < VL_LENGTH(usual) && !library && !o->library; i++)
    o->library = dlopen(usual[i], RTLD_NOW | RTLD_LOCAL);
  if (!o->library)
    return vl_fail(error, VL_ERROR_MISSING, "Open Image Denoise: %s cannot be loaded",
                   library ? library : usual[0]);
  const struct {
    const char *name, *other; /* name in version 2; name in version 1 if it differs */
    void *to;
  } symbols[] = {{"oidnNewDevice", NULL, &o->new_device},
                 {"oidnCommitDevice", NULL, &o->commit_device},
                 {"oidnReleaseDevice", NULL, &o->release_device},
                 {"oidnGetDeviceError", NULL, &o->device_error},
                 {"oidnSetDeviceInt", "oidnSetDevice1i", &o->set_device_int},
                 {"oidnNewFilter", NULL, &o->new_filter},
                 {"oidnSetSharedFilterImage", NULL, &o->set_image},
                 {"oidnSetFilterBool", "oidnSetFilter1b", &o->set_bool},
                 {"oidnCommitFilter", NULL, &o->commit_filter},
                 {"oidnExecuteFilter", NULL, &o->execute},
                 {"oidnReleaseFilter", NULL, &o->release_filter}};
  for (size_t i = 0; i < VL_LENGTH(symbols); i++) {
    void *symbol = dlsym(o->library, symbols[i].name);
    if (!symbol && symbols[i].other)
      symbol = dlsym(o->library, symbols[i].other);
    if (!symbol)
      return vl_fail(error, VL_ERROR_UNSUPPORTED, "Open Image Denoise: %s has no function %s",
                     library ? library : "the library", symbols[i].name);
    memcpy(symbols[i].to, &symbol, sizeof symbol);
  }
  return VL_OK;
}

/* Copies three channels of the image, interleaved, to new memory. Values that are not finite
 * become 0. Null: out of memory. */
static float *copy3(const vlImage *image, const int channel[3]) {
  size_t pixels = (size_t)image->width * image->height;
  float *to = vl_alloc_array(image->context, pixels, 3 * sizeof *to);
  for (size_t i = 0; i < pixels && to; i++)
    for (int c = 0; c < 3; c++) {
      float v = vl_image_get(image, (uint32_t)(i % image->width), (uint32_t)(i / image->width),
                             (uint32_t)channel[c]);
      to[3 * i + (size_t)c] = isfinite(v) ? v : 0.0f;
    }
  return to;
}

/* Runs the denoiser. planes: colour, result, albedo and normal, 3 floats per pixel; albedo and
 * normal may be null. */
static vlResult run(const Oidn *o, const vlImage *image, float *const planes[4],
                    vlError *error) {
  static const char *const names[4] = {"color", "output", "albedo", "normal"};
  void *device = o->new_device(DEFAULT_DEVICE);
  if (!device)
    return vl_fail(error, VL_ERROR_UNSUPPORTED, "Open Image Denoise: no device");
  o->set_device_int(device, "numThreads", (int)vl_context_threads(image->context));
  o->commit_device(device);
  void *filter = o->new_filter(device, "RT");
  for (int i = 0; i < 4 && filter; i++)
    if (planes[i])
      o->set_image(filter, names[i], planes[i], FORMAT_FLOAT3, image->width, image->height, 0,
                   0, 0);
  if (filter) {
    o->set_bool(filter, "hdr", true);
    o->commit_filter(filter);
    o->execute(filter);
  }
  const char *message = NULL;
  vlResult result = VL_OK;
  if (o->device_error(device, &message) != 0 || !filter)
    result = vl_fail(error, VL_ERROR_UNSUPPORTED, "Open Image Denoise: %s",
                     message ? message : "no filter");
  if (filter)
    o->release_filter(filter);
  o->release_device(device);
  return result;
}

vlResult vl_denoise_oidn(const vlImage *image, const vlDenoiseChannels *channels,
                         const char *library, vlImage *clean, vlError *error) {
  Oidn oidn = {0};
  float *planes[4] = {NULL};
  vlResult result = load(&oidn, library, error);
  if (result == VL_OK) {
    planes[0] = copy3(image, channels->color);
    planes[1] = copy3(image, channels->color);
    if (channels->features)
      planes[2] = copy3(image, channels->feature);
    if (channels->features)
      planes[3] = copy3(image, channels->feature + 3);
    if (!planes[0] || !planes[1] || (channels->features && (!planes[2] || !planes[3])))
      result = vl_fail_memory(error);
    else
      result = run(&oidn, image, planes, error);
  }
  size_t pixels = (size_t)image->width * image->height;
  float *to = clean->pixels;
  for (size_t i = 0; i < pixels && result == VL_OK; i++)
    for (size_t c = 0; c < 3; c++)
      to[i * clean->channels + c] = planes[1][3 * i + c];
  for (int i = 0; i < 4; i++)
    vl_free(image->context, planes[i]);
  if (oidn.library)
    dlclose(oidn.library);
  return result;
}
