/* render/options.c: the options of `velo render`, in the order of its help page. */

#include "image/denoise.h"
#include "render/channels.h"
#include "render/job.h"
#include "render/lens_options.h"
#include "render/outputs.h"

/* The first is a family of velo/schema.h; others are further names. */
static const Choice tracers[] = {{"tracers", 0}, {"auto", TRACER_AUTO}, {0}},
                    samplers[] = {{"samplers", 0}, {0}}, filters[] = {{"filters", 0}, {0}};

Option render_options[] = {
    {RENDER_OUTPUT, "output",
     "image file to write; may be given several times. The suffix chooses the format: .exr "
     ".hdr .pfm (linear), .png .jpg .tga (display); of several frames also a video by ffmpeg: "
     ".mp4 .gif. Default: in the current folder, the file name that the scene gives, "
     "otherwise the name of FILE with .exr, or with .png if FILE is a model",
     OPTION_TEXTS, "FILE", .letter = 'o'},
    {RENDER_SPP, "spp", "samples per pixel", OPTION_INTEGER, "N"},
    {RENDER_NOISE, "noise",
     "adaptive sampling: each block of 32 x 32 pixels gets samples until the standard error "
     "of its display values is below this percentage of white, such as 1%, or until it has "
     "--spp samples (docs/adaptive.md)",
     OPTION_TEXT, "PERCENT"},
    {RENDER_DENOISE, "denoise",
     "also write a denoised copy of the image, or of each frame of --turntable, --trajectory "
     "or --animate, to this file (docs/denoising.md)",
     OPTION_TEXT, "FILE"},
    {RENDER_PLAIN, "plain",
     "the first image of a model, too, has 64 samples and is not denoised. Default: a .png, "
     ".jpg or .tga of a model to which velo adds camera or light has 8 samples, denoised, "
     "unless an option asks for something else than what is seen (docs/denoising.md)"},
    {RENDER_DENOISER, "denoiser",
     "denoiser of --denoise; velo: the built-in one; oidn: Intel Open Image Denoise, if it is "
     "installed:",
     OPTION_CHOICE, "NAME", .choices = denoiser_choices},
    {RENDER_DENOISER_LIBRARY, "denoiser-library",
     "path of the library of Open Image Denoise; default: the system's", OPTION_TEXT, "FILE"},
    {RENDER_TIME, "time",
     "time limit of the command, including loading and writing (with --trajectory: of each "
     "image): 30, 30s, 5m, 1h30m. Without --spp, as many samples are taken as fit into it",
     OPTION_TIME, "TIME"},
    {RENDER_SERVE, "serve",
     "show the image in the browser while it renders: prints the address of the page of velo "
     "view, which then only looks on"},
    {RENDER_RESOLUTION, "resolution",
     "image size in pixels; the field of view across the smaller side is kept", OPTION_SIZE,
     "WxH"},
    {RENDER_CROP, "crop", "crop window: render only these pixels; x1 and y1 are exclusive",
     OPTION_CROP, "x0,y0,x1,y1"},
    {RENDER_CROPWINDOW, "cropwindow",
     "crop window in fractions of the image size, in pbrt's order", OPTION_FRACTIONS,
     "x0,x1,y0,y1"},
    {RENDER_FILM, "film",
     "write the film to this file, during the render and at its end. If it is there already, "
     "it is continued: the command of an interrupted render is simply repeated. The film of "
     "another render is refused. Without -o no image is written",
     OPTION_TEXT, "FILE"},
    {RENDER_OVERWRITE, "overwrite",
     "begin the film of --film anew; the film that is there is replaced at the first "
     "checkpoint"},
    {RENDER_CHECKPOINT, "checkpoint",
     "time between two checkpoints, at which the film is written during the render; default "
     "30s, and longer where checkpoints would take more than 0.5 % of the time",
     OPTION_TIME, "TIME"},
    {RENDER_CONTINUE, "continue",
     "continue the render of this film file with its settings and outputs, up to the film's "
     "--spp, or to the --spp or --time given here. FILE gives the scene's path if it has "
     "changed. The film is written to the same file, unless --film names another",
     OPTION_TEXT, "FILM"},
    {RENDER_SHARD, "shard",
     "render part I of N (I from 1) of the image into --film; with --trajectory: every N-th "
     "frame",
     OPTION_TEXT, "I/N"},
    {RENDER_SHARD_BY, "shard-by",
     "how --shard divides the render: by samples (each part has some of the samples of all "
     "pixels), or by tiles of pixels:",
     OPTION_CHOICE, "WHAT", .choices = shard_choices},
    {RENDER_SAMPLES, "samples", "render only samples A to B - 1 of each pixel, into --film",
     OPTION_TEXT, "A:B"},
    {RENDER_TILES, "tiles",
     "render only these pixels, into --film; the numbers are multiples of 32, or the edges of "
     "the image",
     OPTION_CROP, "x0,y0,x1,y1"},
    {RENDER_CAMERA, "camera",
     "scene or camera file that gives the camera and the image size; for a glTF scene also "
     "one of its own cameras, by name or number from 0",
     OPTION_TEXT, "FILE"},
    {RENDER_FRAME, "frame",
     "camera to use, by name or number from 0, if the file of --camera has several",
     OPTION_TEXT, "NAME"},
    {RENDER_SIZE, "size",
     "image size for a file of --camera or --trajectory that does not give one; default: "
     "--resolution",
     OPTION_SIZE, "WxH"},
    {RENDER_SCENE, "scene", "glTF: scene to render, by name or number from 0", OPTION_TEXT,
     "NAME"},
    {RENDER_AT, "at",
     "glTF: time of the animation in seconds, at which the shutter opens; T1: time at which "
     "it closes, for motion blur. Default: the model without animation",
     OPTION_TEXT, "T[:T1]"},
    {RENDER_SHUTTER, "shutter", "time in seconds for which the shutter is open, from --at on",
     OPTION_NUMBER, "SECONDS"},
    {RENDER_ANIMATION, "animation",
     "glTF: animation to play, by name or number from 0; several separated by commas, or all; "
     "default: the first",
     OPTION_TEXT, "NAME"},
    {RENDER_TURN, "turn",
     "rotate the scene's camera about the vertical axis through the middle of the scene",
     OPTION_NUMBER, "DEGREES"},
    {RENDER_VARIANT, "variant", "glTF: material variant to use, by name", OPTION_TEXT, "NAME"},
    {RENDER_SCENE_UNIT, "scene-unit",
     "length of the scene's unit: m (default), cm, mm, km, in, ft, or a number of metres. "
     "Light given in candela and lumens is then that of a scene in metres "
     "(docs/conventions.md)",
     OPTION_TEXT, "UNIT"},
    {RENDER_ENVIRONMENT, "environment",
     "environment that lights the scene: a studio (studio: soft boxes, window, evening), sky, "
     "white, none, lamps (inside of a room), or an image file (2:1: longitude and latitude; "
     "square: equal-area octahedral). Default: studio, if the file has none",
     OPTION_TEXT, "NAME"},
    {RENDER_ENVIRONMENT_ROTATION, "environment-rotation",
     "rotation of the environment map about the vertical axis, in degrees; default: 0, of the "
     "studio so that its key light is on the left of the camera that velo adds",
     OPTION_ANGLE, "DEG"},
    {RENDER_ENVIRONMENT_STRENGTH, "environment-strength",
     "factor on the radiance of the environment map", OPTION_NUMBER, "X"},
    {RENDER_GROUND, "ground", "add a wide grey disk below the scene as ground"},
    {RENDER_NO_GROUND, "no-ground",
     "add no ground below a model in a studio. Default: a ground that shows the model's "
     "shadows and fades into the studio"},
    {RENDER_GROUND_MIDDLE, "ground-middle",
     "middle of the ground, also of one below a model with a camera of its own. Default: "
     "under the model",
     OPTION_POINT, "X,Y,Z"},
    {RENDER_GROUND_RADIUS, "ground-radius",
     "radius of the ground, in scene units. Default: by the size of the model", OPTION_NUMBER,
     "R"},
    {RENDER_FRAMING, "framing",
     "viewpoint of the camera that velo adds to a model without one; auto: flat models from "
     "the front, others from a corner; A,E: A degrees from the front to the right, E degrees "
     "above the horizon:",
     OPTION_CHOICE, "NAME | A,E", .choices = framing_choices, .list = OPTION_LIST_ANGLES},
    {RENDER_WALLS, "walls",
     "closed models, such as a room, without a camera of their own: hide the walls between "
     "the added camera and the middle, or keep them; both-sides: keep them, and show faces "
     "that are seen from one side from both; X,Y,Z: hide those between this point and the "
     "middle, whatever the camera is:",
     OPTION_CHOICE, "NAME | X,Y,Z", .choices = walls_choices, .list = OPTION_LIST_POINT},
    {RENDER_UP, "up",
     "axis of the model that points up, for the camera, light and ground that velo adds; "
     "default: y, of .stl files z:",
     OPTION_CHOICE, "AXIS", .choices = up_choices},
    {RENDER_TRAJECTORY, "trajectory",
     "render every frame of this trajectory: a COLMAP model, transforms.json, a camchain, a "
     "calibration with its views, or a list of poses (CSV, TUM, KITTI). In the name of -o, %d "
     "is the frame's number (%04d: four digits), %n its name, %c the camera's name, %v the "
     "eye (left, right)",
     OPTION_TEXT, "FILE"},
    {RENDER_FRAMES, "frames",
     "render only frames A to B of the trajectory or animation, with STEP every STEP-th; the "
     "first frame is 0",
     OPTION_TEXT, "A-B[:STEP]"},
    {RENDER_SKIP_EXISTING, "skip-existing",
     "leave out frames of the trajectory or animation whose image files all exist"},
    {RENDER_RIG, "rig",
     "render every camera of this file at each pose of the trajectory; a pose is that of the "
     "rig's origin, which in a camchain is cam0",
     OPTION_TEXT, "FILE"},
    {RENDER_ANIMATE, "animate",
     "glTF: render the frames of the animation from T0 up to, but not including, T1, in "
     "seconds; %d (%04d) in the name of -o is the frame's number",
     OPTION_TEXT, "T0:T1"},
    {RENDER_FPS, "fps", "frames per second of --animate and of videos; default 24",
     OPTION_NUMBER, "N", 1e-3, 1e5},
    {RENDER_TURNTABLE, "turntable",
     "render N frames with a camera that makes one turn around the scene", OPTION_INTEGER, "N",
     1, 1000000},
    {RENDER_STEREO, "stereo",
     "render a stereo pair; an .exr has both views, or each eye has its own file if the name "
     "contains %v:",
     OPTION_CHOICE, "MODE", .choices = stereo_choices},
    {RENDER_INTEROCULAR, "interocular",
     "distance between the two eyes, in scene units; default 0.065", OPTION_NUMBER, "D"},
    {RENDER_CONVERGENCE, "convergence",
     "depth at which the eyes' image windows (off-axis) or axes (toe-in) meet, in scene units",
     OPTION_NUMBER, "D"},
    {RENDER_EYE, "eye", "eyes of the stereo pair that are rendered:", OPTION_CHOICE, "NAME",
     .choices = eye_choices},
    {RENDER_TRACER, "tracer",
     "light transport algorithm; auto: chosen by a short race (docs/tracers.md), the default "
     "from 32 samples on where the scene names none:",
     OPTION_KIND, "NAME", .choices = tracers},
    {RENDER_MAX_DEPTH, "max-depth", "largest number of bounces of a path", OPTION_INTEGER, "N"},
    {RENDER_MERGE_RADIUS, "merge-radius",
     "merging, sppm: radius within which vertices of camera and light paths merge in the "
     "first pass, in scene units; default: the width of two pixels",
     OPTION_NUMBER, "R"},
    {RENDER_LIGHT_PATHS, "light-paths",
     "bidirectional, merging, sppm, lightpath: number of light paths per pass of one sample "
     "per pixel; default: as many as pixels",
     OPTION_INTEGER, "N", 0, 1 << 24},
    {RENDER_SAMPLER, "sampler", "generator of the sample points:", OPTION_KIND, "NAME",
     .choices = samplers},
    {RENDER_SEED, "seed", "seed of the random numbers; another seed gives other noise",
     OPTION_INTEGER, "N"},
    {RENDER_SEQUENCE, "sequence",
     "number of samples per pixel for which the sampler arranges its points; default 65536, "
     "or --spp for samplers with a grid",
     OPTION_INTEGER, "N", 1, 1 << 24},
    {RENDER_FILTER, "filter", "pixel filter, with pbrt's default size:", OPTION_KIND, "NAME",
     .choices = filters},
    {RENDER_FILTER_SAMPLES, "filter-samples",
     "shared: a pixel counts all samples that its filter covers, so that it has less noise, "
     "in common with its neighbours; own: each pixel has samples of its own, drawn from its "
     "filter (docs/filters.md); default shared:",
     OPTION_CHOICE, "NAME", .choices = filter_samples_choices},
    {RENDER_LIGHT_SAMPLER, "light-sampler",
     "method that chooses one light for a shading point:", OPTION_CHOICE, "NAME",
     .choices = light_sampler_choices},
    {RENDER_REGULARIZE, "regularize",
     "regularization: surfaces that a path hits after it has been scattered are made rougher, "
     "which removes fireflies and softens caustics; default: as the scene says:",
     OPTION_CHOICE, "NAME", .choices = regularize_choices},
    {RENDER_COLOR, "color", "representation of colours during light transport:", OPTION_CHOICE,
     "NAME", .choices = color_choices},
    {RENDER_SENSOR, "sensor",
     "camera whose spectral response the sensor has; daylight of 6500 K becomes white, unless "
     "the scene gives another white balance:",
     OPTION_KIND, "NAME", .choices = sensor_choices},
    OUTPUT_VIEW_OPTION(RENDER_VIEW),
    {RENDER_FOCUS_PIXEL, "focus-pixel",
     "autofocus: focus on the surface that is seen at this point of the image, in pixels from "
     "the top left corner",
     OPTION_TEXT, "X,Y"},
    {RENDER_FOCUS_DISTANCE, "focus-distance", "depth of the plane in focus, in scene units",
     OPTION_NUMBER, "D"},
    {RENDER_LENS_RADIUS, "lens-radius",
     "radius of the thin lens, in scene units; 0 is a pinhole", OPTION_NUMBER, "R"},
    {RENDER_F_NUMBER, "f-number",
     "f-number, which sets the lens radius to focal length / (2 N); the camera's focal length "
     "must be given in millimetres",
     OPTION_NUMBER, "N"},
    {RENDER_ISO, "iso",
     "sensitivity for a physical exposure, with the camera's f-number and --seconds: radiance "
     "is multiplied by seconds ISO / (120 N^2)",
     OPTION_NUMBER, "S"},
    {RENDER_SECONDS, "seconds",
     "exposure time for --iso, in seconds; default: the time that the shutter is open",
     OPTION_NUMBER, "T"},
    {RENDER_EXPOSURE, "exposure",
     "exposure of .png .jpg .tga: a number multiplies the image by 2^EV; auto chooses it so "
     "that the geometric mean of the image's luminance becomes 18 % grey, or for a model so "
     "that a white surface in its light is bright. Default: 0, for models auto",
     OPTION_TEXT, "EV"},
    {RENDER_CHANNELS, "channels",
     "ground truth channels to write into the .exr, 32-bit, separated by commas: Z, distance, "
     "P, N, Ng, uv, albedo, ray, id.object, id.material, id.instance, id.primitive, samples, "
     "film, or all of these. Channels that cost more and are not part of all: error (standard "
     "error), features (for denoisers), luminance (cd/m2), illuminance (lx), forward, "
     "backward (flow), crypto.object, crypto.material, crypto.instance (Cryptomatte; crypto: "
     "all three). FILE.ids.json lists the names of the ids",
     OPTION_TEXT, "LIST"},
    {RENDER_CHANNELS_MODE, "channels-mode",
     "point of a pixel for which ground truth is computed; centre: the pixel's centre; "
     "nearest: the image sample with the smallest depth; coverage: a sample of the object "
     "that covers most of the pixel:",
     OPTION_CHOICE, "NAME", .choices = channel_mode_choices},
    {RENDER_CHANNELS_TIME, "channels-time",
     "time for which ground truth is computed if something moves: row (the middle of each "
     "row's own exposure; without a rolling shutter that of the image), open, middle or close "
     "of the shutter's time in the middle of the image, or seconds; default row",
     OPTION_TEXT, "TIME"},
    {RENDER_CRYPTO_RANKS, "crypto-ranks",
     "largest number of objects that a Cryptomatte stores per pixel, an even number; default 6",
     OPTION_INTEGER, "N"},
    {RENDER_FLOW_CAMERA, "flow-camera",
     "scene or camera file with the camera of the next image. forward.U and forward.V are the "
     "displacement, in pixels, of each surface point from this image to that one; "
     "forward.hidden tells whether that camera sees the point. Default: this camera at the "
     "end of the shutter's time",
     OPTION_TEXT, "FILE"},
    {RENDER_FLOW_CAMERA_BEFORE, "flow-camera-before",
     "scene or camera file with the camera of the previous image, for backward.U, backward.V, "
     "backward.hidden. Default: this camera at the beginning of the shutter's time",
     OPTION_TEXT, "FILE"},
    {RENDER_BOXES, "boxes",
     "add bounding boxes of each object and instance to FILE.ids.json: in pixels (of the "
     "visible part and of the whole) and in space"},
    {RENDER_SPECTRUM, "spectrum",
     "add the image's spectrum to the .exr: N channels S0.<nm>nm over the wavelengths from "
     "MIN to MAX, default 360 to 830 nm; 0: no spectrum",
     OPTION_TEXT, "N[:MIN:MAX]"},
    {RENDER_TRANSPARENT, "transparent",
     "transparent background: .png and .exr have an alpha channel, in which ground and studio "
     "are transparent (.exr: premultiplied)"},
    OUTPUT_HALF_OPTION(RENDER_HALF),
    {RENDER_AGAIN, "again",
     "repeat the render that the receipt in the image's header describes: the result has the "
     "same bytes, or a message names what has changed. FILE gives the scene's path if it has "
     "changed",
     OPTION_TEXT, "IMAGE.exr"},
    {RENDER_NO_RECEIPT, "no-receipt",
     "do not write a receipt into the .exr, that is command, paths and digests of files, "
     "camera and settings (docs/receipts.md)"},
    THREADS_OPTION(RENDER_THREADS, "image"),
    {RENDER_ISA, "isa",
     "x86-64 instruction set that is used; default: the best that the processor has. The "
     "image does not depend on it:",
     OPTION_CHOICE, "NAME", .choices = isa_choices},
    {RENDER_BITS, "bits",
     "portable (default): the same image on every machine; fast: takes less time, and a few "
     "pixels may differ between machines:",
     OPTION_CHOICE, "NAME", .choices = bits_choices},
    {RENDER_ACCELERATOR, "accelerator",
     "what finds the surfaces that rays meet; default: embree where it gives the image that "
     "--bits promises, else bvh, velo's own. With portable bits the image does not depend on "
     "it:",
     OPTION_CHOICE, "NAME", .choices = accelerator_choices},
    {RENDER_MAX_MEMORY, "max-memory",
     "limit of the memory that is used: 500M, 2G, 1.5GiB. A render that needs more fails "
     "before it starts, with a list of what needs how much",
     OPTION_BYTES, "SIZE"},
    {RENDER_MAX_TEXTURE, "max-texture-pixels",
     "largest number of pixels of one texture image; default 268435456", OPTION_INTEGER, "N", 1,
     1e15},
    {RENDER_SANDBOX, "sandbox",
     "for scenes from untrusted sources: a file that the scene names must be in DIR or below "
     "it, after links are resolved, and the system confines velo where it can; may be given "
     "several times",
     OPTION_FOLDERS, "DIR"},
    {RENDER_PERMISSIVE, "permissive",
     "warn about parts of the scene that velo does not understand, instead of ending with an "
     "error; repair invalid normals and ignore missing images, and report how many"},
    {RENDER_STRICT, "strict",
     "a missing image of a glTF or OBJ file is an error (exit code 4). Default: a warning; "
     "its material is used without the image"},
    {RENDER_STRICT_OPTIONS, "strict-options",
     "an option that has no effect in this render, such as --variant if FILE is not glTF, is "
     "an error (exit code 2). Default: a note"},
    {RENDER_SEARCH, "search-path",
     "folder in which files that the scene names are also looked for; may be given several "
     "times",
     OPTION_SEARCH, "DIR"},
    {RENDER_IMITATE_PBRT, "imitate-pbrt",
     "reproduce a known error of pbrt-v4, to compare images with pbrt's: rough coats are a "
     "few percent too bright"},
    {RENDER_DRY_RUN, "dry-run",
     "load and build the scene and print what would be rendered; write no file"},
    {RENDER_QUIET, "quiet", "print only warnings and errors"},
    {RENDER_VERBOSE, "verbose", "print more about loading and building", .letter = 'v'},
    {RENDER_LOG_JSON, "log-json", "print messages as JSON, one object per line, on stderr"},
    {0}};

const Section render_sections[] = {
    {RENDER_OUTPUT, "the image, and when the render ends"},
    {RENDER_FILM, "film files: interrupted renders, several machines"},
    {RENDER_CAMERA, "camera and scene"},
    {RENDER_TRAJECTORY, "several images: trajectories, rigs, animations, stereo"},
    {RENDER_TRACER, "light transport and sampling"},
    {RENDER_COLOR, "colour, focus, exposure"},
    {RENDER_CHANNELS, "ground truth beside the image (.exr)"},
    {RENDER_THREADS, "threads, processor, memory"},
    {RENDER_PERMISSIVE, "reading the scene, and messages"},
    {0}};
