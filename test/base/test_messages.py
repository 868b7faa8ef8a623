#!/usr/bin/python3
"""Messages are for people: none names a C function or constant of the library, or an argument without saying which.
Reads every string of a call that reports something in src and apps."""
import glob
import os
import re
import sys

ROOT = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
CALL = re.compile(r"\b(\w*(?:fail|wrong|warn|remark|refuse|unsupported|report|bad|check_add|_log)\w*)\s*\(")
PART = re.compile(r'/\*.*?\*/|//[^\n]*|"((?:[^"\\]|\\.)*)"|\'(?:[^\'\\]|\\.)+\'|[()]', re.S)
BAD = [(re.compile(r"\b(?:vl|VL)_?[A-Za-z]\w*"), "names something of C"),
       (re.compile(r"(?:bad|null|invalid|wrong) argument"), "does not say which argument"),
       (re.compile(r"\b\w+\(\)"), "names a function")]

failures = strings = 0
for path in sorted(glob.glob(ROOT + "/src/**/*.c", recursive=True) + glob.glob(ROOT + "/apps/**/*.c", recursive=True)):
    text = open(path).read()
    seen = set()
    for call in CALL.finditer(text):
        depth = 1
        for part in PART.finditer(text, call.end()):
            if part.group(0) in "()":
                depth += 1 if part.group(0) == "(" else -1
                if depth == 0:
                    break
            if part.group(1) is None or part.start() in seen or text[max(0, part.start() - 9):part.start()] == "#include ":
                continue
            seen.add(part.start())
            strings += 1
            for pattern, why in BAD:
                if pattern.search(part.group(1)):
                    failures += 1
                    print("not ok messages: %s:%d: \"%s\" %s" % (os.path.relpath(path, ROOT),
                                                                text.count("\n", 0, part.start()) + 1, part.group(1), why))
if strings < 1000:
    failures += 1
    print("not ok messages: only %d strings were found" % strings)
if not failures:
    print("ok messages (%d strings)" % strings)
sys.exit(failures > 0)
