/** @file
 * velo/setting.h: the rows of the settings (of renders, cameras, loads, image files ...), and
 * the function that checks a value which somebody gave for a row and says what is wrong with
 * it. The options of the program, the Python module with its recipes, velo's JSON and the
 * server of `velo view` check by them. Constant data: any thread may read it. */
#ifndef VELO_SETTING_H
#define VELO_SETTING_H

#include "velo/schema.h"

#ifdef __cplusplus
extern "C" {
#endif

/** X(group, name) for each group of settings. A group has one def, which its rows describe. */
#define VL_SETTING_GROUPS(X)       \
  X(VL_SETTING_RENDER, render)     \
  X(VL_SETTING_CAMERA, camera)     \
  X(VL_SETTING_LOAD, load)         \
  X(VL_SETTING_COMPLETE, complete) \
  X(VL_SETTING_CHANNELS, channels) \
  X(VL_SETTING_WRITE, write)       \
  X(VL_SETTING_CONTEXT, context)   \
  X(VL_SETTING_PROGRAM, program)   \
  X(VL_SETTING_SENSOR, sensor)     \
  X(VL_SETTING_EXPOSURE, exposure)
/** Groups of settings. RENDER: vlSceneDefs; CAMERA: vlCameraDef; LOAD: vlLoadDef; COMPLETE:
 * vlCompleteDef; CHANNELS: vlChannelsDef; WRITE: vlWriteDef; CONTEXT: vlContextDef; PROGRAM: no
 * def, settings that are turned into others; SENSOR: vlSensorDef; EXPOSURE: vlExposureDef. */
typedef enum vlSettingGroup {
#define VL_KIND(group, name) group,
  VL_SETTING_GROUPS(VL_KIND)
#undef VL_KIND
} vlSettingGroup;

/** The rows of a group; null: there is no such group. They are also the family "settings" of
 * velo/schema.h. */
VL_API const vlKindRow *vl_settings(vlSettingGroup group);
/** The row of a setting by its keyword ("spp", "filter_radius_x") or its member
 * ("lens.tilt_x"); a dash or a dot counts as an underscore. Null: there is none. */
VL_API const vlParameter *vl_setting(vlSettingGroup group, const char *name);
/** The keyword of a row: vlParameter.keyword, or the last word of its member. */
VL_API const char *vl_setting_keyword(const vlParameter *row);

/** What kind of value somebody gave. */
typedef enum vlGivenKind {
  VL_GIVEN_NOTHING, /**< none: null, None */
  VL_GIVEN_FLAG,    /**< true or false */
  VL_GIVEN_NUMBER,  /**< a number; NaN and infinities, too */
  VL_GIVEN_TEXT,    /**< text */
  VL_GIVEN_OTHER    /**< anything else: a list, text that should be a number and is none */
} vlGivenKind;

/** A value that somebody gave, in a file, a call, a message or on the command line. */
typedef struct vlGiven {
  vlGivenKind kind;  /**< what it is */
  double number;     /**< of a NUMBER; of a FLAG 0 or 1 */
  const char *text;  /**< of TEXT; UTF-8, not null */
  const char *shown; /**< the value as messages show it; null: the number, or the text in
                        quotation marks */
  double factor;     /**< a NUMBER's unit: value in the def = factor * number; 0 is read as 1 */
} vlGiven;

/** The size of a message of these functions, in bytes. */
#define VL_GIVEN_MESSAGE 512

/** Checks a value for a row. Of a row of three numbers, or of a spectrum, the value is one
 * number. True: *number is the value in the def's unit (a choice's index; a flag's 0 or 1;
 * VL_UNSET for NOTHING; 0 of text). False: the message, one line, has the name, what it must
 * be, the value, and of names the nearest: `spp must be a whole number from 1 to 16777216; it
 * is 0`. name: of the value, as the caller calls it. number may be null. */
VL_API bool vl_given_check(const vlParameter *row, const char *name, const vlGiven *given,
                           double *number, char message[VL_GIVEN_MESSAGE]);
/** Puts the number of vl_given_check into the def. Only rows of one number, of a flag and of a
 * choice hold one; for others it does nothing. */
VL_API void vl_given_put(const vlParameter *row, double number, void *def);
/** Writes that a name is not known, with the nearest of `count` names, or with all of them if
 * none is near: `unknown option "--ssp"; did you mean "--spp"?`. thing: what it is a name of
 * ("option"). prefix: of both names ("--"). */
VL_API void vl_unknown_name(const char *thing, const char *prefix, const char *name,
                            const char *const *names, size_t count,
                            char message[VL_GIVEN_MESSAGE]);
/** The nearest of `count` names by edit distance, or null if none is near. The letters' case
 * does not count. */
VL_API const char *vl_near_name(const char *name, const char *const *names, size_t count);

#ifdef __cplusplus
}
#endif
#endif
