#!/usr/bin/python3
"""The command that a page of velo view copies makes the bytes of the image that the page saves, and the page verifies that: models
with and without a camera, lamps, walls, a ground, a time, a variant, of each axis upwards; scenes of pbrt. Also what verifying says
where the bytes are others, and that commands name new files."""
import json
import os
import shlex
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from copied import ask, copied, settled  # noqa: E402
from live import Page, View  # noqa: E402
import results  # noqa: E402
from results import check  # noqa: E402

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
VELO = os.path.abspath(os.environ.get("VELO") or os.path.join(ROOT, "build/release/bin/velo"))
FACES = [(4, 5, 7), (4, 7, 6), (1, 0, 2), (1, 2, 3), (5, 1, 3), (5, 3, 7), (0, 4, 6), (0, 6, 2), (6, 7, 3), (6, 3, 2), (0, 1, 5), (0, 5, 4)]
SCENE = '''LookAt 0 1 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "float lensradius" 0.1 "float focaldistance" 4
Film "rgb" "integer xresolution" 48 "integer yresolution" 36 "float cropwindow" [0.25 1 0 1]
WorldBegin
LightSource "infinite" "rgb L" [0.5 0.6 0.9]
Material "diffuse" "rgb reflectance" [0.6 0.3 0.1]
Shape "sphere" "float radius" 0.8
'''


def box(low, high, inward=False):
    corners = [tuple((high if i >> k & 1 else low)[k] for k in range(3)) for i in range(8)]
    return corners, [face[::-1] for face in FACES] if inward else FACES


def write_gltf(path, parts, light=None, camera=False, moves=False, variants=False):
    """parts: (corners and faces, inward) of each mesh."""
    data, views, accessors, meshes = b"", [], [], []

    def add(values, kind, name, form):
        nonlocal data
        part = b"".join(struct.pack("<%d%s" % (len(v), form), *v) for v in values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        accessor = {"bufferView": len(views) - 1, "componentType": kind, "count": len(values) * (3 if form == "I" else 1), "type": name}
        if form == "f":
            accessor.update(min=[min(v[i] for v in values) for i in range(len(values[0]))], max=[max(v[i] for v in values) for i in range(len(values[0]))])
        accessors.append(accessor)
        data += part
        return len(accessors) - 1
    for corners, faces in parts:
        primitive = {"attributes": {"POSITION": add(corners, 5126, "VEC3", "f")}, "indices": add(faces, 5125, "SCALAR", "I"), "material": 0}
        if variants:
            primitive["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}
        meshes.append({"primitives": [primitive]})
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "meshes": meshes, "nodes": [{"mesh": i} for i in range(len(meshes))],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": c, "metallicFactor": 0, "roughnessFactor": 0.6}} for c in
                          ([0.2, 0.4, 0.7, 1], [0.8, 0.1, 0.1, 1])], "extensionsUsed": []}
    if variants:
        gltf["extensionsUsed"].append("KHR_materials_variants")
        gltf["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "red"}]}}
    if light:
        gltf["extensionsUsed"].append("KHR_lights_punctual")
        gltf.setdefault("extensions", {})["KHR_lights_punctual"] = {"lights": [light]}
        gltf["nodes"].append({"translation": [0.5, 3, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    if camera:
        gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.01}}]
        gltf["nodes"].append({"camera": 0, "translation": [0.3, 0.7, 6]})
    if moves:
        times, places = add([(0.0,), (2.0,)], 5126, "SCALAR", "f"), add([(0, 0, 0), (1, 0.5, 0)], 5126, "VEC3", "f")
        gltf["animations"] = [{"samplers": [{"input": times, "output": places}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}]
    gltf.update(scenes=[{"nodes": list(range(len(gltf["nodes"])))}], accessors=accessors, bufferViews=views, buffers=[{"byteLength": len(data)}])
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)) + struct.pack("<I4s", len(text), b"JSON") + text +
                   struct.pack("<I4s", len(data), b"BIN\0") + data)


def write_stl(path, corners, faces):
    with open(path, "w") as file:
        file.write("solid box\n")
        for face in faces:
            file.write("facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % corners[i] for i in face) + "endloop\nendfacet\n")
        file.write("endsolid\n")


def write_obj(path, corners, faces):
    with open(path, "w") as file:
        file.writelines("v %g %g %g\n" % c for c in corners)
        file.writelines("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces)


def write_models(folder):
    here = lambda name: os.path.join(folder, name)
    chair, sheet = box((-1, 0.2, -0.4), (1, 1.3, 0.5)), box((-1, 0, -0.01), (1, 1.4, 0.01))
    ball = box((-0.3, 0.7, -0.3), (0.3, 1.3, 0.3))
    write_gltf(here("plain.glb"), [chair])
    write_gltf(here("lamp.glb"), [chair], light={"type": "point", "intensity": 1000})
    write_gltf(here("own camera.glb"), [chair], camera=True)
    write_gltf(here("moves.glb"), [chair], moves=True)
    write_gltf(here("variants.glb"), [chair], variants=True)
    write_gltf(here("room.glb"), [box((-2, 0, -2), (2, 2.5, 2), True), ball])
    write_gltf(here("dome.glb"), [box((-60, -60, -60), (60, 60, 60), True), ball])
    write_gltf(here("turned.glb"), [(chair[0], [face[::-1] for face in chair[1]])])
    write_stl(here("sheet.stl"), *sheet)
    write_obj(here("behind.obj"), sheet[0], [face[::-1] for face in sheet[1]])
    write_obj(here("chair.obj"), *chair)
    with open(here("scene.pbrt"), "w") as file:
        file.write(SCENE)


CASES = (("plain.glb",), ("plain.glb", "--framing", "front"), ("plain.glb", "--framing", "200,35", "--up", "z"),
         ("plain.glb", "--environment", "sky", "--environment-rotation", "33"), ("plain.glb", "--ground"), ("plain.glb", "--no-ground"),
         ("plain.glb", "--environment-strength", "0.3"), ("lamp.glb",), ("own camera.glb",), ("own camera.glb", "--ground-radius", "2"),
         ("moves.glb", "--at", "1"), ("moves.glb", "--at", "0.5:1"), ("variants.glb", "--variant", "red"), ("room.glb",),
         ("room.glb", "--walls", "keep"), ("dome.glb",), ("turned.glb",), ("sheet.stl",), ("sheet.stl", "--up", "y"), ("behind.obj",), ("chair.obj",),
         ("scene.pbrt",), ("scene.pbrt", "--crop", "4,4,20,20"), ("scene.pbrt", "--ground-middle", "0,-0.8,0"),
         ("scene.pbrt", "--focus-pixel", "24,18", "--turn", "30"))


def test_verdicts(folder):
    """Nothing copied; other bytes; an end; the sandbox. Commands name new files."""
    with open(os.path.join(folder, "changes.pbrt"), "w") as file:
        file.write(SCENE)
    view = View(VELO, "changes.pbrt", "--spp", "2", "-t", "1", "--quiet", cwd=folder)
    page = Page(view)
    settled(page)
    refused = ask(page, "verified", type="verify")
    check("nothing_copied", refused["type"] == "refused" and refused["message"] == "no command was copied", refused)
    first = ask(page, "command", type="command", exposure=0, view="standard")
    words = shlex.split(first["command"])
    for name in ("verified", "verified_twice"):
        verdict = ask(page, "verified", type="verify")
        check(name, verdict.get("same") is True, verdict)
    check("verifying_leaves_no_file", not os.path.exists(os.path.join(folder, words[-1])))
    subprocess.run([VELO, *words[1:], "--quiet"], cwd=folder, check=True)
    names = [words[-1], first["file"]]
    for _ in range(2):
        more = ask(page, "command", type="command", exposure=0, view="standard")
        names += [shlex.split(more["command"])[-1], more["file"]]
    check("new_names", len(set(names)) == len(names) and names[2] == "changes-view-2.png", names)
    with open(os.path.join(folder, "changes.pbrt"), "w") as file:
        file.write(SCENE.replace("0.6 0.3 0.1", "0.1 0.3 0.6"))
    verdict = ask(page, "verified", type="verify")
    check("other_bytes", verdict.get("same") is False and "pixels differ, by up to" in verdict["message"] and "sha256" not in verdict, verdict)
    os.remove(os.path.join(folder, more["file"]))
    verdict = ask(page, "verified", type="verify")
    check("no_image", verdict.get("same") is False and "no such file" in verdict["message"], verdict)
    page.close()
    view.end()
    view = View(VELO, "scene.pbrt", "--resolution", "1200x900", "--spp", "200000", "--quiet", cwd=folder)
    page = Page(view)
    page.wait_frame(lambda f: f.scale == 1)
    ask(page, "command", type="command", exposure=0, view="standard")
    page.send(type="verify", id=500)
    refused = ask(page, "verified", type="verify")
    check("one_at_a_time", refused["type"] == "refused" and refused["message"] == "a command is being verified", refused)
    page.send(type="verify", end=True)
    ended = page.wait(lambda m: isinstance(m, dict) and m.get("id") == 500)
    check("ended", ended.get("same") is False and ended["message"] == "ended", ended)
    page.send(type="verify", id=501)
    page.close()
    check("ends_with_the_program", view.end()[0] == 0)
    view = View(VELO, "scene.pbrt", "--spp", "1", "--sandbox", ".", "--quiet", cwd=folder)
    page = Page(view)
    settled(page)
    ask(page, "command", type="command", exposure=0, view="standard")
    check("sandbox", "--sandbox" in ask(page, "verified", type="verify")["message"])
    page.close()
    view.end()


def main():
    with tempfile.TemporaryDirectory() as folder:
        write_models(folder)
        for scene, *options in CASES:
            found, commands = copied(VELO, os.path.join(folder, scene), "--resolution", "48x36", "--spp", "2", "-t", "1", "--quiet", *options)
            check("_".join([scene, *options]).replace(" ", "_"), found is None, found, *commands)
        test_verdicts(folder)
    results.end()


if __name__ == "__main__":
    main()
