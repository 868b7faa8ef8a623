#!/usr/bin/python3
"""velo view: the luminance of the image in cd/m²: its numbers where they are known, its legend in the page, and what has none."""
import math
import os
import shutil
import struct
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import Browser, cannot_view  # noqa: E402
from live import Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SHOTS = os.environ.get("VELO_SCREENSHOTS")  # a folder to which the images of the page are written
WIDTH, HEIGHT, LUMINANCE, ILLUMINANCE = 320, 200, 22, 23
# A sky of 250 cd/m2, before it a lamp of 40000 cd/m2 and a black ball.
SCENE = '''LookAt 0 0 6 0 0 0 0 1 0
Camera "perspective" "float fov" 40
Sampler "halton" "integer pixelsamples" 8
PixelFilter "box"
Film "rgb" "integer xresolution" 320 "integer yresolution" 200
WorldBegin
LightSource "infinite" "rgb L" [1 1 1] "float scale" 250
AttributeBegin
Translate -1 0 0
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "sphere" "float radius" 0.8
AttributeEnd
AttributeBegin
Translate 1 0 0
AreaLightSource "diffuse" "blackbody L" 3000 "float scale" 40000
Shape "sphere" "float radius" 0.8
AttributeEnd
'''
SKY, BLACK, LAMP = (10, 10), (220, 100), (100, 100)


def value_at(page, place):
    return struct.unpack_from("<f", page.pixels, 4 * (place[1] * WIDTH + place[0]))[0]


def wait_last(page, frame):
    """The frame of all samples: `frame` itself, if it came that late."""
    if frame.scale != 1 or frame.spp != 8:
        page.wait_frame(lambda f: f.channel == frame.channel and f.change == frame.change and f.scale == 1 and f.spp == 8)


def show(page, channel):
    page.send(type="settings", channel=channel)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in ("state", "refused"))


def test_numbers(scene, folder):
    view = View(VELO, scene, cwd=folder)
    page = Page(view)
    lists = page.wait_text("lists")["channels"]
    check("listed_by_its_bit", lists.index("luminance") == LUMINANCE - 1 and "" in lists, lists)
    show(page, "luminance")
    first = page.wait_frame(lambda f: f.channel == LUMINANCE)
    check("form", first.format == 1 and first.channels == 1, first.format, first.channels)
    wait_last(page, first)
    check("sky", abs(value_at(page, SKY) - 250) < 0.01 * 250, value_at(page, SKY))
    check("lamp", abs(value_at(page, LAMP) - 40000) < 0.01 * 40000, value_at(page, LAMP))
    check("black", abs(value_at(page, BLACK)) < 1e-3, value_at(page, BLACK))
    page.send(type="camera", change=9, set={"eye": [0, 0, 60]})
    frame = page.wait_frame(lambda f: f.change == 9)
    check("first_image_has_it", frame.channel == LUMINANCE and frame.channels == 1, frame.channel, frame.channels)
    wait_last(page, frame)
    check("moved", abs(value_at(page, BLACK) - 250) < 0.01 * 250, value_at(page, BLACK))
    page.send(type="reset", change=10)
    page.wait_frame(lambda f: f.change == 10)
    show(page, "illuminance")
    page.wait_frame(lambda f: f.channel == ILLUMINANCE and f.scale == 1 and f.spp == 8)
    ball, sky = value_at(page, BLACK), value_at(page, SKY)
    check("illuminance", 0.7 * math.pi * 250 < ball < 1.5 * math.pi * 250 and sky == 0, ball, sky)
    show(page, "image")
    frame = page.wait_frame(lambda f: f.channel == 0)
    check("image_again", frame.channels == 3 and frame.format == 0, frame.channels, frame.format)
    said = show(page, "crypto.object")
    check("not_shown", said["type"] == "refused" and "no such channel" in said["message"], said)
    page.close()
    check("ends", view.end()[0] == 0)


def test_refused(scene, folder):
    """A measured camera's colours have no luminance."""
    view = View(VELO, scene, "--sensor", "canon_eos_5d", cwd=folder)
    page = Page(view)
    page.wait_text("state")
    said = show(page, "luminance")
    check("own_sensor", said["type"] == "refused" and "cie1931" in said["message"], said)
    page.close()
    view.end()


def test_page(scene, folder):
    view = View(VELO, scene, cwd=folder)
    b = Browser()
    try:
        b.open(view.address)
        b.wait("window.velo?.frames > 0 && velo.state && velo.steers")
        b.run("(() => { const s = document.getElementById('channel'); s.value = 'luminance'; s.onchange(); })()")
        b.wait("velo.screen.frame.channel === 22 && velo.screen.frame.spp === 8 && !document.getElementById('legend').hidden")
        legend = b.run("document.getElementById('legend').textContent")
        check("legend", legend.startswith("luminance, cd/m²") and "1000" in legend, legend)
        marks = b.run("[...document.querySelectorAll('#legend .scale span')].map(e => [Number(e.textContent), e.style.left])")
        check("marks_ascend", len(marks) >= 2 and marks == sorted(marks, key=lambda m: m[0]), marks)
        b.run("velo.hover(100, 100)")
        said = b.run("document.getElementById('hover').textContent")
        check("under_the_pointer", said.startswith("100, 100   ") and said.endswith(" cd/m²"), said)
        check("its_number", abs(float(said.split()[-2]) - 40000) < 400, said)
        colour = lambda place: b.run(f"[...velo.screen.values().slice(4 * ({place[1]} * 320 + {place[0]}), 4 * ({place[1]} * 320 + {place[0]}) + 3)]")
        check("colours", colour(LAMP)[0] > 200 and colour(BLACK) == [0, 0, 0] and colour(SKY)[2] > 60, colour(LAMP), colour(SKY))
        plain = b.run("(() => { const s = velo.screen, a = s.values(), p = s.plainValues(); let most = 0;"
                      " for (let i = 0; i < a.length; i++) most = Math.max(most, Math.abs(a[i] - p[i])); return most; })()")
        check("without_webgl_the_same", plain <= 2, plain)
        if SHOTS:
            b.screenshot(os.path.join(SHOTS, "luminance.png"))
        b.run("(() => { const s = document.getElementById('channel'); s.value = 'illuminance'; s.onchange(); })()")
        b.wait("velo.screen.frame.channel === 23 && velo.screen.frame.spp === 8")
        legend = b.run("document.getElementById('legend').textContent")
        check("legend_in_lux", legend.startswith("illuminance, lx"), legend)
        b.run("(() => { const s = document.getElementById('channel'); s.value = 'image'; s.onchange(); })()")
        b.wait("velo.screen.frame.channel === 0 && document.getElementById('legend').hidden")
        b.run("velo.hover(100, 100)")
        check("no_unit_of_colours", "cd" not in b.run("document.getElementById('hover').textContent"))
        check("no_errors", not b.problems(), b.problems())
    finally:
        b.end()
        view.end()


def main():
    reason = cannot_view(VELO, browser=False)
    if reason:
        print(f"skip view_luminance: {reason}")
        return
    folder = tempfile.mkdtemp(prefix="velo-view-")
    scene = os.path.join(folder, "lights.pbrt")
    with open(scene, "w") as file:
        file.write(SCENE)
    test_numbers(scene, folder)
    test_refused(scene, folder)
    reason = cannot_view(VELO)
    if reason:
        print(f"skip view_luminance page: {reason}")
    else:
        test_page(scene, folder)
    shutil.rmtree(folder)


main()
results.end()
