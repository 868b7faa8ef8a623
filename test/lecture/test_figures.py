#!/usr/bin/python3
"""Every slider and every choice of every figure of the lecture's page is moved in a browser (test/lecture/figures.html), in both
languages; what the formulas then say is computed again here, from the numbers that the sliders show. Needs chromium."""
import functools
import html
import http.server
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading

ROOT = os.path.abspath(os.environ.get("VELO_SOURCE_DIR") or ".")


# ---- the cameras of the scenes: their files are read here ----

def camera_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = re.sub(r"#.*", "", file.read())

    def numbers(name, default):
        found = re.search(r'"\w+ %s" (?:\[([^]]*)\]|(\S+))' % name, text)
        return [float(x) for x in (found.group(1) or found.group(2)).split()] if found else default

    kind = re.search(r'Camera "(\w+)"', text).group(1)
    camera = {"kind": "perspective" if kind == "pinhole" else kind, "eye": numbers("eye", [0, 0, 0]), "lookat": numbers("lookat", [0, 0, -1]),
              "up": numbers("up", [0, 1, 0]), "zoom": numbers("zoom", [1])[0], "s": numbers("pixelsize", [1])[0], "roll": numbers("roll", [0])[0],
              "exposure_time": numbers("exposuretime", [1])[0], "near": 0, "width": numbers("xresolution", None)[0], "height": numbers("yresolution", None)[0]}
    if numbers("d", None):
        camera["d"] = numbers("d", None)[0]
    if numbers("fov", None):
        camera["fov"] = numbers("fov", None)[0]
    if kind == "panini":
        camera["panini"] = numbers("panini", [1])[0]
    return camera


def cameras():
    folder = "scenes/lecture"
    return {f"{folder}/{name}": camera_of(f"{folder}/{name}") for name in sorted(os.listdir(os.path.join(ROOT, folder))) if name.endswith(".pbrt")}


# ---- the formulas, again ----

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.hypot(*a) for x in a]


def sum_of(*terms):
    """Of (factor, vector)."""
    return [sum(k * v[i] for k, v in terms) for i in range(3)]


def basis(eye, lookat, up, roll=0):
    w = unit([a - b for a, b in zip(eye, lookat)])
    u = unit(cross(up, w))
    v = cross(w, u)
    c, s = math.cos(math.radians(roll)), math.sin(math.radians(roll))
    return sum_of((c, u), (-s, v)), sum_of((s, u), (c, v)), w


def live_lines(k):
    """name -> the numbers at the end of its line, for a camera."""
    u, v, w = basis(k["eye"], k["lookat"], k["up"], k["roll"])
    d, s, half = k.get("d", 500), k["s"] / k["zoom"], k["height"] / 2
    f = d / s
    r, c = k["height"] // 2, k["width"] // 2
    x, y = s * (c - k["width"] / 2 + 0.5), s * (r - half + 0.5)
    theta, sine = math.atan(2.6 / k["eye"][2]) if k["eye"][2] else 0, 0.6 / math.hypot(2.6, k["eye"][2])

    def vanishing(a):
        depth = -dot(a, w)
        return None if abs(depth) < 1e-9 else [f * dot(a, u) / depth, f * dot(a, v) / depth]

    axes = [vanishing([float(i == j) for j in range(3)]) for i in range(3)]
    slanted = vanishing([-1, 0.75, -5])
    return {
        "f": [f], "fov": [math.degrees(2 * math.atan(half / f))],
        "size": [f / (k["eye"][2] - z) for z in (250, 0, -500, -1500) if z < k["eye"][2]],
        "vanishing": slanted, "principal": [x for p in axes if p for x in (k["width"] / 2 + p[0], half - p[1])],
        "ellipse": [math.sqrt(1 - sine * sine) / math.sqrt(math.cos(theta) ** 2 - sine * sine)] if math.cos(theta) > sine else None,
        "dolly": [2 * f / (k["eye"][2] - 1)] if k["eye"][2] != 1 else None, "uvw": [*u, *v, *w], "origin": [0, 0, k["eye"][2]],
        "axis": unit([x, y, -d]), "point": [x, y], "ray": unit(sum_of((x, u), (y, v), (-d, w)))}


def projection(k):
    e, d, x, y, z = (k[n] for n in "edxyz")
    m = 1 if k["kind"] == "orthographic" else d / (e - z)
    return [[x, y, z], [m * x], [m * y]]


def windows(k):
    t = math.radians(k["turn"])
    u, w = [math.cos(t), 0, -math.sin(t)], [math.sin(t), 0, math.cos(t)]
    arm = [-k["shift_x"], -k["shift_y"], 150]
    if k["kind"] == "orthographic":
        return [[-x for x in w]]
    cosine = dot(arm, w) / math.hypot(*arm)
    return [[dot(arm, u), arm[1]], [cosine], [math.degrees(math.acos(min(1, cosine)))]]


def frustum(k):
    t = math.tan(math.radians(k["fov"] / 2))
    seen = sum(k["near"] <= z <= k["far"] and abs(x) <= 4 / 3 * t * z for x, z in ((-14, 70), (30, 150), (-60, 240), (80, 340), (-40, 450)))
    return [[2 * k["near"] * t], [2 * k["far"] * t], [seen]]


def turning(k):
    a, z, d = math.radians(k["angle"]), k["z"], k["d"]
    ends = [d * (s * 50 * math.cos(a)) / (z - s * 50 * math.sin(a)) for s in (-1, 1)]
    return [[ends[0]], [ends[1]], [ends[1] - ends[0]]]


def retina(k):
    t, a = math.radians(k["theta"]), math.radians(k["alpha"])
    long = (math.tan(t + a) - math.tan(t - a)) / 2
    middle = (math.tan(t + a) + math.tan(t - a)) / 2
    # half of the ellipse's other axis: the ray through (middle, wide, 1) makes the angle alpha with the sphere's direction
    reach = (middle * math.sin(t) + math.cos(t)) / math.cos(a)
    wide = math.sqrt(reach * reach - middle * middle - 1)
    return [[long / wide], [long, wide], [1 / math.cos(t)]]


def uvw(k):
    eye, lookat = ([k[f"{point}_{axis}"] for axis in "xyz"] for point in ("eye", "lookat"))
    up = [math.sin(math.radians(k["up_angle"])), math.cos(math.radians(k["up_angle"])), 0]
    w = unit([a - b for a, b in zip(eye, lookat)])
    side = cross(up, w)
    first = [w, [*side, math.hypot(*side)]]
    if math.hypot(*side) < 1e-6:
        return first
    u, v, _ = basis(eye, lookat, up, k["roll"])
    return first + [u, v]


SPHERES = (((-20, 0, -70), 100), ((125, -40, 45), 60), ((5, -58, 100), 42), ((88, -78, 148), 22), ((-82, -72, 112), 28))


def first_hit(o, d):
    hits = [(-100 - o[1]) / d[1]] if d[1] else []
    for centre, radius in SPHERES:
        q = [a - b for a, b in zip(centre, o)]
        along = dot(q, d)
        under = radius * radius - dot(q, q) + along * along
        if under >= 0:
            hits += [along - math.sqrt(under), along + math.sqrt(under)]
    return min((t for t in hits if t > 1e-9), default=None)


def pixel(k):
    eye = [300, 400, 500]
    u, v, w = basis(eye, [0, 0, -50], [0, 1, 0])
    x, y = 25 * (k["c"] - 8 + k["p_x"]), 25 * (k["r"] - 6 + k["p_y"])
    d = sum_of((x, u), (y, v), (-k["d"], w))
    t = first_hit(eye, unit(d))
    return [[x], [y], d, unit(d)] + ([[t]] if t else [])


def loop(k):
    columns = 17 if k["columns"] == "<=" else 16
    r, c = divmod(min(int(k["pixel"]), columns * 12 - 1), columns)
    d = [25 * (c - 8 + 0.5), 25 * (r - 6 + 0.5), 100 if k["third"] == "zw" else -500]
    return [[0, 0, 500], [d[0]], [d[1]], [d[2]], unit(d)]


def view_plane(k):
    h, v, s, n = k["h_res"], k["v_res"], k["s"], k["n"]
    return [[h * s], [v * s], [n * n], [h * v * n * n], [s / k["zoom"]]]


def samples(k):
    n = int(k["n"])
    lower, upper = (lambda x: k["height"] + k["slope"] * (x - 0.5)), 20000
    area = sum(min(1, max(0, lower((i + 0.5) / upper))) for i in range(upper)) / upper
    grid = [((i + 0.5) / n, (j + 0.5) / n) for i in range(n) for j in range(n)]
    inside = sum(y <= lower(x) for x, y in grid) / (n * n)
    return [[n * n], [inside] if k["sampler"] == "regular" else None, [area]]


def vanishing(k):
    a, e = math.radians(k["azimuth"]), math.radians(k["elevation"])
    u, v, w = basis([math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a)], [0, 0, 0], [0, 1, 0], k["roll"])
    return [[k["d"] * u[i] / -w[i], k["d"] * v[i] / -w[i]] if abs(w[i]) > 1e-9 else [] for i in range(3)]


DRAWN = {
    "projection": projection, "windows": windows, "frustum": frustum, "turning": turning, "retina": retina, "uvw": uvw, "pixel": pixel, "loop": loop,
    "errors": loop, "view_plane": view_plane, "samples": samples, "vanishing": vanishing,
    "field_of_view": lambda k: [[k["v_res"] * k["s"] / 2 / k["d"]], [math.degrees(2 * math.atan(k["v_res"] * k["s"] / 2 / k["d"]))]],
    "size": lambda k: [[k["d"] / k["z"]], [k["zoom"] * k["d"] / k["z"]]],
    "direction": lambda k: [[-k["d"] * k["v_x"] / k["v_z"]], [-k["d"] * k["v_y"] / k["v_z"]]] if k["v_z"] else [[0]],
    "film": lambda k: [[-90 * k["d"] / k["z"]], [90 * k["d"] / k["z"]], [k["hole"] * (1 + k["d"] / k["z"])]],
    "build": lambda k: [[300, 400, 500], [400]],
}
# By the order of the lines in the page's figures: their names in the marks of docs/lecture.md.
NUMBER = re.compile(r"[−-]?\d+(?:\.\d+)?")


def numbers_of(text):
    return [float(x.replace("−", "-")) for x in NUMBER.findall(text)]


def value(text):
    return math.inf if text == "∞" else float(text.replace("−", "-").replace(",", "."))


def agrees(line, expected, language):
    """The last numbers of a line are those expected, to half a unit of their last shown digit. The digits are read as written."""
    if language == "it":
        line = line.replace(",", ".").replace(";", ",")
    shown = NUMBER.findall(line)[-len(expected):] if expected else []
    if len(shown) < len(expected):
        return False
    for text, right in zip(shown, expected):
        digits = len(text.partition(".")[2])
        slack = 0.5 * 10 ** -max(digits, 4) if digits >= 4 else 0.5 * 10 ** -digits if digits else 0.5
        if abs(float(text.replace("−", "-")) - right) > slack * (1 + 1e-6) + 1e-9 * abs(right):
            return False
    return True


def judge(record, formulas, language):
    """What is wrong with a record of the page; None: nothing."""
    lines = record["lines"]
    if record["kind"] == "live":
        all_lines = live_lines(record["camera"])
        names = formulas[record["figure"]]
        expected = [all_lines[name] for name in names]
        for slider, text in record["sliders"].items():  # the slider shows what the camera has
            k = record["camera"]
            match = re.fullmatch(r"(eye|lookat)_([xyz])", slider)
            have = k["eye"][2] if slider == "e" else k[match.group(1)]["xyz".index(match.group(2))] if match else k[slider]
            have = math.inf if have is None else have
            if have != value(text) and abs(have - value(text)) > 5.1e-3 * abs(have):
                return "slider %s shows %s for %g" % (slider, text, have)
        joined = {"fov", "uvw", "principal", "ellipse", "size", "point"}  # several numbers among others
        wrong = []
        for name, line, right in zip(names, lines, expected):
            if right is None:
                continue
            parts = re.split(r"   ", line) if name in joined and name != "fov" else [line]
            got = []
            for part in parts:
                tail = part.split(" = ")[-1] if " = " in part else part.split(": ")[-1]
                got.append(tail)
            if not agrees("   ".join(got), right, language):
                wrong.append("%s: %s is not %s" % (name, line, right))
        return "; ".join(wrong) or ("%d lines" % len(lines) if len(lines) != len(names) else None)
    k = {**{name: value(text) for name, text in record["sliders"].items()}, **record["choices"]}
    expected = DRAWN[record["figure"]](k)
    if len(lines) < len(expected):
        return "%d lines of %d: %s" % (len(lines), len(expected), lines)
    for line, right in zip(lines, expected):
        if right is not None and not agrees(line, right, language):
            return "%s is not %s" % (line, right)
    return None


def page(chromium, port, language):
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--user-data-dir=" + profile, "--window-size=1280,800", "--virtual-time-budget=60000",
             "--dump-dom", "http://127.0.0.1:%d/test/lecture/figures.html?language=%s" % (port, language)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=240)
    found = re.search(r'<pre id="result">(.*?)</pre>', done.stdout.decode(), re.S)
    return json.loads(html.unescape(found.group(1))) if found and found.group(1) else [{"error": done.stderr.decode(errors="replace")[-500:]}]


class Server(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass

    def do_GET(self):
        if self.path != "/cameras.json":
            return super().do_GET()
        body = json.dumps(cameras()).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)


def main():
    chromium = shutil.which("chromium")
    if not chromium:
        print("skip figures: needs chromium")
        return 77
    with open(os.path.join(ROOT, "docs/lecture.md"), encoding="utf-8") as file:
        text = file.read()
    formulas = {os.path.basename(scene)[:-5]: words.split(",") for scene, words in re.findall(r"<!-- live: scene=(\S+).*? formulas=(\S+)", text)}
    sliders_of = {re.sub(r"^scene=.*/|\.pbrt$", "", name): set(re.findall(r"(\w+):", re.sub(r".*sliders=(\S+).*", r"\1", words)))
                  for name, words in re.findall(r"<!-- (?:live|drawn): (\S+)(.*) -->", text) if "sliders=" in words}
    for name in re.findall(r"<!-- live: scene=(\S+)", text):
        formulas.setdefault(os.path.basename(name)[:-5], [])
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=ROOT))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    failed = 0
    for language in ("en", "it"):
        records = page(chromium, server.server_port, language)
        wrong = {}
        for record in records:
            problem = record.get("error") or judge(record, formulas, language)
            if problem:
                wrong.setdefault(record.get("figure", "page"), []).append("%s: %s" % (record.get("moved"), problem))
        seen = {record.get("figure") for record in records}
        for figure, names in sliders_of.items():
            still = names - {r.get("moved") for r in records if r.get("figure") == figure}
            if still:
                wrong.setdefault(figure, []).append("not moved: %s" % ", ".join(sorted(still)))
        for figure in sorted(seen | set(formulas) | set(DRAWN), key=str):
            count = sum(r.get("figure") == figure for r in records)
            good = figure in seen and figure not in wrong
            failed += not good
            print("%s %s_%s" % ("ok" if good else "not ok", language, figure), "" if good else "\n  ".join([""] + wrong.get(figure, ["it is not on the page"])[:4]))
        sliders = {(r.get("figure"), r.get("moved")) for r in records}
        print("# %s: %d figures, %d sliders and choices, %d positions" % (language, len(seen), len(sliders) - len(seen), len(records)))
    server.shutdown()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
