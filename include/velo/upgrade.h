/** @file
 * velo/upgrade.h: rewrites scenes of pbrt-v3 as scenes of pbrt-v4. */
#ifndef VELO_UPGRADE_H
#define VELO_UPGRADE_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the upgrade reports. */
typedef enum vlUpgradeNote {
  VL_UPGRADE_CHANGED, /**< a statement was rewritten; its meaning is the same */
  VL_UPGRADE_LOST, /**< pbrt-v4 has no counterpart: left out or replaced, as the message says */
  VL_UPGRADE_WROTE /**< a file was written; the location names it */
} vlUpgradeNote;

/** Receives a note: `location` is the line in the old file, or the new file for WROTE; both
 * live until the callback returns. Called on the calling thread, in the order of the file. */
typedef void vlUpgradeReport(void *user, vlUpgradeNote note, const vlError *location,
                             const char *message);

/** How to upgrade a scene. */
typedef struct vlUpgradeDef {
  uint32_t cookie;
  /** what has no counterpart is an error, and nothing is written; default false */
  bool strict;
  const char *search_path; /**< further folders, separated by ':', in which files are looked
                              for; default null */
  vlUpgradeReport *report; /**< receives the notes; default null */
  void *report_user;       /**< passed to report */
} vlUpgradeDef;
/** The default def. */
VL_API vlUpgradeDef vl_default_upgrade_def(void);

/** Writes the pbrt-v3 scene `from` as the pbrt-v4 scene `to`. Comments, layout and numbers stay
 * as they are where pbrt-v4 has the same statement. An included file is written beside `to`
 * where it changes; names of files are written relative to the folder of `to`. A map of an
 * infinite or goniometric light, over longitude and latitude, becomes an equal-area map beside
 * `to` (.exr). All files are written or none: they get names that no file has (room-2.pbrt),
 * and `to` is replaced last; files of the replaced scene that had those names are then removed.
 * No file of the old scene is overwritten. A name that is given a second time gets a number.
 * The new scene is read before it is written: it is an error if vl_scene_load, with
 * `permissive`, would refuse it, and then nothing is written. def may be null. Meaning of the
 * statements: https://pbrt.org/fileformat-v3 and https://pbrt.org/fileformat-v4. Errors:
 * ARGUMENT, SCENE (syntax; a line of the new scene that would be refused), MISSING, IO,
 * MEMORY; UNSUPPORTED with `strict`. */
VL_API vlResult vl_scene_upgrade(vlContext *context, const char *from, const char *to,
                                 const vlUpgradeDef *def, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
