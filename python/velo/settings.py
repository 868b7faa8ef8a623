"""The settings of a render as an object, which can be copied and pickled."""
from __future__ import annotations

from typing import Any, Callable

from velo import _velo
from velo._errors import UsageError
from velo.own import bare


class Settings(_velo.Settings):
    """What a render is set to: Scene.settings makes it from the scene's file and from keywords. `get` and `set` read and change one
    keyword, `size` and `crop` are in pixels."""

    _own_code: dict[str, Any] = {}  # "sampler", "tracer": velo.OwnSampler, velo.OwnTracer

    def set(self, name: str, value: Any) -> None:
        """Sets a keyword, as Scene.render has it."""
        super().set(name, bare(value))
        others = {other: code for other, code in self._own_code.items() if other != name}
        self._own_code = others if bare(value) is value else {**others, name: value}

    def get(self, name: str) -> Any:
        """The value of a keyword."""
        return self._own_code[name] if name in self._own_code else super().get(name)

    def copy(self) -> "Settings":
        """The same settings, to be changed on their own."""
        result: Settings = super().copy()
        result._own_code = self._own_code
        return result

    def keywords(self) -> dict[str, Any]:
        """All of it as keywords: `scene.render(**settings.keywords())`."""
        plain = _from_keywords({"filter": self.get("filter")})
        # A filter's name sets its numbers, so it comes first; those of other filters are 0, which no call accepts.
        names = sorted(self.names(), key=lambda name: (name != "filter", name))
        values = {name: self.get(name) for name in names if not name.startswith("filter_") or self.get(name) != plain.get(name)}
        return {"resolution": self.size, "crop": self.crop, **values}

    def __copy__(self) -> "Settings":
        return self.copy()

    def __deepcopy__(self, memo: Any) -> "Settings":
        return self.copy()

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[dict[str, Any]]]:
        """For pickle: the keywords. UsageError: a sampler or tracer of one's own."""
        if self._own_code:
            raise UsageError("settings with a sampler or a tracer of one's own cannot be pickled")
        return _from_keywords, (self.keywords(),)

    def __repr__(self) -> str:
        return f"<velo.Settings {self.size[0]} x {self.size[1]}, {self.get('spp')} samples per pixel>"


_velo.set_type("Settings", Settings)


def _from_keywords(keywords: dict[str, Any]) -> Settings:
    from velo.scene import Scene
    return Scene().settings(**keywords)
