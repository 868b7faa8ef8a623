#!/usr/bin/python3
"""velo view --tracer auto: the race of the tracers when the image stands still, the image of the tracer that wins, a
change of the camera or of the file during and after it, the film and the commands that come of it."""
import os
import shlex
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from lamp import SCENE  # noqa: E402
from live import Frame, Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
INTEGRATOR = 'Integrator "%s" "integer maxdepth" [4]\n'
# All light is seen from all points: paths from the camera alone are the best.
OPEN = SCENE.split("Attribute")[0] % "" + 'LightSource "distant" "point3 from" [0 2 5] "point3 to" [0 0 0]\n'


def status_of(message):
    return message if isinstance(message, dict) and message["type"] == "status" else {}


def is_done(message):
    s = status_of(message)
    return bool(s) and s["spp"] >= s["target"] and not s["racing"] and "next_tracer" not in s


def move(page, eye):
    page.change = getattr(page, "change", 100) + 1
    page.send(type="camera", change=page.change, set={"eye": eye})


def races(errors):
    """The lines of races in a log."""
    return [line for line in errors.splitlines() if "error x rays" in line]


def run(*words):
    return subprocess.run([VELO, *words], capture_output=True, text=True)


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def write(path, text):
    """Whole or not at all, so that a file that is watched is read once."""
    with open(path + ".new", "w") as file:
        file.write(text)
    os.replace(path + ".new", path)


def ask(page, kind, **message):
    page.send(id=7, **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in (kind, "refused") and m.get("id") == 7)


def follow(page):
    """The messages until the image is done."""
    messages = []
    page.wait(lambda m: messages.append(m) or is_done(m), 120)
    return messages


# ---- the race and its result ----

def check_same_image(page, name):
    """The copied command makes the bytes of the saved image."""
    saved = ask(page, "saved", type="save", what="image", name=f"{name}.exr", exposure=0, view="standard")
    words = shlex.split(ask(page, "command", type="command", exposure=0, view="standard")["command"])
    made = run(*words[1:-1], f"{name}-copy.exr")
    check(f"{name}_command_has_no_race", made.returncode == 0 and not races(made.stderr), made.stderr)
    check(f"{name}_command_makes_the_image", bytes_of(f"{name}-copy.exr") == bytes_of(saved["file"]), words)
    return words


def check_film(name, words):
    """The film names the tracer; a continued film is the longer render."""
    command = next(line for line in run("film", "info", f"{name}.film").stdout.splitlines() if " command " in line).split()[1:]
    tracer = words[words.index("--tracer") + 1]
    check(f"{name}_film_names_the_tracer", command[command.index("--tracer") + 1] == tracer, command)
    check(f"{name}_film_names_light_paths", [w for w in command if w == "--light-paths"] == [w for w in words if w == "--light-paths"])
    command[command.index("--spp") + 1] = "80"
    long = run(*command[1:], "-o", f"{name}-long.exr")
    more = run("render", "--continue", f"{name}.film", "--spp", "80", "-o", f"{name}-more.exr")
    check(f"{name}_film_is_continued", more.returncode == 0 and not races(more.stderr), more.stderr)
    check(f"{name}_continued_is_the_longer_render", long.returncode == 0 and bytes_of(f"{name}-long.exr") == bytes_of(f"{name}-more.exr"),
          long.stderr)


def test_auto():
    """Another tracer wins: its image replaces the first one, never with more noise, and stays for other cameras."""
    view = View(VELO, "named.pbrt", "--tracer", "auto", "--film", "auto.film")
    page = Page(view)
    messages = follow(page)
    seen = [status_of(m) for m in messages if status_of(m)]
    check("begins_with_volpath", seen[0]["tracer"] == "volpath" and not seen[0]["raced"], seen[0])
    check("tells_the_race", any(s["racing"] for s in seen), seen)
    check("race_at_32", all(s["spp"] >= 32 for s in seen if s["racing"]), seen)
    check("tells_the_next", any(s.get("next_tracer") == "bidirectional" and s["tracer"] == "volpath" for s in seen), seen)
    check("bidirectional_wins", seen[-1]["tracer"] == "bidirectional" and seen[-1]["raced"], seen[-1])
    note = [m["message"] for m in messages if isinstance(m, dict) and m["type"] == "note"]
    first, second = ([s["spp"] for s in seen if s["tracer"] == name] for name in ("volpath", "bidirectional"))
    check("new_image_with_fewer_samples", 1 < second[0] < first[-1] and first + second == sorted(first) + sorted(second),
          first, second)
    samples = [m.spp for m in messages if isinstance(m, Frame) and m.scale == 1]
    late = samples[next((i for i, n in enumerate(samples) if n >= 32), len(samples)):]
    check("no_later_frame_of_few_samples", all(n >= second[0] for n in late), samples, second)
    told = ask(page, "paths", type="paths", x=3, y=4)
    check("its_paths_are_not_recorded", told["type"] == "refused" and "bidirectional" in told["message"], told)
    # velo hangs up on a page that answers no ping for 30 s, as this one would while the commands run: another one goes on.
    page.close()
    check_same_image(Page(view), "auto")
    page = Page(view)

    move(page, [0.3, 1.1, 3.2])
    page.wait_frame(lambda f: f.change == page.change)
    seen = [status_of(m) for m in follow(page) if status_of(m)]
    check("choice_stays", all(s["tracer"] == "bidirectional" and not s["racing"] for s in seen if s["spp"]), seen)
    words = check_same_image(page, "moved")
    page.close()
    code, errors = view.end()
    race = races(errors)
    check("one_race", code == 0 and len(race) == 1, errors)
    check("page_has_the_line", note == [race[0].split(": ", 1)[1]], note)
    render = run("render", "named.pbrt", "--tracer", "auto", "--crop", "0,0,1,1", "-o", "auto.pfm")
    check("race_of_velo_render", races(render.stderr) == race, render.stderr, race)
    shutil.move("auto.film", "moved.film")
    check_film("moved", words)


def test_path_wins():
    view = View(VELO, "open.pbrt", "--film", "open.film")
    page = Page(view)
    messages = follow(page)
    last = status_of(messages[-1])
    samples = [m.spp for m in messages if isinstance(m, Frame) and m.scale == 1]
    check("path_wins", last["tracer"] == "volpath" and last["raced"], last)
    check("path_goes_on", samples == sorted(samples) and last["spp"] == 64, samples)
    check("path_has_no_note", not [m for m in messages if isinstance(m, dict) and m["type"] == "note"])
    words = check_same_image(page, "open")
    page.close()
    code, errors = view.end()
    check("path_is_told", code == 0 and len(races(errors)) == 1 and "auto: volpath" in errors, errors)
    check_film("open", words)


def test_default():
    """As in velo render: from 32 samples on, where the scene names no integrator."""
    for name, scene, options, tracer, raced in (
            ("default", "scene.pbrt", [], "bidirectional", True),
            ("few_samples", "scene.pbrt", ["--spp", "31"], "volpath", False),
            ("small_image", "scene.pbrt", ["--resolution", "64x48"], "volpath", False),
            ("scenes_own", "named.pbrt", [], "volpath", False),
            ("given", "scene.pbrt", ["--tracer", "volpath"], "volpath", False),
            ("light_paths", "two_way.pbrt", [], "bidirectional", True),
            ("asked_few", "named.pbrt", ["--tracer", "auto", "--spp", "16", "--resolution", "256x192"], "bidirectional", True)):
        view = View(VELO, scene, *options)
        page = Page(view)
        last = status_of(follow(page)[-1])
        check(name, last["tracer"] == tracer and last["raced"] == raced, last)
        if name in ("default", "light_paths"):
            check_same_image(page, name)
        page.close()
        code, errors = view.end()
        check(f"{name}_log", code == 0 and bool(races(errors)) == raced, errors)
    view = View(VELO, "named.pbrt", "--tracer", "auto", "--resolution", "32x24")
    page = Page(view)
    follow(page)
    page.send(type="settings", spp=70)
    last = status_of(follow(page)[-1])
    check("no_race_is_told", last["tracer"] == "volpath" and not last["raced"], last)
    page.close()
    errors = view.end()[1]
    check("no_race_is_told_once", errors.count("auto: volpath (no race") == 1, errors)


# ---- changes during and after the race ----

def test_cancel():
    """A change of the camera, or a pause, ends the race at once; it begins anew when the image has stood still again."""
    view = View(VELO, "named.pbrt", "--tracer", "auto", "--resolution", "400x300", "--spp", "128", "--threads", "1")
    page = Page(view)
    racing = lambda m: status_of(m).get("racing")
    page.wait(racing)
    move(page, [0.1, 1, 3.4])
    page.wait_frame(lambda f: f.change == page.change)
    after = page.wait(lambda m: status_of(m).get("spp"))
    check("moved_during_the_race", not after["raced"] and after["tracer"] == "volpath", after)
    stopped = [after["stop_seconds"]] if "stop_seconds" in after else []
    page.wait(racing)
    check("race_again_after_the_move", True)
    page.send(type="settings", paused=True)
    after = page.wait(lambda m: status_of(m).get("paused"))
    check("paused_during_the_race", not after["raced"] and "next_tracer" not in after, after)
    saved = ask(page, "saved", type="save", what="image", name="paused.pfm", exposure=0, view="standard")
    check("saved_during_the_race", saved["type"] == "saved", saved)
    page.send(type="settings", paused=False)
    after = page.wait(lambda m: status_of(m).get("raced"))
    check("race_after_the_pause", after.get("next_tracer") == "bidirectional" and after["spp"] < 128, after)
    move(page, [0, 1, 3.3])  # drops the image that has not replaced the other one yet
    after = page.wait(lambda m: status_of(m).get("spp") and "next_tracer" not in m)
    check("moved_before_the_new_image", after["tracer"] == "bidirectional" and after["raced"], after)
    check("stopped_soon", all(s < 1 for s in stopped), stopped)
    page.close()
    code, errors = view.end()
    check("one_race_in_the_log", code == 0 and len(races(errors)) == 1, errors)


def test_reload():
    """Another scene has another race; the film of a scene whose file is broken has no receipt."""
    with open("named.pbrt") as file:
        text = file.read()
    write("watched.pbrt", text)
    view = View(VELO, "watched.pbrt", "--tracer", "auto", "--film", "watched.film")
    page = Page(view)
    check("first_choice", status_of(follow(page)[-1])["tracer"] == "bidirectional")
    write("watched.pbrt", OPEN)
    page.wait_text("loaded")
    seen = [status_of(m) for m in follow(page) if status_of(m)]
    check("chosen_anew", any(s["racing"] for s in seen) and seen[-1]["raced"] and seen[-1]["tracer"] == "volpath", seen)
    write("watched.pbrt", OPEN + "Shape\n")
    page.wait_text("error")
    page.close()
    code, errors = view.end()
    check("two_races", code == 0 and len(races(errors)) == 2, errors)
    check("no_receipt_is_told", "no receipt" in errors, errors)
    more = run("render", "--continue", "watched.film", "--spp", "80", "-o", "watched.exr")
    check("without_receipt_not_continued", more.returncode == 3 and "no receipt" in more.stderr, more.stderr)


def main():
    missing = subprocess.run([VELO, "view", "missing.pbrt"], capture_output=True, text=True, timeout=60)
    if "without libwebsockets" in missing.stderr:
        print("skip view_race: velo was built without libwebsockets")
        return
    folder = tempfile.mkdtemp(prefix="velo-view-race-")
    os.chdir(folder)
    for name, text in (("named", SCENE % (INTEGRATOR % "volpath")), ("scene", SCENE % ""), ("open", OPEN),
                       ("two_way", SCENE % (INTEGRATOR % "bdpt"))):
        write(name + ".pbrt", text)
    test_auto()
    test_path_wins()
    test_default()
    test_cancel()
    test_reload()
    os.chdir(ROOT)
    shutil.rmtree(folder)


main()
results.end()
