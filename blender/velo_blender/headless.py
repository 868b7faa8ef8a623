"""headless.py: `velo render scene.blend`: Blender without a window opens a file and renders the frames that velo asks for.

Words: version of velo, path of the file, suffixes of the outputs (".png", ...), "--", then NAME=VALUE of the options of SETTERS. Standard
input: for each image the frame's number (empty: the file's own) and a path for each output, each text ended by a zero byte. Descriptor 3
gets lines: warning TEXT; scene VERSION FIRST LAST CURRENT; progress PART; done WIDTH HEIGHT SAMPLES; error CODE TEXT, whose code is the
exit code of velo. Their parts are separated by tabs."""
import os
import shutil
import sys

import addon_utils
import bpy

EVENTS = 3  # the descriptor
USAGE, SCENE, MISSING, IO = 2, 3, 4, 5  # exit codes of velo
FORMATS = {".png": "PNG", ".jpg": "JPEG", ".jpeg": "JPEG", ".tga": "TARGA", ".exr": "OPEN_EXR", ".hdr": "HDR"}


class Failure(Exception):
    """What ends the program: an exit code of velo and one line."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


def tell(*words):
    """Sends a line to velo. Where velo is gone, so is this process."""
    line = "\t".join(" ".join(str(word).split()) for word in words)[:2000] + "\n"
    try:
        os.write(EVENTS, os.fsencode(line))
    except OSError:
        os._exit(1)


# ---- the options ---------------------------------------------------------------------------------------------------------

def _set(owner, name, value, option):
    """Sets a property of Blender, which cuts off what is out of its range."""
    try:
        setattr(owner, name, value)
        taken = getattr(owner, name)
    except (OverflowError, TypeError, ValueError):
        taken = None
    if taken is None or abs(taken - value) > 1e-6 * abs(value):
        raise Failure(USAGE, "--%s: velo in Blender does not take %s" % (option, value))


def _set_samples(scene, text):
    _set(scene.velo, "samples", int(text), "spp")


def _set_noise(scene, text):
    _set(scene.velo, "noise", float(text), "noise")


def _set_seed(scene, text):
    _set(scene.velo, "seed", int(text), "seed")


def _set_depth(scene, text):
    scene.velo.bounces_of_cycles = False
    if int(text) < 1:
        raise Failure(USAGE, "--max-depth: velo in Blender has at least the depth 1, direct light alone")
    _set(scene.velo, "bounces", int(text) - 1, "max-depth")


def _set_color(scene, text):
    scene.velo.spectral = text == "spectral"


def _set_threads(scene, text):
    import velo
    velo.set_threads(int(text))


def _set_camera(scene, text):
    """The camera of a file, with its frame's pose and its size."""
    from . import camera_files
    path, frame = text
    if not path:
        return
    if not os.path.exists(path):
        raise Failure(MISSING, "%s: there is no such file" % path)
    if scene.camera is None:
        scene.camera = bpy.data.objects.new("velo", bpy.data.cameras.new("velo"))
        scene.collection.objects.link(scene.camera)
    scene.camera.animation_data_clear()
    scene.camera.parent = None
    scene.camera.constraints.clear()
    data = scene.camera.data
    data.velo.file, data.velo.frame = os.path.abspath(path), frame
    camera_files.show_frustum(scene, scene.camera, camera_files.read(data))


def _set_resolution(scene, text):
    width, height = (int(part) for part in text.split(","))
    _set(scene.render, "resolution_x", width, "resolution")
    _set(scene.render, "resolution_y", height, "resolution")
    scene.render.resolution_percentage = 100


def _set_crop(scene, text):
    from . import camera
    x0, y0, x1, y1 = (int(part) for part in text.split(","))
    width, height = camera.image_size(scene)
    if x1 > width or y1 > height:
        raise Failure(USAGE, "--crop: the image has only %d x %d pixels" % (width, height))
    scene.render.use_border = scene.render.use_crop_to_border = True
    # Blender rounds down; a quarter of a pixel keeps the rounding of its floats away.
    scene.render.border_min_x, scene.render.border_max_x = (x0 + 0.25) / width, min(1.0, (x1 + 0.25) / width)
    scene.render.border_min_y, scene.render.border_max_y = (height - y1 + 0.25) / height, min(1.0, (height - y0 + 0.25) / height)


def _set_transparent(scene, text):
    scene.render.film_transparent = True


def _set_half(scene, text):
    """_save reads it."""


#: Option -> what follows it, in this order.
SETTERS = {"spp": _set_samples, "noise": _set_noise, "seed": _set_seed, "max-depth": _set_depth, "color": _set_color,
           "threads": _set_threads, "camera": _set_camera, "resolution": _set_resolution, "crop": _set_crop,
           "transparent": _set_transparent, "half": _set_half}


def _apply(scene, words):
    """Follows the options."""
    given = dict(word.split("=", 1) for word in words)
    given["camera"] = given.get("camera", ""), given.pop("frame", "")
    for name, follow in SETTERS.items():
        if name in given:
            follow(scene, given[name])
    return given


# ---- the file ------------------------------------------------------------------------------------------------------------

def _enable(version):
    try:
        import velo
    except ImportError as error:
        raise Failure(MISSING, "the Python module velo is not installed for Blender's Python: python3-velo (%s)" % error) from None
    if velo.__version__ != version:
        tell("warning", "the Python module velo that Blender has is version %s, this program %s" % (velo.__version__, version))
    failures = []
    addon_utils.enable("velo_blender", handle_error=failures.append)
    if not hasattr(bpy.types.Scene, "velo"):
        raise Failure(MISSING, "the add-on cannot be enabled: %s" % (failures[0] if failures else "unknown"))


def _open(path):
    if os.path.isdir(path):
        raise Failure(SCENE, "it is a folder")
    try:
        bpy.ops.wm.open_mainfile(filepath=os.path.abspath(path), load_ui=False)
    except RuntimeError as error:
        raise Failure(SCENE, "Blender cannot open it: %s" % str(error).replace("Error: ", "")) from None
    if bpy.app.autoexec_fail:
        tell("warning", "scripts in the file are not run: %s" % bpy.app.autoexec_fail_message)
    for library in bpy.data.libraries:
        if not os.path.exists(bpy.path.abspath(library.filepath, library=library.parent)):
            tell("warning", "the library %s is missing" % library.filepath)
    scene = bpy.context.scene
    scene.render.engine = "VELO"
    if scene.render.use_multiview:
        tell("warning", "of a stereo image the view of the camera itself is rendered")
    scene.render.use_multiview = False
    scene.render.use_persistent_data = True  # frames share what does not change
    for node in scene.node_tree.nodes if scene.use_nodes and scene.node_tree is not None else ():
        if node.type == "OUTPUT_FILE" and not node.mute:
            node.mute = True
            tell("warning", "the compositor's output %s is not written" % node.name)
    return scene


# ---- images --------------------------------------------------------------------------------------------------------------

def _choose_format(scene, suffix, half):
    """Sets the file format of the scene for a suffix."""
    options = scene.render.image_settings
    kind = FORMATS[suffix]
    if kind == "OPEN_EXR" and len([layer for layer in scene.view_layers if layer.use]) + len(_extra_passes(scene)) > 1:
        kind = "OPEN_EXR_MULTILAYER"
    options.file_format = kind
    alpha = scene.render.film_transparent and kind in ("PNG", "TARGA", "OPEN_EXR")
    if kind != "OPEN_EXR_MULTILAYER":
        options.color_mode = "RGBA" if alpha else "RGB"
    if kind == "PNG":
        options.color_depth = "8"
    elif kind.startswith("OPEN_EXR"):
        options.color_depth, options.exr_codec = "16" if half else "32", "ZIP"
    elif kind == "JPEG":
        options.quality = 95


def _extra_passes(scene):
    """The passes besides the colours that are on."""
    from . import passes
    return [words for layer in scene.view_layers if layer.use for words in passes.wanted_of(layer)]


def _render(scene, paths, suffixes, half):
    """Renders the current frame to the files. An .exr is written by the render itself, since only that writes layers."""
    from . import report
    order = sorted(range(len(paths)), key=lambda number: suffixes[number] != ".exr")
    first = order[0]
    _choose_format(scene, suffixes[first], half)
    scene.render.filepath, scene.render.use_file_extension = paths[first], False
    scene.render.use_overwrite, scene.render.use_placeholder = True, False
    report.status = 0
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as error:
        text = str(error).replace("Error: ", "", 1)
        raise Failure(report.status or SCENE, text[len("velo: "):] if text.startswith("velo: ") else text) from None
    for number in order[1:]:
        if suffixes[number] == ".exr":
            shutil.copyfile(paths[first], paths[number])
            continue
        _choose_format(scene, suffixes[number], half)
        bpy.data.images["Render Result"].save_render(paths[number], scene=scene)
    empty = [number for number in order if os.path.getsize(paths[number]) == 0]
    if empty:
        raise Failure(IO, "Blender did not write the %s file" % suffixes[empty[0]])


def _read_texts(count):
    """The next texts of the standard input; None: it has ended."""
    texts = []
    while len(texts) < count:
        text = b""
        while not text.endswith(b"\0"):
            byte = os.read(0, 1)
            if not byte:
                return None
            text += byte
        texts.append(os.fsdecode(text[:-1]))
    return texts


def _serve(scene, suffixes, half):
    from . import camera, report
    known = set()
    while True:
        texts = _read_texts(1 + len(suffixes))
        if texts is None:
            return
        if texts[0]:
            scene.frame_set(int(texts[0]))
        _render(scene, ["/" + os.path.abspath(path).lstrip("/") for path in texts[1:]], suffixes, half)
        for line in report.last.get(scene.name, []):
            if line not in known:
                known.add(line)
                tell("warning", line)
        tell("done", *camera.image_size(scene), scene.velo.samples)


def _run(words):
    cut = words.index("--", 2)
    version, path, suffixes = words[0], words[1], [suffix.lower() for suffix in words[2:cut]]
    _enable(version)
    scene = _open(path)
    from . import report
    given = _apply(scene, words[cut + 1:])
    report.listener = lambda part: tell("progress", "%.6f" % part)
    tell("scene", bpy.app.version_string, scene.frame_start, scene.frame_end, scene.frame_current)
    _serve(scene, suffixes, "half" in given)


def main(words):
    """Ends the process."""
    from .report import Refused
    try:
        _run(words)
    except Failure as failure:
        tell("error", failure.code, failure)
    except Refused as refused:
        tell("error", SCENE, refused)
    except OSError as error:
        tell("error", IO, error)
    except Exception as error:  # pylint: disable=broad-except; velo shows one line, Blender's standard error the rest
        import traceback
        traceback.print_exc()
        tell("error", 1, "a fault of the add-on: %s: %s" % (type(error).__name__, error))
    sys.stdout.flush()
    os._exit(0)  # Blender 3.4 may crash while it frees an add-on's modules
