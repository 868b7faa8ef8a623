/** @file
 * velo/velo.h: everything. A program reads: load, build, make, render, develop, write. */
#ifndef VELO_VELO_H
#define VELO_VELO_H

#include "velo/base.h"
#include "velo/boxes.h"
#include "velo/camera.h"
#include "velo/camera_file.h"
#include "velo/channels.h"
#include "velo/check.h"
#include "velo/export.h"
#include "velo/focus.h"
#include "velo/image.h"
#include "velo/render.h"
#include "velo/scene.h"
#include "velo/trajectory.h"
#include "velo/vanishing.h"

#endif
