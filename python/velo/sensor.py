"""Sensors: from a stored spectral image to electrons and the numbers of a raw file (docs/sensor.md)."""
from __future__ import annotations

import math
import os
from typing import Any, Mapping, Optional

from velo import _check, _velo
from velo._context import context_or_default
from velo._errors import UsageError
from velo.image import Image, Path
from velo.raw import Raw, raw_of


class Exposure:
    """The result of an exposure. numbers: rows x columns x 1, uint16; electrons: the same as float32, before the amplifier."""

    def __init__(self, numbers: Image, electrons: Image, counts: Mapping[str, Any], sensor: Optional[Sensor] = None,
                 given: Optional[dict[str, Any]] = None) -> None:
        self._sensor = sensor
        self._given = given or {}
        self.numbers = numbers
        self.electrons = electrons
        #: Pixels with a full well; below and above the converter's range.
        self.full: int = counts["full"]
        self.black: int = counts["black"]
        self.white: int = counts["white"]
        #: Pixels of the image that are not finite or negative; they are black.
        self.not_finite: int = counts["not_finite"]
        self.negative: int = counts["negative"]
        noise: float = counts["film_noise"]
        #: Share of pixels in which the image's own noise is above a tenth of photon noise; None: it has no standard errors.
        self.film_noise: Optional[float] = None if math.isnan(noise) else noise

    def raw(self, light: Any = None) -> Raw:
        """The raw image of the numbers, with the sensor's levels, noise and colour.

        light: the white of the scene's light, 471 values, for each nm from 360 to 830; default D65."""
        if self._sensor is None:
            raise UsageError("the exposure is of no sensor")
        return self._sensor._raw_of(self.numbers, self._given, light)

    def __repr__(self) -> str:
        return f"<velo.Exposure {self.numbers.width} x {self.numbers.height}: {self.full} pixels full>"


class Sensor:
    """A sensor by the name of a preset (sensor_presets()) or by a sensor file (.yaml), with keywords that replace its
    numbers: Sensor("generic_rggb", read_noise=1.5, pattern="BGGR"). The keywords are the rows `sensor` of
    docs/settings.md, in the units there."""

    def __init__(self, sensor: Path = "ideal", *, context: Any = None, **numbers: Any) -> None:
        _check.path(sensor, "sensor")
        name = os.fsdecode(sensor)
        self._context = context_or_default(context)
        self._file = not isinstance(sensor, str) or os.sep in name or name.endswith((".yaml", ".yml"))
        self._name = name
        self._given = dict(numbers)
        self._numbers: dict[str, Any] = _velo.sensor_numbers(self._context, name, self._file, self._given)

    @property
    def numbers(self) -> dict[str, Any]:
        """All numbers of the sensor by their keywords, and its pattern: "RG/GB"."""
        return dict(self._numbers)

    def expose(self, image: Image, **exposure: Any) -> Exposure:
        """Exposes the sensor to an image with a spectrum, as Film.spectrum() and files of `velo render --spectrum` have it.
        exposure: exposure_time in s, stops (a factor of 2^stops on it), f_number, iso, gain, temperature in deg C,
        focal_length in mm, radiance of the value 1 in W/(m^2 sr nm), seed, frame."""
        _check.instance(image, Image, "image")
        for part in image.parts:
            if any(name.startswith("S0.") for name in part._names):
                return Exposure(*_velo.sensor_expose(self._context, self._name, self._file, self._given, part, exposure), self,
                                dict(exposure))
        raise UsageError("the image has no spectrum: render it with buckets=N")

    def raw(self, image: Image, *, light: Any = None, **exposure: Any) -> Raw:
        """Exposes the sensor as expose() does, and makes a raw image with the sensor's levels, noise and colour.

        light: the white of the scene's light, 471 values, for each nm from 360 to 830; default D65."""
        return self.expose(image, **exposure).raw(light)

    def _raw_of(self, numbers: Image, exposure: dict[str, Any], light: Any) -> Raw:
        return raw_of(numbers, _velo.sensor_raw(self._context, self._name, self._file, self._given, exposure, numbers, light))

    def __repr__(self) -> str:
        return f"<velo.Sensor {self._name}: {self._numbers['pattern']}, {self._numbers['bits']} bits>"


def sensor_presets() -> list[str]:
    """The names of presets for Sensor."""
    return _velo.sensor_presets()
