// web/lecture/sliders.js: the sliders of a live figure, and what each of them sets in a camera
// { eye, lookat, up, d, zoom, s, roll, near, far, fov, panini, exposure_time }; and its row on the page.
import { make } from "../dom.js";
import { sliderName } from "./words.js";

// Lengths and factors are spread evenly in their logarithm.
const LOGARITHMIC = ["d", "zoom", "s", "far"];
const WHOLE = ["r", "c", "n", "h_res", "v_res", "pixel"]; // whole numbers
const COORDINATE = { x: 0, y: 1, z: 2 };

// "d:100..2000,r:0..11" gives [{ name, min, max, logarithmic, step }]; step 0: no steps.
export function parseSliders(text) {
  return text.split(",").filter(Boolean).map((word) => {
    const match = word.match(/^(\w+):(-?[\d.]+)\.\.(-?[\d.]+)$/);
    if (!match) throw new Error(`'${word}' is not NAME:MIN..MAX`);
    const [min, max] = [Number(match[2]), Number(match[3])];
    return { name: match[1], min, max, logarithmic: LOGARITHMIC.includes(match[1]) && min > 0, step: WHOLE.includes(match[1]) ? 1 : 0 };
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
  if (name in camera) return camera[name];
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

// ---- the row of a slider on the page ----

const STEPS = 1000;

// Three significant digits are what a slider can set.
const rounded = (value) => Number(value.toPrecision(Math.abs(value) >= 1000 ? 4 : 3));

function short(value, language) {
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "–";
  const text = String(rounded(value)).replace("-", "−");
  return language === "it" ? text.replace(".", ",") : text;
}

// One row: name, slider, value, with its number of steps. change(value) is called while it moves; update(camera) sets it.
export function sliderRow(slider, language, change) {
  const steps = slider.step ? (slider.max - slider.min) / slider.step : STEPS;
  const input = make("input", { type: "range", min: 0, max: steps, step: 1 });
  const output = make("output");
  const row = make("label", { class: "slider" }, make("span", { textContent: sliderName(slider.name, language) }), input, output);
  row.dataset.slider = slider.name;
  const write = (value) => {
    output.textContent = short(value, language);
    input.setAttribute("aria-valuetext", output.textContent);
  };
  input.addEventListener("input", () => {
    const value = slider.step ? slider.min + slider.step * Number(input.value) : rounded(valueAt(slider, input.value / steps));
    write(value);
    change(value);
  });
  const update = (camera) => {
    const value = sliderValue(camera, slider.name);
    row.hidden = value === undefined; // such as d, where the view's projection has none
    if (row.hidden || input.matches(":active")) return; // it is held
    input.value = Math.round(steps * positionOf(slider, value));
    write(value);
  };
  return { slider, row, update, input };
}

