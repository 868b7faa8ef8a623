#!/usr/bin/python3
"""What `velo view` costs and how quick it is, by a client like a page. Usage: view.py VELO [SCENE ...] [-- OPTIONS]
Without scenes: the lecture's, and those of ../shared that are there. Options are of `velo view`, such as --resolution.
For each scene: from a change of the camera to its first frame (median and longest of 30), frames per second while the
camera moves and their usual size, how soon a change stops the running pass (median and longest of what the program
reports), and the share of the program's processor time that developing, packing and sending frames take: while the
camera moves, and in 10 s at rest. Times are only right on a machine that has nothing else to do; the shares hardly
depend on it."""
import os
import statistics
import sys
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "test/view"))
from live import Frame, Page, View  # noqa: E402

SCENES = ["scenes/lecture/pinhole.pbrt", "scenes/lecture/perspective_two_point.pbrt",
          "../shared/scenes/gltf/DamagedHelmet/DamagedHelmet.glb", "../shared/scenes/pbrt/dining-room/dining-room.pbrt"]


def is_status(message):
    return isinstance(message, dict) and message["type"] == "status"


class Client:
    def __init__(self, view):
        self.page = Page(view)
        self.camera = self.page.wait_text("state")["camera"]
        self.change, self.running, self.stops, self.sizes = 1000, True, [], []
        self.page.wait_frame()

    def frame_of(self, change):
        """The first frame that shows a change; notes what statuses say about stopped passes."""
        while True:
            message = self.page.receive()
            if is_status(message) and "stop_seconds" in message:
                self.stops.append(message["stop_seconds"])
            if isinstance(message, Frame) and message.change == change:
                self.sizes.append((message.columns, message.rows))
                return

    def move(self, amount):
        """Moves the eye; the seconds until the first frame."""
        eye, lookat = self.camera["eye"], self.camera["lookat"]
        arm = sum((a - b) ** 2 for a, b in zip(eye, lookat)) ** 0.5
        self.change += 1
        begun = time.monotonic()
        self.page.send(type="camera", change=self.change, gesture=1, set={"eye": [eye[0] + amount * arm, eye[1], eye[2]]})
        self.frame_of(self.change)
        return time.monotonic() - begun

    def pause(self, paused):
        """The seconds until the render has taken notice."""
        begun = time.monotonic()
        self.running = not paused
        self.page.send(type="settings", paused=paused)
        self.last = self.page.wait(lambda m: is_status(m) and m["paused"] == paused)
        return time.monotonic() - begun

    def costs(self):
        """Processor time of the program and of frames, when the render rests."""
        if self.running:
            self.pause(True)
        return self.last["program_seconds"], self.last["frame_seconds"]

    def share(self, action):
        before = self.costs()
        self.page.send(type="settings", paused=False)
        self.running = True
        action()
        after = self.costs()
        return 100 * (after[1] - before[1]) / max(1e-9, after[0] - before[0])


def measure(program, scene, options):
    view = View(program, scene, "--spp", "65536", *options)
    try:
        client = Client(view)
        firsts = []
        for i in range(30):
            firsts.append(client.move(0.002 * i))
            time.sleep(0.05 + 0.05 * (i % 7))
        rate = [0]

        def moving():
            begun = time.monotonic()
            while time.monotonic() - begun < 5:
                client.move(0.002 * (rate[0] % 60))
                rate[0] += 1

        def resting():
            begun = time.monotonic()
            while time.monotonic() - begun < 10:
                client.page.receive()
        stops, client.sizes = client.stops, []
        busy, rest = client.share(moving), client.share(resting)
        columns, rows = statistics.median_low(client.sizes)
        client.page.close()
        ms = lambda values: f"{1e3 * statistics.median(values):.0f} ms (longest {1e3 * max(values):.0f})"
        print(f"{os.path.basename(scene)}: first frame {ms(firsts)}; {rate[0] / 5:.1f} frames/s of {columns}x{rows} moving; "
              f"stopped within {ms(stops)}; frames take {busy:.2f} % of the processor time moving, {rest:.2f} % at rest",
              flush=True)
    finally:
        view.end()


def main():
    words = sys.argv[1:]
    options = words[words.index("--") + 1:] if "--" in words else []
    words = words[:words.index("--")] if "--" in words else words
    if not words:
        sys.exit(__doc__)
    scenes = words[1:] or [path for path in (os.path.join(ROOT, s) for s in SCENES) if os.path.exists(path)]
    for scene in scenes:
        measure(os.path.abspath(words[0]), scene, options)


main()
