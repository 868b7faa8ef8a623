#!/usr/bin/python3
"""velo view: the scene as the camera sees it. The raw file of the page has the bytes of `velo render` and `velo sensor expose`; shutter and
ISO speed need no new samples; hostile values are refused in a line; the camera's back in the page."""
import itertools
import math
import os
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from live import Frame, Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written
CAMERA, SPP, WIDTH, HEIGHT = 64, 48, 96, 64
SCENE = '''LookAt 0 1 5 0 0.3 0 0 1 0
Camera "perspective" "float fov" 40
Sampler "halton" "integer pixelsamples" 48
Film "rgb" "integer xresolution" 96 "integer yresolution" 64
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9] "float scale" 400
Material "diffuse" "rgb reflectance" [0.7 0.2 0.1]
Shape "sphere" "float radius" 0.8
'''


def ask(page, kind, **message):
    page.send(id=7, **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in (kind, "refused") and m.get("id") == 7)


def set_sensor(page, **fields):
    page.send(type="sensor", set=fields)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in ("state", "refused"))


changes = itertools.count(1000)


def expose(page, **fields):
    """Sets fields; the exposure and the frame that follow, in either order. Those of earlier changes may still come: they are passed over."""
    change = next(changes)
    page.send(type="sensor", set=fields, change=change)
    got = {}
    while len(got) < 2:
        message = page.receive(60)
        if isinstance(message, Frame) and message.change == change:
            got["frame"] = message
        elif isinstance(message, dict) and message["type"] == "exposed" and message["change"] == change:
            got["exposed"] = message
    return got["exposed"], got["frame"]


def whole_image(page):
    """The exposure of all samples."""
    page.wait_frame(lambda f: f.channel == CAMERA and f.scale == 1 and f.spp == SPP)


def above_black(exposed):
    return sum(f["mean"] - exposed["black"] for f in exposed["filters"])


def same_as_commands(page, scene, folder):
    """The same numbers as those of `velo render --spectrum` and `velo sensor expose`, byte for byte."""
    expose(page, exposure_time=0.004, iso=400, frame=3)
    saved = ask(page, "saved", type="save", what="image", name="page.dng")
    check("raw_saved", saved.get("file") == "page.dng", saved)
    run = lambda *words: subprocess.run([VELO, *words], cwd=folder, check=True, capture_output=True)
    run("render", scene, "--spectrum", "24", "--filter", "box", "--channels", "error", "--spp", str(SPP), "--sequence", "65536", "-o", "light.exr")
    run("sensor", "expose", "light.exr", "--sensor", "generic_rggb", "--exposure-time", "0.004", "--iso", "400", "--frame", "3",
        "--f-number", "4", "-o", "commands.dng")
    read = lambda name: open(os.path.join(folder, name), "rb").read()
    check("same_bytes_as_commands", read("page.dng") == read("commands.dng"), len(read("page.dng")), len(read("commands.dng")))
    developed = ask(page, "saved", type="save", what="image", name="page.png")
    run("raw", "develop", "commands.dng", "-o", "commands.png")
    check("developed_too", read(developed["file"]) == read("commands.png"))


def test_exposures(page):
    first, frame = expose(page, exposure_time=0.002, iso=100, frame=0)
    before = bytes(page.pixels)
    check("levels", first["bits"] == 14 and first["black"] == 512 and 10000 < first["white"] < 16384, first["black"], first["white"])
    counts = [sum(f["bins"]) for f in first["filters"]]
    check("histogram_has_all", [f["name"] for f in first["filters"]] == ["R", "G", "B"] and counts == [1536, 3072, 1536], counts)
    check("form", frame.format == 0 and frame.channels == 3 and frame.spp == SPP, frame.format, frame.channels, frame.spp)
    twice, frame = expose(page, iso=200)
    ratio = above_black(twice) / above_black(first)
    check("iso_doubles_numbers", abs(ratio - 2) < 0.02 and frame.spp == SPP, ratio)
    longer, frame = expose(page, exposure_time=0.004)
    ratio = above_black(longer) / above_black(twice)
    check("time_doubles_numbers", abs(ratio - 2) < 0.02 and frame.spp == SPP, ratio)
    clipped, frame = expose(page, exposure_time=1)
    check("clipped", all(f["clipped"] > 0.5 for f in clipped["filters"]), [f["clipped"] for f in clipped["filters"]])
    expose(page, exposure_time=0.002, iso=100)
    check("same_noise_again", bytes(page.pixels) == before)
    expose(page, frame=1)
    check("another_frame_other_noise", bytes(page.pixels) != before)
    back, frame = expose(page, frame=0)
    check("same_again", bytes(page.pixels) == before and back["filters"] == first["filters"])
    check("ev", abs(first["ev"] - math.log2(16 / 0.002)) < 1e-6, first["ev"])
    check("metered_ev", abs(first["metered_ev"] - math.log2(first["luminance"] * 8)) < 1e-6 and 100 < first["luminance"] < 400, first["luminance"])
    metered, frame = expose(page, exposure_time=None)
    share = (sum(f["mean"] * n for f, n in zip(metered["filters"], counts)) / sum(counts) - 512) / (16383 - 512)
    check("meter_finds_grey", abs(share - 0.18) < 0.005 and metered["metered"], share)
    check("suggests_itself", abs(metered["suggested_time"] / metered["exposure_time"] - 1) < 1e-6 and abs(metered["suggested_iso"] - 100) < 1e-3,
          metered["suggested_time"], metered["exposure_time"])
    mono, frame = expose(page, preset="generic_mono")
    check("monochrome", [f["name"] for f in mono["filters"]] == ["W"] and frame.channels == 3, mono["filters"][0]["name"])
    expose(page, preset="generic_rggb", white="auto")
    expose(page, white="D65")


def test_lens(page):
    """The f-number is the lens's, and needs new samples."""
    page.send(type="camera", change=70, set={"f_number": 2})
    page.wait_frame(lambda f: f.change == 70 and f.spp == SPP)
    wide, _ = expose(page, exposure_time=0.001, iso=100)
    check("f_number_of_the_lens", wide["f_number"] == 2 and wide["lens_f_number"] == 2, wide["f_number"])
    page.send(type="undo", change=71)
    page.wait_frame(lambda f: f.change == 71 and f.spp == SPP)


def test_hostile(page):
    """Each is refused with one line that names it, and changes nothing."""
    before = set_sensor(page, iso=320)["sensor"]
    bad = [("iso", v) for v in (-1, 1e30, -1e30, "x", [1, 2], None, "")] + [("exposure_time", v) for v in (-1, 1e300, "1/60", [1, 2])]
    bad += [("preset", v) for v in ("generic_rgb", "", 3, None, "x" * 39)] + [("white", v) for v in ("B", 5, None)]
    bad += [("f_number", v) for v in (0, -2, 1e9)] + [("seed", 1.5), ("frame", -1), ("frame", 2**32), ("full_well", 3), ("temperature", 1e9)]
    problems = []
    for name, value in bad:
        page.send(type="sensor", set={name: value})
        try:
            said = page.wait_text("refused", 20)
        except TimeoutError:
            problems.append((name, str(value)[:20], "taken"))
            continue
        words = said["message"]
        if "\n" in words or len(words) > 400 or not ({name, "sensor"} & set(words.replace('"', " ").split())):
            problems.append((name, str(value)[:20], words))
    check("hostile_values", not problems, problems[:4])
    after = set_sensor(page, iso=320)["sensor"]
    check("nothing_changed", after == before, before, after)
    for text in ('{"type":"sensor","set":{"iso":NaN}}', '{"type":"sensor","set":{"iso":1e999}}', '{"type":"sensor","set":3}'):
        other = Page(page.view)
        other.send_raw(1, text.encode())
        closed = None
        while closed is None:
            message = other.receive(20)
            closed = message if isinstance(message, tuple) else None
        check("not_json", len(closed[2]) > 3, closed)
        other.close()


def test_command(page, folder):
    """The copied commands make the raw file of the page."""
    expose(page, exposure_time=0.003, iso=160, frame=2, seed=5, temperature=30)
    said = ask(page, "command", type="command", exposure=0, view="standard")
    check("commands", said["type"] == "command" and said["image"] == "scene-sensor.dng" and said["spp"] == SPP, said)
    program = os.path.join(folder, "velo")
    os.symlink(VELO, program)
    ran = subprocess.run(["sh", "-c", said["command"]], cwd=folder, capture_output=True, text=True,
                         env={**os.environ, "PATH": folder + ":" + os.environ["PATH"]})
    saved = ask(page, "saved", type="save", what="image", name="page2.dng")["file"]
    read = lambda name: open(os.path.join(folder, name), "rb").read()
    same = ran.returncode == 0 and read(said["image"]) == read(saved)
    check("commands_make_the_same", same, said["command"], ran.stderr[-300:])
    expose(page, white="auto")
    said = ask(page, "command", type="command", exposure=0, view="standard")
    check("no_command_of_auto_white", said["type"] == "refused" and "D65" in said["message"], said)
    said = ask(page, "verified", type="verify")
    check("nothing_to_verify", said["type"] == "refused", said)
    expose(page, white="D65")


def test_crop(page, folder):
    """A rectangle is that part of the whole sensor, as the commands have it."""
    whole, _ = expose(page, exposure_time=0.002, iso=100, frame=0)
    page.send(type="settings", crop=[21, 11, 70, 51], change=90)
    page.wait_frame(lambda f: f.change == 90 and f.channel == CAMERA and f.scale == 1 and f.spp == SPP)
    part, frame = expose(page, frame=1)
    part, frame = expose(page, frame=0)
    counts = [sum(f["bins"]) for f in part["filters"]]
    check("crop", (frame.x0, frame.y0, frame.columns, frame.rows) == (21, 11, 49, 40) and counts == [480, 980, 500], counts)
    said = ask(page, "command", type="command", exposure=0, view="standard")
    subprocess.run(["sh", "-c", said["command"]], cwd=folder, capture_output=True, env={**os.environ, "PATH": folder + ":" + os.environ["PATH"]})
    saved = ask(page, "saved", type="save", what="image", name="part.dng")["file"]
    read = lambda name: open(os.path.join(folder, name), "rb").read()
    check("crop_by_commands", read(said["image"]) == read(saved), said["command"])
    page.send(type="settings", crop=None, change=91)
    page.wait_frame(lambda f: f.change == 91 and f.columns == WIDTH and f.spp == SPP)


SENSOR_FILE = """preset: generic_rggb
full_well: 9000 e-
bits: 12 bits
"""


def test_start(folder):
    """--expose begins in this mode, also with a sensor file."""
    with open(os.path.join(folder, "own.yaml"), "w") as file:
        file.write(SENSOR_FILE)
    view = View(VELO, "scene.pbrt", "--expose", "./own.yaml", "--iso", "250", "--seconds", "0.01", "--f-number", "2.5", "--filter", "gaussian", cwd=folder)
    page = Page(view)
    check("file_is_listed_first", page.wait_text("lists")["sensors"][0] == "own.yaml")
    state = page.wait_text("state")
    sensor = state["sensor"]
    check("start", state["channel"] == CAMERA and (sensor["preset"], sensor["iso"], sensor["exposure_time"]) == ("own.yaml", 250, 0.01), sensor)
    whole_image(page)
    exposed, _ = expose(page, frame=1)
    check("own_sensor", exposed["bits"] == 12 and exposed["f_number"] == 2.5 and exposed["preset"] == "own.yaml", exposed["bits"], exposed["f_number"])
    command = ask(page, "command", type="command", exposure=0, view="standard")["command"]
    check("own_file_in_command", "--sensor ./own.yaml" in command and command.count("--filter") == 1 and "--expose" not in command, command)
    expose(page, preset="ideal_rggb")
    exposed, _ = expose(page, preset="own.yaml")
    check("chosen_again", exposed["bits"] == 12)
    page.close()
    view.end()
    bad = [(["--expose", "generic_rgb"], 2, "generic_rggb"), (["--expose", "missing.yaml"], 4, "missing.yaml"),
           (["--expose", "generic_rggb", "--color", "rgb"], 2, "spectrum"), (["--expose", "generic_rggb", "--iso", "1e30"], 2, "--iso"),
           (["--expose", ""], 2, "--expose")]
    for words, code, text in bad:
        ran = subprocess.run([VELO, "view", "scene.pbrt", "--no-open", *words], cwd=folder, capture_output=True, text=True, timeout=60)
        lines = [line for line in ran.stderr.splitlines() if line]
        check("start_refused " + " ".join(words), ran.returncode == code and text in lines[-1] and len(lines) == 1, ran.returncode, ran.stderr)


def test_engine(folder):
    scene = os.path.join(folder, "scene.pbrt")
    view = View(VELO, scene, cwd=folder)
    page = Page(view)
    page.view = view
    lists = page.wait_text("lists")
    check("lists", "generic_rggb" in lists["sensors"] and "auto" in lists["whites"])
    state = page.wait_text("state")
    check("metered_at_first", state["sensor"]["exposure_time"] is None and state["sensor"]["preset"] == "generic_rggb", state["sensor"])
    page.wait_frame(lambda f: f.channel == 0 and f.spp == SPP)
    image = ask(page, "saved", type="save", what="image", name="image.pfm", exposure=0, view="standard")["file"]
    said = ask(page, "saved", type="save", what="image", name="early.dng")
    check("no_raw_without_sensor", said["type"] == "refused" and ".dng" in said["message"], said)
    page.send(type="settings", channel="camera")
    early = page.wait_text("exposed")
    whole_image(page)
    late = expose(page, gain=1)[0]
    check("few_samples_as_bright", early["spp"] < 24 and abs(early["suggested_time"] / late["suggested_time"] - 1) < 0.15,
          early["spp"], early["suggested_time"], late["suggested_time"])
    same_as_commands(page, scene, folder)
    test_exposures(page)
    test_lens(page)
    test_hostile(page)
    test_command(page, folder)
    test_crop(page, folder)
    other = Page(view)
    check("told_to_new_pages", other.wait_text("exposed")["bits"] == 14)
    other.close()
    page.send(type="settings", channel="image", denoise=False)
    page.wait_frame(lambda f: f.channel == 0 and f.spp == SPP and not f.denoised)
    again = ask(page, "saved", type="save", what="image", name="image.pfm", exposure=0, view="standard")["file"]
    read = lambda name: open(os.path.join(folder, name), "rb").read()
    check("image_again_the_same", image != again and read(image) == read(again), image, again)
    page.close()
    check("ends", view.end()[0] == 0)


def test_without(folder):
    """What has no spectrum has no sensor, and says why."""
    for options, word in ((("--color", "rgb"), "spectr"),):
        view = View(VELO, os.path.join(folder, "scene.pbrt"), *options, cwd=folder)
        page = Page(view)
        page.wait_text("state")
        page.send(type="settings", channel="camera")
        said = page.wait_text("refused")
        check("rgb_has_none", word in said["message"] and "\n" not in said["message"], said)
        page.close()
        view.end()
    view = View(VELO, "--lecture")
    page = Page(view)
    check("lecture_has_none", "sensors" not in page.wait_text("lists") and "sensor" not in page.wait_text("state"))
    for message in ({"type": "settings", "channel": "camera"}, {"type": "sensor", "set": {"iso": 200}}):
        page.send(**message)
        check("lecture_refuses", "sensor" in page.wait_text("refused")["message"])
    page.close()
    view.end()


def test_film(folder):
    """A film of the sensor's mode is not what --film promises."""
    view = View(VELO, os.path.join(folder, "scene.pbrt"), "--film", "kept.film", cwd=folder)
    page = Page(view)
    page.wait_text("state")
    page.send(type="settings", channel="camera")
    whole_image(page)
    page.close()
    code, said = view.end()
    check("film_refused", code != 0 and "kept.film is not written" in said and not os.path.exists(os.path.join(folder, "kept.film")), code, said)


def test_page(folder):
    view = View(VELO, os.path.join(folder, "scene.pbrt"), cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("window.velo?.frames > 0 && velo.state && velo.steers")
        check("section", b.run("!document.getElementById('sensor').hidden && !document.getElementById('sensor').open"))
        b.click_on("#sensor summary")
        b.click_on("#sensor-on")
        b.wait(f"velo.screen.frame.channel === {CAMERA} && velo.screen.frame.spp === {SPP} && velo.sensor.last?.spp === {SPP}")
        check("pressed", b.run("document.getElementById('sensor-on').getAttribute('aria-pressed')") == "true")
        check("chosen_in_display", b.run("document.getElementById('channel').value") == "camera" and b.run("document.getElementById('exposure').disabled"))
        said = b.run("document.getElementById('sensor').textContent")
        check("words", all(w in said for w in ("14 bits, black 512", "clipped", "EV metered", "cd/m²", "ISO", "all is sharp")), said)
        check("histogram_drawn", b.run("velo.sensor.histogram.getContext('2d').getImageData(0, 0, 256, 72).data.some(v => v > 0)"))
        check("metered_pressed", b.run("document.getElementById('sensor-meter').getAttribute('aria-pressed')") == "true")
        shown = b.run("document.getElementById('sensor-exposure_time').value")
        check("shutter_shown", shown.startswith("1/"), shown)
        b.type_into("#sensor-iso", "800")
        b.wait("velo.sensor.last.iso === 800")
        b.type_into("#sensor-exposure_time", "1/500")
        b.wait("Math.abs(velo.sensor.last.exposure_time - 0.002) < 1e-9 && velo.state.sensor.exposure_time === 0.002")
        check("typed", b.run("document.getElementById('sensor-meter').getAttribute('aria-pressed')") == "false")
        b.type_into("#sensor-iso", "1e30")
        b.wait("document.querySelector('#sensor .why').textContent.includes('iso must be')")
        check("refused_beside", b.run("velo.state.sensor.iso") == 800)
        b.type_into("#sensor-iso", "fast")
        check("no_number", b.run("document.querySelector('#sensor .why').textContent") == "not a number")
        frame = b.run("velo.sensor.exposures")
        b.click_on("#sensor-again")
        b.wait(f"velo.sensor.exposures > {frame} && velo.state.sensor.frame === 1")
        b.run("(() => { const s = velo.sensor.iso.slider; s.value = 20; s.oninput(); })()")
        b.wait("Math.abs(velo.sensor.last.iso - 101.6) < 0.2")
        b.type_into("#sensor-f_number", "2.8")
        b.wait(f"velo.sensor.last.f_number === 2.8 && velo.sensor.last.spp === {SPP} && velo.sensor.last.lens_f_number === 2.8")
        check("f_number_is_the_lens", b.run("velo.state.camera.lens_radius") > 0)
        b.run("(() => { const s = document.getElementById('sensor-preset'); s.value = 'canon_eos_5d'; s.dispatchEvent(new Event('change')); })()")
        b.wait("velo.sensor.last.preset === 'canon_eos_5d'")
        b.click_on("#sensor-meter")
        b.wait("velo.sensor.last.metered && velo.state.sensor.exposure_time === null")
        b.wait(f"velo.screen.frame.spp === {SPP}")
        colours = b.run("velo.screen.values().slice(0, 3).join()")
        b.run("velo.display.set(3)")
        check("exposure_is_the_sensors", b.run("velo.screen.values().slice(0, 3).join()") == colours, colours)
        if SHOTS:
            b.screenshot(os.path.join(SHOTS, "sensor.png"))
        b.click_on("#sensor-on")
        b.wait("velo.screen.frame.channel === 0")
        check("off", b.run("document.getElementById('sensor-on').getAttribute('aria-pressed')") == "false")
        check("no_errors", not b.problems(), b.problems())
    finally:
        b.end()
        view.end()


def main():
    reason = cannot_view(VELO, browser=False)
    if reason:
        print(f"skip view_sensor: {reason}")
        return
    folder = tempfile.mkdtemp(prefix="velo-view-")
    with open(os.path.join(folder, "scene.pbrt"), "w") as file:
        file.write(SCENE)
    test_engine(folder)
    test_without(folder)
    test_film(folder)
    test_start(folder)
    reason = cannot_view(VELO)
    if reason:
        print(f"skip view_sensor page: {reason}")
    else:
        test_page(folder)
    shutil.rmtree(folder)


main()
results.end()
