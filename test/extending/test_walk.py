#!/usr/bin/python3
"""The table of docs/overview.md that follows one number from its text to a hit: each file exists and defines or lists
what the table names; each name stands in a file above it, too, so that a reader gets there with grep; no file is named
twice, and there are at most FILES."""
import os
import re

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
ROW = re.compile(r"^\| (\*\*\w+\*\* )?\| \[`[^`]+`\]\(\.\./([^)]+)\) \| `(\w+)` \| .+ \|$", re.M)
FILES = 16  # src/, include/; fewer are better


def text_of(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def check(name, wrong):
    print("not ok %s: %s" % (name, "; ".join(wrong)) if wrong else "ok %s" % name)
    return not wrong


def walk():
    page = text_of("docs/overview.md").split("\n## The way of one number\n")[1].split("\n## ")[0]
    return ROW.findall(page), page.count("| [`")


def unreachable(rows):
    """Names that no file above has; except for the first of a step."""
    seen = ""
    for step, path, name in rows:
        if not step and not re.search(r"\b%s\b" % name, seen) and not called_there(path, name):
            yield "%s of %s" % (name, path)
        seen += text_of(path)


def called_there(path, name):
    """A static function is called in its own file."""
    return len(re.findall(r"\b%s\(" % name, text_of(path))) > 1


def main():
    rows, count = walk()
    missing = [path for _, path, _ in rows if not os.path.exists(os.path.join(ROOT, path))]
    good = check("each row has a file, a name and a reason",
                 [] if count == len(rows) else ["%d of %d rows" % (len(rows), count)])
    good &= check("the files are there", missing)
    if missing:
        return 1
    good &= check("each file has its name",
                  ["%s has no %s" % (path, name) for _, path, name in rows if not re.search(r"\b%s\b" % name, text_of(path))])
    good &= check("each name stands in a file above", list(unreachable(rows)))
    files = [path for _, path, _ in rows]
    good &= check("no file twice", sorted({f for f in files if files.count(f) > 1}))
    good &= check("at most %d files" % FILES, [] if len(files) <= FILES else ["%d" % len(files)])
    return 0 if good else 1


raise SystemExit(main())
