/* render/options.c: the options of `velo render`, in the order of its help page. */
#include <stddef.h>

#include "image/denoise.h"
#include "render/channels.h"
#include "render/job.h"
#include "render/lens_options.h"

/* The first is a family of velo/schema.h; others are further names. */
static const Choice tracers[] = {{"tracers", 0}, {"auto", TRACER_AUTO}, {NULL, 0}},
                    samplers[] = {{"samplers", 0}, {NULL, 0}},
                    filters[] = {{"filters", 0}, {NULL, 0}};

Option render_options[] = {
    {RENDER_OUTPUT, 'o', "output", OPTION_TEXTS, "FILE",
     "image file to write; may be given several times. The suffix chooses the format: .exr "
     ".hdr .pfm (linear), .png .jpg .tga (display); of several frames also a video by ffmpeg: "
     ".mp4 .gif. Default: in the current folder, the file "
     "name that the scene gives, otherwise the name of FILE with .exr, or with .png if FILE "
     "is a model"},
    {RENDER_SPP, 0, "spp", OPTION_INTEGER, "N", "samples per pixel"},
    {RENDER_NOISE, 0, "noise", OPTION_TEXT, "PERCENT",
     "adaptive sampling: each block of 32 x 32 pixels gets samples until the standard error "
     "of its display values is below this percentage of white, such as 1%, or until it has "
     "--spp samples (docs/adaptive.md)"},
    {RENDER_DENOISE, 0, "denoise", OPTION_TEXT, "FILE",
     "also write a denoised copy of the image, or of each frame of --turntable, --trajectory "
     "or --animate, to this file (docs/denoising.md)"},
    {RENDER_PLAIN, 0, "plain", OPTION_FLAG, NULL,
     "the first image of a model, too, has 64 samples and is not denoised. Default: a .png, "
     ".jpg or .tga of a model to which velo adds camera or light has 8 samples, denoised, "
     "unless an option asks for something else than what is seen (docs/denoising.md)"},
    {RENDER_DENOISER, 0, "denoiser", OPTION_CHOICE, "NAME",
     "denoiser of --denoise; velo: the built-in one; oidn: Intel Open Image Denoise, if it is "
     "installed:",
     0, 0, denoiser_choices},
    {RENDER_DENOISER_LIBRARY, 0, "denoiser-library", OPTION_TEXT, "FILE",
     "path of the library of Open Image Denoise; default: the system's"},
    {RENDER_TIME, 0, "time", OPTION_TIME, "TIME",
     "time limit of the command, including loading and writing (with --trajectory: of each "
     "image): 30, 30s, 5m, 1h30m. Without --spp, as many samples are taken as fit into it"},
    {RENDER_SERVE, 0, "serve", OPTION_FLAG, NULL,
     "show the image in the browser while it renders: prints the address of the page of velo "
     "view, which then only looks on"},
    {RENDER_RESOLUTION, 0, "resolution", OPTION_SIZE, "WxH",
     "image size in pixels; the field of view across the smaller side is kept"},
    {RENDER_CROP, 0, "crop", OPTION_CROP, "x0,y0,x1,y1",
     "crop window: render only these pixels; x1 and y1 are exclusive"},
    {RENDER_CROPWINDOW, 0, "cropwindow", OPTION_FRACTIONS, "x0,x1,y0,y1",
     "crop window in fractions of the image size, in pbrt's order"},
    {RENDER_FILM, 0, "film", OPTION_TEXT, "FILE",
     "write the film to this file, during the render and at its end. If it is there already, "
     "it is continued: the command of an interrupted render is simply repeated. The film of "
     "another render is refused. Without -o no image is written"},
    {RENDER_OVERWRITE, 0, "overwrite", OPTION_FLAG, NULL,
     "begin the film of --film anew; the film that is there is replaced at the first "
     "checkpoint"},
    {RENDER_CHECKPOINT, 0, "checkpoint", OPTION_TIME, "TIME",
     "time between two checkpoints, at which the film is written during the render; default "
     "30s, and longer where checkpoints would take more than 0.5 % of the time"},
    {RENDER_CONTINUE, 0, "continue", OPTION_TEXT, "FILM",
     "continue the render of this film file with its settings and outputs, up to the film's "
     "--spp, or to the --spp or --time given here. FILE gives the scene's path if it has "
     "changed. The film is written to the same file, unless --film names another"},
    {RENDER_SHARD, 0, "shard", OPTION_TEXT, "I/N",
     "render part I of N (I from 1) of the image into --film; with --trajectory: every N-th "
     "frame"},
    {RENDER_SHARD_BY, 0, "shard-by", OPTION_CHOICE, "WHAT",
     "how --shard divides the render: by samples (each part has some of the samples of all "
     "pixels), or by tiles of pixels:",
     0, 0, shard_choices},
    {RENDER_SAMPLES, 0, "samples", OPTION_TEXT, "A:B",
     "render only samples A to B - 1 of each pixel, into --film"},
    {RENDER_TILES, 0, "tiles", OPTION_CROP, "x0,y0,x1,y1",
     "render only these pixels, into --film; the numbers are multiples of 32, or the edges "
     "of the image"},
    {RENDER_CAMERA, 0, "camera", OPTION_TEXT, "FILE",
     "scene or camera file that gives the camera and the image size; for a glTF scene also "
     "one of its own cameras, by name or number from 0"},
    {RENDER_FRAME, 0, "frame", OPTION_TEXT, "NAME",
     "camera to use, by name or number from 0, if the file of --camera has several"},
    {RENDER_SIZE, 0, "size", OPTION_SIZE, "WxH",
     "image size for a file of --camera or --trajectory that does not give one; default: "
     "--resolution"},
    {RENDER_SCENE, 0, "scene", OPTION_TEXT, "NAME",
     "glTF: scene to render, by name or number from 0"},
    {RENDER_AT, 0, "at", OPTION_TEXT, "T[:T1]",
     "glTF: time of the animation in seconds, at which the shutter opens; T1: time at which "
     "it closes, for motion blur. Default: the model without animation"},
    {RENDER_SHUTTER, 0, "shutter", OPTION_NUMBER, "SECONDS",
     "time in seconds for which the shutter is open, from --at on"},
    {RENDER_ANIMATION, 0, "animation", OPTION_TEXT, "NAME",
     "glTF: animation to play, by name or number from 0; several separated by commas, or all; "
     "default: the first"},
    {RENDER_TURN, 0, "turn", OPTION_NUMBER, "DEGREES",
     "rotate the scene's camera about the vertical axis through the middle of the scene"},
    {RENDER_VARIANT, 0, "variant", OPTION_TEXT, "NAME",
     "glTF: material variant to use, by name"},
    {RENDER_SCENE_UNIT, 0, "scene-unit", OPTION_TEXT, "UNIT",
     "length of the scene's unit: m (default), cm, mm, km, in, ft, or a number of metres. Light "
     "given in candela and lumens is then that of a scene in metres (docs/conventions.md)"},
    {RENDER_ENVIRONMENT, 0, "environment", OPTION_TEXT, "NAME",
     "environment that lights the scene: a studio (studio: soft boxes, window, evening), sky, "
     "white, none, lamps (inside of a room), or an image file (2:1: "
     "longitude and latitude; "
     "square: equal-area octahedral). Default: studio, if the file has none"},
    {RENDER_ENVIRONMENT_ROTATION, 0, "environment-rotation", OPTION_ANGLE, "DEG",
     "rotation of the environment map about the vertical axis, in degrees; default: 0, of the "
     "studio so that its key light is on the left of the camera that velo adds"},
    {RENDER_ENVIRONMENT_STRENGTH, 0, "environment-strength", OPTION_NUMBER, "X",
     "factor on the radiance of the environment map"},
    {RENDER_GROUND, 0, "ground", OPTION_FLAG, NULL,
     "add a wide grey disk below the scene as ground"},
    {RENDER_NO_GROUND, 0, "no-ground", OPTION_FLAG, NULL,
     "add no ground below a model in a studio. Default: a ground that shows the model's "
     "shadows and fades into the studio"},
    {RENDER_GROUND_MIDDLE, 0, "ground-middle", OPTION_POINT, "X,Y,Z",
     "middle of the ground, also of one below a model with a camera of its own. Default: under "
     "the model"},
    {RENDER_GROUND_RADIUS, 0, "ground-radius", OPTION_NUMBER, "R",
     "radius of the ground, in scene units. Default: by the size of the model"},
    {RENDER_FRAMING, 0, "framing", OPTION_CHOICE, "NAME | A,E",
     "viewpoint of the camera that velo adds to a model without one; auto: flat models from "
     "the front, others from a corner; A,E: A degrees from the front to the right, E degrees "
     "above the horizon:",
     0, 0, framing_choices, OPTION_LIST_ANGLES},
    {RENDER_WALLS, 0, "walls", OPTION_CHOICE, "NAME | X,Y,Z",
     "closed models, such as a room, without a camera of their own: hide the walls between "
     "the added camera and the middle, or keep them; both-sides: keep them, and show faces "
     "that are seen from one side from both; X,Y,Z: hide those between this point and the "
     "middle, whatever the camera is:",
     0, 0, walls_choices, OPTION_LIST_POINT},
    {RENDER_UP, 0, "up", OPTION_CHOICE, "AXIS",
     "axis of the model that points up, for the camera, light and ground that velo adds; "
     "default: y, of .stl files z:",
     0, 0, up_choices},
    {RENDER_TRAJECTORY, 0, "trajectory", OPTION_TEXT, "FILE",
     "render every frame of this trajectory: a COLMAP model, transforms.json, a camchain, a "
     "calibration with its views, or a list of poses (CSV, TUM, KITTI). In the name of -o, "
     "%d is the frame's number (%04d: four digits), %n its name, %c the camera's name, %v "
     "the eye (left, right)"},
    {RENDER_FRAMES, 0, "frames", OPTION_TEXT, "A-B[:STEP]",
     "render only frames A to B of the trajectory or animation, with STEP every STEP-th; the "
     "first frame is 0"},
    {RENDER_SKIP_EXISTING, 0, "skip-existing", OPTION_FLAG, NULL,
     "leave out frames of the trajectory or animation whose image files all exist"},
    {RENDER_RIG, 0, "rig", OPTION_TEXT, "FILE",
     "render every camera of this file at each pose of the trajectory; a pose is that of the "
     "rig's origin, which in a camchain is cam0"},
    {RENDER_ANIMATE, 0, "animate", OPTION_TEXT, "T0:T1",
     "glTF: render the frames of the animation from T0 up to, but not including, T1, in "
     "seconds; %d (%04d) in the name of -o is the frame's number"},
    {RENDER_FPS, 0, "fps", OPTION_NUMBER, "N",
     "frames per second of --animate and of videos; default 24", 1e-3, 1e5, NULL},
    {RENDER_TURNTABLE, 0, "turntable", OPTION_INTEGER, "N",
     "render N frames with a camera that makes one turn around the scene", 1, 1000000, NULL},
    {RENDER_STEREO, 0, "stereo", OPTION_CHOICE, "MODE",
     "render a stereo pair; an .exr has both views, or each eye has its own file if the name "
     "contains %v:",
     0, 0, stereo_choices},
    {RENDER_INTEROCULAR, 0, "interocular", OPTION_NUMBER, "D",
     "distance between the two eyes, in scene units; default 0.065"},
    {RENDER_CONVERGENCE, 0, "convergence", OPTION_NUMBER, "D",
     "depth at which the eyes' image windows (off-axis) or axes (toe-in) meet, in scene units"},
    {RENDER_EYE, 0, "eye", OPTION_CHOICE, "NAME",
     "eyes of the stereo pair that are rendered:", 0, 0, eye_choices},
    {RENDER_TRACER, 0, "tracer", OPTION_KIND, "NAME",
     "light transport algorithm; auto: chosen by a short race (docs/tracers.md), the default "
     "from 32 samples on where the scene names none:",
     0, 0, tracers},
    {RENDER_MAX_DEPTH, 0, "max-depth", OPTION_INTEGER, "N",
     "largest number of bounces of a path"},
    {RENDER_MERGE_RADIUS, 0, "merge-radius", OPTION_NUMBER, "R",
     "merging, sppm: radius within which vertices of camera and light paths merge in the "
     "first pass, in scene units; default: the width of two pixels"},
    {RENDER_LIGHT_PATHS, 0, "light-paths", OPTION_INTEGER, "N",
     "bidirectional, merging, sppm, lightpath: number of light paths per pass of one sample "
     "per pixel; default: as many as pixels",
     0, 1 << 24},
    {RENDER_SAMPLER, 0, "sampler", OPTION_KIND, "NAME", "generator of the sample points:", 0, 0,
     samplers},
    {RENDER_SEED, 0, "seed", OPTION_INTEGER, "N",
     "seed of the random numbers; another seed gives other noise"},
    {RENDER_SEQUENCE, 0, "sequence", OPTION_INTEGER, "N",
     "number of samples per pixel for which the sampler arranges its points; default 65536, "
     "or --spp for samplers with a grid",
     1, 1 << 24, NULL},
    {RENDER_FILTER, 0, "filter", OPTION_KIND, "NAME",
     "pixel filter, with pbrt's default size:", 0, 0, filters},
    {RENDER_FILTER_SAMPLES, 0, "filter-samples", OPTION_CHOICE, "NAME",
     "shared: a pixel counts all samples that its filter covers, so that it has less noise, "
     "in common with its neighbours; own: each pixel has samples of its own, drawn from its "
     "filter (docs/filters.md); default shared:",
     0, 0, filter_samples_choices},
    {RENDER_LIGHT_SAMPLER, 0, "light-sampler", OPTION_CHOICE, "NAME",
     "method that chooses one light for a shading point:", 0, 0, light_sampler_choices},
    {RENDER_REGULARIZE, 0, "regularize", OPTION_CHOICE, "NAME",
     "regularization: surfaces that a path hits after it has been scattered are made "
     "rougher, which removes fireflies and softens caustics; default: as the scene says:",
     0, 0, regularize_choices},
    {RENDER_COLOR, 0, "color", OPTION_CHOICE, "NAME",
     "representation of colours during light transport:", 0, 0, color_choices},
    {RENDER_SENSOR, 0, "sensor", OPTION_KIND, "NAME",
     "camera whose spectral response the sensor has; daylight of 6500 K becomes white, "
     "unless the scene gives another white balance:",
     0, 0, sensor_choices},
    {RENDER_VIEW, 0, "view", OPTION_CHOICE, "NAME",
     "view transform from radiance to display values (.png .jpg .tga):", 0, 0, view_choices},
    {RENDER_FOCUS_PIXEL, 0, "focus-pixel", OPTION_TEXT, "X,Y",
     "autofocus: focus on the surface that is seen at this point of the image, in pixels "
     "from the top left corner"},
    {RENDER_FOCUS_DISTANCE, 0, "focus-distance", OPTION_NUMBER, "D",
     "depth of the plane in focus, in scene units"},
    {RENDER_LENS_RADIUS, 0, "lens-radius", OPTION_NUMBER, "R",
     "radius of the thin lens, in scene units; 0 is a pinhole"},
    {RENDER_F_NUMBER, 0, "f-number", OPTION_NUMBER, "N",
     "f-number, which sets the lens radius to focal length / (2 N); the camera's focal "
     "length must be given in millimetres"},
    {RENDER_ISO, 0, "iso", OPTION_NUMBER, "S",
     "sensitivity for a physical exposure, with the camera's f-number and --seconds: "
     "radiance is multiplied by seconds ISO / (120 N^2)"},
    {RENDER_SECONDS, 0, "seconds", OPTION_NUMBER, "T",
     "exposure time for --iso, in seconds; default: the time that the shutter is open"},
    {RENDER_EXPOSURE, 0, "exposure", OPTION_TEXT, "EV",
     "exposure of .png .jpg .tga: a number multiplies the image by 2^EV; auto chooses it so "
     "that the geometric mean of the image's luminance becomes 18 % grey, or for a model so "
     "that a white surface in its light is bright. Default: 0, for models auto"},
    {RENDER_CHANNELS, 0, "channels", OPTION_TEXT, "LIST",
     "ground truth channels to write into the .exr, 32-bit, separated by commas: Z, "
     "distance, P, N, Ng, uv, albedo, ray, id.object, id.material, id.instance, "
     "id.primitive, samples, film, or all of these. Channels that cost more and are not part "
     "of all: error (standard error), features (for denoisers), luminance (cd/m2), illuminance (lx), forward, backward (flow), "
     "crypto.object, crypto.material, crypto.instance (Cryptomatte; crypto: all three). "
     "FILE.ids.json lists the names of the ids"},
    {RENDER_CHANNELS_MODE, 0, "channels-mode", OPTION_CHOICE, "NAME",
     "point of a pixel for which ground truth is computed; centre: the pixel's centre; "
     "nearest: the image sample with the smallest depth; coverage: a sample of the object "
     "that covers most of the pixel:",
     0, 0, channel_mode_choices},
    {RENDER_CHANNELS_TIME, 0, "channels-time", OPTION_TEXT, "TIME",
     "time for which ground truth is computed if something moves: row (the middle of each "
     "row's own exposure; without a rolling shutter that of the image), open, middle or close "
     "of the shutter's time in the middle of the image, or seconds; default row"},
    {RENDER_CRYPTO_RANKS, 0, "crypto-ranks", OPTION_INTEGER, "N",
     "largest number of objects that a Cryptomatte stores per pixel, an even number; default "
     "6"},
    {RENDER_FLOW_CAMERA, 0, "flow-camera", OPTION_TEXT, "FILE",
     "scene or camera file with the camera of the next image. forward.U and forward.V are "
     "the displacement, in pixels, of each surface point from this image to that one; "
     "forward.hidden tells whether that camera sees the point. Default: this camera at the "
     "end of the shutter's time"},
    {RENDER_FLOW_CAMERA_BEFORE, 0, "flow-camera-before", OPTION_TEXT, "FILE",
     "scene or camera file with the camera of the previous image, for backward.U, backward.V, "
     "backward.hidden. "
     "Default: this camera at the beginning of the shutter's time"},
    {RENDER_BOXES, 0, "boxes", OPTION_FLAG, NULL,
     "add bounding boxes of each object and instance to FILE.ids.json: in pixels (of the "
     "visible part and of the whole) and in space"},
    {RENDER_SPECTRUM, 0, "spectrum", OPTION_TEXT, "N[:MIN:MAX]",
     "add the image's spectrum to the .exr: N channels S0.<nm>nm over the wavelengths from "
     "MIN to MAX, default 360 to 830 nm; 0: no spectrum"},
    {RENDER_TRANSPARENT, 0, "transparent", OPTION_FLAG, NULL,
     "transparent background: .png and .exr have an alpha channel, in which ground and "
     "studio are transparent (.exr: premultiplied)"},
    {RENDER_HALF, 0, "half", OPTION_FLAG, NULL,
     "write .exr with 16-bit instead of 32-bit floats"},
    {RENDER_AGAIN, 0, "again", OPTION_TEXT, "IMAGE.exr",
     "repeat the render that the receipt in the image's header describes: the result has the "
     "same bytes, or a message names what has changed. FILE gives the scene's path if it has "
     "changed"},
    {RENDER_NO_RECEIPT, 0, "no-receipt", OPTION_FLAG, NULL,
     "do not write a receipt into the .exr, that is command, paths and digests of files, "
     "camera and settings (docs/receipts.md)"},
    {RENDER_THREADS, 't', "threads", OPTION_INTEGER, "N",
     "number of worker threads; default: one for each processor. The image does not depend on "
     "it"},
    {RENDER_ISA, 0, "isa", OPTION_CHOICE, "NAME",
     "x86-64 instruction set that is used; default: the best that the processor has. The image "
     "does not depend on it:",
     0, 0, isa_choices},
    {RENDER_BITS, 0, "bits", OPTION_CHOICE, "NAME",
     "portable (default): the same image on every machine; fast: takes less time, and a few "
     "pixels may differ between machines:",
     0, 0, bits_choices},
    {RENDER_ACCELERATOR, 0, "accelerator", OPTION_CHOICE, "NAME",
     "what finds the surfaces that rays meet; default: embree where it gives the image that "
     "--bits promises, else bvh, velo's own. With portable bits the image does not depend on "
     "it:",
     0, 0, accelerator_choices},
    {RENDER_MAX_MEMORY, 0, "max-memory", OPTION_BYTES, "SIZE",
     "limit of the memory that is used: 500M, 2G, 1.5GiB. A render that needs more fails "
     "before it starts, with a list of what needs how much"},
    {RENDER_MAX_TEXTURE, 0, "max-texture-pixels", OPTION_INTEGER, "N",
     "largest number of pixels of one texture image; default 268435456", 1, 1e15, NULL},
    {RENDER_SANDBOX, 0, "sandbox", OPTION_FOLDERS, "DIR",
     "for scenes from untrusted sources: a file that the scene names must be in DIR or below "
     "it, after links are resolved, and the system confines velo where it can; may be given "
     "several times"},
    {RENDER_PERMISSIVE, 0, "permissive", OPTION_FLAG, NULL,
     "warn about parts of the scene that velo does not understand, instead of ending with an "
     "error; repair invalid normals and ignore missing images, and report how many"},
    {RENDER_STRICT, 0, "strict", OPTION_FLAG, NULL,
     "a missing image of a glTF or OBJ file is an error (exit code 4). Default: a warning; "
     "its material is used without the image"},
    {RENDER_STRICT_OPTIONS, 0, "strict-options", OPTION_FLAG, NULL,
     "an option that has no effect in this render, such as --variant if FILE is not glTF, is "
     "an error (exit code 2). Default: a note"},
    {RENDER_SEARCH, 0, "search-path", OPTION_SEARCH, "DIR",
     "folder in which files that the scene names are also looked for; may be given several "
     "times"},
    {RENDER_IMITATE_PBRT, 0, "imitate-pbrt", OPTION_FLAG, NULL,
     "reproduce a known error of pbrt-v4, to compare images with pbrt's: rough coats are a few "
     "percent too bright"},
    {RENDER_DRY_RUN, 0, "dry-run", OPTION_FLAG, NULL,
     "load and build the scene and print what would be rendered; write no file"},
    {RENDER_QUIET, 0, "quiet", OPTION_FLAG, NULL, "print only warnings and errors"},
    {RENDER_VERBOSE, 'v', "verbose", OPTION_FLAG, NULL,
     "print more about loading and building"},
    {RENDER_LOG_JSON, 0, "log-json", OPTION_FLAG, NULL,
     "print messages as JSON, one object per line, on stderr"},
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
    {0, NULL}};
