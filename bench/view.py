#!/usr/bin/python3
"""What `velo view` costs and how quick it is, by a client like a page. Usage: view.py VELO [--drag] [SCENE ...] [-- OPTIONS]
Without scenes: the lecture's, and those of ../shared that are there. Options are of `velo view`, such as --resolution.
For each scene: from a change of the camera to its first frame (median and longest of 30), frames per second while the
camera moves and their usual size, how soon a change stops the running pass (median and longest of what the program
reports), and the share of the program's processor time that developing, packing and sending frames take: while the
camera moves, and in 10 s at rest.
With --drag only this: the camera moves 60 times a second and waits for nothing, as a page does while one drags. Images per
second and their usual size; their age, from a change to the first image that shows it or a later one (median); the
processor time of the program per image. Then, at rest, the images until the first whole pass, with the longest pause
between two of them; --drag waits REST seconds for that.
bench/classroom.py makes a scene of 500,000 triangles. Times are only right on a machine that has nothing else to do;
processor times and shares hardly depend on it."""
import os
import statistics
import sys
import threading
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


EDITS, SECONDS, REST = 60, 6, 40  # edits per second; seconds of a drag; most seconds at rest


class Drag:
    """Edits at the display's rate in a thread of its own, as a page sends them; the frames come meanwhile."""

    def __init__(self, page, camera):
        self.page, self.camera, self.sent, self.ended = page, camera, {}, threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        eye, lookat = self.camera["eye"], self.camera["lookat"]
        arm = sum((a - b) ** 2 for a, b in zip(eye, lookat)) ** 0.5
        begun = time.monotonic()
        for i in range(EDITS * SECONDS):
            time.sleep(max(0, begun + i / EDITS - time.monotonic()))
            self.sent[2000 + i] = time.monotonic()
            x = eye[0] + 0.0005 * arm * (i % 120)
            self.page.send(type="camera", change=2000 + i, gesture=2, set={"eye": [x, eye[1], eye[2]]})
        self.ended.set()

    def ages(self, frames):
        """Of all edits: the seconds until the first frame that shows it or a later one. frames: (time, Frame)."""
        left, ages = sorted(self.sent.items()), []
        for at, frame in frames:
            while left and left[0][0] <= frame.change:
                ages.append(at - left.pop(0)[1])
        return ages


def processor_seconds(process):
    fields = open(f"/proc/{process.pid}/stat").read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def frames_until(page, frames, done, seconds):
    """Receives until done(last frame or None), or for so many seconds."""
    end = time.monotonic() + seconds
    while not done(frames[-1][1] if frames else None) and time.monotonic() < end:
        try:
            message = page.receive(max(0.01, end - time.monotonic()))
        except TimeoutError:
            return
        if isinstance(message, Frame):
            frames.append((time.monotonic(), message))


def measure_drag(program, scene, options):
    view = View(program, scene, "--spp", "65536", *options)
    try:
        page = Page(view)
        camera = page.wait_text("state")["camera"]
        page.wait_frame(lambda f: f.spp > 0)
        frames, used, drag = [], processor_seconds(view.process), Drag(page, camera)
        frames_until(page, frames, lambda _: drag.ended.is_set(), 2 * SECONDS)
        drag.thread.join()
        used = processor_seconds(view.process) - used
        moving, rest = list(frames), []
        frames_until(page, rest, lambda f: f and f.spp > 0, REST)
        page.close()
    finally:
        view.end()
    ages = drag.ages(moving + rest)
    pauses = [b[0] - a[0] for a, b in zip([(drag.sent[max(drag.sent)],)] + rest, rest)]
    size = statistics.median_low([(f.columns, f.rows) for _, f in moving]) if moving else (0, 0)
    steps = [f"{f.columns}x{f.rows}" for _, f in rest]
    print(f"{os.path.basename(scene)}, {EDITS} edits/s: {len(moving) / SECONDS:.1f} images/s of {size[0]}x{size[1]}; "
          f"age {1e3 * statistics.median(ages):.0f} ms (longest {1e3 * max(ages):.0f}); "
          f"{1e3 * used / max(1, len(moving)):.0f} ms of processor time per image, {used / SECONDS:.2f} processors; "
          f"at rest: {len(rest)} images in {sum(pauses):.1f} s, longest pause {max(pauses, default=0):.1f} s: "
          f"{' '.join(dict.fromkeys(steps))}", flush=True)


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
    drag = "--drag" in words
    words = [w for w in words if w != "--drag"]
    scenes = words[1:] or [path for path in (os.path.join(ROOT, s) for s in SCENES) if os.path.exists(path)]
    for scene in scenes:
        (measure_drag if drag else measure)(os.path.abspath(words[0]), scene, options)


main()
