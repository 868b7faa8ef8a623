#!/usr/bin/python3
"""velo view while the camera moves and just after: a page that sends changes without waiting for images still gets images
of them, and the image gets finer step by step once it stands still."""
import os
import struct
import sys
import threading
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from browser import cannot_view  # noqa: E402
from live import Frame, Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
SCENE = os.path.join(ROOT, "scenes/lecture/perspective_two_point.pbrt")
ENOUGH, PATIENCE = 6, 30  # images that a flood of changes must leave; seconds until the test gives up


class Flood:
    """Changes of the camera in a thread of its own, faster than any image, until it is ended."""

    def __init__(self, page, camera):
        self.page, self.eye, self.change, self.go = page, camera["eye"], 1000, True
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        while self.go:
            self.change += 1
            x = self.eye[0] + 0.01 * (self.change % 100)
            self.page.send(type="camera", change=self.change, gesture=3, set={"eye": [x, *self.eye[1:]]})
            time.sleep(0.001)

    def end(self):
        self.go = False
        self.thread.join()


def images_of_flood(page, camera, fits):
    """The changes that images show while changes flood; at most ENOUGH."""
    shown, flood, end = [], Flood(page, camera), time.monotonic() + PATIENCE
    while len(shown) < ENOUGH and time.monotonic() < end:
        try:
            message = page.receive(1)
        except TimeoutError:
            continue
        if isinstance(message, Frame) and fits(message) and 1000 < message.change and message.change not in shown:
            shown.append(message.change)
    flood.end()
    return shown, flood.change


def check_flood(page, camera, name, fits):
    shown, last = images_of_flood(page, camera, fits)
    check(name, len(shown) == ENOUGH and shown == sorted(shown), shown, last)
    page.wait_frame(lambda f: f.change == last and f.scale == 1)


def test_flood():
    view = View(VELO, SCENE, "--resolution", "800x600", "--threads", "1", "--spp", "1")
    try:
        page = Page(view)
        camera = page.wait_text("state")["camera"]
        page.wait_frame(lambda f: f.spp > 0)
        check_flood(page, camera, "flood_image", lambda f: f.channel == 0)
        page.send(type="settings", channel="Z")
        page.wait_frame(lambda f: f.channel > 0 and f.scale == 1)
        check_flood(page, camera, "flood_depth", lambda f: f.channel > 0)
        page.close()
    finally:
        check("ends", view.end()[0] == 0)


def test_growth():
    """A slow image gets finer step by step, and its first samples are shown while they come. It must be slow on any machine:
    what takes less than 0.8 s is not shown in parts."""
    view = View(VELO, SCENE, "--resolution", "2560x1920", "--threads", "1", "--spp", "1")
    try:
        page, frames = Page(view), []
        while not (frames and frames[-1].spp):
            frames.append(page.wait_frame())
        page.close()
    finally:
        check("growth_ends", view.end()[0] == 0)
    widths = [f.columns for f in frames]
    check("growth_is_steady", widths == sorted(widths) and len(set(widths)) >= 3, widths)
    parts = [f for f in frames if f.columns == 2560 and not f.spp]
    check("growth_of_the_whole_image", len(parts) >= 2 and all(f.change == frames[-1].change for f in parts), widths)
    rows = [min(y for _, y, _, _, _ in f.parts) for f in parts[1:] + frames[-1:]]
    check("growth_from_the_top", rows == sorted(rows) and rows[-1] > 0, rows)


def values(page, frame):
    """The frame's colours as a list of rows, each pixel as often as it covers pixels of the image."""
    numbers = struct.unpack(f"<{frame.rows * frame.columns * frame.channels}{'e' if frame.format == 0 else 'f'}", bytes(page.pixels))
    n, s = frame.channels, frame.scale
    rows = [[numbers[n * (y * frame.columns + x):n * (y * frame.columns + x) + 3] for x in range(frame.columns)] for y in range(frame.rows)]
    return [[rows[y // s][x // s] for x in range(frame.width)] for y in range(frame.height)]


def difference(a, b):
    """Mean absolute difference, after a curve that is near the display's."""
    curve = lambda v: max(0.0, min(1.0, v)) ** 0.45
    return sum(abs(curve(p) - curve(q)) for r, s in zip(a, b) for u, v in zip(r, s) for p, q in zip(u, v)) / (3 * len(a) * len(a[0]))


def test_moved():
    """After a change the last clean image comes first, moved to the new camera: nearer to the finished image than one of few samples.
    Where the cameras see different things, and where pages see ground truth, it does not."""
    view = View(VELO, SCENE, "--resolution", "320x240", "--threads", "1", "--spp", "32")
    try:
        page = Page(view)
        camera = page.wait_text("state")["camera"]

        def after(change, **message):
            """The first image of a change, its colours, and those of the finished one."""
            page.send(change=change, **message)
            first = page.wait_frame(lambda f: f.change == change)
            colours = values(page, first)
            last = page.wait_frame(lambda f: f.change == change and f.spp == 32 and f.denoised == 1)
            return first, colours, values(page, last)
        page.wait_frame(lambda f: f.spp == 32 and f.denoised == 1)
        eye, step = camera["eye"], 0.02 * abs(camera["eye"][2] - camera["lookat"][2])
        for attempt in range(1, 6):  # on a busy machine a later image can replace one that is not sent yet
            time.sleep(0.5)  # what is needed to move it is rendered
            moved_eye = [eye[0] + attempt * step, *eye[1:]]
            first, moved, finished = after(900 + attempt, type="camera", set={"eye": moved_eye})
            if first.denoised == 2:
                break
        error = difference(moved, finished)
        check("moved_comes_first", first.denoised == 2 and first.spp == 0, first.denoised, first.spp, first.scale)
        check("moved_is_near", error < 0.02, error)
        first, _, _ = after(910, type="camera", set={"eye": camera["lookat"], "lookat": eye})
        check("other_view_is_not_moved", first.denoised != 2, first.denoised)
        page.send(type="settings", channel="Z", change=911)
        check("ground_truth_is_not_moved", page.wait_frame(lambda f: f.channel > 0).denoised == 0)
        page.close()
    finally:
        check("moved_ends", view.end()[0] == 0)


def main():
    reason = cannot_view(VELO, browser=False)
    if reason:
        print(f"skip view_drag: {reason}")
        return
    test_flood()
    test_growth()
    test_moved()


main()
results.end()
