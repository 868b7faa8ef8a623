/** @file
 * velo/scene.h: the editable description of a world. A scene file or a program adds textures,
 * materials, media, lights and shapes to it; everything is copied. A scene keeps its first
 * error: from then on every vl_scene_add_* returns an id of index 0, and vl_scene_result
 * returns the error; vl_scene_roll_back (velo/edit.h) takes what failed back. A scene is not
 * thread-safe. */
#ifndef VELO_SCENE_H
#define VELO_SCENE_H

#include "velo/base.h"
#include "velo/camera.h"
#include "velo/filter.h"
#include "velo/filter_kinds.h"
#include "velo/image.h"
#include "velo/light.h"
#include "velo/load.h"
#include "velo/material.h"
#include "velo/medium.h"
#include "velo/sampler.h"
#include "velo/scene_base.h"
#include "velo/shape.h"
#include "velo/spectrum.h"
#include "velo/texture.h"
#include "velo/tracer.h"

#endif
