/** @file
 * velo/drawing.h: a camera as lines, faces and labels in world space, as drawings of
 * perspective show it from outside: eye, view plane, pyramid, frustum, axes, projectors. A
 * program projects them with another camera (docs/draw.md). */
#ifndef VELO_DRAWING_H
#define VELO_DRAWING_H

#include "velo/camera.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The parts of a drawing. X(part, name). */
#define VL_DRAWING_PARTS(X)                                                                   \
  X(VL_DRAWING_EYE, eye)       /* the centre of projection; of a lens its opening */          \
  X(VL_DRAWING_WINDOW, window) /* the image on the view surface: its border */                \
  X(VL_DRAWING_GRID, grid)     /* lines of pixels on the view surface */                      \
  X(VL_DRAWING_VOLUME, volume) /* edges of the view volume, from the eye to its end */        \
  X(VL_DRAWING_NEAR, near)     /* near clipping plane */                                      \
  X(VL_DRAWING_FAR, far)       /* far clipping plane, or the end of the drawing */            \
  X(VL_DRAWING_AXES, axes)     /* u to the right, v up, w against the view direction */       \
  X(VL_DRAWING_DISTANCE,                                                                      \
    distance)                /* from the eye to the view surface, along the view direction */ \
  X(VL_DRAWING_FOCUS, focus) /* plane in focus */                                             \
  X(VL_DRAWING_PROJECTOR,                                                                     \
    projector) /* from a point to the centre of projection, through its image */              \
  X(VL_DRAWING_FILM,                                                                          \
    film) /* film behind the centre of projection, with the image upside down */              \
  X(VL_DRAWING_PATH, path) /* between the cameras of a rig or trajectory */
/** The parts: VL_DRAWING_EYE and so on. */
typedef enum vlDrawingPart {
#define VL_KIND(part, name) part,
  VL_DRAWING_PARTS(VL_KIND)
#undef VL_KIND
} vlDrawingPart;

/** A line. Equal ends: a dot. World space. */
typedef struct vlDrawingLine {
  vlDrawingPart part;    /**< what it belongs to */
  uint32_t camera;       /**< index of the camera */
  double from[3], to[3]; /**< its two ends */
} vlDrawingLine;
/** A flat quadrilateral, meant to be drawn translucent. World space. */
typedef struct vlDrawingFace {
  vlDrawingPart part;   /**< what it belongs to */
  uint32_t camera;      /**< index of the camera */
  double corners[4][3]; /**< in the order of its border */
} vlDrawingFace;
/** A short text beside a point. World space. */
typedef struct vlDrawingLabel {
  vlDrawingPart part; /**< what it belongs to */
  uint32_t camera;    /**< index of the camera */
  double at[3];       /**< the labelled point */
  char text[16];      /**< "e", "u", "v", "w", "d", "P", "P'", ... */
} vlDrawingLabel;
/** A drawing. */
typedef struct vlDrawing {
  uint32_t line_count, face_count, label_count; /**< counts */
  const vlDrawingLine *lines;                   /**< line_count lines */
  const vlDrawingFace *faces;                   /**< face_count faces */
  const vlDrawingLabel *labels;                 /**< label_count labels */
  double low[3], high[3];                       /**< corners of its bounding box, world space */
} vlDrawing;

/** What is drawn. */
typedef struct vlDrawingDef {
  uint32_t cookie;
  uint32_t parts; /**< bits 1 << VL_DRAWING_*; default all but FILM */
  /** Distance of the view surface from the eye, scene units, above 0: of a perspective or
   * orthographic camera a plane at this depth, of the others the sphere around the eye. The
   * image on the film is as far behind the eye. Default 1. */
  double plane;
  /** Where the view volume of a perspective or orthographic camera ends in the drawing if it
   * has no far plane; of the others it ends at the view surface. Default 2. */
  double reach;
  uint32_t grid; /**< largest number of grid lines in each direction; the lines are borders of
                    pixels; default 16 */
  /** points whose projectors are drawn: 3 numbers each, world space; null: none */
  const double *points;
  uint32_t point_count; /**< number of points */
} vlDrawingDef;
/** The default def. */
VL_API vlDrawingDef vl_default_drawing_def(void);

/** Draws cameras. With one camera, all parts; with several, each camera's window and volume up
 * to its view surface, and the line through their eyes. Rays are those of vl_camera_unproject,
 * so that distortion, fisheyes and panoramas show their true bundles; parts of the image
 * without rays are left out. *drawing is owned by the caller. Errors: ARGUMENT: no camera,
 * plane or reach not above 0 and finite, points that are not finite. MEMORY. Thread-safe. */
VL_API vlResult vl_camera_outline(vlContext *context, const vlCamera *cameras, uint32_t count,
                                  const vlDrawingDef *def, vlDrawing **drawing, vlError *error);
/** Frees a drawing; null is ignored. */
VL_API void vl_drawing_destroy(vlDrawing *drawing);

#ifdef __cplusplus
}
#endif
#endif
