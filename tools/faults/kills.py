"""Films that are killed again and again: kill -9 at random moments, continued with another number of threads, until complete."""
import os
import signal
import subprocess
import time

CHECKPOINT = 0.02  # seconds
SLACK = 2.0  # seconds for a pass, the writing of a film and other processes of the machine
MAX_KILLS = 8  # kills of one film; then it may be completed
VARIANTS = [[], ["--tracer", "volpath"], ["--tracer", "bidirectional"], ["--tracer", "merging"], ["--tracer", "sppm"], ["--tracer", "lightpath"],
            ["--channels", "error,Z"], ["--spectrum", "4"], ["--sampler", "stratified", "--sequence", "256"], ["--color", "rgb"],
            ["--crop", "10,20,100,90"]]


def samples_of(tool, folder):
    """The number of samples of each pixel in k.film; None where the film is not whole."""
    done = subprocess.run([tool.velo, "film", "info", "--check", "k.film"], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    for line in done.stdout.splitlines():
        words = line.split()
        if words and words[0] == "samples" and done.returncode == 0:
            return int(words[1].split(":")[1])
    return None


def straight(tool, variant, samples):
    """The image of a render that is not killed."""
    key = (tuple(variant), samples)
    if key not in tool.straight:
        name = os.path.join(tool.films, "straight.exr")
        subprocess.run([tool.velo, "render", "scene.pbrt", "-o", name, "--quiet", "--spp", str(samples), *variant], cwd=tool.films, check=True)
        with open(name, "rb") as f:
            tool.straight[key] = f.read()
    return tool.straight[key]


class Film:
    def __init__(self, trial):
        self.trial, self.tool, self.draw, self.folder = trial, trial.tool, trial.draw, trial.folder
        self.variant, self.samples = self.draw.choice(VARIANTS), self.draw.choice([32, 64, 128])
        self.path, self.held, self.kills = os.path.join(self.folder, "k.film"), 0, 0

    def start(self):
        threads = ["--threads", str(self.draw.randint(1, 8)), "--quiet"]
        begin = ["scene.pbrt", "--film", "k.film", "--spp", str(self.samples), "--checkpoint", str(CHECKPOINT), *self.variant]
        words = ["--continue", "k.film", "--checkpoint", str(CHECKPOINT)] if self.held else begin
        return self.trial.start([self.tool.velo, "render", *words, *threads])

    def kill(self):
        """One run, killed at a random moment, sometimes just after a checkpoint. Returns whether it ended before."""
        begin = os.stat(self.path).st_mtime_ns if self.held else 0
        started = time.time_ns()
        process = self.start()
        until = time.monotonic() + self.draw.uniform(0.0, 0.4)
        if self.draw.random() < 0.5:
            while time.monotonic() < until + 1 and process.poll() is None:
                if os.path.exists(self.path) and os.stat(self.path).st_mtime_ns != begin:
                    break
                time.sleep(0.001)
            until = time.monotonic() + self.draw.uniform(0.0, 0.03)
        while time.monotonic() < until and process.poll() is None:
            time.sleep(min(0.01, max(0, until - time.monotonic())))
        process.send_signal(signal.SIGKILL)
        killed = time.time_ns()
        code = self.trial.end(process, {0, 137})
        if code == 137:
            self.kills += 1
            self.tool.kills += 1
            self.judge(begin, started, killed)
        return code == 0

    def judge(self, begin, started, killed):
        if not os.path.exists(self.path):
            if self.held:
                self.trial.problems.append("the film is gone")
            return
        held = samples_of(self.tool, self.folder)
        if held is None or held < self.held:
            self.trial.problems.append("the film held %d samples, now %s" % (self.held, held))
            return
        written = os.stat(self.path).st_mtime_ns
        lost = (killed - (written if written != begin else started)) * 1e-9
        self.tool.lost = max(self.tool.lost, lost)
        if lost > CHECKPOINT + SLACK:
            self.trial.problems.append("work of %.2f s is lost" % lost)
        self.held = held

    def finish(self):
        """Completes the film. Its image has the bytes of the one that is never killed."""
        words = ["--continue", "k.film", "-o", "k.exr"] if self.held else ["scene.pbrt", "-o", "k.exr", "--spp", str(self.samples), *self.variant]
        code = self.trial.end(self.trial.start([self.tool.velo, "render", *words, "--quiet", "--threads", str(self.draw.randint(1, 8))]), {0})
        if code != 0:
            return
        with open(os.path.join(self.folder, "k.exr"), "rb") as f:
            if f.read() != straight(self.tool, self.variant, self.samples):
                self.trial.problems.append("the image differs from that of a straight render: %s, %d samples" % (self.variant, self.samples))
        left = [n for n in os.listdir(self.folder) if n.startswith(".velo-")]
        if left:
            self.trial.problems.append("left: " + " ".join(left))


def trial_kill(trial):
    film = Film(trial)
    for _ in range(trial.draw.randint(2, MAX_KILLS)):
        if film.kill() or trial.problems:
            break
    if not trial.problems:
        film.finish()
