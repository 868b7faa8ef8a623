/* program/program.h: what a program needs around a renderer: the command line (command.h), the list of what it has, the
 * files of images, memory, a tree that finds the same hits sooner. Nothing here decides the colour of a pixel. */
#pragma once
#include "world.h"

/* check.c: whether the renderer has all that a scene asks for; else an error with the name and the place of the first
 * thing that it does not have. */
bool check_scene(vlContext *context, vlScene *scene, const vlCamera *camera, vlError *error);

/* accelerator.c: makes the tree of boxes. */
void make_accelerator(world *w);
