/** @file
 * velo/edit.h: changes to a scene between two builds. A program changes some objects, builds
 * again with vlBuildDef.previous and renders the new world, which shares all that has not
 * changed with the previous one.
 *
 * Rules for all calls that change a scene: the checks are those of the vl_scene_add_* call of
 * the object. After an error the scene is unchanged, and vl_scene_result does not report the
 * error. Worlds that were built before do not change. Errors: ARGUMENT (no such id, the scene
 * has an error, a def without cookie), SCENE, MEMORY.
 *
 * What an earlier change of an object has allocated is freed, so a scene does not grow however
 * often its objects are set. */
#ifndef VELO_EDIT_H
#define VELO_EDIT_H

#include "velo/base.h"
#include "velo/scene_base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The def of an object, with defaults in the members that its kind does not use; null if there
 * is no such id or the object was removed. It and what it points at belong to the scene and are
 * valid until the scene is changed. To change an object: copy its def, change the copy, pass it
 * to the vl_scene_set_* call. */
VL_API const vlTextureDef *vl_scene_texture(const vlScene *scene, vlTextureId id);
/** As vl_scene_texture. */
VL_API const vlMaterialDef *vl_scene_material(const vlScene *scene, vlMaterialId id);
/** As vl_scene_texture. */
VL_API const vlEmissionDef *vl_scene_emission(const vlScene *scene, vlEmissionId id);
/** As vl_scene_texture. An environment is a light of kind VL_LIGHT_INFINITE. */
VL_API const vlLightDef *vl_scene_light(const vlScene *scene, vlLightId id);
/** As vl_scene_texture. */
VL_API const vlMediumDef *vl_scene_medium(const vlScene *scene, vlMediumId id);
/** As vl_scene_texture. The arrays are null after vl_world_build_last. */
VL_API const vlShapeDef *vl_scene_shape(const vlScene *scene, vlShapeId id);

/** An instance of a scene. */
typedef struct vlInstanceInfo {
  vlGroupId group; /**< what it places */
  /** its pose; of a moving instance: the pose at its first time */
  double world_from_group[16];
  bool moves;          /**< it has several poses */
  uint32_t keys;       /**< number of poses of a moving instance; 0: it is at rest */
  const double *times; /**< their times in seconds, ascending; null: it is at rest */
  /** 16 numbers of each pose, world_from_group; null: it is at rest. Between the times it moves
   * as vl_scene_add_moving_instance says. */
  const double *poses;
  bool shown;      /**< it is in the worlds that are built from now on */
  vlSource source; /**< where the file describes it */
  vlLabel label;   /**< what the file calls it */
} vlInstanceInfo;
/** Fills *info; its strings and arrays belong to the scene and are valid until the scene is
 * changed. ARGUMENT: there is no such instance, or it was removed. */
VL_API vlResult vl_scene_instance(const vlScene *scene, vlInstanceId id, vlInstanceInfo *info);

/** Replaces a texture. Its inputs must have lower ids than its own; it stays a float or a
 * colour texture. */
VL_API vlResult vl_scene_set_texture(vlScene *scene, vlTextureId id, const vlTextureDef *def,
                                     vlError *error);
/** Replaces a material. The parts of a mix must have lower ids than its own. */
VL_API vlResult vl_scene_set_material(vlScene *scene, vlMaterialId id, const vlMaterialDef *def,
                                      vlError *error);
/** Replaces an emission. */
VL_API vlResult vl_scene_set_emission(vlScene *scene, vlEmissionId id, const vlEmissionDef *def,
                                      vlError *error);
/** Replaces a light. */
VL_API vlResult vl_scene_set_light(vlScene *scene, vlLightId id, const vlLightDef *def,
                                   vlError *error);
/** Replaces a medium. */
VL_API vlResult vl_scene_set_medium(vlScene *scene, vlMediumId id, const vlMediumDef *def,
                                    vlError *error);
/** Shows or hides a light; lights are shown at first. */
VL_API vlResult vl_scene_show_light(vlScene *scene, vlLightId id, bool shown, vlError *error);

/** Replaces a shape: its arrays, its kind, its transform, its group. A def that keeps arrays of
 * the shape's own (vl_scene_shape) may point at them. The next world compiles the shape again,
 * and the accelerator of its group. A removed shape is there again, as a new one with its id.
 * Errors: as above; the arrays are copied before the old ones are freed. */
VL_API vlResult vl_scene_set_shape(vlScene *scene, vlShapeId id, const vlShapeDef *def,
                                   vlError *error);
/** Removes a shape and frees its arrays. Ids of other objects do not change; its own stays free
 * until vl_scene_set_shape gives it to another shape. */
VL_API vlResult vl_scene_remove_shape(vlScene *scene, vlShapeId id, vlError *error);
/** The lowest id of a removed shape; index 0: there is none. A program that removes and adds
 * shapes in a loop sets it, so that the scene does not grow. */
VL_API vlShapeId vl_scene_removed_shape(const vlScene *scene);
/** A number by which a shape is told from others that had its id before: 0 for the first one,
 * and if there is no such shape. */
VL_API uint64_t vl_scene_shape_serial(const vlScene *scene, vlShapeId id);

/** The kinds of objects that have ids. */
typedef enum vlSceneFamily {
  VL_SCENE_TEXTURES,  /**< vlTextureId, vlTextureDef */
  VL_SCENE_MATERIALS, /**< vlMaterialId, vlMaterialDef */
  VL_SCENE_MEDIA,     /**< vlMediumId, vlMediumDef */
  VL_SCENE_EMISSIONS, /**< vlEmissionId, vlEmissionDef */
  VL_SCENE_LIGHTS,    /**< vlLightId, vlLightDef */
  VL_SCENE_SHAPES,    /**< vlShapeId, vlShapeDef */
  VL_SCENE_GROUPS,    /**< vlGroupId; no def */
  VL_SCENE_INSTANCES  /**< vlInstanceId; no def */
} vlSceneFamily;
/** Removes an object of any family and frees what it points at. Ids of other objects do not
 * change. The shapes of a group are removed with it. Errors: SCENE: another object, which the
 * message names, still uses it (a material its textures, an instance its group, ...); ARGUMENT,
 * MEMORY. */
VL_API vlResult vl_scene_remove(vlScene *scene, vlSceneFamily family, uint32_t index,
                                vlError *error);
/** Whether the scene has this object: it was added and not removed. */
VL_API bool vl_scene_has(const vlScene *scene, vlSceneFamily family, uint32_t index);
/** No object of this family has a higher index; 0: there is none. Removed ones may have it and
 * lower ones. */
VL_API uint32_t vl_scene_highest(const vlScene *scene, vlSceneFamily family);
/** The lowest index of a removed object whose id a new one can take by vl_scene_set_*; 0:
 * there is none. def: of the new object, of the family's type, or null; what it refers to in
 * its own family has lower ids. For instances see vl_scene_fill_instance. A program that
 * removes and adds objects in a loop sets them, so that the scene does not grow. */
VL_API uint32_t vl_scene_removed(const vlScene *scene, vlSceneFamily family, const void *def);
/** A number by which an object is told from others that had its id before: 0 for the first one,
 * and if there is no such object. */
VL_API uint64_t vl_scene_serial(const vlScene *scene, vlSceneFamily family, uint32_t index);
/** Gives a group another name, which is copied (null: none). A removed group is there again, as
 * a new and empty one with its id. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_set_group(vlScene *scene, vlGroupId id, const char *name,
                                   vlError *error);

/** Gives a shape another material; index 0: the default material. */
VL_API vlResult vl_scene_set_shape_material(vlScene *scene, vlShapeId id, vlMaterialId material,
                                            vlError *error);
/** Gives a shape another emission; index 0: none. */
VL_API vlResult vl_scene_set_shape_emission(vlScene *scene, vlShapeId id, vlEmissionId emission,
                                            vlError *error);
/** Shows or hides a shape, also in all instances of its group; shapes are shown at first. Ids
 * of objects do not change. */
VL_API vlResult vl_scene_show_shape(vlScene *scene, vlShapeId id, bool shown, vlError *error);

/** Moves an instance, which is then at rest. */
VL_API vlResult vl_scene_set_instance(vlScene *scene, vlInstanceId id,
                                      const double world_from_group[16], vlError *error);
/** Shows or hides an instance; instances are shown at first. Hidden instances have no
 * id.instance: the ids of those after them are lower by 1. */
VL_API vlResult vl_scene_show_instance(vlScene *scene, vlInstanceId id, bool shown,
                                       vlError *error);
/** Removes an instance for good; its id is given again by vl_scene_fill_instance only. */
VL_API vlResult vl_scene_remove_instance(vlScene *scene, vlInstanceId id, vlError *error);
/** Gives the instance that was added last the lowest id of those that were removed, so
 * that a program that removes and adds instances in a loop does not make the scene grow.
 * Returns its id, which is its old one if none was removed; index 0: there is no instance, or
 * the last one is removed. */
VL_API vlInstanceId vl_scene_fill_instance(vlScene *scene);
/** As vl_scene_shape_serial. */
VL_API uint64_t vl_scene_instance_serial(const vlScene *scene, vlInstanceId id);

/** Moves, turns and scales everything that the scene describes, so that a camera that is moved
 * in the same way (vl_camera_move with world_from_scene times its pose, which also scales its
 * lens) sees the same image: shapes, instances, lights, portals, media, textures. Lengths are
 * scaled, coefficients of media and of subsurface materials are divided by the scale,
 * intensities and powers are multiplied by its square. The scene's own camera and the lengths
 * in vlSceneDefs stay. world_from_scene: a rotation, a uniform scale above 0 and a translation.
 * If it scales, float textures are added for the heights of bump maps. Errors: ARGUMENT: it is
 * another matrix, or as above; MEMORY: the scene is changed in part, and vl_scene_result
 * reports it. */
VL_API vlResult vl_scene_transform(vlScene *scene, const double world_from_scene[16],
                                   vlError *error);

/** What a scene holds at a moment. */
typedef struct vlSceneCheckpoint vlSceneCheckpoint;
/** Takes a checkpoint of a scene, so that a failed vl_scene_add_*, vl_scene_load,
 * vl_scene_load_group or vl_scene_complete can be taken back. ARGUMENT, MEMORY. */
VL_API vlResult vl_scene_checkpoint(const vlScene *scene, vlSceneCheckpoint **checkpoint,
                                    vlError *error);
/** Removes what was added since the checkpoint, with its memory, sets defs and the scene's
 * error as they were then, and destroys the checkpoint. Between the two, things may be added
 * (or fail to be), not changed, and no world may be built with vl_world_build_last. Ids that
 * were given since are given again. Allocates nothing. */
VL_API void vl_scene_roll_back(vlScene *scene, vlSceneCheckpoint *checkpoint);
/** Frees a checkpoint that is not needed; the scene keeps what it has. Null is allowed. */
VL_API void vl_scene_checkpoint_destroy(vlSceneCheckpoint *checkpoint);

#ifdef __cplusplus
}
#endif
#endif
