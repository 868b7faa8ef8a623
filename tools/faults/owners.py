"""Commands that want the same film file: killed and repeated, started twice, other renders and other shards, merges. The film
never loses a sample; whoever may not write it ends with exit code 2 before it renders."""
import os
import signal
import subprocess
import time

import kills

VARIANTS = [*kills.VARIANTS, ["--noise", "3%"]]
SENT = [signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT]
OTHERS = [["--seed", "7"], ["--max-depth", "2"], ["--resolution", "96x64"], ["--spp", "1"], ["--sampler", "independent"]]


class Film:
    """A film and the command that renders it, which is the same throughout."""

    def __init__(self, trial, name, variant, samples, part):
        self.trial, self.tool, self.draw, self.folder = trial, trial.tool, trial.draw, trial.folder
        self.name, self.path, self.part = name, os.path.join(trial.folder, name), part
        self.words = ["scene.pbrt", "--film", name, "--spp", str(samples), "--checkpoint", str(kills.CHECKPOINT), *variant, *part]
        self.held = {}

    def start(self, *more):
        return self.trial.start([self.tool.velo, "render", *self.words, "--quiet", "--threads", str(self.draw.randint(1, 3)), *more])

    def bytes(self):
        if not os.path.exists(self.path):
            return None
        with open(self.path, "rb") as f:
            return f.read()

    def judge(self, what):
        """The film is whole and has at least what it had. A film of --noise has several numbers of samples, by place."""
        if not os.path.exists(self.path):
            if self.held:
                self.trial.problems.append("%s: the film is gone" % what)
            return
        done = subprocess.run([self.tool.velo, "film", "info", "--check", self.name], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True)
        lines = [line.split() for line in done.stdout.splitlines() if line.startswith("  samples")]
        ranges = [tuple(int(n) for n in words[1].split(":")) for words in lines if words[1:] and ":" in words[1]]
        if done.returncode or not ranges:
            self.trial.problems.append("%s: the film is not whole: %s" % (what, done.stderr[:200]))
            return
        held = {"first": min(r[0] for r in ranges), "least": min(r[1] for r in ranges), "most": max(r[1] for r in ranges)}
        if self.held and (held["first"] != self.held["first"] or held["least"] < self.held["least"] or held["most"] < self.held["most"]):
            self.trial.problems.append("%s: the film held %s, now %s" % (what, self.held, held))
        self.held = held


def stop(trial, process, codes, longest=0.4):
    """Kills a process at a random moment, or lets it end."""
    if trial.draw.random() < 0.8:
        time.sleep(trial.draw.uniform(0.0, longest))
        sent = trial.draw.choice(SENT)
        process.send_signal(sent)
        codes = codes | {128 + sent}
        trial.tool.kills += 1
    return trial.end(process, codes)


def step_repeat(film):
    stop(film.trial, film.start(), {0})
    film.judge("repeated")


def step_twice(film):
    """The same command twice, or two parts that were given one film by mistake."""
    trial, other = film.trial, []
    if film.part and trial.draw.random() < 0.5:
        other = ["--shard", "2/2" if film.part[1] == "1/2" else "1/2"]
    words = film.words
    first = film.start()
    time.sleep(trial.draw.choice([0, trial.draw.uniform(0, 0.2)]))
    if other:
        film.words = [*words[:words.index("--shard")], *other]
    second = film.start()
    film.words = words
    if other and not film.held:  # whichever comes first begins the film
        stop(trial, first, {0, 2})
        stop(trial, second, {0, 2})
        try_part(film, other)
    else:
        stop(trial, first, {0, 2})
        stop(trial, second, {2} if other else {0, 2})
    film.judge("started twice")


def try_part(film, other):
    """Both parts were started at once: the film is the one's that got it. It must be whole; here it begins anew."""
    film.judge("two parts at once")
    if film.held and film.trial.problems == []:
        subprocess.run([film.tool.velo, "render", *film.words, "--overwrite", "--quiet"], cwd=film.folder, stdin=subprocess.DEVNULL)
        film.held = {}


def step_other(film):
    """Another render, or a merge, while the film lies there or is written: refused, and the film stays."""
    trial = film.trial
    if not film.held:
        return
    process = film.start() if trial.draw.random() < 0.5 else None
    before = film.bytes()
    if trial.draw.random() < 0.3:
        command = ["film", "merge", os.path.join(film.tool.films, "seed.film"), "-o", film.name]
        codes = {3, 5}
    else:
        command = ["render", *film.words, *trial.draw.choice(OTHERS), "--quiet"]
        codes = {2}
    trial.end(trial.start([film.tool.velo, *command]), codes)
    if process:
        stop(trial, process, {0})
    elif film.bytes() != before:
        trial.problems.append("a refused command changed the film")
    film.judge("refused")


STEPS = [step_repeat, step_repeat, step_twice, step_other]


def finish(trial, films, variant, samples):
    """Completes the films. The image has the bytes of the render that is never killed."""
    draw, velo = trial.draw, trial.tool.velo
    for film in films:
        if trial.end(film.start(*([] if film.part else ["-o", "k.exr"])), {0}) != 0:
            return
        film.judge("completed")
    if len(films) > 1:
        trial.end(trial.start([velo, "film", "merge", *[f.name for f in films], "-o", "k.film"]), {0})
        trial.end(trial.start([velo, "render", "--continue", "k.film", "-o", "k.exr", "--quiet"]), {0})
    right = kills.straight(trial.tool, variant, samples)
    with open(os.path.join(trial.folder, "k.exr"), "rb") as f:
        if f.read() != right:
            trial.problems.append("the image differs from that of a straight render: %s, %d samples" % (variant, samples))
    film = draw.choice(films)
    outputs = [] if film.part else ["-o", "k.exr"]
    before = film.bytes()
    trial.end(film.start(*outputs), {0})
    if film.bytes() != before:
        trial.problems.append("a complete film changed when its command was repeated")
    trial.end(film.start("--seed", "9", "--overwrite"), {0})
    if film.bytes() == before:
        trial.problems.append("--overwrite left the film")
    left = [n for n in os.listdir(trial.folder) if n.startswith(".velo-")]
    if left:
        trial.problems.append("left: " + " ".join(left))


def trial_owner(trial):
    variant, samples = trial.draw.choice(VARIANTS), trial.draw.choice([32, 64, 128])
    parts = trial.draw.random() < 0.4 and "--noise" not in variant
    names = [("a.film", ["--shard", "1/2"]), ("b.film", ["--shard", "2/2"])] if parts else [("k.film", [])]
    films = [Film(trial, name, variant, samples, part) for name, part in names]
    for _ in range(trial.draw.randint(3, 7)):
        trial.draw.choice(STEPS)(trial.draw.choice(films))
        if trial.problems:
            return
    finish(trial, films, variant, samples)
