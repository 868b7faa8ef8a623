"""report.py: what velo could not take over from a scene, one line for each thing, for the panel and for Blender's report."""


class Notes:
    """Lines (owner, thing, text), each once, in the order in which they came.

    owner: name of the material, object or image; thing: its node or setting, may be empty; text: what happens instead."""

    def __init__(self):
        self.lines = []
        self._known = set()

    def add(self, owner, thing, text):
        line = (str(owner), str(thing), str(text))
        if line not in self._known:
            self._known.add(line)
            self.lines.append(line)

    def texts(self):
        """The lines as text: `owner, thing: text`."""
        return ["%s%s: %s" % (owner, ", " + thing if thing else "", text) for owner, thing, text in self.lines]


class Refused(Exception):
    """A scene or a setting that cannot be rendered; its text is one line. code: the exit code of velo's program."""
    code = 3


class Cancelled(Exception):
    """The user ended the export."""


#: Called with the finished part of a render, 0 to 1; None: nobody asks. headless.py sets it.
listener = None
#: Exit code that velo's program has for the error that ended the last render; 0: there was none.
status = 0
#: The notes of the last export, by the name of its scene; the panel reads them.
last = {}


def remember(scene_name, notes):
    last[scene_name] = notes.texts()
