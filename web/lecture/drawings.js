// web/lecture/drawings.js: all drawn figures by name.
import { frameDrawings } from "./drawings/frame.js";
import { loopDrawings } from "./drawings/loop.js";
import { planeDrawings } from "./drawings/plane.js";
import { spaceDrawings } from "./drawings/space.js";
import { vanishDrawings } from "./drawings/vanish.js";

export const drawings = { ...spaceDrawings, ...planeDrawings, ...vanishDrawings, ...frameDrawings, ...loopDrawings };
