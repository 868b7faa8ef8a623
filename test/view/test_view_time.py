#!/usr/bin/python3
"""The timeline of velo view: another time of an animation, with motion blur and without, keeps the page's camera and its settings, and
the copied command makes these bytes; times that cannot be are refused. In chromium: scrub, play, loop, blur; the cameras of a trajectory."""
import os
import shlex
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from copied import ask, bytes_of  # noqa: E402
from live import Frame, Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402
from test_view_copied import SCENE, VELO, box, write_gltf  # noqa: E402

SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written
OPTIONS = ("--spp", "2", "--resolution", "64x48")


def state_of(page, change):
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in ("state", "refused") and m.get("change") == change, 60)


def finished(page, change):
    """The image with the number of this change has all its samples. An image waits until the page has seen the one before; a
    status does not, so that either may come first."""
    missing = {"image", "samples"}

    def complete(m):
        if isinstance(m, Frame) and m.change == change:
            missing.discard("image")
        elif isinstance(m, dict) and m["type"] == "status" and m["change"] == change and m["spp"] >= m["target"]:
            missing.discard("samples")
        return not missing

    page.wait(complete, 60)


def test_engine(folder):
    view = View(VELO, "walk.gltf", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        first = page.wait(lambda m: isinstance(m, dict) and m["type"] == "state")
        check("duration", first["time"] == {"from": 0, "seconds": 2, "at": None, "shutter": 0}, first["time"])
        page.send(type="camera", change=5, set={"roll": 7})
        moved = state_of(page, 5)
        page.send(type="time", at=0.25, shutter=0, change=6)
        later = state_of(page, 6)
        check("time", later.get("time") == {"from": 0, "seconds": 2, "at": 0.25, "shutter": 0}, later)
        check("camera_stays", later["camera"] == moved["camera"], moved["camera"], later["camera"])
        check("exposure_stays", later["exposure"] == first["exposure"])
        check("undo_stays", later["can_undo"])
        finished(page, 6)
        files = []
        for shutter, change in ((0, 6), (0.5, 7)):
            if shutter:
                page.send(type="time", at=0.25, shutter=shutter, change=change)
                check("blur", state_of(page, change)["time"]["shutter"] == 0.5)
                finished(page, change)
            saved = ask(page, "saved", type="save", what="image", name="walk.exr", exposure=0, view="standard")["file"]
            command = ask(page, "command", type="command", exposure=0, view="standard")["command"]
            words = shlex.split(command)
            check(f"command_has_the_time_{change}", words[words.index("--at") + 1] == ("0.25:0.75" if shutter else "0.25"), command)
            subprocess.run([VELO, *words[1:], "-o", f"copy{change}.exr"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
            check(f"same_bytes_{change}", bytes_of(folder, saved) == bytes_of(folder, f"copy{change}.exr"), command)
            files.append(bytes_of(folder, saved))
        check("blur_is_seen", files[0] != files[1])
        page.send(type="reset", change=8)
        home = state_of(page, 8)
        check("reset", home["camera"]["roll"] == first["camera"]["roll"])
        for i in range(40):  # more than can be shown: the newest counts
            page.send(type="time", at=0.01 * i, shutter=0, change=100 + i)
        check("newest_counts", state_of(page, 139)["time"]["at"] == 0.39)
        for at, shutter in (("x", 0), (1e9, 0), (0, -1)):
            bad = Page(view)
            bad.send(type="time", at=at, shutter=shutter, change=200)
            try:
                bad.wait(lambda m: False, 20)
                check(f"bad_{at}_{shutter}", False)
            except ConnectionError as error:
                check(f"bad_{at}_{shutter}", "must be" in str(error), error)
            bad.socket.close()
    finally:
        page.socket.close()
        code, errors = view.end()
        check("ends", code == 0, errors)


def test_own_camera(folder):
    """A camera of the file's is followed until the page moves it."""
    view = View(VELO, "seen.gltf", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        first = page.wait(lambda m: isinstance(m, dict) and m["type"] == "state")
        page.send(type="time", at=0.5, shutter=0, change=2)
        second = state_of(page, 2)
        check("own_camera", second["camera"]["eye"] == first["camera"]["eye"], first["camera"]["eye"], second["camera"]["eye"])
    finally:
        page.socket.close()
        view.end()


MOVING = '''LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "float shutteropen" 0 "float shutterclose" 1
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
TransformTimes 0 1
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9]
Material "diffuse" "rgb reflectance" [0.6 0.3 0.1]
ActiveTransform EndTime
Translate 1.5 0 0
ActiveTransform All
Shape "sphere" "float radius" 0.8
'''


def test_shutter(folder):
    """The shutter of a scene that moves by itself: an instant, a while; the copied command has it."""
    view = View(VELO, "moving.pbrt", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        files = []
        for change, (opens, closes) in enumerate(((0, 1), (0.5, 0.5)), 2):
            page.send(type="camera", change=change, set={"shutter_open": opens, "shutter_close": closes})
            state = state_of(page, change)
            check(f"shutter_{change}", (state["camera"]["shutter_open"], state["camera"]["shutter_close"]) == (opens, closes), state)
            finished(page, change)
            saved = ask(page, "saved", type="save", what="image", name="moving.exr", exposure=0, view="standard")["file"]
            words = shlex.split(ask(page, "command", type="command", exposure=0, view="standard")["command"])
            subprocess.run([VELO, *words[1:], "-o", f"still{change}.exr"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
            check(f"same_bytes_{change}", bytes_of(folder, saved) == bytes_of(folder, f"still{change}.exr"), words)
            files.append(bytes_of(folder, saved))
        check("shutter_is_seen", files[0] != files[1])
        page.send(type="camera", change=9, set={"shutter_open": 2})
        check("shutter_refused", state_of(page, 9)["type"] == "refused")
    finally:
        page.socket.close()
        view.end()


MOVING_CAMERA = '''Camera "thinlens" "point3 eye" [0 1 5] "point3 lookat" [0 0 0] "point3 eyeclose" [2 1 5] "float shutteropen" 1 "float shutterclose" 3
  "float focallength" 50 "float sensorwidth" 36 "float iso" 100 "float fnumber" 8
Film "rgb" "integer xresolution" 64 "integer yresolution" 48
WorldBegin
LightSource "infinite" "rgb L" [50 60 90]
Shape "sphere" "float radius" 0.8
'''


def test_motion(folder):
    """The timeline of a scene that moves by itself moves the shutter: undo, the copied command; a moving camera keeps the times of its
    poses and the image its brightness, also by the fields of the panel."""
    view = View(VELO, "moving.pbrt", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        first = page.wait(lambda m: isinstance(m, dict) and m["type"] == "state")
        check("motion", first["time"] == {"from": 0, "seconds": 1, "at": 0, "shutter": 1}, first["time"])
        page.send(type="time", at=0.25, shutter=0.5, gesture=4, change=2)
        page.send(type="time", at=0.5, shutter=0, gesture=4, change=3)
        check("motion_time", state_of(page, 3).get("time") == {"from": 0, "seconds": 1, "at": 0.5, "shutter": 0})
        page.send(type="undo", change=4)
        check("motion_undo", state_of(page, 4)["time"] == first["time"])
    finally:
        page.socket.close()
        view.end()
    view = View(VELO, "moving_camera.pbrt", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        first = page.wait(lambda m: isinstance(m, dict) and m["type"] == "state")
        check("camera_motion", first["time"] == {"from": 1, "seconds": 2, "at": 1, "shutter": 2}, first["time"])
        files = []
        for change, edit in enumerate(({"type": "time", "at": 1.5, "shutter": 0}, {"type": "time", "at": 2, "shutter": 0},
                                       {"type": "camera", "set": {"shutter_open": 1.5, "shutter_close": 1.5}}), 2):
            page.send(change=change, **edit)
            state = state_of(page, change)
            check(f"poses_keep_their_times_{change}", state.get("time", {}).get("from") == 1 and state["time"]["seconds"] == 2, state)
            check(f"brightness_{change}", state["camera"]["exposure_time"] == first["camera"]["exposure_time"])
            finished(page, change)
            saved = ask(page, "saved", type="save", what="image", name="camera.exr", exposure=0, view="standard")["file"]
            words = shlex.split(ask(page, "command", type="command", exposure=0, view="standard")["command"])
            subprocess.run([VELO, *words[1:], "-o", f"camera_still{change}.exr"], cwd=folder, check=True, stderr=subprocess.DEVNULL)
            check(f"camera_same_bytes_{change}", bytes_of(folder, saved) == bytes_of(folder, f"camera_still{change}.exr"), words)
            files.append(bytes_of(folder, saved))
        check("camera_moved", files[0] != files[1])
        check("same_as_the_panel", files[0] == files[2])
    finally:
        page.socket.close()
        view.end()


def test_none(folder):
    view = View(VELO, "still.pbrt", *OPTIONS, cwd=folder)
    page = Page(view)
    try:
        first = page.wait(lambda m: isinstance(m, dict) and m["type"] == "state")
        check("no_animation", first["time"]["seconds"] == 0 and first["poses"] == 0, first)
        page.send(type="time", at=1, shutter=0, change=2)
        check("refused", state_of(page, 2)["type"] == "refused")
    finally:
        page.socket.close()
        view.end()


def test_browser(folder):
    view = View(VELO, "walk.gltf", "--trajectory", "way.tum", "--spp", "64", "--resolution", "320x240", cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("window.velo?.state && window.velo.frames > 0")
        check("timeline_is_there", not b.run("document.getElementById('timeline').hidden"))
        b.run("(() => { const s = document.getElementById('time-at'); s.value = 0.4; s.dispatchEvent(new Event('input')); })()")
        check("scrub", bool(b.wait("window.velo.state.time.at === 0.4")))
        check("scrub_text", b.run("document.getElementById('time-text').textContent") == "0.40 of 2.00 s")
        b.click_on("#blur")
        check("blur_on", bool(b.wait("window.velo.state.time.shutter > 0.02 && document.getElementById('blur').ariaPressed === 'true'")))
        b.click_on("#blur")
        check("blur_off", bool(b.wait("window.velo.state.time.shutter === 0")))
        b.run("window.times = []; setInterval(() => { const t = window.velo.state.time.at; if (t !== window.times.at(-1)) window.times.push(t); }, 5)")
        b.click_on("#time-play")
        b.wait("window.times.some((t, i) => t < window.times[i - 1])")
        times = b.run("window.times")
        check("loops", len(times) > 2, times)  # how many times fit into one round is a matter of the machine
        b.click_on("#time-loop")
        b.wait("document.getElementById('time-play').ariaPressed === 'false' && window.velo.state.time.at === 2")
        check("ends_at_the_end", True)
        b.run("(() => { const s = document.getElementById('pose-at'); s.value = 3; s.dispatchEvent(new Event('input')); })()")
        check("pose", bool(b.wait("Math.abs(window.velo.state.camera.eye[0] - 1) < 1e-6")), b.run("window.velo.state.camera.eye"))
        check("pose_text", b.run("document.getElementById('pose-text').textContent") == "camera 4 of 5")
        b.click_on("#pose-loop")
        b.click_on("#pose-play")
        check("pose_plays", bool(b.wait("Math.abs(window.velo.state.camera.eye[0] - 2) < 1e-6")))
        check("no_errors", not b.problems(), b.problems())
        if SHOTS:
            b.screenshot(os.path.join(SHOTS, "timeline.png"))
    finally:
        b.end()
        view.end()


def test_browser_motion(folder):
    """The timeline of a camera that moves from 1 s to 3 s."""
    view = View(VELO, "moving_camera.pbrt", *OPTIONS, cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("window.velo?.state && window.velo.frames > 0 && velo.steers")
        check("motion_range", b.run("[document.getElementById('time-at').min, document.getElementById('time-at').max]") == ["1", "3"])
        b.run("(() => { const s = document.getElementById('time-at'); s.value = 2.5; s.dispatchEvent(new Event('input')); })()")
        check("motion_scrub", bool(b.wait("velo.state.time.at === 2.5 && velo.state.time.shutter === 2")))
        b.click_on("#blur")
        check("motion_blur_off", bool(b.wait("velo.state.time.shutter === 0 && document.getElementById('blur').ariaPressed === 'false'")))
        b.run("window.times = []; setInterval(() => { const t = velo.state.time.at; if (t !== window.times.at(-1)) window.times.push(t); }, 5)")
        b.click_on("#time-play")
        b.wait("window.times.some((t, i) => t < window.times[i - 1])")
        check("motion_loops", b.run("Math.min(...window.times) >= 1 && Math.max(...window.times) <= 3"), b.run("window.times"))
        b.click_on("#time-play")
        b.click_on("#blur")
        check("motion_blur_on", bool(b.wait("velo.state.time.shutter === 2")))
        b.click_on("#undo")
        check("motion_undone", bool(b.wait("velo.state.time.shutter === 0")))
        check("motion_no_errors", not b.problems(), b.problems())
        if SHOTS:
            b.screenshot(os.path.join(SHOTS, "motion.png"))
    finally:
        b.end()
        view.end()


def main():
    reason = cannot_view(VELO)
    with tempfile.TemporaryDirectory() as folder:
        parts = [box((-0.5, 0, -0.5), (0.5, 1, 0.5)), box((-2, -0.2, -1), (2, 0, 1))]
        write_gltf(os.path.join(folder, "walk.gltf"), parts, moves=True)
        write_gltf(os.path.join(folder, "seen.gltf"), parts, moves=True, camera=True)
        with open(os.path.join(folder, "still.pbrt"), "w", encoding="utf-8") as file:
            file.write(SCENE)
        with open(os.path.join(folder, "way.tum"), "w", encoding="utf-8") as file:
            file.write("".join(f"{i} {-2 + i} 1.5 4 1 0 0 0\n" for i in range(5)))
        test_engine(folder)
        test_own_camera(folder)
        test_none(folder)
        with open(os.path.join(folder, "moving.pbrt"), "w", encoding="utf-8") as file:
            file.write(MOVING)
        with open(os.path.join(folder, "moving_camera.pbrt"), "w", encoding="utf-8") as file:
            file.write(MOVING_CAMERA)
        test_shutter(folder)
        test_motion(folder)
        if reason:
            print(f"skip browser: {reason}")
        else:
            test_browser(folder)
            test_browser_motion(folder)
    results.end()


main()
