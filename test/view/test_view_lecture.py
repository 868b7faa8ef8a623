#!/usr/bin/python3
"""velo view --lecture: usage, language, the files and scenes that are in the program, who may choose a scene; and the page in
a real browser, in both languages: scrolling, sliders, formulas, listings. Without chromium the second part is skipped."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser  # noqa: E402
from live import Frame, Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.path.abspath(os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written


def read(path, mode="r"):
    with open(os.path.join(ROOT, path), mode) as file:
        return file.read()


def start(*options, **environment):
    """In an empty folder: all that the lecture needs is in the program."""
    env = {name: value for name, value in os.environ.items() if name not in ("LANG", "LC_ALL", "LC_MESSAGES")}
    return View(VELO, "--lecture", *options, cwd=os.environ["LECTURE_FOLDER"], env={**env, **environment})


def test_usage():
    for name, words, options in (("file", "--lecture takes no FILE", ["--lecture", "a.pbrt"]), ("camera", "--camera does not go", ["--lecture", "--camera", "a"]),
                                 ("language_alone", "--language goes with --lecture", ["--language", "it", "a.pbrt"]),
                                 ("no_language", 'did you mean "it"?', ["--lecture", "--language", "ti"]), ("nothing", "too few arguments", [])):
        done = subprocess.run([VELO, "view", *options], capture_output=True, text=True, timeout=60)
        check("usage_" + name, done.returncode == 2 and words in done.stderr, done.returncode, done.stderr)


def test_language():
    for name, language, options, environment in (
            ("none", "en", [], {}), ("lang", "it", [], {"LANG": "it_IT.UTF-8"}), ("first", "en", [], {"LC_ALL": "C", "LANG": "it_IT"}),
            ("other", "en", [], {"LANG": "itx"}), ("option", "en", ["--language", "en"], {"LANG": "it"})):
        view = start(*options, **environment)
        check("language_" + name, view.address.endswith("/?language=" + language), view.address)
        view.end()


def test_files(view):
    status, body = view.get(view.path + "?language=it")
    check("page", status == 200 and b"lecture/main.js" in body, status)
    text = read("docs/lecture.md")
    names = {"docs/lecture.md", "docs/lezione.md"} | {"docs/" + name for name in re.findall(r"!\[[^\]]*\]\(([^)]*)\)", text)}
    names |= set(re.findall(r"\]\(\.\./([^)#]*\.[a-z]+)", text))
    wrong = [name for name in sorted(names) if view.get(view.path + name) != (200, read(name, "rb"))]
    check("files", len(names) > 50 and not wrong, wrong)
    for name in ("drawings", "drawings/frame", "drawn", "figures", "formulas", "links", "listing", "live", "main", "markdown", "math", "page", "present", "sliders"):
        check("module_" + name, view.get(f"{view.path}lecture/{name}.js")[0] == 200)
    check("no_token", view.get("/docs/lecture.md")[0] == 403)
    check("foreign_host", view.get(view.path + "docs/lecture.md", host="example.com")[0] == 403)
    check("no_other_file", view.get(view.path + "README.md")[0] == 404 and view.get(view.path + "docs/../../etc/passwd")[0] in (403, 404))


def choose(page, name, change):
    page.send(type="scene", name=name, change=change)
    return page.wait(lambda m: isinstance(m, dict) and m.get("change") == change and m["type"] in ("state", "refused") or
                     isinstance(m, dict) and m["type"] == "error")


def test_scenes(view):
    page = Page(view)
    text, change = read("docs/lecture.md"), 10
    scenes = set(re.findall(r"live: scene=(\S+)", text))
    for scene, views in re.findall(r"live: scene=(\S+) views=(\S+)", text):
        scenes |= {f"{os.path.dirname(scene)}/{name}.pbrt" for name in views.split(",")}
    wrong = []
    for scene in sorted(scenes):
        change += 1
        state = choose(page, scene, change)
        if state["type"] != "state" or state["scene"] != scene:
            wrong.append((scene, state))
    check("scenes", len(scenes) > 20 and not wrong, wrong)
    frame = page.wait_frame(lambda f: f.change == change and f.scale == 1)
    check("frame", frame.columns == state["camera"]["width"], frame.columns)
    for name in ("scenes/lecture/none.pbrt", "scenes/lecture/objects/box.pbrt", "scenes/lecture/../lecture/pinhole.pbrt", "/etc/passwd", "docs/lecture.md"):
        change += 1
        answer = choose(page, name, change)
        check("no_scene_" + os.path.basename(name), answer["type"] == "refused" and "no such scene" in answer["message"], answer)
    looker = Page(view)
    check("one_steers", "another page steers" in choose(looker, "scenes/lecture/pinhole.pbrt", change + 1)["message"])
    looker.close()
    page.send(type="save", id=7, what="camera", name="a.json", dialect="velo")
    check("saves_nothing", "saves nothing" in page.wait(lambda m: isinstance(m, dict) and m.get("id") == 7)["message"])
    for scene in ("perspective_two_point", "pinhole"):  # the same as from the file, with all that it includes
        change += 2
        state = choose(page, f"scenes/lecture/{scene}.pbrt", change)
        other = View(VELO, os.path.join(ROOT, f"scenes/lecture/{scene}.pbrt"))
        expected = Page(other).wait_text("state")
        check("same_scene_" + scene, all(state[part] == expected[part] for part in ("camera", "bounds", "exposure")), state, expected)
        other.end()
    page.close()


# ---- the page ----

def shot(b, name):
    if SHOTS:
        b.screenshot(os.path.join(SHOTS, name + ".png"))


def make_live(b, name):
    """Scrolls to the figure of a scene and waits for its image. Returns its number."""
    number = b.run(f"velo.lecture.figures.findIndex(f => f.element.dataset.scene.includes('{name}'))")
    b.run(f"velo.lecture.figures[{number}].element.scrollIntoView({{block: 'center'}})")
    b.wait(f"velo.live.element === velo.lecture.figures[{number}].element && !velo.live.canvas.hidden && velo.live.screen.frame.scale === 1")
    return number


def middle(b):
    """The sum of the display values of the image."""
    return b.run("velo.live.screen.values().reduce((a, x) => a + x, 0)")


def test_figure(b, language):
    n = make_live(b, "view_plane_500")
    figure = f"velo.lecture.figures[{n}]"
    comma = "," if language == "it" else "."
    numbers = lambda: b.run(f"{figure}.element.querySelector('.numbers').dataset.text")
    before, formula = middle(b), numbers()
    check(language + "_formula", formula == "f = zoom · d / s = 1 · 500 / 1 = 500", formula)
    box = b.run(f"(() => {{ const r = {figure}.element.querySelector('[data-slider=d] input').getBoundingClientRect(); return [r.x, r.y + r.height / 2, r.width]; }})()")
    place = b.run(f"{figure}.element.querySelector('[data-slider=d] input').value / 1000")
    b.drag(box[0] + 8 + place * (box[2] - 16), box[1], box[0] + 0.8 * box[2], box[1])
    b.wait(f"velo.live.state.camera.d > 900 && velo.live.shown === velo.live.change && velo.live.screen.frame.scale === 1")
    d = b.run(f"{figure}.camera.d")
    check(language + "_slider_moves_the_numbers", numbers() == f"f = zoom · d / s = 1 · {d:g} / 1 = {d:g}", numbers(), d)
    text = b.run("document.querySelector('blockquote[data-formula=fov] .numbers').dataset.text")
    check(language + "_formula_of_the_text", comma in text and text.endswith("°") and "43" not in text.split("=")[-1], text)
    check(language + "_slider_moves_the_image", abs(middle(b) - before) > 1e5, before, middle(b))
    # the drawing follows the slider in steps: wait for the one of this d
    b.wait("velo.live.outside.drawing && velo.live.outside.drawing.lines.length > 10 && !!velo.live.outside.image && "
           f"Math.abs(velo.live.outside.drawing.plane - {d!r}) < 1e-6 * {d!r}")
    check(language + "_outside", True)
    foot = b.wait("velo.live.hash && document.getElementById('engine').textContent")
    check(language + "_foot", "velo view" in foot and re.search("[0-9a-f]{64}$", foot), foot)
    shot(b, "lecture_" + language)
    return n, d


def test_page(b, view):
    # another page steers: the figure of its scene shows its image
    other = Page(view)
    choose(other, "scenes/lecture/view_plane_500.pbrt", 77)
    b.open(view.address)
    b.wait("!!velo.lecture && velo.live.steers === false", 120)
    n = make_live(b, "view_plane_500")
    other.send(type="camera", change=78, gesture=1, set={"d": 800})
    b.wait(f"velo.live.shown === 78 && velo.lecture.figures[{n}].camera.d === 800")
    b.run("velo.live.edit({ d: 300 })")
    choose(other, "scenes/lecture/pinhole.pbrt", 79)
    b.wait(f"velo.live.canvas.hidden && velo.lecture.figures[{n}].error.textContent")
    check("looks_on", b.run(f"velo.lecture.figures[{n}].camera.d") == 800)
    other.close()
    b.wait("velo.live.steers && !velo.live.canvas.hidden")
    b.open(view.address)
    b.wait("!!velo.lecture && velo.live.steers", 120)
    check("figures", b.run("velo.lecture.figures.length") >= 15)
    n, d = test_figure(b, "en")
    # another figure is live, then the first again with the camera that it had
    b.run(f"document.querySelector('button.view[data-view=distortion_e15_d875]').scrollIntoView({{block: 'center'}})")
    b.click_on("button.view[data-view=distortion_e15_d875]")
    b.wait("velo.live.scene.includes('distortion_e15') && !velo.live.canvas.hidden && velo.live.state.camera.d === 875")
    check("view", b.run("document.querySelector('[data-view=distortion_e15_d875]').getAttribute('aria-pressed')") == "true")
    check("still", b.run(f"velo.lecture.figures[{n}].element.querySelector('canvas.still').width > 100"))
    make_live(b, "view_plane_500")
    b.wait(f"Math.abs(velo.live.state.camera.d - {d}) < 1e-6")
    check("camera_is_kept", True)
    # the handle of the view plane in the pane moves the slider
    b.run(f"velo.lecture.figures[{n}].element.querySelector('.reset').click()")
    b.wait("Math.abs(velo.live.outside?.drawing?.plane - 500) < 1e-6 && !!velo.live.outside.handles.plane")
    at = b.run("(() => { const o = velo.live.outside, r = o.canvas.getBoundingClientRect(), p = o.project(o.handles.plane), q = o.project(o.handles.eye);"
               " const n = Math.hypot(q[0] - p[0], q[1] - p[1]); return [r.x + p[0], r.y + p[1], (q[0] - p[0]) / n, (q[1] - p[1]) / n]; })()")
    b.drag(at[0], at[1], at[0] + 30 * at[2], at[1] + 30 * at[3])
    b.wait(f"velo.live.state.camera.d < 450 && velo.lecture.figures[{n}].camera.d === velo.live.state.camera.d")
    check("drag_plane_outside", True)
    # dragging the image turns the camera round lookat; so do the arrow keys
    arm = "(c => Math.hypot(...c.eye.map((x, i) => x - c.lookat[i])))(velo.live.state.camera)"
    at = b.run("(r => [r.x + r.width / 2, r.y + r.height / 2])(velo.live.canvas.getBoundingClientRect())")
    eye, length = b.run("velo.live.state.camera.eye"), b.run(arm)
    b.drag(at[0], at[1], at[0] + 60, at[1])
    b.wait(f"velo.live.shown === velo.live.change && Math.abs(velo.live.state.camera.eye[0] - {eye[0]}) > 10")
    check("drag_image", abs(b.run(arm) - length) < 1e-6 * length and
          b.run(f"velo.lecture.figures[{n}].camera.eye.join() === velo.live.state.camera.eye.join()"), b.run(arm), length)
    b.run("velo.live.canvas.dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowUp', cancelable: true }))")
    b.wait("velo.live.shown === velo.live.change && Math.abs(velo.live.state.camera.eye[1]) > 5")
    # a click on a pixel: its ray in the formulas, its projector outside; r counts from below
    n = make_live(b, "lecture/axis_aligned")
    b.wait("velo.live.outside?.drawing && velo.live.state.bounds")
    at = b.run("(() => { const r = velo.live.canvas.getBoundingClientRect(), p = velo.live.screen.toPage(100.5, 299.5); return [r.x + p[0], r.y + p[1]]; })()")
    b.click(*at)
    numbers = b.wait(f"velo.lecture.figures[{n}].pixel.r === 100 && velo.lecture.figures[{n}].pixel.c === 100 && [...velo.lecture.figures[{n}].element.querySelectorAll('.numbers')].at(-1).dataset.text")
    check("click_pixel", numbers.startswith("d = (−99.5, −99.5, −500)"), numbers)
    b.wait("velo.live.outside.point && velo.live.outside.drawing.lines.some(l => l[0] === 'projector')")
    # the same by keyboard: after Enter the arrow keys move the pixel, and after Escape they turn the camera again
    camera = b.run("(({ width, height, eye }) => ({ width, height, eye }))(velo.live.local)")
    for key, shift in (("Enter", "false"), ("ArrowLeft", "false"), ("ArrowUp", "true")):
        b.run(f"velo.live.canvas.dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}', shiftKey: {shift}, cancelable: true }}))")
    picked = b.run(f"velo.lecture.figures[{n}].pixel")
    check("keyboard_pixel", picked == {"r": camera["height"] - 1 - camera["height"] // 2 + 10, "c": camera["width"] // 2 - 1} and
          b.run("velo.live.local.eye.join()") == ",".join("%g" % x for x in camera["eye"]), picked)
    for key in ("Escape", "ArrowUp"):
        b.run(f"velo.live.canvas.dispatchEvent(new KeyboardEvent('keydown', {{ key: '{key}', cancelable: true }}))")
    b.wait(f"velo.live.local.eye.join() !== '{','.join('%g' % x for x in camera['eye'])}'")
    # the Panini projection has its own slider, and d is there for perspective alone
    n = make_live(b, "wide_perspective")
    shown = f"velo.lecture.figures[{n}].rows.filter(r => !r.row.hidden).map(r => r.slider.name).join()"
    check("sliders_perspective", b.run(shown) == "fov", b.run(shown))
    b.click_on("button.view[data-view=wide_panini]")
    b.wait(f"velo.live.scene.includes('panini') && {shown} === 'fov,panini'")
    before = b.wait("velo.live.screen.frame.scale === 1 && velo.live.shown === velo.live.change && velo.live.screen.values().reduce((a, x) => a + x, 0)")
    b.run(f"(() => {{ const i = velo.lecture.figures[{n}].rows.find(r => r.slider.name === 'panini').input; i.value = 0; i.dispatchEvent(new Event('input')); }})()")
    b.wait("velo.live.state.camera.shape[0] === 0 && velo.live.shown === velo.live.change && velo.live.screen.frame.scale === 1")
    check("panini", abs(middle(b) - before) > 1e4, before, middle(b))
    b.click_on("button.view[data-view=wide_stereographic]")
    b.wait(f"velo.live.scene.includes('stereographic') && {shown} === 'fov'")
    # what cannot be: near behind far
    make_live(b, "lecture/example_2")
    b.run("(() => { const f = velo.lecture.figures.find(f => f.element.dataset.scene.includes('/example_2')); f.set({ ...f.camera, near: 900, far: 300 }, false); })()")
    words = b.wait("[...document.querySelectorAll('figure .error')].map(e => e.textContent).join('')")
    check("refusal_is_shown", "far" in words, words)
    b.run("[...document.querySelectorAll('a[data-source]')].find(a => a.textContent === 'Pinhole_get_direction').click()")
    text = b.wait("document.querySelector('dialog[open] pre')?.textContent")
    check("listing", "static Vector3D Pinhole_get_direction(" in text, text[:200])
    b.click_on("dialog .whole")
    check("whole_file", b.run("document.querySelectorAll('dialog .line').length") == read("examples/lecture.c").count("\n") and
          b.run("document.querySelectorAll('dialog .marked').length > 2"))
    b.click_on("dialog .close")
    b.run("[...document.querySelectorAll('a[data-source]')].find(a => a.dataset.source.includes('src/render/render.c#L')).click()")
    check("place_in_velo", "vl_render(" in b.wait("document.querySelector('dialog[open] pre')?.textContent"))
    b.click_on("dialog .close")
    # the other language, at the same place
    place = "(() => { const h = [...document.querySelectorAll('#page > :is(h1, h2, h3)')]; return h.findLastIndex(e => e.getBoundingClientRect().top < innerHeight / 3); })()"
    before = b.run(place)
    b.run("document.getElementById('language').click()")
    b.wait("document.documentElement.lang === 'it' && velo.lecture.figures.length >= 15 && document.title.includes('prospettica')")
    b.wait(f"{place} === {before}")
    check("switch_keeps_the_place", before > 3 and b.run("location.search") == "?language=it", before)
    check("no_errors", not b.problems(), b.problems())


def test_narrow(view):
    b = Browser(390, 844, dark=True, phone=True)
    try:
        b.open(view.address.replace("language=en", "language=it"))
        b.wait("!!velo.lecture && velo.live.steers", 120)
        test_figure(b, "it")
        check("phone_fits", b.run("document.documentElement.scrollWidth <= innerWidth"))
        nameless = b.run("[...document.querySelectorAll('button, input')].filter(e => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length ||"
                         " e.querySelector('img')?.alt)).map(e => e.outerHTML)")
        check("phone_names", not nameless, nameless)
        check("phone_no_errors", not b.problems(), b.problems())
    finally:
        b.end()


def main():
    if "without libwebsockets" in subprocess.run([VELO, "view", "missing.pbrt"], capture_output=True, text=True, timeout=60).stderr:
        print("skip view_lecture: velo was built without libwebsockets")
        return
    os.environ["LECTURE_FOLDER"] = folder = tempfile.mkdtemp(prefix="velo-lecture-")
    test_usage()
    test_language()
    view = start("--spp", "2")
    try:
        test_files(view)
        test_scenes(view)
        if any(shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")):
            b = Browser()
            try:
                test_page(b, view)
            finally:
                b.end()
            test_narrow(view)
        else:
            print("skip view_lecture_page: there is no chromium")
    finally:
        code, errors = view.end()
    check("ends", code == 0, errors)
    check("writes_nothing", not os.listdir(folder), os.listdir(folder))
    shutil.rmtree(folder)


main()
results.end()
