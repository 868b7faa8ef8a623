/* camera/verify.h: the parts of `velo camera verify`: a target, its images, the corners found in them, and a second
 * projection to compare with. */
#ifndef APP_CAMERA_VERIFY_H
#define APP_CAMERA_VERIFY_H

#include "velo/velo.h"

/* ---- verify_model.c: the independent projection ------------------------------------------------------------------ */

typedef struct VerifyModel {
  vlCameraDef def; /* coefficients as the file gave them */
  vlCamera camera; /* intrinsics in pixels and pose */
} VerifyModel;

/* There is a second implementation of this model. */
bool verify_knows(const VerifyModel *model);
/* World point to film point, the image's corner being (0, 0). false: behind, or no number. Folds are not told. */
bool verify_project(const VerifyModel *model, const double point[3], double pixel[2]);

/* ---- verify_corners.c: corners of a chessboard in an image, without knowing where they are -----------------------
 */

typedef struct Image {
  int width, height; /* pixels are row after row; the middle of the first is (0.5, 0.5) */
  const float *pixels;
} Image;

typedef struct Corner {
  double x, y;
  double strength; /* of the saddle */
} Corner;

/* All places where the image looks like a saddle, to a pixel, in `corners`; at most `room` of them, whole rows first.
 * -1: no memory. */
int corners_find(const Image *image, Corner *corners, int room);
/* One of them to a hundredth of a pixel, by what lies within `reach` pixels. false: no corner of a chessboard. */
bool corner_refine(const Image *image, double reach, Corner *corner);

/* ---- verify_target.c: the board and where it stands -------------------------------------------------------------- */

enum { TARGET_MAX = 9, MARKER_BITS = 16 };

typedef struct Target {
  bool charuco;
  int corners; /* across and down; the board has one square more */
} Target;

typedef struct Placement {
  double center[3], x[3], y[3]; /* of the board, and the sides of one square; world */
} Placement;

typedef struct Random {
  uint64_t state;
} Random;
/* 0 to 1, the same numbers for a seed for ever. */
double random_unit(Random *random);

/* Pixels that a square should measure, and how many fit, by the size of the image. */
double target_choose(Target *target, const vlCamera *camera);
/* The board about `side` pixels a square, seen around film point (x, y), tilted and turned at random. false: the camera
 * sees nothing there, or so little that no board fits. */
bool target_place(const Target *target, const vlCamera *camera, double x, double y, double side, Random *random,
                  Placement *placement);
/* The point that is rendered (its coordinates are floats) at (i, j) squares from the board's corner. */
void target_point(const Target *target, const Placement *placement, double i, double j, double point[3]);
vlResult target_build(vlContext *context, const Target *target, const Placement *placement, vlWorld **world,
                      vlError *error);
/* The marker of the white square (i, j), read between its four corners (across, then down) in the image: 1 as drawn,
 * 0 another, -1 the square has none, or it is too small. */
int target_read_marker(const Target *target, int i, int j, const Image *image, double corners[4][2]);

/* ---- verify_run.c: pose after pose ------------------------------------------------------------------------------- */

enum { VERIFY_POSES = 1000, COVERAGE = 8 };

/* What was measured: of one pose, or of all. Differences are found - projected, in pixels. */
typedef struct Measure {
  uint32_t expected, found; /* corners that the camera should show; that were found where they should be, roughly */
  uint32_t unseen;          /* corners that were found and that the other camera does not see */
  uint32_t markers, misread;
  double sum, sum2, sum_x, sum_y, most;
  double at_x, at_y; /* where the largest was */
  uint32_t pose;     /* and in which pose */
} Measure;

typedef struct Verification {
  Target target;
  uint32_t poses, spp;
  uint64_t seed;
  const char *keep; /* folder for images and corners.csv; null */
  vlCamera camera;  /* makes the images */
  VerifyModel model;
  double side;     /* of a square, pixels */
  uint32_t placed; /* poses that found a place */
  Measure all, each[VERIFY_POSES];
  bool covered[COVERAGE][COVERAGE]; /* parts of the image in which corners were found */
} Verification;

/* -1, or the exit code when all has been said. */
int verify_run(Verification *v, vlContext *context);

#endif
