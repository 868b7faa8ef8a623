"""What the tests of the Python module share: the module itself, and lines `ok NAME`, `not ok NAME`, `skip NAME: why` that
tools/run_tests counts."""
import contextlib
import functools
import io
import os
import resource
import signal
import sys
import tempfile
import traceback
import warnings

SOURCE = os.environ.get("VELO_SOURCE_DIR") or os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BINARY = os.environ.get("VELO_BINARY_DIR") or os.path.join(SOURCE, "build/release")
VELO = os.environ.get("VELO") or os.path.join(BINARY, "bin/velo")
MODULES = os.path.join(BINARY, "python")
SCENES = os.path.join(SOURCE, "scenes")
PINHOLE = os.path.join(SCENES, "lecture/pinhole.pbrt")
WORK = tempfile.mkdtemp(prefix="velo-python-")

failures = 0
cases = []


def skip_all(why):
    print("skip %s: %s" % (os.path.basename(sys.argv[0]), why))
    sys.exit(0)


if not any(name.startswith("_velo.") for name in
           (os.listdir(os.path.join(MODULES, "velo")) if os.path.isdir(os.path.join(MODULES, "velo")) else [])):
    skip_all("the Python module is not built")
for sanitizer in ("libasan", "libtsan"):
    # A program that is not built with a sanitizer can load such a module only with the sanitizer's library preloaded.
    with open(os.path.join(MODULES, "velo/_velo.abi3.so"), "rb") as module:
        if sanitizer.encode() in module.read() and sanitizer not in os.environ.get("LD_PRELOAD", ""):
            skip_all("the module needs LD_PRELOAD=%s.so" % sanitizer)
sys.path.insert(0, MODULES)
os.environ["PYTHONPATH"] = MODULES


class Skip(Exception):
    """Raised by a case that cannot run here."""


def need(*names):
    """The modules of these names; skips the whole script where one is missing."""
    modules = []
    for name in names:
        try:
            modules.append(__import__(name))
        except ImportError:
            skip_all("needs Python's module %s" % name)
    return modules[0] if len(modules) == 1 else modules


def case(function):
    """A function that is a case: it fails by an exception."""
    cases.append(function)
    return function


@contextlib.contextmanager
def raises(kind, *texts):
    """The block must raise this exception, and its text must have these parts."""
    try:
        yield
    except kind as error:
        for text in texts:
            assert text in str(error), "%r is not in %r" % (text, str(error))
        return
    raise AssertionError("nothing was raised, %s was expected" % kind.__name__)


@contextlib.contextmanager
def warned():
    """The warnings of what runs inside: `with warned() as notes:`."""
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        yield notes


# ---- rules of written files ----

@functools.lru_cache(None)
def _tool(name):
    """A program of tools/ as a module."""
    import importlib.machinery
    import importlib.util
    sys.dont_write_bytecode = True  # no file beside the tool
    loader = importlib.machinery.SourceFileLoader(name, os.path.join(SOURCE, "tools", name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def broken_rules(path):
    """What the format of a written scene forbids: pbrt-v4's by tools/check_pbrt, glTF's by tools/check_gltf."""
    if path.endswith(".pbrt"):
        return _tool("check_pbrt").mistakes_of(path)
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        wrong = _tool("check_gltf").File(path).check()
    return said.getvalue().splitlines() if wrong else []


# ---- rows of settings ----

class Row:
    """A row of `velo scene kinds settings`. infinite, optional: whether infinity, or nothing, may be right."""

    def __init__(self, group, name, kind, default, text):
        self.group, self.name, self.kind, self.choices = group, name, kind, None
        self.infinite = default.split()[0] == "inf" or name == "focus_distance"
        self.optional = default == "\u2013"
        self.low, self.high, self.above, self.below = float("-inf"), float("inf"), text.startswith(">"), "excluded" in text
        if kind == "string":
            self.choices = text.split(", ") if text else None
        elif text:
            ends = text.strip("> \u2265").replace(", excluded", "").split(" to ")
            self.low = float(ends[0])
            self.high = float(ends[1]) if len(ends) > 1 else self.high
        self.number = kind in ("integer", "float")
        self.unit = default.split()[-1] if " " in default and not self.optional else ""

    def holds(self, value):
        """Whether a number is one of the row's; None where the table does not say."""
        if value != value or (self.kind == "integer" and value != int(value) if abs(value) < 1e300 else self.kind == "integer"):
            return False
        if value in (float("inf"), float("-inf")):
            return None if self.infinite and value > 0 else False
        fits = (value > self.low if self.above else value >= self.low) and (value < self.high if self.below else value <= self.high)
        return fits and (self.kind != "integer" or 0 <= value <= 2**32 - 1)


def setting_rows():
    """All settings, as the program prints them."""
    import re
    import subprocess
    text = subprocess.run([VELO, "scene", "kinds", "settings"], stdout=subprocess.PIPE, text=True, check=True).stdout
    rows, group = [], ""
    for line in text.splitlines():
        head = re.match(r"\*\*`(\w+)`\*\*", line)
        group = head.group(1) if head else group
        row = re.match(r"\| `([\w\[\]]+)` \| (\w+) \| (.*?) \| (.*?) ?\| ", line)
        if row:
            rows.append(Row(group, *(part.strip() for part in row.groups())))
    return rows


# ---- calls with values that they must refuse ----

class _TooLong(BaseException):
    pass


def _ring(*unused):
    raise _TooLong()


def attempt(call, **changes):
    """None: accepted; the velo.Error; or the text of what must not happen. Within limited."""
    import velo
    signal.alarm(20)
    try:
        call(**changes)
        return None
    except velo.Error as error:
        return error
    except _TooLong:
        return "hangs"
    except Exception as error:
        return "%s: %s" % (type(error).__name__, str(error)[:200])
    finally:
        signal.alarm(0)


def limited(function):
    """Runs with a limit of memory and without waiting for ever."""
    @functools.wraps(function)
    def run():
        old = resource.getrlimit(resource.RLIMIT_AS)
        previous = signal.signal(signal.SIGALRM, _ring)
        if "san" not in os.environ.get("LD_PRELOAD", ""):
            resource.setrlimit(resource.RLIMIT_AS, (6 << 30, old[1]))
        try:
            function()
        finally:
            resource.setrlimit(resource.RLIMIT_AS, old)
            signal.signal(signal.SIGALRM, previous)
    return run


def report(problems):
    """Fails where there are problems, which are texts."""
    assert not problems, "%d problems:\n  %s" % (len(problems), "\n  ".join(problems[:60]).encode(errors="backslashreplace").decode())


def work(name):
    return os.path.join(WORK, name)


def main():
    global failures
    only = sys.argv[1:]
    for function in cases:
        if only and function.__name__ not in only:
            continue
        name = function.__name__.replace("_", " ")
        try:
            function()
            print("ok %s" % name, flush=True)
        except Skip as why:
            print("skip %s: %s" % (name, why), flush=True)
        except BaseException:
            failures += 1
            print("not ok %s" % name, flush=True)
            traceback.print_exc(file=sys.stdout)
    import shutil
    shutil.rmtree(WORK, ignore_errors=True)
    sys.exit(1 if failures else 0)
