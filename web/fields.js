// The fields of the camera panel, by group. Every group is a spelling of the same camera: an edit of one changes the
// others. count: numbers of a field; slide: range of its slider; choices: names; min: smallest value of a drag.
// brief(camera): what a folded group says; unusual(camera): whether it is open at first.
import { short } from "./dom.js";

const said = (name, value, unit = "") => Number.isFinite(value) ? `${name} ${short(value, 4)}${unit}` : "";
const lens = c => c.optics ? "of glass" : c.lens_radius > 0 ? said("f /", c.f_number) : "pinhole";

export const groups = [
  { title: "Pose", fields: [
    { name: "eye", label: "eye", count: 3, title: "position of the camera" },
    { name: "lookat", label: "lookat", count: 3, title: "a point on the view axis" },
    { name: "up", label: "up", count: 3, title: "direction of the image's up" },
    { name: "roll", label: "roll °", slide: { from: -180, to: 180 }, title: "about the view direction" },
  ] },
  { title: "View plane (lecture)", spelling: "lecture", brief: c => said("d", c.d), fields: [
    { name: "d", label: "d", slide: { octaves: 3 }, title: "distance of the view plane, in units of s" },
    { name: "zoom", label: "zoom", slide: { octaves: 3 } },
    { name: "s", label: "s", slide: { octaves: 3 }, title: "size of a pixel on the view plane" },
  ] },
  { title: "Field of view", spelling: "fov", brief: c => said("", c.fov, "°"), fields: [
    { name: "fov", label: "fov °", slide: { from: 1, to: 175 } },
    { name: "fov_axis", label: "across", choices: ["vertical", "horizontal", "diagonal", "smaller", "larger"] },
  ] },
  { title: "Focal length", spelling: "focal", brief: c => said("", c.focal_mm, " mm"), fields: [
    { name: "focal_mm", label: "focal mm" },
    { name: "sensor_width_mm", label: "sensor mm", title: "width of the sensor" },
  ] },
  { title: "Calibration matrix", spelling: "matrix", brief: c => said("fx", c.fx), fields: [
    { name: "fx", label: "fx px" }, { name: "fy", label: "fy px" }, { name: "cx", label: "cx px" },
    { name: "cy", label: "cy px" }, { name: "skew", label: "skew px" },
  ] },
  { title: "Projection", brief: c => c.projection + (c.distortion === "none" ? "" : ", distorted"), unusual: c => c.projection !== "perspective" || c.distortion !== "none", fields: [
    { name: "projection", label: "projection", list: "projections" },
    { name: "shape", label: "shape", count: 2, title: "parameters of the projection", empty: true },
    { name: "max_angle", label: "circle °", title: "radius of the image circle", empty: true },
    { name: "distortion", label: "distortion", choices: ["none", "opencv", "radial", "thin_prism", "rad_tan_thin_prism"] },
    { name: "coefficients", label: "coefficients", text: true, title: "in the order of the model" },
  ] },
  { title: "Lens", brief: lens, unusual: c => c.lens_radius > 0, fields: [
    { name: "lens_radius", label: "radius", slide: { from: 0, to: 0.5, relative: true }, title: "0: a pinhole" },
    { name: "f_number", label: "f-number", empty: true },
    { name: "focus_distance", label: "focus at", slide: { octaves: 4 }, empty: true, title: "depth of the plane in focus" },
    { name: "blades", label: "blades", title: "0: a round opening" }, { name: "rotation", label: "rotation °" },
    { name: "ratio", label: "ratio", title: "height of the opening divided by its width" },
    { name: "tilt_x", label: "tilt x °", title: "of the plane in focus" }, { name: "tilt_y", label: "tilt y °" },
    { name: "lens_tilt_x", label: "lens tilt x °", title: "Scheimpflug" }, { name: "lens_tilt_y", label: "lens tilt y °" },
  ] },
  { title: "Shutter", brief: c => `${short(c.shutter_open, 3)} to ${short(c.shutter_close, 3)} s`, unusual: c => c.shutter_open !== 0 || c.shutter_close !== 1, fields: [
    { name: "shutter_open", label: "opens at s" }, { name: "shutter_close", label: "closes at s", title: "at the time when it opens: no motion blur" },
  ] },
  { title: "Clipping", brief: c => c.near > 0 || c.far !== null ? `${short(c.near, 3)} to ${c.far === null ? "∞" : short(c.far, 3)}` : "none", unusual: c => c.near > 0 || c.far !== null, fields: [
    { name: "near", label: "near" }, { name: "far", label: "far", empty: true },
  ] },
];
