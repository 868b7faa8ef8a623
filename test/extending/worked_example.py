"""The worked example of a page of docs/: its blocks as edits of a copy of the tree. A block ```c file=PATH is a new file; a block
```diff edits a file: after the line @@ come lines of context (" "), removed ("-") and added ("+") lines, which must be found in the
file in this order, each piece once."""
import os
import re
import shutil
import subprocess


class Part:
    def __init__(self, path, hunks=None, text=None):
        self.path, self.hunks, self.text = path, hunks, text

    def apply(self, root):
        path = os.path.join(root, self.path)
        if self.text is not None:
            with open(path, "x", encoding="utf-8") as file:
                file.write(self.text)
            return
        self._edit(path, self.hunks)

    def undo(self, root):
        self._edit(os.path.join(root, self.path), [(after, before) for before, after in self.hunks])

    @staticmethod
    def _edit(path, hunks):
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for before, after in hunks:
            if text.count(before) != 1:
                raise SystemExit("%s: %d places for\n%s" % (path, text.count(before), before))
            text = text.replace(before, after)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)


def _hunks(body):
    for piece in re.split(r"^@@.*\n", body, flags=re.M)[1:]:
        lines = piece.splitlines(keepends=True)
        before = "".join(l[1:] for l in lines if l[0] in " -")
        after = "".join(l[1:] for l in lines if l[0] in " +")
        yield before, after


def parts(page, begin, end):
    """The parts of the blocks between two headings of the page, in their order."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    text = text[text.index("\n" + begin + "\n"):text.index("\n" + end + "\n")]
    for head, body in re.findall(r"^```(\S[^\n]*)\n(.*?)^```$", text, flags=re.M | re.S):
        new = re.match(r"c file=(\S+)$", head)
        if new:
            yield Part(new.group(1), text=body)
        elif head == "diff":
            yield Part(re.search(r"^\+\+\+ b/(\S+)$", body, flags=re.M).group(1), hunks=list(_hunks(body)))


def copy_tree(root, scratch):
    names = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard", "-z"], check=True,
                           stdout=subprocess.PIPE).stdout.decode().split("\0")
    for name in names:
        if not name or not os.path.exists(os.path.join(root, name)):
            continue
        to = os.path.join(scratch, name)
        os.makedirs(os.path.dirname(to), exist_ok=True)
        shutil.copy2(os.path.join(root, name), to)


def configure(scratch):
    """Warnings are errors; not optimised, for speed of building."""
    subprocess.run(["cmake", "-G", "Ninja", "-S", scratch, "-B", scratch + "/build", "-DCMAKE_BUILD_TYPE=Debug",
                    "-DCMAKE_C_FLAGS_DEBUG=-O0", "-DVELO_WERROR=ON", "-DVELO_SHARED=OFF", "-DVELO_LOWEST_SET_ONLY=ON"], check=True,
                   stdout=subprocess.DEVNULL)


def build(scratch, target):
    """Exit code, output."""
    run = subprocess.run(["ninja", "-C", scratch + "/build", target], stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return run.returncode, run.stdout.decode(errors="replace")
