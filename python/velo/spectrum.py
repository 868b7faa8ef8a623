"""Spectra: of lights, materials and media."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Sequence

from velo import _velo


@dataclass(frozen=True)
class Spectrum:
    """A spectrum by value. Wherever a spectrum is expected, a number (the same value at every wavelength), three numbers
    (linear sRGB) or a str (one of spectrum_names()) do as well."""
    kind: str  #: constant, rgb, blackbody, sampled or named
    value: Any  #: number; (r, g, b); kelvin; (wavelengths in nm, values); name
    scale: float = 1.0  #: factor on all values
    space: str = "srgb"  #: of an rgb value: srgb, dci_p3, rec2020 or aces2065_1; all linear


def rgb(r: float, g: float, b: float, *, scale: float = 1.0, space: str = "srgb") -> Spectrum:
    """A linear RGB colour."""
    return Spectrum("rgb", (r, g, b), scale, space)


def blackbody(kelvin: float, *, scale: float = 1.0) -> Spectrum:
    """A black body at this temperature, in kelvin, normalised to maximum 1."""
    return Spectrum("blackbody", kelvin, scale)


def sampled(wavelengths: Sequence[float], values: Sequence[float], *, scale: float = 1.0) -> Spectrum:
    """Values at ascending wavelengths, in nm: linear between them, 0 outside."""
    return Spectrum("sampled", (wavelengths, values), scale)


def named(name: str, *, scale: float = 1.0) -> Spectrum:
    """One of the library's spectra: "metal-Au-eta", "glass-BK7", "stdillum-D65"."""
    return Spectrum("named", name, scale)


def spectrum_names() -> list[str]:
    """The names of the library's spectra."""
    return _velo.spectrum_names()
