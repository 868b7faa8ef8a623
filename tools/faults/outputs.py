"""What tools/check_faults makes velo write: commands, the files that they write, and what these files were before."""
import os
import shutil
import subprocess

OLD = b"the earlier file\n"
SCENE = """Film "rgb" "integer xresolution" 128 "integer yresolution" 96
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [0.4 0.5 0.6]
Translate 0 0 4
Material "diffuse"
Shape "sphere"
Translate 1 0 0
Shape "trianglemesh" "point3 P" [0 0 0  1 0 0  0 1 0] "integer indices" [0 1 2]
"""
# Films that commands read; made once.
FILMS = {"first.film": ["--spp", "2"], "part_1.film": ["--spp", "4", "--shard", "1/2"], "part_2.film": ["--spp", "4", "--shard", "2/2"],
         "tile_1.film": ["--spp", "4", "--shard", "1/2", "--shard-by", "tiles"], "whole.film": ["--spp", "4"],
         "errors.film": ["--spp", "4", "--channels", "error"], "seed.film": ["--spp", "4", "--seed", "7"]}


class Output:
    """words: a command, in which all names that begin with "out" are written. earlier: the content of these files before the
    command: the name of one of FILMS, or None for OLD. reads: other films that the command reads."""

    def __init__(self, words, earlier, reads=()):
        self.words, self.earlier, self.reads = words, earlier, reads
        self.renders = words[0] == "render"
        self.name = " ".join(words)

    def command(self, velo, samples, folder=""):
        words = [folder + w if w.startswith("out") else w for w in self.words]
        return [velo, *words, *(["--quiet", "--spp", str(samples), "--threads", "2"] if self.renders else [])]

    def reads_its_output(self):
        return any(self.earlier.values())


def render(*words, **earlier):
    """A render that writes the files that it names; those named by `earlier` were these films before, other films that of another
    render."""
    files = {w: "errors.film" if w.endswith(".film") else None for w in words if w.startswith("out") and "%" not in w}
    files.update({name.replace("_film", ".film"): film for name, film in earlier.items()})
    return Output(["render", *([] if "--continue" in words else ["scene.pbrt"]), *words], files)


OUTPUTS = [
    render("-o", "out.exr"),
    render("-o", "out.png"),
    render("-o", "out.exr", "-o", "out.png"),
    render("-o", "out.exr", "--channels", "all"),
    render("--overwrite", "--film", "out.film"),
    render("--overwrite", "--film", "out.film", "--checkpoint", "0.01", "-o", "out.exr"),
    render("--overwrite", "--film", "out.film", "--checkpoint", "0.01", "-o", "out.exr", "--channels", "error,Z", "--spectrum", "3"),
    render("--overwrite", "--film", "out.film", "--checkpoint", "0.01", "--shard", "1/2"),
    render("--overwrite", "--film", "out_%v.film", "--stereo", "parallel", "--checkpoint", "0.01", out_left_film="first.film", out_right_film="first.film"),
    render("--continue", "out.film", "--checkpoint", "0.01", out_film="first.film"),
    render("--continue", "out.film", "--checkpoint", "0.01", "-o", "out.exr", "--channels", "Z", out_film="first.film"),
    render("--film", "out.film", "--checkpoint", "0.01", "-o", "out.exr", out_film="first.film"),
    Output(["film", "merge", "part_1.film", "part_2.film", "--overwrite", "-o", "out.film"], {"out.film": "errors.film"},
           ["part_1.film", "part_2.film"]),
    Output(["film", "merge", "out.film", "part_1.film", "part_2.film", "-o", "out.film"], {"out.film": "tile_1.film"},
           ["part_1.film", "part_2.film"]),
    Output(["film", "develop", "errors.film", "-o", "out.exr", "-o", "out.png"], {"out.exr": None, "out.png": None}, ["errors.film"]),
]


def make_films(velo, folder):
    """Writes FILMS and the scene to a folder."""
    with open(os.path.join(folder, "scene.pbrt"), "w") as f:
        f.write(SCENE)
    for name, words in FILMS.items():
        subprocess.run([velo, "render", "scene.pbrt", "--film", name, "--quiet", *words], cwd=folder, check=True)


def lay_out(output, films, folder, inner=""):
    """Writes the scene, the films that the command reads and the earlier files. Returns the earlier files' contents by name."""
    contents = {}
    for name in ["scene.pbrt", *output.reads]:
        shutil.copy(os.path.join(films, name), folder)
    for name, film in output.earlier.items():
        contents[name] = OLD if not film else open(os.path.join(films, film), "rb").read()
        with open(os.path.join(folder, inner, name), "wb") as f:
            f.write(contents[name])
    return contents


def is_whole(velo, name, folder):
    words = ["film", "info", "--check", name] if name.endswith(".film") else ["image", "diff", name, name]
    done = subprocess.run([velo, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return done.returncode == 0
