/* render/options.c: the options of `velo render`, in the order of its help page. */
#include <stddef.h>

#include "image/denoise.h"
#include "render/channels.h"
#include "render/job.h"
#include "render/lens_options.h"

/* Families of velo/schema.h. */
static const Choice tracers[] = {{"tracers", 0}}, samplers[] = {{"samplers", 0}}, filters[] = {{"filters", 0}};

const Option render_options[] = {
    {RENDER_OUTPUT, 'o', "output", OPTION_TEXTS, "FILE",
     "image to write; may be given several times. The suffix chooses\n"
     "the format: .exr .hdr .pfm (linear), .png .jpg .tga (display).\n"
     "Default: the name the scene asks for, else its own with .exr, of\na model with .png, in the current folder",
     0, 0, NULL},
    {RENDER_SPP, 0, "spp", OPTION_INTEGER, "N", "samples per pixel", 1, 1 << 24, NULL},
    {RENDER_NOISE, 0, "noise", OPTION_TEXT, "PERCENT",
     "adaptive sampling: each block of 32 x 32 pixels gets samples until\nthe standard error of its display values is "
     "below this part of\nwhite, such as 1%, or until it has --spp (docs/adaptive.md)",
     0, 0, NULL},
    {RENDER_DENOISE, 0, "denoise", OPTION_TEXT, "FILE", "a denoised copy of the image, beside it (docs/denoising.md)",
     0, 0, NULL},
    {RENDER_DENOISER, 0, "denoiser", OPTION_CHOICE, "NAME",
     "velo: its own; oidn: Intel Open Image Denoise, where it is\ninstalled:", 0, 0, denoiser_choices},
    {RENDER_DENOISER_LIBRARY, 0, "denoiser-library", OPTION_TEXT, "FILE",
     "the library of Open Image Denoise; default: the system's", 0, 0, NULL},
    {RENDER_TIME, 0, "time", OPTION_TIME, "TIME",
     "end after this time, loading and writing included (of a\n"
     "trajectory: after it for each image): 30, 30s, 5m, 1h30m. Without\n"
     "--spp as many samples as fit into it",
     0, 0, NULL},
    {RENDER_RESOLUTION, 0, "resolution", OPTION_SIZE, "WxH", "image size in pixels; the framing stays", 1, 65536, NULL},
    {RENDER_CROP, 0, "crop", OPTION_CROP, "x0,y0,x1,y1", "render only these pixels, x1 and y1 exclusive", 0, 0, NULL},
    {RENDER_CROPWINDOW, 0, "cropwindow", OPTION_FRACTIONS, "x0,x1,y0,y1",
     "the same in fractions of the image, in pbrt's order", 0, 0, NULL},
    {RENDER_FILM, 0, "film", OPTION_TEXT, "FILE",
     "keep the film in FILE, while rendering and at the end; a render\nthat ends early is continued from it. Without "
     "-o "
     "no image is\nwritten",
     0, 0, NULL},
    {RENDER_CHECKPOINT, 0, "checkpoint", OPTION_TIME, "TIME",
     "how often the film is written while rendering; default 30s, and\nless often where it would cost more than 0.5 %",
     0, 0, NULL},
    {RENDER_CONTINUE, 0, "continue", OPTION_TEXT, "FILM",
     "go on with this film, with its settings and outputs, to its --spp\nor the one given, or for --time. FILE is the "
     "scene where it is\nnot where the film says. The film is kept in the same file unless\n--film names another",
     0, 0, NULL},
    {RENDER_SHARD, 0, "shard", OPTION_TEXT, "I/N",
     "render the I-th of N parts of the image into --film, I from 1;\nof a trajectory: every N-th frame", 0, 0, NULL},
    {RENDER_SHARD_BY, 0, "shard-by", OPTION_CHOICE, "WHAT", "what the parts are: some samples of all pixels, or:", 0, 0,
     shard_choices},
    {RENDER_SAMPLES, 0, "samples", OPTION_TEXT, "A:B", "only the samples A to B - 1 of each pixel, into --film", 0, 0,
     NULL},
    {RENDER_TILES, 0, "tiles", OPTION_CROP, "x0,y0,x1,y1", "only these pixels of the film, cut at multiples of 32", 0,
     0, NULL},
    {RENDER_CAMERA, 0, "camera", OPTION_TEXT, "FILE",
     "take camera and image size from this scene or camera file;\nof a glTF file one of its own, by name or number", 0,
     0, NULL},
    {RENDER_FRAME, 0, "frame", OPTION_TEXT, "NAME", "which camera of --camera FILE, by its name or number from 0", 0, 0,
     NULL},
    {RENDER_SIZE, 0, "size", OPTION_SIZE, "WxH",
     "the image's size that a file of --camera or --trajectory does not\nhave; default: --resolution", 1, 65536, NULL},
    {RENDER_SCENE, 0, "scene", OPTION_TEXT, "NAME", "glTF: which of its scenes, by name or number from 0", 0, 0, NULL},
    {RENDER_AT, 0, "at", OPTION_TEXT, "T[:T1]",
     "glTF: the moment of its animation, in seconds, or two: what moves\nbetween them is blurred; default: as modelled",
     0, 0, NULL},
    {RENDER_SHUTTER, 0, "shutter", OPTION_NUMBER, "SECONDS", "the shutter is open so long from --at on", 0, 1e6, NULL},
    {RENDER_ANIMATION, 0, "animation", OPTION_TEXT, "NAME",
     "which one, by name or number from 0, several with commas, or all;\ndefault: the first", 0, 0, NULL},
    {RENDER_TURN, 0, "turn", OPTION_NUMBER, "DEGREES",
     "turn the scene's camera about the vertical axis through its middle", -1e6, 1e6, NULL},
    {RENDER_VARIANT, 0, "variant", OPTION_TEXT, "NAME", "glTF: this variant of its materials", 0, 0, NULL},
    {RENDER_ENVIRONMENT, 0, "environment", OPTION_TEXT, "FILE",
     "light from all around: studio, sky, white, none, or an image\n(twice as wide as high: longitude and latitude; "
     "or a square:\n"
     "equal-area). Default: the studio where a file has none",
     0, 0, NULL},
    {RENDER_ENVIRONMENT_ROTATION, 0, "environment-rotation", OPTION_NUMBER, "DEG", "turned about the vertical", -36000,
     36000, NULL},
    {RENDER_ENVIRONMENT_STRENGTH, 0, "environment-strength", OPTION_NUMBER, "X", "factor on its light", 0, 1e6, NULL},
    {RENDER_GROUND, 0, "ground", OPTION_FLAG, NULL, "a wide grey disk under everything", 0, 0, NULL},
    {RENDER_NO_GROUND, 0, "no-ground", OPTION_FLAG, NULL,
     "nothing under a model whose camera velo chooses. Default: a ground\nthat catches its shadows and fades into the "
     "studio",
     0, 0, NULL},
    {RENDER_FRAMING, 0, "framing", OPTION_CHOICE, "NAME",
     "from where a model without camera is seen; auto: flat ones from\ntheir front, else from the corner:", 0, 0,
     framing_choices},
    {RENDER_WALLS, 0, "walls", OPTION_CHOICE, "NAME",
     "of a closed model whose camera velo chooses (a room, a dome): hide\nthe walls on the camera's side, or keep "
     "them:",
     0, 0, walls_choices},
    {RENDER_UP, 0, "up", OPTION_CHOICE, "AXIS",
     "which way is up for the camera, light and ground that velo chooses;\ndefault: y, of .stl files z:", 0, 0,
     up_choices},
    {RENDER_TRAJECTORY, 0, "trajectory", OPTION_TEXT, "FILE",
     "render every frame of FILE: a COLMAP model, transforms.json, a\n"
     "camchain, a calibration with its views, or poses in lines (CSV,\n"
     "TUM, KITTI). In -o %d (%04d: four digits) becomes the frame's\n"
     "number, %n its name, %c the camera's, %v the eye",
     0, 0, NULL},
    {RENDER_FRAMES, 0, "frames", OPTION_TEXT, "A-B[:STEP]", "only these frames of the trajectory; numbers from 0", 0, 0,
     NULL},
    {RENDER_SKIP_EXISTING, 0, "skip-existing", OPTION_FLAG, NULL,
     "leave out the frames of the trajectory whose files are all there", 0, 0, NULL},
    {RENDER_RIG, 0, "rig", OPTION_TEXT, "FILE",
     "every camera of FILE at each pose of the trajectory: a pose is\nthe place of the rig, as a camchain's is cam0's",
     0, 0, NULL},
    {RENDER_ANIMATE, 0, "animate", OPTION_TEXT, "T0:T1",
     "glTF: the frames of its animation from T0 on and before T1, in\nseconds; in -o %d (%04d) becomes the frame's "
     "number",
     0, 0, NULL},
    {RENDER_FPS, 0, "fps", OPTION_NUMBER, "N", "frames per second of --animate; default 24", 1e-3, 1e5, NULL},
    {RENDER_TURNTABLE, 0, "turntable", OPTION_INTEGER, "N", "N frames of a camera that goes once around the scene", 1,
     1000000, NULL},
    {RENDER_STEREO, 0, "stereo", OPTION_CHOICE, "MODE",
     "two eyes: an .exr holds both views, or one file for each where\n"
     "the name has %v:",
     0, 0, stereo_choices},
    {RENDER_INTEROCULAR, 0, "interocular", OPTION_NUMBER, "D", "distance between the eyes, scene units; default 0.065",
     1e-9, 1e9, NULL},
    {RENDER_CONVERGENCE, 0, "convergence", OPTION_NUMBER, "D",
     "depth where off-axis windows or toed-in axes meet, scene units", 1e-9, 1e12, NULL},
    {RENDER_EYE, 0, "eye", OPTION_CHOICE, "NAME", "which eyes' images:", 0, 0, eye_choices},
    {RENDER_TRACER, 0, "tracer", OPTION_KIND, "NAME", "how light is followed:", 0, 0, tracers},
    {RENDER_MAX_DEPTH, 0, "max-depth", OPTION_INTEGER, "N", "longest path, in bounces", 0, 4096, NULL},
    {RENDER_MERGE_RADIUS, 0, "merge-radius", OPTION_NUMBER, "R",
     "merging, sppm: within which paths from the eye and from the\nlights meet at first, scene units; default: two "
     "pixels wide",
     1e-30, 1e30, NULL},
    {RENDER_LIGHT_PATHS, 0, "light-paths", OPTION_INTEGER, "N",
     "bidirectional, merging, sppm, lightpath: paths from the lights\nfor each sample of the image; default: as many "
     "as pixels",
     0, 1 << 24, NULL},
    {RENDER_SAMPLER, 0, "sampler", OPTION_KIND, "NAME", "how samples are placed:", 0, 0, samplers},
    {RENDER_SEED, 0, "seed", OPTION_INTEGER, "N", "another number, other noise", 0, 4294967295.0, NULL},
    {RENDER_SEQUENCE, 0, "sequence", OPTION_INTEGER, "N",
     "samples per pixel that the sampler lays its points out for;\ndefault 65536, or --spp for samplers with a grid", 1,
     1 << 24, NULL},
    {RENDER_FILTER, 0, "filter", OPTION_KIND, "NAME", "pixel filter, with pbrt's usual size:", 0, 0, filters},
    {RENDER_LIGHT_SAMPLER, 0, "light-sampler", OPTION_CHOICE, "NAME", "how a light is chosen:", 0, 0,
     light_sampler_choices},
    {RENDER_REGULARIZE, 0, "regularize", OPTION_CHOICE, "NAME",
     "make surfaces rougher for paths that have been scattered: no\n"
     "fireflies, and softer caustics; default: as the scene says, or:",
     0, 0, regularize_choices},
    {RENDER_COLOR, 0, "color", OPTION_CHOICE, "NAME", "what light is made of:", 0, 0, color_choices},
    {RENDER_SENSOR, 0, "sensor", OPTION_CHOICE, "NAME",
     "which camera's colours; white is daylight of 6500 K, unless the\nscene says another:", 0, 0, sensor_choices},
    {RENDER_VIEW, 0, "view", OPTION_CHOICE, "NAME", "how light becomes display values (.png .jpg .tga):", 0, 0,
     view_choices},
    {RENDER_FOCUS_PIXEL, 0, "focus-pixel", OPTION_TEXT, "X,Y",
     "autofocus: sharp is what this point of the image sees, in\npixels from the top left corner", 0, 0, NULL},
    {RENDER_FOCUS_DISTANCE, 0, "focus-distance", OPTION_NUMBER, "D", "sharp is the plane at this depth, in scene units",
     1e-30, 1e30, NULL},
    {RENDER_LENS_RADIUS, 0, "lens-radius", OPTION_NUMBER, "R", "of a thin lens, in scene units; 0 is a pinhole", 0,
     1e30, NULL},
    {RENDER_F_NUMBER, 0, "f-number", OPTION_NUMBER, "N",
     "the same by focal length / (2 N); the camera must have its\nfocal length in millimetres", 1e-6, 1e6, NULL},
    {RENDER_ISO, 0, "iso", OPTION_NUMBER, "S",
     "exposure as a camera has it, with its f-number and --seconds:\nthe light is multiplied by seconds ISO / (120 "
     "N^2)",
     1e-6, 1e12, NULL},
    {RENDER_SECONDS, 0, "seconds", OPTION_NUMBER, "T", "exposure time for --iso; default: the shutter's", 1e-12, 1e12,
     NULL},
    {RENDER_EXPOSURE, 0, "exposure", OPTION_TEXT, "EV",
     "brighter by 2^EV (.png .jpg .tga), or auto: so that the middle\nof the image's light is 18 % grey; models: so "
     "that white in their\nlight is bright. "
     "Default: 0, models auto",
     0, 0, NULL},
    {RENDER_CHANNELS, 0, "channels", OPTION_TEXT, "LIST",
     "ground truth into the .exr, 32-bit: any of Z, distance, P, N, Ng,\n"
     "uv, albedo, ray, id.object, id.material, id.instance,\n"
     "id.primitive, samples, film, separated by commas; or all of\n"
     "these. More, that cost more: error (standard error), features\n"
     "(for denoisers), forward, backward (flow), crypto.object,\n"
     "crypto.material, crypto.instance (Cryptomatte; crypto: all\n"
     "three).\n"
     "FILE.ids.json says what the ids stand for",
     0, 0, NULL},
    {RENDER_CHANNELS_MODE, 0, "channels-mode", OPTION_CHOICE, "NAME",
     "which point of a pixel they tell about: its centre, or of the\n"
     "image's samples the nearest, or one of the thing that covers\nmost of the pixel:",
     0, 0, channel_mode_choices},
    {RENDER_CHANNELS_TIME, 0, "channels-time", OPTION_TEXT, "TIME",
     "when they see what moves: open, middle or close of the shutter's\ntime, or seconds; default middle", 0, 0, NULL},
    {RENDER_CRYPTO_RANKS, 0, "crypto-ranks", OPTION_INTEGER, "N", "things a pixel of a Cryptomatte can hold; default 6",
     2, 32, NULL},
    {RENDER_FLOW_CAMERA, 0, "flow-camera", OPTION_TEXT, "FILE",
     "the camera of the next image: the channels forward.U, .V tell\n"
     "in pixels where it sees what this one sees, and forward.hidden\nwhether it does (scene or camera file). Without "
     "it: this camera at\nthe end of the shutter's time (--flow-camera-before: at its beginning)",
     0, 0, NULL},
    {RENDER_FLOW_CAMERA_BEFORE, 0, "flow-camera-before", OPTION_TEXT, "FILE",
     "the camera of the image before, for backward.U, .V, .hidden", 0, 0, NULL},
    {RENDER_BOXES, 0, "boxes", OPTION_FLAG, NULL,
     "FILE.ids.json also has boxes of each object and instance, in\n"
     "pixels (of what is seen, and of all of it) and in space",
     0, 0, NULL},
    {RENDER_SPECTRUM, 0, "spectrum", OPTION_TEXT, "N[:MIN:MAX]",
     "the image's spectrum into the .exr, too: N channels S0.<nm>nm,\n"
     "from 360 (MIN) to 830 (MAX) nm; 0: none",
     0, 0, NULL},
    {RENDER_TRANSPARENT, 0, "transparent", OPTION_FLAG, NULL,
     "no background: .png and .exr have the alpha of the scene without\nthe ground and the studio (.exr is "
     "premultiplied)",
     0, 0, NULL},
    {RENDER_HALF, 0, "half", OPTION_FLAG, NULL, ".exr with 16-bit instead of 32-bit floats", 0, 0, NULL},
    {RENDER_AGAIN, 0, "again", OPTION_TEXT, "IMAGE.exr",
     "render what the receipt in IMAGE's header describes: the same bytes,\nor a message that names what has changed. "
     "FILE is the scene where it\nis not where the receipt says",
     0, 0, NULL},
    {RENDER_NO_RECEIPT, 0, "no-receipt", OPTION_FLAG, NULL,
     "leave out of the .exr what made it: command, paths and digests\nof files, camera, settings (docs/receipts.md)", 0,
     0, NULL},
    {RENDER_THREADS, 't', "threads", OPTION_INTEGER, "N",
     "workers; default: one for each processor. The image does not\n"
     "depend on it",
     1, 1024, NULL},
    {RENDER_ISA, 0, "isa", OPTION_CHOICE, "NAME",
     "instruction set, x86-64-...; default: the machine's best. The\n"
     "image does not depend on it:",
     0, 0, isa_choices},
    {RENDER_BITS, 0, "bits", OPTION_CHOICE, "NAME",
     "portable: the same image on every machine (default); fast: a few\n"
     "pixels may differ between machines, for less time:",
     0, 0, bits_choices},
    {RENDER_MAX_MEMORY, 0, "max-memory", OPTION_BYTES, "SIZE",
     "memory that may be held: 500M, 2G, 1.5GiB. What needs more fails at\nonce and says what needs how much", 0, 0,
     NULL},
    {RENDER_MAX_TEXTURE, 0, "max-texture-pixels", OPTION_INTEGER, "N",
     "pixels that one image of a texture may have; default 268435456", 1, 1e15, NULL},
    {RENDER_SANDBOX, 0, "sandbox", OPTION_FOLDERS, "DIR",
     "for scenes of strangers: the files that a scene names must lie in\nDIR or beneath it, links followed; several "
     "times for several",
     0, 0, NULL},
    {RENDER_PERMISSIVE, 0, "permissive", OPTION_FLAG, NULL,
     "warn about what is not understood instead of refusing it; repair\nbroken normals, do without missing images, and "
     "count both",
     0, 0, NULL},
    {RENDER_STRICT, 0, "strict", OPTION_FLAG, NULL,
     "a missing image of a glTF or OBJ file is an error (exit code 4);\nwithout, its material does without it", 0, 0,
     NULL},
    {RENDER_SEARCH, 0, "search-path", OPTION_SEARCH, "DIR",
     "look in DIR, too, for the files that a scene names; several times\nfor several", 0, 0, NULL},
    {RENDER_IMITATE_PBRT, 0, "imitate-pbrt", OPTION_FLAG, NULL,
     "follow pbrt-v4 where it is known to be off: rough coats come out\n"
     "a few percent too bright",
     0, 0, NULL},
    {RENDER_DRY_RUN, 0, "dry-run", OPTION_FLAG, NULL, "load, build and say what would be rendered; write nothing", 0, 0,
     NULL},
    {RENDER_QUIET, 0, "quiet", OPTION_FLAG, NULL, "only warnings and errors", 0, 0, NULL},
    {RENDER_VERBOSE, 'v', "verbose", OPTION_FLAG, NULL, "more about loading and building", 0, 0, NULL},
    {RENDER_LOG_JSON, 0, "log-json", OPTION_FLAG, NULL, "messages as JSON, one object a line, on stderr", 0, 0, NULL},
    {0, 0, NULL, OPTION_FLAG, NULL, NULL, 0, 0, NULL}};

const Section render_sections[] = {{RENDER_OUTPUT, "the image and when it is done"},
                                   {RENDER_FILM, "the film: stop and go on, many machines"},
                                   {RENDER_CAMERA, "camera and scene"},
                                   {RENDER_TRAJECTORY, "many images: trajectories, rigs, two eyes"},
                                   {RENDER_TRACER, "light and samples"},
                                   {RENDER_COLOR, "colour, focus, exposure"},
                                   {RENDER_CHANNELS, "ground truth beside the image (.exr)"},
                                   {RENDER_THREADS, "the machine"},
                                   {RENDER_PERMISSIVE, "the scene's file, and what is printed"},
                                   {0, NULL}};
