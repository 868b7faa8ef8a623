#!/usr/bin/python3
"""The page of velo view in a real browser: open, orbit, change d and fx, pick a pixel, compare, save camera and image, the
view transforms, edit the file, break it, mend it; light and dark, wide and narrow. Skipped without chromium."""
import base64
import hashlib
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from lamp import SCENE as LAMP  # noqa: E402
from live import View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written
THINGS = 'Material "diffuse" "rgb reflectance" [%s]\nShape "sphere" "float radius" 0.8\n'
SCENE = '''LookAt 0 1 5 0 0 0 0 1 0
Camera "perspective" "float fov" 40
Sampler "halton" "integer pixelsamples" 4
Film "rgb" "integer xresolution" 320 "integer yresolution" 240
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9]
LightSource "point" "rgb I" [40 36 30] "point3 from" [3 4 3]
Include "things.pbrt"
Material "diffuse" "rgb reflectance" [0.6 0.6 0.5]
Shape "bilinearmesh" "point3 P" [-9 -0.8 -9 9 -0.8 -9 -9 -0.8 9 9 -0.8 9]
'''


def read_png(path):
    """Width, height and the bytes R G B of an 8-bit PNG without interlacing."""
    data, at, parts = open(path, "rb").read(), 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        if kind == b"IHDR":
            width, height, depth, colour = *[int.from_bytes(data[at + 8 + 4 * i:at + 12 + 4 * i], "big") for i in (0, 1)], data[at + 16], data[at + 17]
            assert depth == 8 and colour == 2
        if kind == b"IDAT":
            parts += data[at + 8:at + 8 + size]
        at += size + 12
    raw, n, rows, last = zlib.decompress(parts), 3 * width, [], bytearray(3 * width)
    for y in range(height):
        line, how = bytearray(raw[y * (n + 1) + 1:(y + 1) * (n + 1)]), raw[y * (n + 1)]
        for i in range(n):
            a, b, c = line[i - 3] if i > 2 else 0, last[i], last[i - 3] if i > 2 else 0
            p = a + b - c
            near = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            line[i] = (line[i] + (0, a, b, (a + b) // 2, near)[how]) & 255
        rows.append(bytes(line))
        last = line
    return width, height, b"".join(rows)


def wait_done(b):
    b.wait("velo.screen.frame.scale === 1 && document.getElementById('status').textContent.includes('done')", 60)


def camera(b, name):
    return b.run(f"velo.state.camera.{name}")


def shot(b, name):
    if SHOTS:
        b.screenshot(os.path.join(SHOTS, name + ".png"))


def wait_file(path, seconds=20):
    until = time.monotonic() + seconds
    while not os.path.exists(path) and time.monotonic() < until:
        time.sleep(0.05)
    return os.path.exists(path)


def test_camera(b):
    b.wait("velo.frames > 0 && velo.state && velo.steers")
    check("opens", True)
    box = b.run("(() => { const r = document.getElementById('screen').getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()")
    x, y = box[0] + box[2] / 2, box[1] + box[3] / 2
    eye = camera(b, "eye")
    b.drag(x, y, x + 90, y + 20)
    b.wait("Math.abs(velo.state.camera.eye[0]) > 0.5")
    moved, middle = camera(b, "eye"), camera(b, "lookat")
    distance = lambda p: sum((v - w) ** 2 for v, w in zip(p, middle)) ** 0.5
    check("orbit", abs(distance(moved) - distance(eye)) < 1e-3 * distance(eye), eye, moved)
    frames = b.run("velo.frames")
    b.wait(f"velo.frames > {frames} || velo.screen.frame.change === velo.change")
    d = camera(b, "d")
    b.type_into("#field-d", str(1.5 * d))
    b.wait(f"Math.abs(velo.state.camera.d - {1.5 * d}) < 1e-6")
    check("d_changes_fx", abs(camera(b, "fx") - 1.5 * d) < 1e-3 * d, camera(b, "fx"), d)
    b.type_into("#field-fx", "300")
    b.wait("velo.state.camera.fx === 300")
    check("fx_changes_d", abs(camera(b, "d") - 300) < 1e-6)
    check("panel_follows", b.run("document.getElementById('field-d').value") == "300")
    b.type_into("#field-fov", "200")
    b.wait("document.querySelector('#camera .why:not(:empty)') !== null")
    check("refusal_is_shown", "fov" in b.run("document.querySelector('#camera .why:not(:empty)').textContent"))
    b.click_on("#undo")
    b.wait(f"velo.state.camera.fx !== 300")
    check("undo", abs(camera(b, "fx") - 1.5 * d) < 1e-3 * d)
    b.run("document.getElementById('stage').focus()")
    b.call("Input.dispatchKeyEvent", type="keyDown", key="Home", code="Home", windowsVirtualKeyCode=36)
    b.wait(f"Math.abs(velo.state.camera.eye[0]) < 1e-9")
    check("home_key", True)
    # one drag of a label: what does d do?
    b.run("document.querySelector('details.group:has(#field-d)').open = true")
    b.run("document.getElementById('field-d').scrollIntoView({block: 'center'})")
    r = b.run("(() => { const r = document.querySelector('label[for=field-d]').getBoundingClientRect(); return [r.x + 4, r.y + r.height / 2]; })()")
    b.drag(r[0], r[1], r[0] + 80, r[1])
    b.wait(f"velo.state.camera.d > {1.2 * d}")
    check("drag_d", True)
    b.click_on("#reset")
    b.wait(f"Math.abs(velo.state.camera.d - {d}) < 1e-6")
    return x, y


def test_denoise(b):
    """The switch says which of the two one sees. The tests after it want the samples."""
    said = "document.getElementById('seen').textContent"
    b.wait(f"{said}.startsWith('seen: denoised preview') && velo.screen.frame.denoised === 1")
    check("denoise_is_on", b.run("document.getElementById('denoise').getAttribute('aria-pressed')") == "true")
    b.click_on("#denoise")
    b.wait(f"{said}.startsWith('seen: samples') && velo.screen.frame.denoised === 0")
    check("denoise_is_off", b.run("document.getElementById('denoise').getAttribute('aria-pressed')") == "false")


def test_pixel(b, x, y):
    b.click(x, y)
    b.wait("document.querySelector('#pixel dl').textContent.includes('position')")
    text = b.run("document.querySelector('#pixel dl').textContent")
    check("pick", "things.pbrt:2" in text and "sphere" in text, text)
    b.wait("document.querySelectorAll('#path-list table.vertices tbody tr').length > 1")
    check("paths", b.run("velo.paths.answer.paths.length") == 16 and "volpath" in b.run("document.querySelector('#pixel [role=status]').textContent"))
    check("texture", b.wait("[...document.querySelectorAll('#pixel dd')].some(e => e.textContent === 'none')"))
    b.click_on("#path-outside")
    b.wait("velo.outside.drawing && velo.outside.image && velo.outside.size()[0] > 100 && velo.paths.lines.some(l => l[0] === 'path')", 60)
    yellow = ("(() => { const c = velo.outside.canvas, d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;"
              "for (let i = 0; i < d.length; i += 4) n += d[i] > 240 && d[i + 1] > 200 && d[i + 1] < 220 && d[i + 2] < 90; return n; })()")
    check("paths_from_outside", b.run(yellow) > 20, b.run(yellow))
    b.click_on("#path-list details:nth-of-type(2) summary")
    b.wait("velo.paths.chosen === 1 && document.querySelectorAll('#path-list table').length === 2")
    shot(b, "paths")
    b.click_on("#outside-toggle")
    b.mouse("mouseMoved", x + 3, y, buttons=0)
    b.wait("document.getElementById('hover').textContent.length > 5")
    check("hover", True)


def test_views(b, folder):
    wait_done(b)
    worst, quick = {}, 0
    for i, view in enumerate(("standard", "neutral", "agx", "raw")):
        b.run(f"(() => {{ velo.display.view.value = {i}; velo.display.set(0.75); }})()")
        name = f"seen-{view}.png"
        b.run(f"new Promise(r => velo.ask({{type: 'save', what: 'image', name: '{name}', exposure: velo.display.ev, view: velo.display.viewName}}, r))")
        width, height, file = read_png(os.path.join(folder, name))
        shown = base64.b64decode(b.run("(() => { const v = velo.screen.values(); let s = ''; for (let i = 0; i < v.length; i += 30000)"
                                       " s += String.fromCharCode(...v.subarray(i, i + 30000)); return btoa(s); })()"))
        worst[view] = max(abs(shown[4 * p + c] - file[3 * p + c]) for p in range(width * height) for c in range(3))
    check("views_equal_png", max(worst.values()) <= 1, worst)
    b.run("(() => { velo.display.view.value = 0; velo.display.set(0); })()")
    measure = ("(() => { const gl = velo.screen.gl, t = performance.now(), p = new Uint8Array(4); let n = 0;"
               "while (performance.now() - t < 800) { velo.screen.display.exposure = n++ % 7 / 10; velo.screen.redevelop(); velo.screen.drawNow();"
               "gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, p); } return n / (performance.now() - t) * 1000; })()")
    quick = max(b.run(measure) for _ in range(2))  # the machine may be busy
    size = b.run("[velo.screen.canvas.width, velo.screen.canvas.height]")
    print(f"   exposure at {size[0]} x {size[1]}: {quick:.0f} per second", file=sys.stderr)
    check("exposure_is_quick", quick > 3, quick)


def test_panels(b, folder):
    b.run("document.getElementById('compare').open = true")
    b.click_on("#keep")
    check("wipe", b.run("!document.getElementById('other').hidden"))
    b.run("(() => { const m = document.getElementById('compare-mode'); m.value = 'difference'; m.onchange(); })()")
    text = b.run("document.querySelector('#compare .hint').textContent")
    check("difference", "greatest 0" in text, text)
    b.run("(() => { const m = document.getElementById('compare-mode'); m.value = 'off'; m.onchange(); })()")
    b.run("document.getElementById('save').open = true")
    b.click_on("#save-image")
    check("save_image", wait_file(os.path.join(folder, "shown.png")))
    b.click_on("#save-camera")
    check("save_camera", wait_file(os.path.join(folder, "shown-camera.json")))
    b.click_on("#copy-command")
    command = b.wait("document.querySelector('code.command').textContent")
    check("command", command.startswith("velo render "), command)
    b.click_on("#verify-command")
    check("verify_runs", b.run("document.getElementById('verify-command').textContent") in ("Stop", "Verify"))
    verdict = b.wait("!velo.save.verifying && document.getElementById('verdict').textContent")
    words = shlex.split(command)
    subprocess.run([VELO, *words[1:], "--quiet"], cwd=folder, check=True)
    made = hashlib.sha256(open(os.path.join(folder, words[-1]), "rb").read()).hexdigest()
    check("verified", verdict == f"{words[-1]}: same bytes ✓ SHA-256 {made}", verdict, made)
    shot(b, "verified")
    for name in ("axes", "vanishing", "horizon", "grid", "boxes", "centre"):
        b.run(f"document.getElementById('overlay-{name}').click()")
    b.wait("document.querySelectorAll('#overlay rect').length >= 2 && document.querySelectorAll('#overlay text').length > 3")
    check("overlays", True)
    shot(b, "overlays")
    b.run("velo.edit({distortion: 'opencv', coefficients: [-0.35, 0.1, 0, 0, 0]})")
    b.run("document.getElementById('overlay-distortion').click()")
    b.wait("document.querySelectorAll('#overlay polyline').length > 20 && document.querySelectorAll('#overlay circle').length > 200")
    check("overlays_of_a_lens", b.run("[...document.querySelectorAll('#overlay text')].some(e => e.textContent.includes('distortion: up to'))"))
    wait_done(b)
    shot(b, "distorted")
    b.run("document.getElementById('overlay-distortion').click()")
    b.click_on("#reset")
    b.wait("velo.state.camera.distortion === 'none'")
    for name in ("axes", "vanishing", "horizon", "grid", "boxes", "centre"):
        b.run(f"document.getElementById('overlay-{name}').click()")
    b.click_on("#mark")
    b.run("velo.edit({eye: [0.4, 1.1, 4.8]})")
    shown = b.run("[...document.getElementById('channel').options].map(o => o.textContent)")
    check("channels", {"depth", "distance", "position", "normals", "uv", "albedo", "objects", "standard error", "flow"} <= set(shown), shown)
    for channel in ("Z", "N", "id.object", "error", "forward"):
        b.run(f"(() => {{ const s = document.getElementById('channel'); s.value = '{channel}'; s.onchange(); }})()")
        b.wait("velo.screen.frame.channel > 0 && !document.getElementById('legend').hidden")
        b.wait(f"velo.display.channels[velo.screen.frame.channel] === '{channel}'")
        shot(b, channel)
    check("legend", b.run("document.querySelector('#legend .wheel') !== null && document.getElementById('legend').textContent.includes('pixels')"))
    b.run("(() => { const s = document.getElementById('channel'); s.value = 'image'; s.onchange(); })()")
    b.wait("velo.screen.frame.channel === 0")


def settle(b):
    b.wait("velo.outside.drawing && !velo.outside.asked && !velo.queued && velo.screen.frame.change === velo.change")


def test_outside(b):
    """The second pane: its handles move e and d."""
    b.click_on("#outside-toggle")
    b.wait("velo.outside.drawing && velo.outside.drawing.lines.length > 10 && velo.outside.image !== undefined", 60)
    handle = lambda name: b.run(f"(() => {{ const o = velo.outside, r = o.canvas.getBoundingClientRect(), p = o.project(o.handles.{name});"
                                " return [r.x + p[0], r.y + p[1]]; })()")
    settle(b)
    eye, d = camera(b, "eye"), camera(b, "d")
    x, y = handle("eye")
    b.drag(x, y, x + 25, y - 15)
    b.wait(f"Math.hypot(velo.state.camera.eye[0] - {eye[0]}, velo.state.camera.eye[1] - {eye[1]}) > 0.05")
    settle(b)
    check("drag_eye_outside", math.dist(handle("eye"), (x + 25, y - 15)) < 4, handle("eye"), x, y)
    b.click_on("#undo")
    b.wait(f"Math.abs(velo.state.camera.eye[1] - {eye[1]}) < 1e-9")
    settle(b)
    edited = [eye[0] + 0.5, eye[1], eye[2]]
    b.run(f"velo.edit({{eye: {edited}}}, velo.next()); velo.undo()")
    settle(b)
    check("undo_of_an_edit_on_its_way", math.dist(camera(b, "eye"), eye) < 1e-9, camera(b, "eye"), eye)
    x, y = handle("plane")
    towards = b.run("(() => { const o = velo.outside, c = velo.camera(), p = o.project(o.handles.plane), q = o.project(c.lookat);"
                    " const n = Math.hypot(q[0] - p[0], q[1] - p[1]); return [(q[0] - p[0]) / n, (q[1] - p[1]) / n]; })()")
    b.drag(x, y, x + 20 * towards[0], y + 20 * towards[1])
    b.wait(f"velo.state.camera.d > {1.05 * d}")
    settle(b)
    end = (x + 20 * towards[0], y + 20 * towards[1])
    check("drag_plane_outside", math.dist(handle("plane"), end) < 6, handle("plane"), end)
    shot(b, "outside")
    b.click_on("#undo")
    b.wait(f"Math.abs(velo.state.camera.d - {d}) < 1e-6")
    parts = "velo.outside.drawing.lines.map(l => l[0])"
    b.run("velo.edit({f_number: 2, focus_distance: 4})")
    b.wait(f"{parts}.includes('focus')")
    b.run("velo.edit({projection: 'equidistant fisheye', fov: 150})")
    b.wait(f"{parts}.filter(p => p === 'window').length > 100")
    settle(b)
    check("bundle_of_a_fisheye", b.run(f"{parts}.filter(p => p === 'volume').length") >= 8)
    shot(b, "fisheye")
    b.click_on("#reset")
    b.wait("velo.state.camera.projection === 'perspective'")
    settle(b)
    x, y = b.run("(() => { const o = velo.outside, r = o.canvas.getBoundingClientRect(), m = o.string.poses[1],"
                 " p = o.project([m[3], m[7], m[11]]); return [r.x + p[0], r.y + p[1]]; })()")
    b.click(x, y)
    b.wait("Math.abs(velo.state.camera.eye[0] + 1) < 1e-9 && Math.abs(velo.state.camera.eye[2] - 4) < 1e-9")
    check("click_on_the_trajectory", True)
    b.click_on("#reset")
    b.wait(f"Math.abs(velo.state.camera.d - {d}) < 1e-6 && Math.abs(velo.state.camera.eye[2] - 5) < 1e-9")
    b.click_on("#outside-toggle")


def test_crop(b, x, y):
    b.click_on("#tools [data-tool=crop]")
    b.drag(x - 80, y - 60, x + 60, y + 50)
    b.wait("velo.cropped && velo.screen.frame.columns < 320 && velo.screen.frame.scale === 1")
    check("crop", True)
    b.click(x, y)
    b.wait("!velo.cropped && velo.screen.frame.columns === 320")
    check("crop_ends", True)
    b.click_on("#tools [data-tool=inspect]")
    b.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-900)
    b.wait("velo.screen.zoom > 3")
    shot(b, "zoomed")
    b.run("velo.wholeImage()")
    b.click_on("#tools [data-tool=orbit]")


def test_file(b, folder):
    inner = os.path.join(folder, "things.pbrt")
    open(inner, "w").write(THINGS % "0.1 0.6 0.2")
    green = "(() => { const v = velo.screen.pixels.at(160, 120); return v && v[1] > 1.5 * v[0]; })()"
    b.wait(green)
    check("file_edited", True)
    open(inner, "w").write(THINGS % "0.1 0.6 0.2" + 'Shape "spere"\n')
    b.wait("!document.getElementById('notice').hidden && document.getElementById('notice').textContent.includes('spere')")
    text = b.run("document.getElementById('notice').textContent")
    check("file_broken", "things.pbrt:3:" in text, text)
    shot(b, "broken")
    check("image_stays", b.run(green))
    open(inner, "w").write(THINGS % "0.7 0.2 0.1")
    b.wait("(() => { const v = velo.screen.pixels.at(160, 120); return v && v[0] > 1.5 * v[1]; })()")
    check("file_mended", not b.run("document.getElementById('notice').textContent.includes('spere')"))


SMALL = """[...document.querySelectorAll('button, select, summary, input:not([type=file]), .check label')].filter(e => e.checkVisibility()).filter(e => {
  const b = (e.type === 'checkbox' ? e.closest('.check') : e).getBoundingClientRect(); return b.height < 39.5 || (b.width < 39.5); }).map(e => e.outerHTML.slice(0, 80))"""
SIDEWAYS = """[...document.querySelectorAll('*')].filter(e => e.checkVisibility() && !e.closest('svg') && (e.getBoundingClientRect().right > innerWidth + 1 ||
  (e.scrollWidth > e.clientWidth + 1 && ['auto', 'scroll'].includes(getComputedStyle(e).overflowX)))).map(e => e.outerHTML.slice(0, 80))"""


def test_touch(b):
    """On a phone, with all sections open and a pixel picked: what is touched is large, and nothing scrolls sideways."""
    b.run("velo.pick(160, 120, 'orbit'); document.querySelectorAll('details').forEach(d => { d.open = true; })")
    b.wait("document.querySelectorAll('#path-list table').length > 0")
    b.run("document.querySelectorAll('#path-list details').forEach(d => { d.open = true; })")
    b.run("document.getElementById('outside-toggle').click()")
    b.run("velo.notice('an error that is told in a sentence')")
    time.sleep(0.5)
    check("touch_is_large", not b.run(SMALL), b.run(SMALL))
    check("nothing_sideways", not b.run(SIDEWAYS), b.run(SIDEWAYS))
    shot(b, "phone_open")
    for i in range(1, 6):
        b.run(f"(() => {{ const s = document.getElementById('side'); s.scrollTop = {i} * s.clientHeight * 0.95; }})()")
        shot(b, f"phone_open_{i}")
    b.run("document.getElementById('notice').hidden = true; document.getElementById('side').scrollTop = 0; document.getElementById('outside-toggle').click()")


def test_layout(view):
    """Light, dark and narrow: nothing reaches beyond the page, every control has a name."""
    for name, width, height, dark, phone in (("dark", 1280, 720, True, False), ("phone", 390, 844, False, True)):
        b = Browser(width, height, dark, phone)
        try:
            b.open(view.address)
            b.wait("velo.frames > 0 && velo.state")
            wait_done(b)
            check(name + "_fits", b.run("document.documentElement.scrollWidth <= innerWidth"))
            nameless = b.run("[...document.querySelectorAll('button, input, select')].filter(e => !e.hidden && !(e.textContent.trim() || "
                             "e.getAttribute('aria-label') || e.labels?.length || e.title)).map(e => e.outerHTML)")
            check(name + "_names", not nameless, nameless)
            if phone:
                test_touch(b)
            check(name + "_no_errors", not b.problems(), b.problems())
            shot(b, name)
        finally:
            b.end(kill=name == "dark")  # a browser that is killed in the middle


def test_race(folder):
    """The line of the image says which tracer won the race, and a copied command names it."""
    open(os.path.join(folder, "lamp.pbrt"), "w").write(LAMP % "")
    view = View(VELO, os.path.join(folder, "lamp.pbrt"), "--max-depth", "4", "--tracer", "auto", cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("velo.connection")
        b.run("""new Promise(done => { window.lines = []; const line = document.getElementById("status");
              new MutationObserver(() => lines.push(line.textContent)).observe(line, {childList: true}); done(); })""")
        b.wait("velo.frames > 0 && velo.state")
        wait_done(b)
        lines = b.run("lines")
        check("race_compares", any("comparing tracers" in line for line in lines), lines)
        check("race_next", any("auto: bidirectional is next" in line for line in lines), lines)
        check("race_done_is_last", not [line for line in lines if "done" in line and "auto: bidirectional" not in line], lines)
        check("race_chosen", "64 of 64 spp" in lines[-1] and "auto: bidirectional  ·  done" in lines[-1], lines)
        notice = b.run("document.getElementById('notice').textContent")
        check("race_line", notice.startswith("auto: bidirectional") and "error x rays" in notice, notice)
        b.click_on("#save summary")
        b.click_on("#copy-command")
        b.wait("!document.querySelector('.command').hidden")
        command = b.run("document.querySelector('.command').textContent")
        check("race_command", "--tracer bidirectional" in command and "auto" not in command.split(), command)
        check("race_no_errors", not b.problems(), b.problems())
        shot(b, "race")
    finally:
        b.end()
    code, errors = view.end()
    check("race_ends", code == 0, errors)


def main():
    reason = cannot_view(VELO)
    if reason:
        print(f"skip view_browser: {reason}")
        return
    folder = tempfile.mkdtemp(prefix="velo-view-")
    open(os.path.join(folder, "things.pbrt"), "w").write(THINGS % "0.7 0.2 0.1")
    open(os.path.join(folder, "shown.pbrt"), "w").write(SCENE)
    open(os.path.join(folder, "way.tum"), "w").write("".join(f"{i} {-2 + i} 1.5 4 1 0 0 0\n" for i in range(5)))
    view = View(VELO, os.path.join(folder, "shown.pbrt"), "--trajectory", "way.tum", cwd=folder)
    try:
        b = Browser()
        try:
            b.open(view.address)
            x, y = test_camera(b)
            test_denoise(b)
            test_pixel(b, x, y)
            test_views(b, folder)
            test_panels(b, folder)
            test_outside(b)
            test_crop(b, x, y)
            test_file(b, folder)
            check("no_errors", not b.problems(), b.problems())
            shot(b, "light")
        finally:
            b.end()
        test_layout(view)
        check("server_stays", view.get(view.path)[0] == 200)
    finally:
        code, errors = view.end()
    check("ends", code == 0, errors)
    test_race(folder)
    shutil.rmtree(folder)


main()
results.end()
