// web/lecture/drawings/vanish.js: vanishing points where they lie, outside the image: of the axes, with one, two or three of
// them, and of a direction that one chooses. Each axis has its own colour, line and mark.
import { add, dot, scale } from "../../vec.js";
import { arrow, box, circle, frameOf, label, line, onPlane, polygon, rectangle } from "../svg.js";

const SIZE = [900, 600], CENTRE = [450, 250], HALF = [120, 90];
const AXES = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], NAMES = "xyz";
const BOXES = [box([0, 0, 0], [200, 200, 200]), box([-250, 0, -150], [100, 150, 100]), box([250, 0, -150], [100, 90, 100]), box([-150, 0, 250], [90, 60, 90])];
const place = ([x, y]) => [CENTRE[0] + x, CENTRE[1] - y];

// The vanishing point of a direction, relative to the image's centre, y up; null: parallel to the view plane.
export function vanishes({ u, v, w }, d, direction) {
  const depth = -dot(direction, w);
  return Math.abs(depth) < 1e-9 ? null : [(d * dot(direction, u)) / depth, (d * dot(direction, v)) / depth];
}

function mark(axis, at) {
  const [x, y] = at;
  if (axis === 0) return circle(at, 8, "axis-x mark");
  if (axis === 1) return rectangle(x - 7, y - 7, 14, 14, "axis-y mark");
  return polygon([[x, y - 9], [x + 9, y + 7], [x - 9, y + 7]], "axis-z mark");
}

// The mark of a vanishing point with its name; one that is not on the drawing: an arrow at the edge towards it.
function vanishingMark(axis, point) {
  const at = place(point), inside = at[0] > 16 && at[0] < SIZE[0] - 16 && at[1] > 16 && at[1] < SIZE[1] - 16, name = NAMES[axis];
  if (inside) return mark(axis, at) + label([at[0] + 13, at[1] - 9], name, "name big");
  const away = [at[0] - CENTRE[0], at[1] - CENTRE[1]];
  const room = away.map((x, i) => (x > 0 ? SIZE[i] - CENTRE[i] : CENTRE[i]) - 22), k = Math.min(...room.map((x, i) => x / Math.abs(away[i] || 1e-9)));
  const end = [CENTRE[0] + k * away[0], CENTRE[1] + k * away[1]], start = [CENTRE[0] + 0.9 * k * away[0], CENTRE[1] + 0.9 * k * away[1]];
  return arrow(start, end, `axis-${name}`, 14) + label([start[0] + 12, start[1] - 8], name, "name big");
}

const POSES = { one: [0, 0], two: [40, 0], three: [38, 32] };

const vanishing = {
  size: SIZE,
  turns: true,
  state: { points: "three", azimuth: 38, elevation: 32, roll: 0, d: 190 },
  choices: { points: ["one", "two", "three"] },
  choose: (s, key, value) => ({ ...s, points: value, azimuth: POSES[value][0], elevation: POSES[value][1] }),
  camera({ azimuth, elevation, roll }) {
    const a = (azimuth * Math.PI) / 180, e = (elevation * Math.PI) / 180, target = [0, 90, 0];
    const eye = add(target, scale([Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)], 640));
    return { eye, frame: frameOf(eye, target, [0, 1, 0], roll) };
  },
  points(s) {
    const { frame } = this.camera(s);
    return AXES.map((axis) => vanishes(frame, s.d, axis));
  },
  draw(s, say) {
    const { eye, frame } = this.camera(s), all = this.points(s), image = (p) => onPlane(p, eye, frame, s.d);
    const [x, y] = [CENTRE[0] - HALF[0], CENTRE[1] - HALF[1]];
    let lines = "", edges = "";
    if (all[0] && all[2]) lines += line(place(all[0]), place(all[2]), "horizon") + label([SIZE[0] - 12, (all[0][1] + all[2][1]) / -2 + CENTRE[1] + 18], say("horizon", "orizzonte"), "small", "end");
    BOXES.forEach((b, k) => {
      for (const { axis, a, b: to } of b.edges) {
        const [p, q] = [image(b.corners[a]), image(b.corners[to])];
        if (!p || !q) continue;
        edges += line(place(p), place(q), `axis-${NAMES[axis]}`);
        const point = all[axis];
        if (k || !point) continue;
        const near = Math.hypot(p[0] - point[0], p[1] - point[1]) < Math.hypot(q[0] - point[0], q[1] - point[1]) ? p : q;
        lines += line(place(near), place(point), `axis-${NAMES[axis]} to-point`);
      }
    });
    const clip = `<clipPath id="vanishing-clip"><rect x="${x}" y="${y}" width="${2 * HALF[0]}" height="${2 * HALF[1]}"/></clipPath>`;
    let html = clip + rectangle(x, y, 2 * HALF[0], 2 * HALF[1], "window") + lines + `<g clip-path="url(#vanishing-clip)">${edges}</g>`;
    html += all.map((point, axis) => (point ? vanishingMark(axis, point) : "")).join("");
    html += label([x, y - 6], say("the image", "l'immagine"), "small") + label([14, 26], `${say("vanishing points", "punti di fuga")}: ${all.filter(Boolean).length}`, "name");
    const parallel = all.map((point, axis) => (point ? "" : NAMES[axis])).filter(Boolean).join(", ");
    return html + (parallel ? label([14, 50], `${say("parallel to the view plane", "parallele al view plane")}: ${parallel}`, "") : "");
  },
  drag: (s, name, [dx, dy]) => ({ ...s, points: "", azimuth: s.azimuth - 0.3 * dx, elevation: s.elevation + 0.3 * dy }),
  numbers(s, w) {
    return this.points(s).map((point, axis) => `${NAMES[axis]}: ${point ? w.vector(point, 1) : "∞"}`);
  },
};

// Six lines of one direction, from points before the eye: property 4 where v_z is 0, property 5 elsewhere.
const STARTS = [[-110, -70, 250], [-20, -80, 250], [70, -50, 250], [80, 50, 250], [-30, 70, 250], [-100, 20, 250]];

const direction = {
  size: [720, 440],
  state: { v_x: -1, v_y: 0.75, v_z: -5, d: 300 },
  draw(s, say) {
    const v = [s.v_x, s.v_y, s.v_z], eye = [0, 0, 500], frame = { u: [1, 0, 0], v: [0, 1, 0], w: [0, 0, 1] }, middle = [360, 220];
    const at = (p) => p && [middle[0] + p[0], middle[1] - p[1]], point = s.v_z ? vanishes(frame, s.d, v) : null;
    let html = rectangle(middle[0] - 200, middle[1] - 150, 400, 300, "window") + label([middle[0] - 200, middle[1] - 156], say("the image", "l'immagine"), "small");
    const far = s.v_z > 0 ? scale(v, -1) : v; // the way that leads away from the eye
    for (const start of STARTS) {
      const ends = s.v_z ? [start, add(start, scale(far, 2000))] : [add(start, scale(v, -400)), add(start, scale(v, 400))];
      const [a, b] = ends.map((p) => onPlane(p, eye, frame, s.d));
      html += line(at(a), at(b), "axis-x") + (point && Math.hypot(...point) < 4000 ? line(at(b), at(point), "axis-x to-point") : "");
      if (s.v_z) html += circle(at(onPlane(start, eye, frame, s.d)), 4, "dot");
    }
    if (point && Math.abs(point[0]) < 350 && Math.abs(point[1]) < 210) html += mark(0, at(point)) + label([at(point)[0] + 13, at(point)[1] - 9], say("vanishing point", "punto di fuga"), "name");
    else html += label([14, 26], point ? say("the vanishing point lies outside this drawing", "il punto di fuga è fuori da questo disegno") : say("parallel to the view plane: no vanishing point", "parallele al view plane: nessun punto di fuga"), "name");
    return html;
  },
  numbers(s, w) {
    if (!s.v_z) return ["v_z = 0"];
    const one = (name, value) => `${name} = −d v_${name} / v_z = −${w.number(s.d)} · (${w.number(value)}) / (${w.number(s.v_z)}) = ${w.number((-s.d * value) / s.v_z, 1)}`;
    return [one("x", s.v_x), one("y", s.v_y)];
  },
};

export const vanishDrawings = { vanishing, direction };
