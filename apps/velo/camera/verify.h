/* camera/verify.h: the parts of `velo camera verify`: a target, its rendered images, the
 * corners found in them, and an independent projection to compare with. */
#ifndef APP_CAMERA_VERIFY_H
#define APP_CAMERA_VERIFY_H

#include "velo/camera.h"
#include "velo/world.h"

/* ---- verify_model.c: the independent projection ------------------------------------------ */

typedef struct VerifyModel {
  vlCameraDef def; /* coefficients as in the file */
  vlCamera camera; /* intrinsics in pixels, and pose */
} VerifyModel;

/* Whether the independent implementation covers this camera model. */
bool verify_knows(const VerifyModel *model);
/* Projects a world point to a film point; the image's corner is (0, 0). False: behind the
 * camera, or no finite result. Folds of the distortion are not detected. */
bool verify_project(const VerifyModel *model, const double point[3], double pixel[2]);

/* verify_corners.c: corners of a chessboard in an image, without knowing where they are. */

typedef struct Image {
  int width, height; /* rows from the top; the first pixel's centre is (0.5, 0.5) */
  const float *pixels;
} Image;

typedef struct Corner {
  double x, y;
  double strength; /* of the saddle point */
} Corner;

/* Finds all saddle points of the image to about a pixel. At most `room` are stored, by rows
 * from the top. -1: out of memory. */
int corners_find(const Image *image, Corner *corners, int room);
/* Refines a corner to about a hundredth of a pixel from the pixels within `reach`. False: not a
 * chessboard corner. */
bool corner_refine(const Image *image, double reach, Corner *corner);

/* ---- verify_target.c: the board and where it stands -------------------------------------- */

enum { MAX_TARGET_SIDE = 9 };

typedef struct Target {
  bool charuco;
  int corners; /* inner corners in each direction; the board has one more square */
} Target;

typedef struct Placement {
  /* centre of the board; its axes with the length of a square's side; world space */
  double center[3], x[3], y[3];
} Placement;

typedef struct Random {
  uint64_t state;
} Random;
/* Uniform in [0, 1); the sequence depends on the seed only. */
double random_unit(Random *random);

/* The side of a square in pixels and the number of corners for the image's size. */
double target_choose(Target *target, const vlCamera *camera);
/* Places the board, with squares about `side` pixels wide, around film point (x, y) with a
 * random tilt and rotation. False: the film point has no ray, or the board does not fit. */
bool target_place(const Target *target, const vlCamera *camera, double x, double y, double side,
                  Random *random, Placement *placement);
/* The world point (float coordinates, as rendered) at (i, j) squares from the board's
 * corner. */
void target_point(const Target *target, const Placement *placement, double i, double j,
                  double point[3]);
vlResult target_build(vlContext *context, const Target *target, const Placement *placement,
                      vlWorld **world, vlError *error);
/* Reads the marker of the white square (i, j) between its four corners in the image (by rows).
 * 1: as drawn, 0: another marker, -1: the square has none or is too small. */
int target_read_marker(const Target *target, int i, int j, const Image *image,
                       double corners[4][2]);

/* ---- verify_run.c: pose after pose ------------------------------------------------------- */

enum { VERIFY_POSES = 1000, COVERAGE = 8 };

/* Measurements of one pose or of all. Differences are measured minus projected, in pixels. */
typedef struct Measure {
  uint32_t expected,
      found;       /* corners that should be visible, and those of them that were found */
  uint32_t unseen; /* found corners that the independent projection cannot project */
  uint32_t markers, misread;
  double sum, sum2, sum_x, sum_y, max;
  double at_x, at_y; /* where the largest difference was */
  uint32_t pose;     /* pose of the largest difference */
} Measure;

typedef struct Verification {
  Target target;
  uint32_t poses, spp;
  uint64_t seed;
  const char *keep; /* folder for images and corners.csv, or null */
  vlCamera camera;  /* renders the images */
  VerifyModel model;
  double side;     /* of a square, pixels */
  uint32_t placed; /* number of poses in which the board could be placed */
  Measure all, each[VERIFY_POSES];
  bool covered[COVERAGE][COVERAGE]; /* whether corners were found in each cell of the image */
} Verification;

/* Renders and measures all poses. Returns -1, or the exit code after reporting the error. */
int verify_run(Verification *v, vlContext *context);

#endif
