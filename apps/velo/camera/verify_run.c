/* camera/verify_run.c: poses of the board that cover the image. Each is rendered; its corners
 * are found and compared. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "camera/verify.h"
#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"
#include "render/output_names.h"
#include "velo/filter_kinds.h"
#include "velo/render.h"
#include "velo/sampler.h"

enum {
  TRIES = 400, /* places of the board per pose */
  ROOM = 4096, /* corners found in one image */
  MARGIN = 3   /* pixels around a window that must be visible, too */
};
/* Windows for the refinement of a corner, pixels: at most so wide, and as much of the distance
 * to the next lines as has no other edge (of a charuco board the markers are nearer). */
static const double max_reach = 8.0, min_reach = 4.5, blurred = 1.5;
static const double free_share = 0.8, free_share_of_charuco = 0.27;
/* How far a straight line through the window may bend, as a share of its radius. */
static const double max_bend = 0.04;

typedef struct Expected {
  int i, j;
  double point[3], x, y; /* world space; film point by the rendering camera */
  double apart;          /* distance to the next line of corners, pixels */
  double reach;          /* radius of the window, pixels */
  bool found;
  Corner corner;
} Expected;

typedef struct Pose {
  const Verification *v;
  Placement placement;
  Expected expected[MAX_TARGET_SIDE * MAX_TARGET_SIDE];
  int count;
  uint32_t crop[4];
} Pose;

/* Whether the window around (x, y) lies in the image, has rays everywhere and shows straight
 * lines as nearly straight. It does not at seams of maps of the sphere and at poles. */
static bool in_one_piece(const vlCamera *c, double x, double y, double radius) {
  for (int k = 0; k < 8; k++) {
    double middle[3] = {0, 0, 0}, o[3], d[3], pixel[2], z;
    for (int side = 0; side < 2; side++) {
      double r = side ? -radius : radius, px = x + r * cos(M_PI * k / 8.0),
             py = y + r * sin(M_PI * k / 8.0);
      if (!(px >= 0.0 && py >= 0.0 && px <= c->width && py <= c->height))
        return false;
      if (!vl_camera_unproject(c, px, py, o, d))
        return false;
      for (int a = 0; a < 3; a++)
        middle[a] += 0.5 * (o[a] + d[a]);
    }
    if (!vl_camera_project(c, middle, pixel, &z))
      return false;
    double off = (pixel[1] - y) * cos(M_PI * k / 8.0) - (pixel[0] - x) * sin(M_PI * k / 8.0);
    if (!(fabs(off) < max_bend * radius))
      return false;
  }
  return true;
}

static bool project_corner(const Pose *pose, double i, double j, double point[3],
                           double pixel[2]) {
  double z;
  target_point(&pose->v->target, &pose->placement, i, j, point);
  return vl_camera_project(&pose->v->camera, point, pixel, &z);
}

/* Sets the crop: what the corners that are expected and their surroundings need; all of the
 * image if it is kept. */
static void crop_around(Pose *pose) {
  const Verification *v = pose->v;
  double box[4] = {v->camera.width, v->camera.height, 0, 0};
  for (int k = 0; k < pose->count; k++) {
    const Expected *e = &pose->expected[k];
    double around = fmax(16.0, e->apart);
    box[0] = fmin(box[0], e->x - around);
    box[1] = fmin(box[1], e->y - around);
    box[2] = fmax(box[2], e->x + around);
    box[3] = fmax(box[3], e->y + around);
  }
  if (v->keep || pose->count == 0) {
    box[0] = box[1] = 0;
    box[2] = v->camera.width;
    box[3] = v->camera.height;
  }
  for (int a = 0; a < 4; a++) {
    double size = a % 2 ? v->camera.height : v->camera.width;
    pose->crop[a] = (uint32_t)fmin(fmax(a < 2 ? floor(box[a]) : ceil(box[a]), 0.0), size);
  }
}

/* Lists the corners that the image should show completely, with the radius of their windows. */
static void expect_corners(Pose *pose) {
  const Verification *v = pose->v;
  pose->count = 0;
  for (int j = 1; j <= v->target.corners; j++)
    for (int i = 1; i <= v->target.corners; i++) {
      Expected e = {.i = i, .j = j};
      double at[2], side[4][2], other[3], apart = INFINITY;
      if (!project_corner(pose, i, j, e.point, at) ||
          !project_corner(pose, i + 1, j, other, side[0]) ||
          !project_corner(pose, i, j + 1, other, side[1]) ||
          !project_corner(pose, i - 1, j, other, side[2]) ||
          !project_corner(pose, i, j - 1, other, side[3]))
        continue;
      for (int k = 0; k < 4; k++) {
        double ax = side[k][0] - at[0], ay = side[k][1] - at[1];
        double bx = side[(k + 1) % 4][0] - at[0], by = side[(k + 1) % 4][1] - at[1];
        double area = fabs(ax * by - ay * bx);
        apart = fmin(apart, area / fmax(fmax(hypot(ax, ay), hypot(bx, by)), 1e-9));
      }
      e.x = at[0];
      e.y = at[1];
      e.apart = apart;
      double share = v->target.charuco ? free_share_of_charuco : free_share;
      e.reach = fmin(max_reach, share * apart - blurred);
      if (e.reach < min_reach || !in_one_piece(&v->camera, e.x, e.y, e.reach + MARGIN))
        continue;
      pose->expected[pose->count++] = e;
    }
  crop_around(pose);
}

/* Chooses a pose that shows at least four corners. The film points cover the image evenly (the
 * R2 sequence). */
static bool choose_pose(Pose *pose, uint32_t *sequence, Random *random) {
  const Verification *v = pose->v;
  for (int attempt = 0; attempt < TRIES; attempt++) {
    uint32_t n = ++*sequence;
    double x = fmod(0.5 + n * 0.75487766624669276, 1.0) * v->camera.width;
    double y = fmod(0.5 + n * 0.56984029099805327, 1.0) * v->camera.height;
    if (!target_place(&v->target, &v->camera, x, y, v->side, random, &pose->placement))
      continue;
    expect_corners(pose);
    if (pose->count >= 4)
      return true;
  }
  return false;
}

static vlResult render(const Pose *pose, vlContext *context, vlImage **image, vlError *error) {
  const Verification *v = pose->v;
  vlWorld *world = NULL;
  vlFilmDef film_def = vl_default_film_def(v->camera.width, v->camera.height);
  memcpy(film_def.crop, pose->crop, sizeof film_def.crop);
  film_def.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  vlRenderDef def = vl_default_render_def();
  def.spp = v->spp;
  def.seed = (uint32_t)v->seed;
  def.max_depth = 0; /* only emission is visible */
  def.sampler = VL_SAMPLER_MULTI_JITTERED;
  vlResult result = target_build(context, &v->target, &pose->placement, &world, error);
  if (result == VL_OK)
    result = image_render(context, world, &v->camera, &film_def, &def, NULL, image, error);
  vl_world_destroy(world);
  return result;
}

/* Assigns detections to expected corners: each takes the strongest saddle point near it, then
 * its refined position. */
static void match(Pose *pose, const Image *rendered, const Corner *corners, int count) {
  for (int k = 0; k < pose->count; k++) {
    Expected *e = &pose->expected[k];
    double x = e->x - pose->crop[0], y = e->y - pose->crop[1], near = fmax(3.0, 0.4 * e->apart);
    int best = -1;
    for (int c = 0; c < count; c++)
      if (hypot(corners[c].x - x, corners[c].y - y) < near &&
          (best < 0 || corners[c].strength > corners[best].strength))
        best = c;
    if (best < 0)
      continue;
    e->corner = corners[best];
    e->found = corner_refine(rendered, e->reach, &e->corner);
  }
}

static const Expected *corner_at(const Pose *pose, int i, int j) {
  for (int k = 0; k < pose->count; k++)
    if (pose->expected[k].i == i && pose->expected[k].j == j && pose->expected[k].found)
      return &pose->expected[k];
  return NULL;
}

/* Counts the markers whose four corners were found, and those of them that are wrong. */
static void read_markers(const Pose *pose, const Image *rendered, Measure *m) {
  for (int j = 1; j < pose->v->target.corners; j++)
    for (int i = 1; i < pose->v->target.corners; i++) {
      double at[4][2];
      int there = 0;
      for (int k = 0; k < 4; k++) {
        const Expected *e = corner_at(pose, i + k % 2, j + k / 2);
        if (!e)
          break;
        at[k][0] = e->corner.x;
        at[k][1] = e->corner.y;
        there++;
      }
      int read = there == 4 ? target_read_marker(&pose->v->target, i, j, rendered, at) : -1;
      m->markers += read >= 0;
      m->misread += read == 0;
    }
}

/* Adds up how far the corners that were found are from where the model's formula has them. csv:
 * gets a line for each; may be null. */
static void compare(const Pose *pose, uint32_t index, Verification *v, FILE *csv) {
  Measure *m = &v->each[index];
  m->pose = index;
  for (int k = 0; k < pose->count; k++) {
    const Expected *e = &pose->expected[k];
    m->expected++;
    if (!e->found)
      continue;
    m->found++;
    double x = e->corner.x + pose->crop[0], y = e->corner.y + pose->crop[1], at[2] = {0, 0};
    v->covered[(int)(COVERAGE * y / v->camera.height)][(int)(COVERAGE * x / v->camera.width)] =
        true;
    bool seen = verify_project(&v->model, e->point, at);
    if (csv)
      fprintf(csv, "%u,%d,%d,%.9g,%.9g,%.9g,%.17g,%.17g,%.17g,%.17g,%d\n", index, e->i, e->j,
              e->point[0], e->point[1], e->point[2], x, y, at[0], at[1], seen);
    if (!seen) {
      m->unseen++;
      continue;
    }
    double dx = x - at[0], dy = y - at[1], d = hypot(dx, dy);
    m->sum += d;
    m->sum2 += d * d;
    m->sum_x += dx;
    m->sum_y += dy;
    if (d >= m->max) {
      m->max = d;
      m->at_x = x;
      m->at_y = y;
    }
  }
}

static void add_up(Measure *all, const Measure *m) {
  all->expected += m->expected;
  all->found += m->found;
  all->unseen += m->unseen;
  all->markers += m->markers;
  all->misread += m->misread;
  all->sum += m->sum;
  all->sum2 += m->sum2;
  all->sum_x += m->sum_x;
  all->sum_y += m->sum_y;
  if (m->found && m->max >= all->max) {
    all->max = m->max;
    all->at_x = m->at_x;
    all->at_y = m->at_y;
    all->pose = m->pose;
  }
}

/* Writes one channel without alpha, for corner finders of other programs. */
static vlResult keep_image(vlContext *context, const char *folder, uint32_t index,
                           const Image *rendered, vlError *error) {
  char path[4096];
  vlImage *image = NULL;
  vlResult result = image_make(context, (uint32_t)rendered->width, (uint32_t)rendered->height,
                               1, NULL, &image);
  text_set(path, "%s/pose_%03u.png", folder, index);
  if (result == VL_OK) {
    memcpy(vl_image_pixels(image), rendered->pixels,
           (size_t)rendered->width * (size_t)rendered->height * sizeof *rendered->pixels);
    result = vl_image_write(image, path, NULL, error);
  }
  vl_image_destroy(image);
  return result;
}

/* Renders one pose, finds its corners and compares them. Returns -1 or the exit code. */
static int measure_pose(Pose *pose, uint32_t index, Verification *v, vlContext *context,
                        FILE *csv) {
  static Corner corners[ROOM];
  vlImage *image = NULL;
  vlError error = {0};
  vlResult result = render(pose, context, &image, &error);
  int width = (int)crop_width(pose->crop), height = (int)crop_height(pose->crop);
  float *red = result == VL_OK ? malloc((size_t)width * (size_t)height * sizeof *red) : NULL;
  if (result == VL_OK && !red)
    result = VL_ERROR_MEMORY;
  if (result == VL_OK) {
    const float *pixels = vl_image_const_pixels(image);
    uint32_t channels = vl_image_channels(image);
    for (size_t k = 0; k < (size_t)width * (size_t)height; k++)
      red[k] = pixels[channels * k];
    Image rendered = {width, height, red};
    int count = corners_find(&rendered, corners, ROOM);
    if (count < 0)
      result = VL_ERROR_MEMORY;
    if (count >= 0 && v->keep)
      result = keep_image(context, v->keep, index, &rendered, &error);
    match(pose, &rendered, corners, count);
    compare(pose, index, v, csv);
    read_markers(pose, &rendered, &v->each[index]);
    add_up(&v->all, &v->each[index]);
  }
  free(red);
  vl_image_destroy(image);
  return report_error(&error, result, v->keep);
}

/* Checks the names of all files that are kept. Returns -1 or the exit code. */
static int check_kept(const Verification *v, vlContext *context) {
  char path[4096];
  OutputNames names = {0};
  for (uint32_t i = 0; i <= v->poses; i++) {
    if (i < v->poses)
      text_set(path, "%s/pose_%03u.png", v->keep, i);
    else
      text_set(path, "%s/corners.csv", v->keep);
    output_names_add(&names, path, VL_OUTPUT_PLAIN);
  }
  return output_names_check(&names, context);
}

/* Writes the table of corners, which was composed in memory. Returns -1 or the exit code. */
static int keep_table(vlContext *context, const char *folder, const char *text, size_t size) {
  char path[4096];
  vlError error = {0};
  text_set(path, "%s/corners.csv", folder);
  vlResult result = text ? vl_write_file(context, path, text, size, &error) : VL_ERROR_MEMORY;
  return report_error(&error, result, path);
}

int verify_run(Verification *v, vlContext *context) {
  Pose pose = {.v = v};
  Random random = {v->seed};
  uint32_t sequence = (uint32_t)(1000.0 * random_unit(&random));
  char *table = NULL;
  size_t size = 0;
  int status = v->keep ? check_kept(v, context) : -1;
  if (status >= 0)
    return status;
  FILE *csv = v->keep ? open_memstream(&table, &size) : NULL;
  if (csv)
    fprintf(csv, "pose,i,j,x,y,z,found_u,found_v,u,v,valid\n");
  v->side = target_choose(&v->target, &v->camera);
  for (uint32_t i = 0; i < v->poses && status < 0 && choose_pose(&pose, &sequence, &random);
       i++) {
    v->placed++;
    status = measure_pose(&pose, i, v, context, csv);
  }
  bool whole = csv && fclose(csv) == 0;
  if (v->keep && status < 0)
    status = keep_table(context, v->keep, whole ? table : NULL, size);
  free(table);
  return status;
}
