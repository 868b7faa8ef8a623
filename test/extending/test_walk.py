#!/usr/bin/python3
"""The tables that follow one number from its text to a hit or a ray, of a texture (docs/overview.md), a material and a
projection (README.md of their folders): each file exists and has what its row names, also in the reason; each name stands
in a file above it, too, so that a reader gets there with grep; no file is named twice, and there are no more than FILES
allows."""
import os
import re

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROW = re.compile(r"^\| (\*\*\w+\*\* )?\| \[`[^`]+`\]\(([^)]+)\) \| `(\w+)` \| (.+) \|$", re.M)
NAME = re.compile(r"`(\w+)`")
# src/, include/; fewer are better
FILES = {"docs/overview.md": 12, "src/material/README.md": 18, "src/projection/README.md": 18}


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def check(name, wrong):
    print("not ok %s: %s" % (name, "; ".join(wrong)) if wrong else "ok %s" % name)
    return not wrong


def walk(page):
    text = text_of(page).split("\n## The way of one number\n")[1].split("\n## ")[0]
    rows = [(step, os.path.normpath(os.path.join(os.path.dirname(page), path)), name, why)
            for step, path, name, why in ROW.findall(text)]
    return rows, text.count("| [`")


def unreachable(rows):
    """Names that no file above has; except for the first of a step."""
    seen = ""
    for step, path, name, _ in rows:
        if not step and not re.search(r"\b%s\b" % name, seen) and not called_there(path, name):
            yield "%s of %s" % (name, path)
        seen += text_of(path)


def called_there(path, name):
    """A static function is called in its own file."""
    return len(re.findall(r"\b%s\(" % name, text_of(path))) > 1


def check_walk(page):
    rows, count = walk(page)
    files = [path for _, path, _, _ in rows]
    missing = [path for path in files if not os.path.exists(os.path.join(ROOT, path))]
    good = check("%s: each row has a file, a name and a reason" % page,
                 [] if count == len(rows) else ["%d of %d rows" % (len(rows), count)])
    good &= check("%s: the files are there" % page, missing)
    if missing:
        return False
    good &= check("%s: each file has its name" % page,
                  ["%s has no %s" % (path, word) for _, path, name, why in rows for word in [name] + NAME.findall(why)
                   if not re.search(r"\b%s\b" % word, text_of(path))])
    good &= check("%s: each name stands in a file above" % page, list(unreachable(rows)))
    good &= check("%s: no file twice" % page, sorted({f for f in files if files.count(f) > 1}))
    good &= check("%s: at most %d files" % (page, FILES[page]), [] if len(files) <= FILES[page] else ["%d" % len(files)])
    return good


raise SystemExit(0 if all([check_walk(page) for page in FILES]) else 1)
