#!/usr/bin/python3
"""Pages of velo view in real browsers: who steers and taking over, velo that ends and begins again on its port, browsers without
WebGL2 or whose context is lost, the file that leads the browser to the page, a file whose image size changes. Skipped without chromium."""
import os
import shutil
import socket
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from live import View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written
SCENE = '''LookAt 0 1 5 0 0 0 0 1 0
Camera "perspective" "float fov" %s
Sampler "halton" "integer pixelsamples" 4
Film "rgb" "integer xresolution" %d "integer yresolution" 120
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9]
Material "diffuse" "rgb reflectance" [0.7 0.2 0.1]
Shape "sphere" "float radius" 0.8
'''
READY = "window.velo?.frames > 0 && velo.state && velo.steers"


def write_scene(folder, fov=40, width=160):
    path = os.path.join(folder, "shown.pbrt")
    with open(path + ".new", "w") as file:
        file.write(SCENE % (fov, width))
    os.rename(path + ".new", path)
    return path


def shot(b, name):
    if SHOTS:
        b.screenshot(os.path.join(SHOTS, name + ".png"))


def test_roles(folder):
    """A lasting sign says who steers; what a page may not do looks off, until it takes over."""
    view = View(VELO, write_scene(folder), cwd=folder)
    first, second = Browser(), Browser()
    off = "[...document.querySelectorAll('header button, #tools button, #side input, #side select, #side button')].filter(e => e.disabled).map(e => e.id || e.dataset.tool)"
    said = "document.getElementById('role').hidden ? '' : document.getElementById('role-text').textContent"
    try:
        first.open(view.address)
        first.wait(READY)
        check("alone_no_sign", first.run(said) == "", first.run(said))
        second.open(view.address)
        second.wait("window.velo?.frames > 0 && velo.state && velo.steers === false")
        time.sleep(7)  # longer than a calm notice stays
        check("says_who_steers", (first.run(said), second.run(said)) == ("you steer, 1 looks on", "another page steers"), first.run(said), second.run(said))
        names = set(second.run(off))
        check("others_are_off", {"undo", "reset", "pause", "orbit", "look", "turn", "focus", "crop", "channel", "spp", "save-image", "copy-command",
                                 "field-eye", "field-fov"} <= names and "inspect" not in names, names)
        faint = second.run("Number(getComputedStyle(document.getElementById('reset')).opacity)")
        check("off_looks_off", faint < 0.5 and first.run("Number(getComputedStyle(document.getElementById('reset')).opacity)") == 1, faint)
        shot(second, "looks_on")
        shot(first, "steers")
        second.click_on("#take-over")
        second.wait("velo.steers === true")
        first.wait("velo.steers === false")
        check("taken_over", second.run(said) == "you steer, 1 looks on" and first.run(said) == "another page steers")
        check("all_is_on", set(second.run(off)) <= {"undo", "redo"} and second.run("velo.tool") == "orbit", second.run(off))
        second.run("velo.edit({eye: [1, 1, 5]})")
        first.wait("velo.state.camera.eye[0] === 1")
        check("the_other_edits", True)
        first.click_on("#take-over")
        first.wait("velo.steers === true && !document.getElementById('reset').disabled")
        first.run("velo.edit({eye: [2, 1, 5]})")
        second.wait("velo.state.camera.eye[0] === 2")
        check("taken_back", second.run(said) == "another page steers")
        check("roles_no_errors", not first.problems() + second.problems(), first.problems(), second.problems())
    finally:
        first.end()
        second.end()
        view.end()


def test_again(folder):
    """velo ends and begins again on the same port: the page finds it. Another token: the page says so."""
    private = os.path.join(folder, "private")
    os.mkdir(private, 0o700)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])

    def start():
        return View(VELO, write_scene(folder), "--port", port, cwd=folder, env={**os.environ, "XDG_RUNTIME_DIR": private})
    view = start()
    b = Browser()
    try:
        b.open(view.address)
        b.wait(READY)
        b.click_on("#outside-toggle")
        b.wait("velo.outside.drawing && !!velo.outside.image")
        b.run("velo.edit({eye: [1, 1, 5]})")
        b.wait("velo.state.camera.eye[0] === 1")
        view.end()
        b.wait("!velo.connected && document.getElementById('role-text').textContent === 'no connection'", 20)
        check("away_is_off", b.run("document.getElementById('reset').disabled && document.getElementById('field-fov').disabled"))
        b.run("velo.edit({eye: [3, 1, 5]})")
        b.run("velo.outside.render()")
        shot(b, "away")
        frames = b.run("velo.frames")
        view = start()
        b.wait(f"velo.connected && velo.steers && velo.frames > {frames} && velo.state.camera.eye[0] === 0", 30)
        check("found_again", True)
        b.run("velo.edit({eye: [2, 1, 5]})")
        b.wait("velo.state.camera.eye[0] === 2 && velo.local.eye[0] === 2", 20)
        b.run("window.drawingBefore = velo.outside.drawing, velo.outside.image = null, velo.outside.render(), velo.outside.outline()")
        b.wait("!!velo.outside.image && velo.outside.drawing !== drawingBefore", 20)
        check("works_again", not [p for p in b.problems() if "WebSocket" not in p and "Failed to load" not in p and "ERR_" not in p], b.problems())
        view.end()
        os.unlink(os.path.join(private, f"velo-view-{port}.token"))
        view = start()
        text = b.wait("document.getElementById('status').textContent.includes('another address') && document.getElementById('status').textContent", 20)
        check("another_address", "printed" in text, text)
    finally:
        b.end()
        view.end()


def test_plain(folder):
    """Without WebGL2, and when the browser takes it away, the image is there with the same values."""
    view = View(VELO, write_scene(folder, width=200), cwd=folder)
    b = Browser()
    # the same frame by the graphics processor, then by the processor alone
    both = "(() => { const g = velo.screen.values(), p = velo.screen.plainValues(); let most = 0; for (let i = 0; i < g.length; i++) most = Math.max(most, Math.abs(g[i] - p[i])); return most; })()"
    seen = ("(() => { const c = document.getElementById('plain'); if (c.hidden) return null; const d = c.getContext('2d').getImageData(c.width / 2, c.height / 2, 1, 1).data;"
            " return [...d]; })()")
    try:
        b.open(view.address)
        b.wait(READY)
        b.run("velo.settings({denoise: false})")
        b.wait("document.getElementById('status').textContent.includes('done') && velo.screen.frame.scale === 1 && !velo.screen.frame.denoised")
        for i, name in enumerate(("standard", "neutral", "agx", "raw")):
            b.run(f"velo.display.view.value = {i}; velo.display.set({0.7 * i - 0.5})")
            check(f"plain_{name}", b.run(both) <= 1, b.run(both))
        b.run("velo.display.view.value = 0; velo.display.set(0)")
        for channel in ("Z", "N", "P", "uv", "albedo", "id.object", "error", "forward"):
            b.run(f"velo.settings({{channel: '{channel}'}})")
            b.wait(f"velo.display.channels[velo.screen.frame.channel] === '{channel}'")
            check(f"plain_{channel}", b.run(both) <= 1, b.run(both))
        b.run("velo.settings({channel: 'image'})")
        b.run("velo.settings({denoise: false})")  # the values are compared with those after the context is back
        b.wait("velo.screen.frame.channel === 0 && velo.screen.frame.scale === 1")
        b.wait("document.getElementById('denoise').getAttribute('aria-pressed') === 'false' && velo.screen.frame.denoised === 0")
        b.run("window.taker = velo.screen.gl.getExtension('WEBGL_lose_context'); window.before = velo.screen.values(); taker.loseContext()")
        colour = b.wait(seen, 10)
        check("lost_context_shows_the_image", colour[0] > 1.5 * colour[2] and colour[3] == 255, colour)
        check("lost_context_says_so", "graphics processor" in b.run("document.getElementById('notice').textContent"))
        b.run("velo.display.view.value = 2; velo.display.set(1); document.getElementById('keep').click(); velo.edit({eye: [0.1, 1, 5]})")
        b.wait("velo.screen.frame.change === velo.change")
        b.run("velo.crop([60, 20, 140, 100])")
        b.wait("velo.cropped && velo.screen.frame.columns < 200 && velo.screen.frame.scale === 1")
        shot(b, "lost")
        b.run("velo.crop(null); velo.edit({eye: [0, 1, 5]}); velo.display.view.value = 0; velo.display.set(0)")
        b.wait("!velo.cropped && velo.screen.frame.columns === 200 && velo.screen.frame.change === velo.change")
        b.run("taker.restoreContext()")
        b.wait("document.getElementById('plain').hidden && velo.screen.hasGL && document.getElementById('notice').hidden", 20)
        b.wait("document.getElementById('status').textContent.includes('done') && velo.screen.frame.scale === 1 && velo.screen.frame.spp === 4")
        check("context_comes_back", b.wait("velo.screen.values().every((v, i) => v === before[i])", 20))
        check("lost_no_errors", not b.problems(), b.problems())
    finally:
        b.end()
    b = Browser(more_flags=["--disable-3d-apis"])
    try:
        b.open(view.address)
        b.wait(READY, 20)
        check("no_webgl2", b.run("velo.screen.gl === null") and "spp" in b.run("document.getElementById('status').textContent"))
        colour = b.wait(seen, 10)
        check("no_webgl2_shows_the_image", colour[0] > 1.5 * colour[2] and colour[3] == 255, colour)
        shot(b, "no_webgl2")
        b.run("velo.edit({eye: [0, 1, 9]})")
        b.wait("velo.screen.frame.change === velo.change")
        check("no_webgl2_no_errors", not b.problems(), b.problems())
    finally:
        b.end()
        view.end()


def test_size(folder):
    """The file's image size changes: the page's camera and its undo stay. The file's camera changes: it is the page's."""
    view = View(VELO, write_scene(folder), cwd=folder)
    b = Browser()
    here = "[velo.state.camera.width, velo.state.camera.eye[0], Math.round(1000 * velo.state.camera.fov_vertical) / 1000]"
    try:
        b.open(view.address)
        b.wait(READY)
        b.run("velo.edit({eye: [1, 1, 5]})")
        b.wait("velo.state.camera.eye[0] === 1")
        write_scene(folder, width=240)
        b.wait("velo.state.camera.width === 240 && velo.screen.frame.width === 240", 20)
        check("size_keeps_the_pose", b.run(here) == [240, 1, 40], b.run(here))
        b.run("velo.edit({fx: 100, fy: 100})")
        b.wait("velo.state.camera.fx === 100")
        field = b.run("velo.state.camera.fov_vertical")
        write_scene(folder, width=90)
        b.wait("velo.state.camera.width === 90", 20)
        check("size_keeps_the_field", b.run("[velo.state.camera.fx, velo.state.camera.spelled]") == [75, "matrix"], b.run("velo.state.camera.fx"), field)
        write_scene(folder, width=160)
        b.wait("velo.state.camera.width === 160", 20)
        b.click_on("#undo")
        b.wait("Math.abs(velo.state.camera.fov_vertical - 40) < 1e-6", 20)
        check("size_keeps_the_undo", b.run(here) == [160, 1, 40], b.run(here))
        b.click_on("#undo")
        b.wait("velo.state.camera.eye[0] === 0", 20)
        b.click_on("#redo")
        b.wait("velo.state.camera.eye[0] === 1", 20)
        write_scene(folder, fov=50)
        b.wait("Math.abs(velo.state.camera.fov_vertical - 50) < 1e-6", 20)
        check("the_file's_camera", b.run(here) == [160, 0, 50] and not b.run("velo.state.can_undo"), b.run(here))
        check("size_no_errors", not b.problems(), b.problems())
    finally:
        b.end()
        view.end()


def test_way(folder):
    """The file that xdg-open gets leads a browser to the page, though its name tells nothing."""
    opened, opener = os.path.join(folder, "opened"), os.path.join(folder, "xdg-open")
    with open(opener, "w") as file:
        file.write(f'#!/bin/sh\nprintf %s "$1" >"{opened}.part" && mv "{opened}.part" "{opened}"\n')
    os.chmod(opener, 0o755)
    view = View(VELO, write_scene(folder), cwd=folder, opens=True, env={**os.environ, "DISPLAY": ":none", "PATH": f"{folder}:{os.environ['PATH']}"})
    b = Browser()
    try:
        until = time.monotonic() + 20
        while not os.path.exists(opened) and time.monotonic() < until:
            time.sleep(0.05)
        way = open(opened).read()
        check("way_without_token", view.path.strip("/") not in way and os.stat(way).st_mode & 0o777 == 0o600, way)
        b.open("file://" + way)
        b.wait(READY, 30)
        check("way_leads_to_the_page", b.run("location.href") == view.address, b.run("location.href"))
    finally:
        b.end()
        view.end()
    check("way_is_gone", not os.path.exists(way))


def main():
    reason = cannot_view(VELO)
    if reason:
        print(f"skip view_pages: {reason}")
        return
    for test in (test_roles, test_again, test_plain, test_size, test_way):
        folder = tempfile.mkdtemp(prefix="velo-view-")
        test(folder)
        shutil.rmtree(folder)


main()
results.end()
