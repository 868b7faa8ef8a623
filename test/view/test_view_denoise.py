#!/usr/bin/python3
"""velo view: the denoised preview. Frames say whether they are denoised; what is saved is not; the switch shows the samples."""
import os
import shlex
import struct
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import cannot_view  # noqa: E402
from live import Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SCENE = os.path.join(ROOT, "scenes/denoising/room.pbrt")
WIDTH, HEIGHT, SPP = 160, 106, 8


def halves(page):
    return struct.unpack(f"<{3 * WIDTH * HEIGHT}e", bytes(page.pixels))


def read_pfm(path):
    """The numbers of a .pfm, rows from the top."""
    _, _, _, floats = open(path, "rb").read().split(b"\n", 3)
    values, row = struct.unpack(f"<{3 * WIDTH * HEIGHT}f", floats), 3 * WIDTH
    return [v for y in range(HEIGHT - 1, -1, -1) for v in values[row * y:row * (y + 1)]]


def roughness(values):
    """The mean difference between neighbours, of values up to 1."""
    v = [min(1, max(0, x)) for x in values]
    return sum(abs(a - b) for a, b in zip(v, v[3:])) / len(v)


def worst(a, b):
    return max(abs(x - y) / max(abs(y), 2 ** -14) for x, y in zip(a, b) if y < 65504)


def ask(page, kind, **message):
    page.send(id=7, exposure=0, view="standard", **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in (kind, "refused") and m.get("id") == 7)


def follow(page, change):
    """All frames until that of all samples which is denoised."""
    frames = [page.wait_frame(lambda f: f.change == change)]
    while not (frames[-1].spp == SPP and frames[-1].denoised):
        frames.append(page.wait_frame())
    return frames


def check_steps(frames, name):
    denoised = [f.spp for f in frames if f.denoised and f.spp]
    steps = all(b >= 2 * a or b == SPP for a, b in zip(denoised, denoised[1:]))
    check(name + "_steps", steps and denoised[-1] == SPP, denoised)
    check(name + "_stays", all(f.denoised for f in frames[[f.spp > 0 and f.denoised for f in frames].index(True):]), denoised)


def first_frames(page, eye):
    """The first image of a change is not denoised. A frame that comes while the one before is on its way to a busy page is left out: some are tried."""
    seen = []
    for change in range(40, 46):
        page.send(type="camera", change=change, set={"eye": [eye[0] + 0.001 * change, eye[1], eye[2]]})
        frames = follow(page, change)
        seen.append([f.denoised for f in frames])
        if frames[0].denoised != 1:
            break
    check("first_is_quick", frames[0].denoised != 1, seen)
    return frames


def test_preview(folder):
    view = View(VELO, SCENE, "--resolution", f"{WIDTH}x{HEIGHT}", "--spp", str(SPP), cwd=folder)
    page = Page(view)
    state = page.wait_text("state")
    check("on_at_first", state["denoise"] is True, state)
    check_steps(follow(page, 0), "loaded")
    eye = state["camera"]["eye"]
    frames = first_frames(page, eye)
    check_steps(frames, "moved")
    clean = halves(page)
    saved = ask(page, "saved", type="save", what="image", name="saved.pfm")
    exact = read_pfm(os.path.join(folder, saved["file"]))
    check("preview_is_cleaner", roughness(clean) < 0.7 * roughness(exact), roughness(clean), roughness(exact))
    command = ask(page, "command", type="command")["command"]
    denoises = [word for word in shlex.split(command) if word.startswith("--denoise")]
    check("command_denoises_nothing", not denoises, command)
    page.send(type="settings", denoise=False)
    frame = page.wait_frame(lambda f: not f.denoised)
    check("off_shows_the_samples", frame.spp == SPP and worst(halves(page), exact) <= 2 ** -11 * 1.001)
    page.send(type="settings", denoise=True)
    page.wait_frame(lambda f: f.denoised)
    check("on_again_is_the_same", halves(page) == clean)
    again = ask(page, "saved", type="save", what="image", name="saved.pfm")
    check("saved_is_the_same", read_pfm(os.path.join(folder, again["file"])) == exact)
    for i in range(8):  # off again while the denoiser works
        page.send(type="settings", denoise=True)
        time.sleep(0.01 * i)
        page.send(type="settings", denoise=False)
        page.wait(lambda m: isinstance(m, dict) and m["type"] == "state" and not m["denoise"])
    page.wait_frame(lambda f: not f.denoised and f.spp == SPP)
    check("off_while_it_works", worst(halves(page), exact) <= 2 ** -11 * 1.001)
    page.close()
    check("ends", view.end()[0] == 0)


def test_lecture():
    """The lecture has no such preview."""
    view = View(VELO, "--lecture")
    page = Page(view)
    check("lecture_is_off", page.wait_text("state")["denoise"] is False)
    page.send(type="settings", denoise=True)
    said = page.wait_text("refused")
    check("lecture_refuses", "denoised" in said["message"], said)
    page.close()
    check("lecture_ends", view.end()[0] == 0)


def main():
    reason = cannot_view(VELO, browser=False)
    if reason:
        print(f"skip view_denoise: {reason}")
        return
    test_preview(tempfile.mkdtemp(prefix="velo-denoise-"))
    test_lecture()


main()
results.end()
