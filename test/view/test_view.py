#!/usr/bin/python3
"""velo view, through a WebSocket client: frames, edits of the camera, refusals, files, copied commands, who may come in,
malformed messages, pages that come and go."""
import base64
import itertools
import json
import math
import os
import random
import re
import shlex
import shutil
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from types import SimpleNamespace
from urllib.parse import urlsplit

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from live import Frame, Page, Refused, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SCENE = os.path.join(ROOT, "scenes/lecture/perspective_two_point.pbrt")


def state_after(page, **message):
    """Sends an edit; the state or the refusal that answers it."""
    page.change = getattr(page, "change", 100) + 1
    page.send(change=page.change, **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in ("state", "refused") and
                     m.get("change") == page.change)


def edit(page, **fields):
    return state_after(page, type="camera", set=fields)


def near(a, b, share=1e-6):
    return abs(a - b) <= share * max(abs(a), abs(b), 1)


def answer(page, kind, **message):
    page.id = getattr(page, "id", 0) + 1
    page.send(id=page.id, **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in (kind, "refused") and m.get("id") == page.id)


# ---- who may come in ----

def test_access(view):
    good = f"{view.host}:{view.port}"
    status, body = view.get(view.path)
    check("page", status == 200 and b"<canvas" in body, status)
    check("module", view.get(view.path + "app.js")[0] == 200)
    check("no_token", view.get("/")[0] == 403 and view.get("/index.html")[0] == 403)
    wrong = "/" + ("0" if view.path[1] != "0" else "1") + view.path[2:]
    check("wrong_token", view.get(wrong)[0] == 403)
    check("foreign_host", view.get(view.path, host="example.com")[0] == 403)
    check("rebound_host", view.get(view.path, host=f"127.0.0.1.example.com:{view.port}")[0] == 403)
    check("localhost", view.get(view.path, host=f"localhost:{view.port}")[0] == 200)
    check("no_such_file", view.get(view.path + "../../etc/passwd")[0] in (403, 404))
    check("only_get", view.get(view.path, method="POST")[0] == 405)

    def refused(**arguments):
        try:
            Page(view, **arguments).close()
        except (Refused, OSError):
            return True
        return False
    check("socket_wrong_token", refused(path=wrong + "socket"))
    check("socket_foreign_host", refused(host="example.com"))
    check("socket_foreign_origin", refused(origin="http://example.com"))
    check("socket_other_port", refused(origin=f"http://127.0.0.1:{view.port + 1}"))
    check("socket_https_origin", refused(origin=f"https://{good}"))
    check("socket_no_origin", refused(origin=""))
    check("socket_no_protocol", refused(protocol=None))


# ---- frames and edits ----

def test_camera(page):
    state = page.wait_text("state")
    camera = state["camera"]
    check("spelled", camera["spelled"] == "lecture", camera["spelled"])
    d = camera["d"]
    for step in ("undo", "redo"):
        check(step + "_of_nothing", near(state_after(page, type=step)["camera"]["d"], d))
    new = edit(page, d=2 * d)["camera"]
    check("d_changes_fx", near(new["fx"], 2 * camera["fx"]) and near(new["d"], 2 * d), new["fx"])
    check("d_changes_focal_mm", near(new["focal_mm"], 2 * camera["focal_mm"]))
    new = edit(page, fx=camera["fx"], fy=camera["fy"])["camera"]
    check("fx_changes_d", near(new["d"], d) and new["spelled"] == "matrix", new["d"])
    new = edit(page, fov=40, fov_axis="horizontal")["camera"]
    check("fov", near(new["fov_horizontal"], 40) and new["spelled"] == "fov", new["fov_horizontal"])
    new = edit(page, focal_mm=35, sensor_width_mm=36)["camera"]
    check("focal_mm", near(new["fx"], 35 / 36 * camera["width"]) and new["spelled"] == "focal", new["fx"])
    new = edit(page, lens_radius=0.01)["camera"]
    check("f_number_of_a_radius", near(new["f_number"], 35 / (2 * 1000 * 0.01)) and camera["width"] != camera["height"], new)
    edit(page, lens_radius=0)
    new = edit(page, cx=camera["cx"] + 11.5)["camera"]
    check("cx", near(new["cx"], camera["cx"] + 11.5))
    new = edit(page, roll=30)["camera"]
    check("roll", near(new["roll"], 30))
    new = edit(page, eye=[1, 2, 3], lookat=[0, 0, 0], roll=0)["camera"]
    check("eye", new["world_from_camera"][3::4][:3] == [1, 2, 3], new["world_from_camera"])
    new = edit(page, distortion="opencv", coefficients=[-0.1, 0.01, 0, 0, 0])
    check("distortion", new["type"] == "state" and new["camera"]["distortion"] == "opencv", new)
    for name, count in (("radial", 2), ("thin_prism", 8), ("rad_tan_thin_prism", 12), ("opencv", 5)):
        new = edit(page, distortion=name).get("camera", {})
        check("distortion_" + name, new.get("distortion") == name and new["coefficients"] == [0] * count, new)
    for name in ("equidistant fisheye", "equirectangular", "unified", "Panini", "orthographic", "perspective"):
        answer_ = edit(page, projection=name)
        check("projection_" + name.split()[0], answer_.get("camera", {}).get("projection") == name, answer_)

    refused = edit(page, fov=200)
    check("refused", refused["type"] == "refused" and "fov" in refused["message"] and refused["field"] == "fov", refused)
    check("refused_eye", edit(page, eye=[0, 0, 0], lookat=[0, 0, 0])["type"] == "refused")
    check("refused_field", edit(page, nonsense=1)["type"] == "refused")
    before = state_after(page, type="undo")["camera"]
    check("undo", before["projection"] == "orthographic", before["projection"])
    check("redo", state_after(page, type="redo")["camera"]["projection"] == "perspective")
    check("reset", near(state_after(page, type="reset")["camera"]["d"], d))


def test_words(view, page, folder):
    """A refusal has the command line's words."""
    said = edit(page, near=5, far=3)["message"]
    path = os.path.join(folder, "near.json")
    saved = answer(page, "saved", type="save", what="camera", name="near.json", dialect="velo")
    camera = json.load(open(path))
    text = json.dumps(camera)
    run = subprocess.run([VELO, "camera", "info", path], capture_output=True, text=True)
    check("saved_camera_is_read", saved["type"] == "saved" and run.returncode == 0, run.stderr)
    check("refusal_names_both", "5" in said and "3" in said and text, said)


def test_latency(page):
    times, frames, start = [], 0, time.monotonic()
    eye = page.wait_camera["eye"]
    for i in range(20):
        page.change += 1
        begun = time.monotonic()
        page.send(type="camera", change=page.change, gesture=7, set={"eye": [eye[0] + 0.01 * i, eye[1], eye[2]]})
        page.wait_frame(lambda f: f.change == page.change)
        times.append(time.monotonic() - begun)
        time.sleep(0.02)
    print(f"   from a change to its first frame: median {1e3 * statistics.median(times):.0f} ms, "
          f"longest {1e3 * max(times):.0f} ms", file=sys.stderr)
    check("latency", statistics.median(times) < 5, times)
    start, i = time.monotonic(), 0
    while time.monotonic() - start < 2:
        i += 1
        page.change += 1
        page.send(type="camera", change=page.change, gesture=8, set={"eye": [eye[0] - 0.01 * i, eye[1], eye[2]]})
        page.wait_frame(lambda f: f.change == page.change)
        frames += 1
    print(f"   while moving: {frames / 2:.1f} frames/s", file=sys.stderr)


def test_paths(page):
    """The paths of a pixel are those of `velo camera paths`; a newer request and another camera end an older one."""
    state_after(page, type="reset")
    told = answer(page, "paths", type="paths", x=81.5, y=60, samples=32, show=5)
    run = subprocess.run([VELO, "camera", "paths", SCENE, "--resolution", "160x120", "--pixel", "81,60", "--samples", "32",
                          "--show", "5", "--json"], capture_output=True, text=True)
    same = json.loads(run.stdout) if run.returncode == 0 else {}
    told.pop("type"), told.pop("id")
    check("paths", told == same and len(told["paths"]) == 5 and told["sees"]["object"]["id"] > 0, run.stderr,
          [key for key in told if told[key] != same.get(key)])
    first = answer(page, "paths", type="paths", x=81, y=60, samples=3, show=27, by_sample=True)
    own = [p["sample"] for p in first["paths"] if p["pixel"] == [81, 60]]
    order = [p["sample"] for p in first["paths"]]
    check("paths_by_sample", own == [0, 1, 2] and order == sorted(order) and first["samples"] == 3, own, order)
    check("paths_outside", answer(page, "paths", type="paths", x=160, y=1)["type"] == "refused")
    page.send(type="paths", id=9001, x=81, y=60, samples=65536)
    page.send(type="paths", id=9002, x=81, y=60, samples=65536)
    older = page.wait(lambda m: isinstance(m, dict) and m.get("id") == 9001)
    check("paths_newer_ends_older", older["type"] == "refused", older["type"])
    begun = time.monotonic()
    page.send(type="camera", change=page.change, set={"eye": [300, 200, 471]})
    newer = page.wait(lambda m: isinstance(m, dict) and m.get("id") == 9002)
    print(f"   paths are cancelled after {1e3 * (time.monotonic() - begun):.0f} ms", file=sys.stderr)
    check("paths_camera_ends_them", newer["type"] == "refused", newer["type"])
    state_after(page, type="undo")


def test_curves(page):
    """Overlays of distorted lenses and fisheyes, against the models' own formulas."""
    state_after(page, type="reset")
    c = edit(page, distortion="opencv", coefficients=[-0.2, 0.03, 0, 0, 0])["camera"]
    told = answer(page, "overlay", type="overlay", curves=True, field=True)
    worst = 0
    for x0, y0, x, y in told["field"]:
        u, v = (x0 - c["cx"]) / c["fx"], (y0 - c["cy"]) / c["fy"]
        r = u * u + v * v
        k = 1 - 0.2 * r + 0.03 * r * r
        worst = max(worst, abs(c["fx"] * k * u + c["cx"] - x), abs(c["fy"] * k * v + c["cy"] - y))
    check("distortion_field", len(told["field"]) > 300 and worst < 0.02 and told["greatest"] > 1, worst, told["greatest"])
    axes = {curve[0]: curve for curve in told["curves"]["axes"]}
    check("axes_of_a_lens", set(axes) == {"x", "y", "z"} and abs(axes["x"][1] - c["cx"]) < 0.02 and abs(axes["x"][2] - c["cy"]) < 0.02,
          axes)
    check("grid_of_a_lens", len(told["curves"]["grid"]) > 5 and len(told["curves"]["grid"][0]) > 6)
    check("vanishing_lines", {curve[0] for curve in told["curves"]["vanishing"]} == {"x", "y", "z"})
    c = edit(page, distortion="none", projection="equidistant fisheye", fov=150, up=[0, 1, 0])["camera"]
    told = answer(page, "overlay", type="overlay", curves=True)
    m, worst, count = c["world_from_camera"], 0, 0
    for name, *numbers in told["curves"]["horizon"]:
        for x, y in zip(numbers[::2], numbers[1::2]):
            u, v = (x - c["cx"]) / c["fx"], (y - c["cy"]) / c["fy"]
            t = math.hypot(u, v)
            s = math.sin(t) / t if t else 1
            worst, count = max(worst, abs(m[4] * u * s + m[5] * v * s + m[6] * math.cos(t))), count + 1
    check("horizon_of_a_fisheye", count > 50 and worst < 3e-4, worst, count)
    state_after(page, type="reset")


def test_flow(page):
    """Flow leads to the view that was marked: checked with the position that a pixel sees. The standard error follows
    the samples."""
    mark = state_after(page, type="settings", mark=True)["camera"]
    eye = mark["eye"]
    edit(page, eye=[eye[0] + 30, eye[1], eye[2] - 10])
    state_after(page, type="settings", channel="forward")
    frame = page.wait_frame(lambda f: f.channel == 16 and f.scale == 1)
    x, y = 81, 60
    p = answer(page, "picked", type="pick", x=x, y=y)["P"] + [1]
    w = mark["camera_from_world"]
    q = [sum(w[4 * i + k] * p[k] for k in range(4)) for i in range(3)]
    there = mark["fx"] * q[0] / q[2] + mark["cx"] - x - 0.5, mark["fy"] * q[1] / q[2] + mark["cy"] - y - 0.5
    flow = struct.unpack_from("<3f", page.pixels, 12 * (y * frame.columns + x))
    check("flow", frame.channels == 3 and max(abs(flow[i] - there[i]) for i in range(2)) < 0.01, flow, there)
    state_after(page, type="settings", channel="error")
    first = page.wait_frame(lambda f: f.channel == 15)
    values = struct.unpack(f"<{len(page.pixels) // 4}f", page.pixels)
    check("error_channel", first.format == 1 and first.channels == 3 and first.spp >= 2 and 0 < sum(values) < math.inf, vars(first))
    state_after(page, type="settings", channel="Z")
    edit(page, eye=eye)
    page.wait_frame(lambda f: f.channel == 1 and f.scale == 1)
    time.sleep(0.3)
    page.send(type="pick", id=7777, x=1, y=1)
    count = 0
    while True:
        message = page.receive()
        if isinstance(message, dict) and message.get("id") == 7777:
            break
        count += 1
    check("channel_rests", count < 20, count)
    state_after(page, type="settings", channel="image")
    state_after(page, type="reset")


def test_other_tracer(folder):
    view = View(VELO, SCENE, "--resolution", "64x48", "--tracer", "sppm", "--spp", "1", cwd=folder)
    page = Page(view)
    told = answer(page, "paths", type="paths", x=3, y=4)
    check("paths_other_tracer", told["type"] == "refused" and "sppm" in told["message"] and "volpath" in told["message"], told)
    page.close()
    check("other_tracer_ends", view.end()[0] == 0)


def test_trajectory(folder):
    """--trajectory: a string of cameras for the view from outside; the page's camera is still the scene's."""
    way = os.path.join(folder, "way.tum")
    open(way, "w").write("".join(f"{i} {40 * i} 30 {500 - 20 * i} 1 0 0 0\n" for i in range(7)))
    view = View(VELO, SCENE, "--resolution", "64x48", "--trajectory", way, "--spp", "1", cwd=folder)
    page = Page(view)
    told = answer(page, "cameras", type="cameras")
    parts = [line[0] for line in told["lines"]]
    check("trajectory", len(told["poses"]) == 7 and parts.count("path") == 6 and parts.count("eye") == 7 and
          parts.count("volume") == 28, parts)
    check("trajectory_poses", [told["poses"][i][3] for i in range(7)] == [40 * i for i in range(7)])
    page.close()
    check("trajectory_ends", view.end()[0] == 0)
    wrong = subprocess.run([VELO, "view", SCENE, "--no-open", "--trajectory", SCENE + ".no"], capture_output=True, text=True)
    check("trajectory_missing", wrong.returncode == 4, wrong.stderr)


def test_tasks(page):
    picked = answer(page, "picked", type="pick", x=page.wait_camera["width"] / 2, y=page.wait_camera["height"] / 2)
    check("pick", picked["type"] == "picked" and picked["Z"][0] > 0 and picked["object"]["id"] > 0, picked)
    check("pick_outside", answer(page, "picked", type="pick", x=60000, y=1)["type"] == "refused")
    test_paths(page)
    overlay = answer(page, "overlay", type="overlay", boxes=True)
    check("overlay", len(overlay["vanishing"]) == 3 and len(overlay["boxes"]) > 0, overlay)
    outline = answer(page, "outline", type="outline", set={"point": picked["P"]})
    parts = {line[0] for line in outline["lines"]}
    check("outline", {"window", "volume", "eye", "projector"} <= parts and outline["plane"] > 0, parts)
    image = answer(page, "outside", type="outside", size=[64, 40], exposure=0,
                     set={"eye": [900, 500, 0], "lookat": [0, 0, 0], "up": [0, 1, 0]})
    check("outside", base64.b64decode(image["data"])[:2] == b"\xff\xd8", image)
    check("outside_refused", answer(page, "outside", type="outside", set={"eye": [0, 0, 0], "lookat": [0, 0, 0]})["type"] == "refused")
    test_curves(page)
    test_flow(page)
    for channel in ("Z", "distance", "N", "Ng", "P", "uv", "albedo", "id.object", "id.material", "id.instance"):
        state_after(page, type="settings", channel=channel)
        frame = page.wait_frame(lambda f: f.channel > 0 and f.scale == 1)
        check("channel_" + channel, frame.format == 1 and frame.columns == frame.width, vars(frame))
    state_after(page, type="settings", channel="image")
    crop = [16, 8, 80, 40]
    state_after(page, type="settings", crop=crop)
    frame = page.wait_frame(lambda f: f.scale == 1 and f.columns == 64)
    check("crop", (frame.x0, frame.y0, frame.rows) == (16, 8, 32), vars(frame))
    check("crop_outside", state_after(page, type="settings", crop=[0, 0, 60000, 2])["type"] == "refused")
    state_after(page, type="settings", crop=None)


# ---- files ----

def wait_done(page):
    return page.wait(lambda m: isinstance(m, dict) and m["type"] == "status" and m["spp"] >= m["target"], 60)


def test_files(page, folder):
    state_after(page, type="settings", spp=3)
    edit(page, eye=[300, 200, 470], zoom=1.25)
    page.wait_frame(lambda f: f.change == page.change and f.spp == 3)
    look = dict(exposure=0.5, view="agx")
    for suffix in ("png", "exr", "pfm", "hdr", "jpg", "tga"):
        saved = answer(page, "saved", type="save", what="image", name=f"shown.{suffix}", **look)
        check("save_" + suffix, saved["type"] == "saved" and os.path.exists(os.path.join(folder, f"shown.{suffix}")), saved)
    again = answer(page, "saved", type="save", what="image", name="shown.png", **look)
    check("save_keeps_files", again.get("file") == "shown-2.png", again)
    for name in ("../up.png", "/tmp/up.png", ".hidden.png", "-o.png", "a.gif", ""):
        check("refused_name", answer(page, "saved", type="save", what="image", name=name, **look)["type"] == "refused", name)
    command = answer(page, "command", type="command", **look)
    words = shlex.split(command["command"])
    check("command", words[:2] == ["velo", "render"] and "--camera" in words, command)
    run = subprocess.run([VELO] + words[1:], cwd=folder, capture_output=True, text=True)
    check("command_runs", run.returncode == 0, run.stderr)
    same = lambda a, b: open(os.path.join(folder, a), "rb").read() == open(os.path.join(folder, b), "rb").read()
    check("command_same_png", same(words[-1], "shown.png"))
    for suffix in ("exr", "pfm"):
        run = subprocess.run([VELO] + words[1:-1] + [f"copy.{suffix}"], cwd=folder, capture_output=True, text=True)
        check("command_same_" + suffix, run.returncode == 0 and same(f"copy.{suffix}", f"shown.{suffix}"), run.stderr)
    frame_equals_file(page, folder, words)
    lists = page.lists["dialects"]
    written = 0
    for dialect in lists:
        saved = answer(page, "saved", type="save", what="camera", name=f"camera-{dialect}.{SUFFIX.get(dialect, 'json')}", dialect=dialect)
        written += saved["type"] == "saved"
        if saved["type"] == "refused":
            check("dialect_reason", len(saved["message"]) > 10, saved)
    print(f"   {written} of {len(lists)} dialects hold this camera", file=sys.stderr)
    check("dialects", written >= 15, written)


SUFFIX = dict(opencv="yaml", ros="yaml", kalibr="yaml", colmap="txt", gltf="gltf", mitsuba="xml", usd="usda", pbrt="pbrt",
              euroc="yaml", camodocal="yaml", orbslam="yaml", okvis="yaml", svo="yaml", kitti="txt", metashape="xml",
              meshroom="sfm", visp="xml", blender="json")


def frame_equals_file(page, folder, words):
    """The half floats of the frame are the rounded values of the .pfm."""
    data = open(os.path.join(folder, "shown.pfm"), "rb").read()
    head, size, order, floats = data.split(b"\n", 3)
    width, height = map(int, size.split())
    values = struct.unpack(f"<{3 * width * height}f", floats)
    rows = [values[3 * width * y:3 * width * (y + 1)] for y in range(height)][::-1]
    shown = struct.unpack(f"<{3 * width * height}e", bytes(page.pixels))
    exact = [v for row in rows for v in row]
    worst = max(abs(a - b) / max(abs(b), 2 ** -14) for a, b in zip(shown, exact) if b < 65504)
    check("frame_is_the_image", page.form[:2] == (width, height) and worst <= 2 ** -11 * 1.001, worst, page.form, width, height)


# ---- hostile values of settings ----

HOSTILE = (2**32 + 8, -1, 1.5, 1e300, -1e300, 1e-300, "", "8", "x" * 10000, True, [1, 2], {})
RAW = ("NaN", "Infinity", "-Infinity", "1e999")  # not JSON
CHANGES = itertools.count(1000)
SPELLED = {"view_distance": "d", "pixel_size": "s", "near_plane": "near", "far_plane": "far"}


def setting_rows(group):
    """Names and types of the rows of a group of settings."""
    text = subprocess.run([VELO, "scene", "kinds", "settings"], stdout=subprocess.PIPE, text=True, check=True).stdout
    part = text.split(f"**`{group}`**")[1].split("\n**`")[0]
    return re.findall(r"^\| `(\w+)` \| (\w+) ", part, re.M)


def reply(view, page, text):
    """What one message brings: (page, sentence, state). A page that was hung up on is replaced; its sentence is the reason."""
    change = next(CHANGES)  # a state that greets a new page has the number of an older edit
    page.send_raw(1, text.replace("CHANGE", str(change)).encode())
    while True:
        message = page.receive(60)
        if isinstance(message, tuple):
            page.close()
            return Page(view), message[2], None
        if isinstance(message, dict) and message["type"] == "refused":
            return page, message["message"], None
        if isinstance(message, dict) and message["type"] == "state" and message.get("change") == change:
            return page, "", message
        if isinstance(message, dict) and message.get("id") == change:
            return page, "", None


def test_settings(view, page):
    """Every setting that a page can send, by its row, has hostile values: refused with one sentence that names it, or a state of finite
    numbers. The server stays up, also while it renders what it accepted."""
    camera = [("camera", SPELLED.get(name, name), kind) for name, kind in setting_rows("camera")]
    types = {"exposure": "outside", "show": "paths", "samples": "paths", "spp": "settings", "x": "pick", "y": "pick"}
    own = [(types[name], name, kind) for name, kind in setting_rows("program") + setting_rows("render") if name in types]
    problems, tried, names = [], 0, set()
    for message, name, kind in camera + own:
        for value in [json.dumps(v) for v in HOSTILE] + list(RAW):
            member = f'"set":{{"{name}":{value}}}' if message == "camera" else f'"{name}":{value}'
            page, sentence, state = reply(view, page, f'{{"type":"{message}","id":CHANGE,"change":CHANGE,{member}}}')
            if "unknown field" in sentence:
                break
            tried += 1
            names.add(name)
            number = kind in ("float", "integer")
            wrong = value in RAW or (number and not re.match(r"-?[0-9]", value))
            said = name in sentence or name.replace("_", " ") in sentence or (value in RAW and "JSON" in sentence)
            if wrong and not said:
                problems.append((name, value[:20], sentence))
            if len(sentence) > 1000 or "\n" in sentence:
                problems.append((name, value[:20], len(sentence)))
            if state and re.search(r"NaN|Infinity", json.dumps(state["camera"])):
                problems.append((name, value[:20], "not finite"))
            if state and tried % 4 == 0:
                page.wait_frame()
            if state:
                page, sentence, state = reply(view, page, '{"type":"reset","change":CHANGE}')
    page, sentence, state = reply(view, page, '{"type":"settings","change":CHANGE,"spp":3}')
    check("settings", not problems and len(names) > 25 and tried > 400, problems[:5], len(names), tried)
    check("settings_server_stays", view.process.poll() is None and state, sentence)
    return page


def test_long(view):
    """A message of 10^9 bytes is refused when its first bytes are too many."""
    page = Page(view)
    sent = 0
    try:
        page.socket.sendall(bytes([0x81, 0x80 | 127]) + struct.pack("!Q", 10**9) + bytes(4))
        while sent < 10**9:
            page.socket.sendall(b"x" * 10**6)
            sent += 10**6
    except OSError:
        pass
    check("long", sent < 10**9 and closed(page)[1] in (1009, 0), sent)
    page.close()


# ---- malformed messages, many pages ----

def closed(page):
    try:
        while True:
            message = page.receive(5)
            if isinstance(message, tuple):
                return message
    except (ConnectionError, OSError):
        return ("closed", 0, "")


def test_documented(view):
    """Each type of docs/view.md is a type, and each of its members one that a number in place of text, or text in place of a number,
    makes wrong."""
    text = open(os.path.join(ROOT, "docs/view.md")).read()
    table = re.findall(r"^\| (`.*?) \| (.*) \|$", text[text.index("| type | members |"):text.index("velo answers with")], re.M)
    members = ("serial change gesture id x y exposure at shutter samples show spp paused denoise boxes curves field mark by_sample end "
               "crop size channel what name dialect view set").split()
    wrong, tried = [], 0
    for types, said in table:
        for kind in re.findall(r"`(\w+)`", types):
            for member in [m for m in re.findall(r"`(\w+)`", said.split("`set`: `")[0]) if m in members]:
                text_like = member in ("channel", "what", "name", "dialect", "view")
                page = Page(view)
                page.send(**{"type": kind, member: 5 if text_like else "x"})
                reason = closed(page)
                tried += 1
                if reason[1] != 1008 or member not in reason[2]:
                    wrong.append((kind, member, reason))
                page.close()
    check("documented", tried > 40 and not wrong, tried, wrong)


def test_malformed(view):
    rest = random.Random(5)
    texts = [b"", b"{", b"[]", b"null", b'{"type":1}', b'{"type":"camera","set":[]}', b'{"type":"camera","change":-1}',
             b'{"type":"camera","set":{"eye":[1,2,"x"]}}', b'{"type":"settings","spp":0}', b'{"type":"settings","spp":1e30}',
             b'{"type":"pick","x":1e300}', b'{"type":"save","name":5}', b'{"type":"seen","seen":1,"type":"seen"}', b"\xff\xfe",
             b'{"type":"camera","set":{' + b",".join(b'"f%d":1' % i for i in range(100)) + b"}}",
             b'{"type":"camera","set":{"eye":' + b"[" * 5000 + b"]" * 5000 + b"}}", b'{"type":"x"}',
             b'{"type":"save","name":"' + b"a" * 300 + b'"}', b'{"type":"save","name":"a\\u0000b"}']
    refused = 0
    for text in texts:
        page = Page(view)
        page.send_raw(1, text)
        refused += closed(page)[1] in (0, 1007, 1008, 1009)
        page.close()
    check("malformed", refused == len(texts), refused, len(texts))
    page = Page(view)
    page.send_raw(2, b"binary")
    check("binary", closed(page)[1] != 1000)
    page = Page(view)
    page.send_raw(1, b"x" * 70000)
    check("too_long", closed(page)[1] in (1009, 0))
    page = Page(view)
    page.send_raw(1, b"{}", masked=False)
    closed(page)
    seed = b'{"type":"camera","change":3,"gesture":4,"set":{"eye":[1,2,3],"fov":30,"projection":"perspective"}}'
    for i in range(1000):  # requests and messages of noise; most pages are closed by the first
        s = socket.create_connection((view.host, view.port), 10)
        s.sendall(rest.randbytes(rest.randrange(1, 300)) + b"\r\n\r\n" * (i % 2))
        s.close()
        if i % 5 == 0:
            text = bytearray(seed)
            for _ in range(rest.randrange(1, 6)):
                text[rest.randrange(len(text))] = rest.randrange(256)
            page = Page(view)
            page.send_raw(1, bytes(text), final=rest.random() < 0.9)
            page.close()
    check("still_there", view.get(view.path)[0] == 200)


def test_many(view):
    pages = []
    for i in range(50):
        pages.append(Page(view))
        if i % 3 == 0:
            pages.pop(0).close()
    for page in pages[:5]:
        page.wait_frame()
    roles = [page.wait_text("role") if not page.texts else None for page in pages[5:6]]
    for page in pages:
        page.close()
    page = Page(view)
    role = page.wait_text("role")
    until = time.monotonic() + 10
    while not role["steers"] and time.monotonic() < until:  # the server learns that the others are gone
        role = page.wait_text("role")
    check("many_pages", role["steers"] and roles, role)
    other = Page(view)
    looks = other.wait_text("role")
    other.change = 1
    check("second_looks", not looks["steers"])
    check("second_is_refused", edit(other, fov=20)["type"] == "refused")
    check("pages_are_counted", looks["pages"] == 2 and page.wait_text("role")["pages"] == 2, looks)
    other.send(type="steer")
    check("takes_over", other.wait_text("role")["steers"] and not page.wait_text("role")["steers"])
    check("first_is_refused", edit(page, fov=20)["type"] == "refused")
    page.send(type="steer")
    check("takes_over_again", page.wait_text("role")["steers"] and not other.wait_text("role")["steers"])
    page.close()
    role = other.wait_text("role")
    check("heir_steers", role["steers"] and role["pages"] == 1, role)
    check("heir_edits", edit(other, fov=20)["type"] == "state")
    # not by the status: one from before the edit may still be on its way, and the film would have no sample
    other.wait_frame(lambda f: f.change == other.change and f.scale == 1 and f.spp == 3)
    other.close()


def test_page_that_does_not_read(view):
    """What waits for it is limited; the last state arrives all the same."""
    page, idle = Page(view), Page(view)
    page.change = idle.wait_text("state")["change"]
    idle.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    last = [edit(page, fov=20 + 0.01 * i) for i in range(3000)][-1]  # half of it is more than the system's buffers take
    idle.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
    try:
        state = idle.wait(lambda m: isinstance(m, dict) and m["type"] == "state" and m["change"] >= last["change"], 20)
    except TimeoutError:
        state = None
    check("last_state_arrives", state and state["camera"]["fov"] == last["camera"]["fov"], state)
    page.close()
    idle.close()


# ---- files that change ----

SMALL = ('LookAt 0 0 5 0 0 0 0 1 0\nCamera "perspective" "float fov" 40\nSampler "halton" "integer pixelsamples" 4\n'
         'Film "rgb" "integer xresolution" 64 "integer yresolution" 48\nWorldBegin\nLightSource "infinite"\n')


def test_watch(folder):
    inner = os.path.join(folder, "things.pbrt")
    outer = os.path.join(folder, "watched.pbrt")
    thing = 'Material "diffuse" "rgb reflectance" [%s]\nShape "sphere"\n'
    open(inner, "w").write(thing % "0.8 0.1 0.1")
    open(outer, "w").write(SMALL + 'Include "things.pbrt"\n')
    view = View(VELO, outer, cwd=folder)
    page = Page(view)
    middle = lambda: struct.unpack_from("<3e", page.pixels, 6 * (24 * 64 + 32))
    wait_done(page)
    red = middle()
    check("watch_first", red[0] > 2 * red[1], red)
    moved = edit(page, eye=[0, 0, 4.5])
    open(inner, "w").write(thing % "0.1 0.8 0.1")
    page.wait_text("loaded")
    state = page.wait_text("state")
    page.wait_frame(lambda f: f.scale == 1 and middle()[1] > 2 * middle()[0])
    check("watch_change", True)
    check("watch_keeps_camera", state["camera"]["eye"] == moved["camera"]["eye"], state["camera"]["eye"])
    open(inner, "w").write(thing % "0.1 0.8 0.1" + 'Shape "spere"\n')
    error = page.wait_text("error")
    check("watch_error", error["file"].endswith("things.pbrt") and error["line"] == 3 and error["column"] > 0 and
          "spere" in error["message"], error)
    edit(page, eye=[0, 0, 4.75])
    page.wait_frame(lambda f: f.scale == 1)
    check("watch_old_image_stays", middle()[1] > 2 * middle()[0], middle())
    new = inner + ".new"  # as editors do it: another file takes its place
    open(new, "w").write(thing % "0.1 0.1 0.8")
    os.rename(new, inner)
    page.wait_text("loaded")
    page.wait_frame(lambda f: f.scale == 1 and middle()[2] > 2 * middle()[0])
    check("watch_mended", True)
    page.close()
    check("watch_ends", view.end()[0] == 0)


# ---- a sandbox ----

def threads_of(process):
    """The status of each thread, as a dict."""
    for thread in os.listdir(f"/proc/{process}/task"):
        with open(f"/proc/{process}/task/{thread}/status") as file:
            yield dict(line.rstrip("\n").split(":\t", 1) for line in file if ":\t" in line)


def arguments_of_all():
    """The arguments of every process of this machine, as every user can read them."""
    for process in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{process}/cmdline", "rb") as file:
                yield file.read()
        except OSError:
            pass  # it has ended


def test_same_port(folder):
    """Runs on one port have one token, which only the user can read; other ports have others."""
    private = os.path.join(folder, "private")
    os.mkdir(private, 0o700)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]

    def run(*options, **env):
        view = View(VELO, os.path.join(folder, "confined.pbrt"), *options, cwd=folder, env={**os.environ, "XDG_RUNTIME_DIR": private, **env})
        view.end()
        return view.path
    first = run("--port", str(port))
    check("same_port_same_token", run("--port", str(port)) == first)
    names = os.listdir(private)
    check("token_is_private", len(names) == 1 and os.stat(os.path.join(private, names[0])).st_mode & 0o777 == 0o600, names)
    check("free_port_new_token", run() != first)
    check("listen_new_token", run("--port", str(port), "--listen", "127.0.0.1") != first)
    with open(os.path.join(private, names[0]), "w") as file:
        file.write("../../etc")
    second = run("--port", str(port))
    check("broken_token", second != first and run("--port", str(port)) == second, second)
    os.chmod(private, 0o755)
    check("folder_of_others", run("--port", str(port), TMPDIR=folder) != second)
    os.unlink(os.path.join(private, names[0]))
    os.chmod(private, 0o700)
    os.symlink(os.path.join(folder, "confined.pbrt"), os.path.join(private, names[0]))
    check("no_link_is_followed", run("--port", str(port)) != run("--port", str(port)))


def test_sandbox(folder):
    """The system confines velo and all its threads; the page, the browser, saved files and reloads work."""
    for name in ("box", "work", "films", "programs", "elsewhere"):
        os.mkdir(os.path.join(folder, name))
    scene, opener = os.path.join(folder, "confined.pbrt"), os.path.join(folder, "programs/xdg-open")
    opened, work = os.path.join(folder, "opened"), os.path.join(folder, "work")
    with open(opener, "w") as file:
        file.write(f'#!/bin/sh\nprintf %s "$1" >{shlex.quote(opened)}.part && mv {shlex.quote(opened)}.part {shlex.quote(opened)}\nsleep 2\n')
    os.chmod(opener, 0o755)

    def replace(more):
        with open(scene + ".new", "w") as file:
            file.write(SMALL + more)
        os.rename(scene + ".new", scene)
    replace("")
    for name in ("box", "elsewhere"):
        with open(os.path.join(folder, name, "inner.pbrt"), "w") as file:
            file.write('Material "diffuse"\n')
    view = View(VELO, scene, "--sandbox", os.path.join(folder, "box"), "--film",
                os.path.join(folder, "films/a.film"), "--threads", "2", cwd=work, opens=True,
                env={**os.environ, "DISPLAY": ":none", "PATH": f"{folder}/programs:{os.environ['PATH']}"})
    page = Page(view)
    page.lists = page.wait_text("lists")
    wait_done(page)
    threads = list(threads_of(view.process.pid))
    until = time.monotonic() + 20
    while not os.path.exists(opened) and time.monotonic() < until:
        time.sleep(0.05)
    way = open(opened).read()
    check("sandbox_opens_the_browser", view.address in open(way).read() and os.stat(way).st_mode & 0o777 == 0o600, way)
    check("no_argument_has_the_token", not [line for line in arguments_of_all() if view.path.strip("/").encode() in line])
    saved = answer(page, "saved", type="save", what="camera", name="camera.json", dialect="velo")
    check("sandbox_saves_a_camera", saved["type"] == "saved" and os.path.exists(os.path.join(work, "camera.json")), saved)
    saved = answer(page, "saved", type="save", what="image", name="shown.png", view="standard", exposure=0)
    check("sandbox_saves_an_image", saved["type"] == "saved" and os.path.exists(os.path.join(work, "shown.png")), saved)
    replace('Include "box/inner.pbrt"\n')
    check("sandbox_reloads", bool(page.wait_text("loaded")))
    replace('Include "elsewhere/inner.pbrt"\n')
    error = page.wait_text("error")
    check("sandbox_refuses_others", "outside of the sandbox" in error["message"], error)
    replace("")
    page.wait_text("loaded")
    wait_done(page)
    page.close()
    code, errors = view.end()
    check("way_is_removed", not os.path.exists(way))
    check("sandbox_ends", code == 0 and os.path.exists(os.path.join(folder, "films/a.film")), code, errors)
    if "files by folder" in errors and "network open" not in errors:
        check("sandbox_confines_each_thread", len(threads) > 5 and
              all(thread["NoNewPrivs"] == "1" and thread["Seccomp"] == "2" for thread in threads), [(thread["Name"], thread["Seccomp"]) for thread in threads])
        check("sandbox_has_no_network", "no network but the page" in errors, errors)
    else:
        print("skip sandbox_confines_each_thread: this system lacks Landlock or seccomp")


def test_serve(folder):
    """velo render --serve: the same page, which only looks on."""
    run = subprocess.Popen([VELO, "render", SCENE, "--resolution", "160x120", "--time", "6", "--serve", "-o", "served.png"],
                           cwd=folder, stderr=subprocess.PIPE, text=True)
    line = ""
    while "http://" not in line:
        line = run.stderr.readline()
        if not line:
            break
    address = urlsplit(line[line.find("http://"):].strip())
    view = SimpleNamespace(host=address.hostname, port=address.port, path=address.path)
    page = Page(view)
    role = page.wait_text("role")
    check("serve_looks", not role["steers"] and not role["steering"], role)
    frame = page.wait_frame()
    check("serve_frame", (frame.columns, frame.rows) == (160, 120) and frame.spp > 0, vars(frame))
    check("serve_refuses", edit(page, fov=20)["type"] == "refused")
    more = page.wait_frame(lambda f: f.spp > frame.spp)
    check("serve_goes_on", more.serial > frame.serial)
    page.close()
    check("serve_ends", run.wait(60) == 0 and os.path.exists(os.path.join(folder, "served.png")))
    run.stderr.close()


def test_not_finite(folder):
    """Samples that are left out are told once, in the log and on the page."""
    with open(os.path.join(folder, "nan.pfm"), "wb") as file:
        file.write(b"PF\n1 1\n-1.0\n" + struct.pack("<3f", *3 * [math.nan]))
    scene = os.path.join(folder, "nan.pbrt")
    with open(scene, "w") as file:
        file.write('Film "rgb" "integer xresolution" 32 "integer yresolution" 24\nCamera "perspective"\nWorldBegin\n'
                   'LightSource "infinite"\nTexture "t" "spectrum" "imagemap" "string filename" "nan.pfm"\n'
                   'Material "diffuse" "texture reflectance" "t" Translate 0 0 3 Shape "sphere"\n')
    view = View(VELO, scene, "--color", "rgb", "--spp", "8")
    page = Page(view)
    note = page.wait_text("note")
    page.wait(lambda m: isinstance(m, dict) and m["type"] == "status" and m["spp"] == 8)
    later = Page(view)
    check("later_pages_are_told", later.wait_text("note") == note)
    later.close()
    page.close()
    code, errors = view.end()
    lines = [line for line in errors.splitlines() if "samples were not finite" in line]
    check("not_finite_is_told", code == 0 and len(lines) == 1 and lines[0].endswith(note["message"]), errors, note)


def main():
    missing = subprocess.run([VELO, "view", "missing.pbrt"], capture_output=True, text=True, timeout=60)
    if "without libwebsockets" in missing.stderr:
        print("skip view: velo was built without libwebsockets")
        return
    check("missing_scene", missing.returncode == 4, missing.stderr)
    folder = tempfile.mkdtemp(prefix="velo-view-")
    film = os.path.join(folder, "end.film")
    view = View(VELO, SCENE, "--resolution", "160x120", "--film", film, "--threads", "2", cwd=folder,
                env={**os.environ, "SSH_CONNECTION": "192.0.2.1 50000 192.0.2.7 22"})
    try:
        test_access(view)
        page = Page(view)
        frame = page.wait_frame()
        check("first_frame", frame.width == 160 and frame.scale >= 1, vars(frame))
        page.close()
        page = Page(view)
        page.lists = page.wait_text("lists")
        page.send(type="settings", denoise=False)  # frames are compared with saved images
        test_camera(page)
        page.wait_camera = state_after(page, type="reset")["camera"]
        test_words(view, page, folder)
        test_latency(page)
        test_tasks(page)
        test_files(page, folder)
        page.close()
        test_settings(view, Page(view)).close()
        test_long(view)
        test_documented(view)
        test_malformed(view)
        test_many(view)
        test_page_that_does_not_read(view)
    finally:
        code, errors = view.end()
    check("ends", code == 0, code, errors)
    check("ssh_line", f"ssh -N -L {view.port}:127.0.0.1:{view.port}" in errors, errors)
    test_other_tracer(folder)
    test_not_finite(folder)
    test_trajectory(folder)
    test_watch(folder)
    test_sandbox(folder)
    test_same_port(folder)
    test_serve(folder)
    info = subprocess.run([VELO, "film", "info", film], capture_output=True, text=True)
    check("film", info.returncode == 0, info.stderr)
    before = open(film, "rb").read()
    refused = subprocess.run([VELO, "view", SCENE, "--no-open", "--film", film], capture_output=True, text=True, timeout=60)
    check("film_is_kept", refused.returncode == 2 and "is a film already; --overwrite" in refused.stderr, refused.stderr)
    check("film_is_unchanged", open(film, "rb").read() == before)
    refused = subprocess.run([VELO, "view", SCENE, "--no-open", "--light-paths", "16777217"], capture_output=True, text=True, timeout=60)
    check("too_many_light_paths", refused.returncode == 2 and "--light-paths" in refused.stderr, refused.stderr)
    shutil.rmtree(folder)


main()
results.end()
