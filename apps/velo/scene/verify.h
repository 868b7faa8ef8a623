/* scene/verify.h: the parts of `velo scene verify`: which tracers claim the light of a scene,
 * the renders of the scene and of its moved copies, the comparisons, and their report.
 * docs/verify.md describes the method. */
#ifndef APP_SCENE_VERIFY_H
#define APP_SCENE_VERIFY_H

#include "camera/scene_world.h"
#include "cli/macros.h"
#include "scene/verify_statistics.h"
#include "velo/tracer.h"

/* Replicates of each run: images with different seeds. Samples per pixel of the second look,
 * relative to the first. */
enum { VERIFY_REPLICATES = 32, VERIFY_SECOND = 4 };
/* Of verify_seed and of the loop over the runs: counts rays. */
enum { VERIFY_TRIAL = 3 };
/* The reference renderer's share of the rays, relative to another run's. */
enum { VERIFY_REFERENCE_SHARES = 3 };
enum { VERIFY_MAX_RUNS = 24, VERIFY_MAX_MATERIALS = 32, VERIFY_MAX_NOTES = 16 };

/* ---- verify_plan.c: what is rendered, and what is compared with what --------------------- */

/* Where the scene is: as in its file; shifted, turned, scaled; or all of these. Its camera is
 * always moved with it. */
typedef enum VerifyPose {
  VERIFY_AS_IT_IS,
  VERIFY_SHIFTED,
  VERIFY_TURNED,
  VERIFY_SCALED,
  VERIFY_MOVED,
  VERIFY_PLACES
} VerifyPose;
/* Which lights the scene has. A light is small if a ray cannot meet it: point, spot, distant
 * and so on. */
typedef enum VerifyLights {
  VERIFY_ALL,
  VERIFY_NOT_SMALL,
  VERIFY_SMALL,
  VERIFY_SURFACES,
  VERIFY_SKY
} VerifyLights;

/* Renders of one tracer: VERIFY_REPLICATES images. */
typedef struct VerifyRun {
  const char *name; /* "bidirectional, scaled" */
  vlTracer tracer;
  VerifyPose pose;
  VerifyLights lights;
  bool sharp;     /* textures are not filtered */
  bool reference; /* by the reference renderer, a program of its own */
  bool evenly;    /* lights are chosen with equal probability; else as the scene asks */
  int against;    /* the run with which it is compared, a lower index; -1: none */
  bool apart;     /* a biased tracer: its means are reported, but not judged */
  bool left_out;  /* another tracer would replace this one; the reference: it cannot render the
                   * scene
                   */
  double rays;    /* of one sample per pixel, counted in a trial render */
  uint32_t spp[2];
  double *values[2]; /* of both looks: VERIFY_REPLICATES rows of means, VERIFY_CHANNELS for each
                        cell */
  uint64_t dropped;  /* samples that were not finite */
  bool again;        /* takes part in the second look */
  uint32_t marked;   /* values that were significant in the first look */
  uint32_t differs;  /* of these, those that were in the second look as well */
} VerifyRun;

/* A part of the image. */
typedef struct VerifyCell {
  VerifyFamily family;
  uint32_t pixels;
  /* blocks: column + columns * row; materials: id.material, 0: nothing is seen */
  uint32_t index;
} VerifyCell;

/* A value that was significant in the first look. */
typedef struct VerifyMark {
  int run;
  uint32_t value; /* VERIFY_CHANNELS * cell + channel */
  VerifyDifference first, second;
  bool differs; /* both looks agree */
} VerifyMark;

typedef struct Verify {
  const char *path;
  vlContext *context;
  SceneWorld in;   /* its world is built for the focus only */
  vlCamera camera; /* at the size of the renders */
  uint32_t width, height, columns, rows;
  double budget; /* rays of the first look */
  uint32_t seed;
  bool drowned;           /* messages of the library are not reported */
  char reference[4096];   /* path of the program; empty: the scene is not compared with it */
  char unreferenced[400]; /* why it is not; empty: it is */

  bool far_light; /* there is an infinite or distant light */
  double meets;   /* how much of the image a light path from the sky or a sun meets, as a number
                     of independent paths */
  double matrix[VERIFY_PLACES][16]; /* world of the copy from the world of the file */
  VerifyPose pose;                  /* the scene's state */
  VerifyLights lights;
  vlEmissionId *emissions; /* of each shape, as in the file */
  uint32_t shapes, light_count;

  VerifyRun runs[VERIFY_MAX_RUNS];
  int run_count;
  char notes[VERIFY_MAX_NOTES][240]; /* what is not compared, and why */
  int note_count;

  VerifyCell *cells;
  uint32_t cell_count, families;
  /* cell of each pixel; 0: none (cell 0 is the whole image) */
  uint32_t *block_of, *material_of;

  VerifyMark *marks;
  uint32_t mark_count, compared; /* values that were compared in the first look */
} Verify;

/* Adds the runs and the notes. */
void verify_plan(Verify *v);
void verify_note(Verify *v, const char *format, ...) PRINTF(2, 3);
/* Whether a light is in the group. */
bool verify_has_light(VerifyLights lights, const vlLightDef *light);
/* Whether emissive surfaces are in the group. */
bool verify_has_surfaces(VerifyLights lights);

/* ---- verify_run.c: renders the runs ------------------------------------------------------ */

/* Finds where the scene's copies are, and the cells: renders ground truth. */
vlResult verify_prepare(Verify *v, vlError *error);
/* Counts rays and sets the samples of each run. Runs of tracers that another one replaces are
 * left out, with a note. */
vlResult verify_measure(Verify *v, vlError *error);
/* Renders a look: 0, of all runs; 1, of those with `again`. VL_CANCELLED after a signal. */
vlResult verify_render(Verify *v, int look, vlError *error);

/* Seeds are the same for all runs of a replicate: common random numbers make their differences
 * smaller. */
uint32_t verify_seed(const Verify *v, int look, uint32_t replicate);
/* The means of an image's first three channels over the cells. row: VERIFY_CHANNELS for each
 * cell. */
void verify_take_means(const Verify *v, const vlImage *image, double *row);

/* ---- verify_reference.c: renders by the reference renderer ------------------------------- */

/* Finds the program: path (null: not given), the environment variable VELO_REFERENCE,
 * velo-reference beside this program. Sets v->reference or v->unreferenced. -1, or the exit
 * code after reporting that what was given is not there. */
int verify_reference_find(Verify *v, const Arguments *arguments, const OptionValue *given);
/* Renders one sample per pixel. Where the program refuses the scene, the run is left out, and
 * v->unreferenced says why. IO: the program failed. */
vlResult verify_reference_try(Verify *v, VerifyRun *run, vlError *error);
/* Renders the replicates of a look, as many at once as the context has threads. As above; a run
 * that takes too long is left out, too. VL_CANCELLED after a signal. */
vlResult verify_reference(Verify *v, VerifyRun *run, int look, vlError *error);

/* ---- verify_compare.c -------------------------------------------------------------------- */

/* Whether the cell is compared for this run. Runs with a part of the lights have one cell, the
 * image, which then counts in the family of lights. */
bool verify_uses_cell(const Verify *v, const VerifyRun *run, uint32_t cell);
VerifyFamily verify_family(const VerifyRun *run, const VerifyCell *cell);
/* The difference of a value in a look, between a run and the one that it is compared with. */
VerifyDifference verify_difference(const Verify *v, const VerifyRun *run, int look,
                                   uint32_t value);
/* Marks the values that are significant in the first look, and the runs that take part in the
 * second. MEMORY. */
vlResult verify_first(Verify *v);
/* Judges the marks by the second look. */
void verify_second(Verify *v);

/* ---- verify_report.c --------------------------------------------------------------------- */

void verify_print(const Verify *v);
void verify_print_json(const Verify *v);
/* The number of runs that differ beyond chance. */
int verify_count(const Verify *v);

#endif
