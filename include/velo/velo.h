/** @file
 * velo/velo.h: includes every public header. A program loads a scene, builds the world, makes the camera, renders,
 * develops the film and writes the image. */
#ifndef VELO_VELO_H
#define VELO_VELO_H

#include "velo/base.h"
#include "velo/boxes.h"
#include "velo/camera.h"
#include "velo/camera_file.h"
#include "velo/channels.h"
#include "velo/check.h"
#include "velo/choose.h"
#include "velo/color.h"
#include "velo/confine.h"
#include "velo/denoise.h"
#include "velo/drawing.h"
#include "velo/edit.h"
#include "velo/export.h"
#include "velo/film.h"
#include "velo/focus.h"
#include "velo/group.h"
#include "velo/image.h"
#include "velo/own.h"
#include "velo/paths.h"
#include "velo/receipt.h"
#include "velo/render.h"
#include "velo/scene.h"
#include "velo/trace.h"
#include "velo/trajectory.h"
#include "velo/upgrade.h"
#include "velo/vanishing.h"

#endif
