// web/lecture/sliders.js: the sliders of a live figure, and what each of them sets in a camera
// { eye, lookat, up, d, zoom, s, roll, near, far, fov, panini }.

// Lengths and factors are spread evenly in their logarithm.
const LOGARITHMIC = ["d", "zoom", "s", "far"];
const COORDINATE = { x: 0, y: 1, z: 2 };

// "d:100..2000,projection" gives [{ name, min, max, logarithmic }, { name }]: without a range, a choice.
export function parseSliders(text) {
  return text.split(",").filter(Boolean).map((word) => {
    const match = word.match(/^(\w+)(?::(-?[\d.]+)\.\.(-?[\d.]+))?$/);
    if (!match) throw new Error(`'${word}' is not NAME:MIN..MAX`);
    if (match[2] === undefined) return { name: match[1] };
    const [min, max] = [Number(match[2]), Number(match[3])];
    return { name: match[1], min, max, logarithmic: LOGARITHMIC.includes(match[1]) && min > 0 };
  });
}

// Between a slider's position, 0 to 1, and its value.
export function valueAt({ min, max, logarithmic }, position) {
  return logarithmic ? min * (max / min) ** position : min + (max - min) * position;
}

export function positionOf({ min, max, logarithmic }, value) {
  const position = logarithmic ? Math.log(value / min) / Math.log(max / min) : (value - min) / (max - min);
  return Math.min(Math.max(position, 0), 1);
}

export function sliderValue(camera, name) {
  if (name === "e") return camera.eye[2];
  const match = name.match(/^(eye|lookat)_([xyz])$/);
  return match ? camera[match[1]][COORDINATE[match[2]]] : camera[name];
}

// The camera with one value changed; the given one stays as it is. e moves lookat with the eye.
export function withSlider(camera, name, value) {
  const moved = (point, axis, to) => point.map((x, k) => (k === axis ? to : x));
  if (name === "e") {
    const lookat = camera.lookat[2] + value - camera.eye[2];
    return { ...camera, eye: moved(camera.eye, 2, value), lookat: moved(camera.lookat, 2, lookat) };
  }
  const match = name.match(/^(eye|lookat)_([xyz])$/);
  if (match) return { ...camera, [match[1]]: moved(camera[match[1]], COORDINATE[match[2]], value) };
  return { ...camera, [name]: value };
}
