/* sensor/verify.h: the parts of `velo sensor verify`: flat fields and dark frames by EMVA 1288,
 * what the sensor's own numbers let one expect of them, a slanted edge by ISO 12233, the plot
 * and the folder of frames. */
#ifndef APP_SENSOR_VERIFY_H
#define APP_SENSOR_VERIFY_H

#include <stdio.h>

#include "velo/sensor.h"

enum { VERIFY_STEPS = 50, VERIFY_ROWS = 16 };

/* One exposure time: a pair of flat fields and a pair of dark frames. */
typedef struct VerifyStep {
  double time;                                     /* s */
  double electrons;                                /* mean photoelectrons */
  double mean, variance, dark_mean, dark_variance; /* measured: DN, DN^2 */
} VerifyStep;

/* Spatial statistics of a stack of frames. */
typedef struct VerifyStack {
  double mean;    /* DN */
  double spatial; /* variance of the pixels' means, without what is left of the noise; DN^2 */
} VerifyStack;

/* A parameter: what the sensor says and what the frames say. */
typedef struct VerifyRow {
  const char *name, *unit;
  double expected, measured;
  double allowed;   /* relative difference; of a row without expectation the largest value */
  const char *skip; /* why it is not compared; null: it is */
} VerifyRow;

typedef struct Verify {
  vlContext *context;
  vlSensor *sensor;
  vlExposureDef exposure; /* ISO, gain, temperature, seed */
  uint32_t size;          /* side of the frames, pixels */
  uint32_t stack;         /* frames of a stack */
  const char *folder;     /* where frames are written; null: nowhere */
  double gain;            /* DN/e-, with the exposure's gain */
  double saturation;      /* e-: the full well, or what the converter holds */
  double efficiency;      /* electrons per photon of the descriptor */
  double full_time;       /* exposure time of the last step, s */
  double full_electrons;  /* photoelectrons of the last step */
  VerifyStep steps[VERIFY_STEPS];
  VerifyStack bright, dark;
  VerifyRow rows[VERIFY_ROWS];
  int count;
  double *means;       /* size * size */
  uint16_t *frames[2]; /* size * size */
  FILE *descriptor;    /* of the folder; null: there is none */
  uint32_t frame;      /* number of the next frame */
} Verify;

/* Both return -1, or the exit code after reporting the error. The first makes and measures all
 * frames; the second exposes a slanted edge and adds its row. */
int verify_frames(Verify *verify);
int verify_edge(Verify *verify);
/* Adds the rows of the parameters of EMVA 1288. */
void verify_parameters(Verify *verify);
/* Variance of a step's frame that the sensor's numbers give, DN^2. */
double verify_expected_variance(const Verify *verify, const VerifyStep *step);
void verify_add(Verify *verify, VerifyRow row);
/* Whether a row is within what is allowed. */
bool verify_passes(const VerifyRow *row);
/* The folder of frames: opens its descriptor; begins a series ('b' or 'd'); adds a frame to it.
 * Return -1, or the exit code after reporting the error. */
int verify_folder_open(Verify *verify);
int verify_folder_series(Verify *verify, char kind, double time, double electrons);
int verify_folder_frame(Verify *verify, int which);
int verify_folder_close(Verify *verify);
/* Writes the photon transfer curve as an SVG image. */
int verify_plot(const Verify *verify, const char *path);

#endif
