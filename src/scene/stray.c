/* scene/stray.c: see stray.h. */
#include "scene/stray.h"

#include <math.h>
#include <string.h>

#include "scene/things.h"

enum { BINS = 1024, MAX_ROUNDS = 8, MAX_PASSES = 16 };

/* ---- the core ---------------------------------------------------------------------------- */

typedef struct Survey {
  vlExtent limits;                    /* things that are not inside do not count */
  vlExtent box;                       /* of all that count, needles without their tips */
  vlExtent whole;                     /* with the tips that are inside of the limits */
  vlExtent core;                      /* grows */
  double reach;                       /* what is no further from the core belongs to it */
  double histogram[3][BINS], surface; /* along each axis of `box`; sum */
  uint64_t outside;                   /* number of things that are not all inside of `limits` */
} Survey;

static void measure(void *user, const vlThing *thing) {
  Survey *s = user;
  const bool all = vl_extent_holds(&s->limits, &thing->box);
  if (!all)
    s->outside++;
  if (!vl_extent_holds(&s->limits, &thing->body))
    return;
  vl_extent_join(&s->box, &thing->body);
  vl_extent_join(&s->whole, all ? &thing->box : &thing->body);
}

static void weigh(void *user, const vlThing *thing) {
  Survey *s = user;
  const vlExtent *box = &thing->body;
  const double surface = thing->surface;
  if (!vl_extent_holds(&s->limits, box) || !(surface > 0) || !isfinite(surface))
    return;
  for (int i = 0; i < 3; i++) {
    const double size = vl_extent_size(&s->box, i),
                 at = 0.5 * (box->low[i] + box->high[i]) - s->box.low[i];
    const int bin = size > 0 ? (int)(at / size * BINS) : 0;
    s->histogram[i][bin < BINS ? bin : BINS - 1] += surface;
  }
  s->surface += surface;
}

/* Whether a box is within the core's reach: any of it, or with `all` the whole of it. */
static bool is_near(const Survey *s, const vlExtent *box, bool all) {
  bool near = true;
  for (int i = 0; i < 3; i++) {
    const double from = all ? box->low[i] : box->high[i], to = all ? box->high[i] : box->low[i];
    near = near && to <= s->core.high[i] + s->reach && from >= s->core.low[i] - s->reach;
  }
  return near;
}

/* A needle whose tip is far away may be the trace of a lone corner there; one whose other end
 * is far away is a part of something, such as a mast. */
static void absorb(void *user, const vlThing *thing) {
  Survey *s = user;
  if (!vl_extent_holds(&s->limits, &thing->body) || !is_near(s, &thing->box, false))
    return;
  vl_extent_join(&s->core, is_near(s, &thing->box, true) ? &thing->box : &thing->body);
}

/* The end of the core along an axis, from `bin` on in steps of `step`. */
static int core_end(const double histogram[BINS], double surface, int bin, int step) {
  const double share = 0.002;
  double sum = histogram[bin];
  while (!(sum > share * surface) && bin + step >= 0 && bin + step < BINS) {
    bin += step;
    sum += histogram[bin];
  }
  return bin;
}

static void find_core(Survey *s) {
  for (int i = 0; i < 3; i++) {
    const double size = vl_extent_size(&s->box, i);
    const int first = core_end(s->histogram[i], s->surface, 0, 1),
              last = core_end(s->histogram[i], s->surface, BINS - 1, -1);
    s->core.low[i] = s->box.low[i] + size * first / BINS;
    s->core.high[i] = s->box.low[i] + size * (last + 1) / BINS;
  }
}

static bool same(const vlExtent *a, const vlExtent *b) {
  return memcmp(a, b, sizeof *a) == 0;
}

/* Of what counts, the core and all that belongs to it become the limits. Returns whether
 * something that counted does not count any more. */
static bool narrow(const vlScene *scene, const vlExtent *boxes, Survey *s) {
  const vlExtent limits = s->limits;
  *s = (Survey){.limits = limits, .box = vl_extent_nothing, .whole = vl_extent_nothing};
  vl_things_visit(scene, boxes, measure, s);
  if (!isfinite(vl_extent_diagonal(&s->box)))
    return false;
  vl_things_visit(scene, boxes, weigh, s);
  if (!(s->surface > 0) || !isfinite(s->surface))
    return false;
  find_core(s);
  for (int pass = 0; pass < MAX_PASSES; pass++) {
    const vlExtent before = s->core;
    s->reach = vl_extent_diagonal(&s->core);
    if (is_near(s, &s->whole, true)) { /* all belongs to the core */
      s->limits = s->whole;
      return false;
    }
    vl_things_visit(scene, boxes, absorb, s);
    if (same(&before, &s->core))
      break;
  }
  for (int i = 0; i < 3; i++) {
    s->limits.low[i] = fmax(s->core.low[i], s->whole.low[i]);
    s->limits.high[i] = fmin(s->core.high[i], s->whole.high[i]);
  }
  return !same(&s->limits, &s->whole);
}

void vl_stray_limit(const vlScene *scene, vlExtent *boxes, uint64_t *count) {
  vlExtent *limits = &boxes[scene->groups.count];
  *count = 0;
  if (scene->frame_points.count || !vl_things_are_few(scene))
    return;
  Survey s = {.limits = *limits};
  bool some = false;
  for (int round = 0; round < MAX_ROUNDS && narrow(scene, boxes, &s); round++)
    some = true;
  if (!some)
    return;
  s.outside = 0;
  vl_things_visit(scene, boxes, measure, &s);
  *limits = s.limits;
  *count = s.outside;
}
