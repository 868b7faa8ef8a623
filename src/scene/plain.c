/* scene/plain.c: see plain.h. */
#include "scene/plain.h"

#include <math.h>

#include "scene/things.h"

typedef struct Survey {
  vlExtent limits;
  int axis;
  double top; /* of the lowest tenth */
  vlExtent low, model;
  double surface, flat; /* of what is low; of what lies flat of that */
} Survey;

static double widest(const vlExtent *box, int axis) {
  return fmax(vl_extent_size(box, (axis + 1) % 3), vl_extent_size(box, (axis + 2) % 3));
}

static void visit(void *user, const vlThing *thing) {
  Survey *s = user;
  const vlExtent *box = &thing->box;
  const double surface = thing->surface;
  if (!vl_extent_holds(&s->limits, box))
    return;
  const bool low = box->high[s->axis] <= s->top;
  vl_extent_join(low ? &s->low : &s->model, box);
  if (low && surface > 0)
    s->surface += surface;
  if (low && surface > 0 && vl_extent_size(box, s->axis) <= 0.15 * widest(box, s->axis))
    s->flat += surface;
}

static bool find(const vlScene *scene, const vlExtent *boxes, int axis, vlPlain *plain) {
  const double tenth = 0.1, max = 0.9, wide = 8, covered = 0.3, around = 0.25;
  vlExtent whole = vl_extent_nothing;
  if (scene->frame_points.count || !vl_things_are_few(scene))
    return false;
  vl_extent_visit(scene, boxes, NULL, vl_extent_grow, &whole);
  const double height = vl_extent_size(&whole, axis);
  if (!(height > 0) || !isfinite(height))
    return false;
  Survey s = {.limits = boxes[scene->groups.count],
              .axis = axis,
              .top = whole.low[axis] + tenth * height,
              .low = vl_extent_nothing,
              .model = vl_extent_nothing};
  vl_things_visit(scene, boxes, visit, &s);
  if (!(s.flat > max * s.surface) || !(s.model.low[0] <= s.model.high[0]))
    return false;
  const double model = fmax(widest(&s.model, axis), vl_extent_size(&s.model, axis));
  const double footprint =
      vl_extent_size(&s.low, (axis + 1) % 3) * vl_extent_size(&s.low, (axis + 2) % 3);
  if (!(widest(&s.low, axis) >= wide * model) || !(s.flat >= covered * footprint))
    return false;
  plain->model = plain->shown = s.model;
  for (int i = 0; i < 3; i++) {
    if (i == axis)
      continue;
    plain->shown.low[i] = fmax(s.model.low[i] - around * model, s.low.low[i]);
    plain->shown.high[i] = fmin(s.model.high[i] + around * model, s.low.high[i]);
  }
  plain->shown.low[axis] = s.low.low[axis];
  return plain->shown.low[0] <= plain->shown.high[0] &&
         plain->shown.low[1] <= plain->shown.high[1] &&
         plain->shown.low[2] <= plain->shown.high[2];
}

const vlPlain *vl_plain_search(const vlScene *scene, const vlExtent *boxes, int axis,
                               vlPlains *plains) {
  if (!plains->searched[axis])
    plains->found[axis] = find(scene, boxes, axis, &plains->plain[axis]);
  plains->searched[axis] = true;
  return plains->found[axis] ? &plains->plain[axis] : NULL;
}
