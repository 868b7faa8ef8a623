/* render/outputs.h: the output files of one render. They are checked before the render and
 * written atomically. While rendering and after an interruption, the image of NAME.EXT is in
 * NAME.part.EXT. Only a finished render replaces NAME.EXT. The output "-.EXT" is the standard
 * output in that format; "-" is "-.exr". */
#ifndef APP_RENDER_OUTPUTS_H
#define APP_RENDER_OUTPUTS_H

#include "cli/options.h"
#include "velo/image.h"

enum { MAX_OUTPUTS = 32 };

/* The stage of the image being written. */
typedef enum OutputStage {
  OUTPUT_PROGRESS, /* to NAME.part.EXT, except for pipes and devices; a failure is a warning */
  OUTPUT_STOPPED,  /* to NAME.part.EXT, for the last time */
  OUTPUT_FINISHED  /* to NAME.EXT; NAME.part.EXT is removed */
} OutputStage;

typedef struct Outputs {
  const char *paths[MAX_OUTPUTS];
  int count;
  bool half;
  bool to_stdout; /* "-" is allowed: the command prints nothing else */
  bool patterns;  /* the names are patterns (pattern.h): directories with a % are made later */
  vlView view;    /* for 8-bit files */
  float exposure; /* EV, for 8-bit files */
  const char *comment; /* a text for 8-bit files that have a place for one; null: none */
  bool transparent;    /* .png files have alpha */
  bool meter;          /* meter the exposure from the image; `exposure` is not used */
  float *shared; /* with meter: the exposure of several images; NaN until the first is metered;
                    null: none */
  const char *video;        /* what is made of the frames (video.h); null: nothing */
  const vlImage *layers[4]; /* further channels of .exr files; null: none */
  struct {
    uint32_t part_spp; /* samples per pixel in NAME.part.EXT; 0: it was not written */
    bool failing;      /* the last progress write failed, and the failure was reported */
  } files[MAX_OUTPUTS];
} Outputs;

/* Rows of options of commands that write images. */
#define OUTPUT_VIEW_OPTION(id)                                                             \
  {                                                                                        \
    (id), "view",                                                                          \
        "view transform from radiance to display values (.png .jpg .tga):", OPTION_CHOICE, \
        "NAME", .choices = view_choices                                                    \
  }
#define OUTPUT_EXPOSURE_OPTION(id)                                                             \
  {                                                                                            \
    (id), "exposure", "exposure of .png .jpg .tga: multiply the image by 2^EV", OPTION_NUMBER, \
        "EV"                                                                                   \
  }
#define OUTPUT_HALF_OPTION(id) \
  { (id), "half", "write .exr with 16-bit instead of 32-bit floats" }

/* Whether the output is the standard output. */
bool output_is_stdout(const char *path);
/* The path that is opened for this output. */
const char *output_opened(const char *path);
/* Whether two paths are of the same file, which need not be there. */
bool output_is_same(const char *a, const char *b);
/* Whether the output is written as a stream: once, when it is complete. */
bool output_is_stream(const char *path);
/* Whether the file's format holds more than colours. */
bool output_holds_layers(const char *path);
/* Whether the file's format holds an alpha channel. */
bool output_holds_alpha(const char *path);
/* The suffix of the name, from its dot on; null: it has none. */
const char *output_dot(const char *path);
/* Whether it is the suffix of the name: ".png"; in upper case or lower. */
bool output_has_suffix(const char *path, const char *suffix);
/* Whether velo writes files with this suffix; and whether the format holds display values. */
bool output_is_known(const char *path);
bool output_is_display(const char *path);
/* Reports that a drawing needs a format of display values, unless the path has one. Returns -1,
 * or the exit code. */
int output_check_drawing(const char *path);
/* Whether the test is true for some path. */
bool outputs_any(const Outputs *outputs, bool (*test)(const char *path));
/* The largest width and height of the format. */
uint32_t output_largest_side(const char *path);
/* Takes the names that the command line gives. */
void outputs_take_names(Outputs *outputs, const Arguments *arguments);
/* Checks that every name has a suffix that velo writes and is given once. Does not access the
 * file system. Returns -1, or the exit code after reporting the error. */
int outputs_check_names(const Outputs *outputs);
/* Checks that every file can be written, and removes what an earlier run that was killed has
 * left beside it. Returns as outputs_check_names. */
int outputs_check_folders(const Outputs *outputs);
/* Checks one name against the file system and against what the context, which may be null, has
 * read. Returns -1, or the exit code after reporting the error. */
int output_check(vlContext *context, const char *path, vlOutputKind kind);
/* NAME.part.EXT beside the target of `path`; names that are too long are shortened. False:
 * still too long, or `path` is a device or pipe. */
bool output_part_path(const char *path, char *part, size_t size);
/* Removes NAME.part.EXT once NAME.EXT is complete, also that of an earlier render. */
void output_remove_part(const char *path);
/* Makes the path PATH.ids.json; a name that is too long is shortened. */
bool output_ids_path(const char *path, char *ids, size_t size);
/* Writes an image with its layers to one output. */
vlResult output_write_layers(const vlImage *const *images, uint32_t count, const char *path,
                             vlWriteDef def, vlError *error);
/* Writes the image with `spp` samples per pixel to every file, also after one of them failed.
 * Returns STATUS_OK or the exit code of the first failure. */
int outputs_write(vlContext *context, Outputs *outputs, const vlImage *image, uint32_t spp,
                  OutputStage stage);
/* The path to which output i was written at that stage: its own, or its NAME.part.EXT (in
 * `part`). */
const char *output_written(const Outputs *outputs, int i, OutputStage stage, char *part,
                           size_t size);

#endif
