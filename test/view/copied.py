#!/usr/bin/python3
"""Whether the command that a page of `velo view` copies makes the bytes of the image that the page saves, for any scenes:

    test/view/copied.py build/release/bin/velo ../shared/scenes --list

A folder stands for all scenes in it. Prints a line for each scene and, at the end, how many are equal; the exit code is 1 if one
is not. test_view_copied.py has the scenes of the test."""
import argparse
import os
import shlex
import subprocess
import sys
import tempfile
from hashlib import sha256

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from live import Page, View  # noqa: E402

SUFFIXES = (".gltf", ".glb", ".obj", ".ply", ".stl", ".off", ".pbrt", ".pbrt.gz")


def ask(page, kind, **message):
    """Sends a message with an id; the answer to it."""
    page.id = getattr(page, "id", 0) + 1
    page.send(id=page.id, **message)
    return page.wait(lambda m: isinstance(m, dict) and m["type"] in (kind, "refused") and m.get("id") == page.id, 300)


def move(page, camera):
    """Moves the camera a little to its right and turns it. False: this camera does not move."""
    eye, lookat = camera["eye"], camera["lookat"]
    right = [0.05 * (lookat[i - 1] - eye[i - 1]) for i in range(3)]
    page.send(type="camera", change=77, set={"eye": [e + r for e, r in zip(eye, right)], "lookat": lookat, "roll": 3})
    answer = page.wait(lambda m: isinstance(m, dict) and m["type"] in ("state", "refused") and m.get("change") == 77)
    return answer["type"] == "state"


def settled(page, change=0):
    """The image after the page's change of this number has all its samples."""
    page.wait(lambda m: isinstance(m, dict) and m["type"] == "status" and m["change"] == change and m["spp"] >= m["target"], 300)


def bytes_of(folder, name):
    with open(os.path.join(folder, name), "rb") as file:
        return file.read()


def look(velo, page, folder, name, change=0):
    """Saves the page's image as .exr and .png, runs the command for both. What differs, or None; and the command."""
    settled(page, change)
    shown = {}
    for suffix in ("exr", "png"):
        saved = ask(page, "saved", type="save", what="image", name=f"{name}.{suffix}", exposure=0.37, view="agx")
        if saved["type"] != "saved":
            return saved["message"], ""
        shown[suffix] = saved["file"]
    answer = ask(page, "command", type="command", exposure=0.37, view="agx")
    if answer["type"] != "command":
        return answer["message"], ""
    words = shlex.split(answer["command"])
    run = subprocess.run([velo, *words[1:], "-o", f"{name}-copy.exr"], cwd=folder, capture_output=True, text=True)
    if run.returncode or "has no effect" in run.stderr:
        return run.stderr.strip(), answer["command"]
    if os.path.basename(words[-1]) in (shown["png"], shown["exr"]):
        return f"the command writes {words[-1]}, which is there already", answer["command"]
    verified = ask(page, "verified", type="verify")
    made = {"exr": bytes_of(folder, f"{name}-copy.exr"), "png": bytes_of(folder, words[-1])}
    differ = [shown[suffix] for suffix in shown if bytes_of(folder, shown[suffix]) != made[suffix]]
    if verified.get("same") != (not differ):
        return f"the page says {verified}", answer["command"]
    if not differ and (verified["sha256"], verified["sha256_exr"]) != tuple(sha256(made[s]).hexdigest() for s in ("png", "exr")):
        return f"the hashes are others: {verified}", answer["command"]
    return ", ".join(differ) + f" differs: {verified['message']}" if differ else None, answer["command"]


def copied(velo, scene, *options):
    """What differs between images of the page and of its commands, at first and with a moved camera, or None; and the commands."""
    commands = []
    with tempfile.TemporaryDirectory() as folder:
        view = View(velo, os.path.abspath(scene), *options, cwd=folder)
        try:
            page = Page(view)
            state = page.wait_text("state")
            found, command = look(velo, page, folder, "first")
            commands.append(command)
            if not found and move(page, state["camera"]):
                found, command = look(velo, page, folder, "moved", 77)
                commands.append(command)
            page.close()
        finally:
            view.end()
    return found, commands


def scenes_in(path):
    if not os.path.isdir(path):
        return [path]
    found = [os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names if name.endswith(SUFFIXES)]
    return sorted(found)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("velo")
    parser.add_argument("scenes", nargs="+", help="files or folders")
    parser.add_argument("--resolution", default="48x32")
    parser.add_argument("--spp", default="1")
    parser.add_argument("--most-bytes", type=int, default=1 << 40, help="leave out larger files")
    parser.add_argument("--list", action="store_true", help="print the commands, too")
    given = parser.parse_args()
    velo, counts = os.path.abspath(given.velo), {"equal": 0, "differs": 0, "left out": 0}
    for scene in [s for path in given.scenes for s in scenes_in(path)]:
        if os.path.getsize(scene) > given.most_bytes:
            counts["left out"] += 1
            continue
        try:
            found, commands = copied(velo, scene, "--resolution", given.resolution, "--spp", given.spp, "-t", "1", "--quiet")
        except RuntimeError as error:  # it is no scene of its own
            print(f"left out  {scene}: {str(error).strip()}", flush=True)
            counts["left out"] += 1
            continue
        counts["differs" if found else "equal"] += 1
        print(f"{'differs' if found else 'equal':9} {scene}{': ' + found if found else ''}", flush=True)
        for command in commands if given.list else ():
            print("         ", command, flush=True)
    print(", ".join(f"{count} {name}" for name, count in counts.items()))
    return 1 if counts["differs"] else 0


if __name__ == "__main__":
    sys.exit(main())
