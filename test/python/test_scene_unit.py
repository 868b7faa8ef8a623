#!/usr/bin/python3
"""scene_unit: candela and lumens of a scene in any unit give the light that they give in metres."""
import cases
from cases import case, raises, work

numpy = cases.need("numpy")
import velo

LIGHTS = {
    "point": 'LightSource "point" "point3 from" [%(a)g %(b)g %(a)g] "rgb I" [3 2 1]',
    "point by power": 'LightSource "point" "point3 from" [%(a)g %(b)g %(a)g] "rgb I" [3 2 1] "float power" 40',
    "spot": 'LightSource "spot" "point3 from" [%(a)g %(b)g %(a)g] "point3 to" [0 0 0] "rgb I" [3 2 1]',
    "surface by power": 'AttributeBegin AreaLightSource "diffuse" "rgb L" [3 2 1] "float power" 30 Translate %(a)g %(b)g %(a)g '
                        'Shape "sphere" "float radius" %(c)g AttributeEnd',
    "surface by luminance": 'AttributeBegin AreaLightSource "diffuse" "rgb L" [9 6 3] Translate %(a)g %(b)g %(a)g '
                            'Shape "sphere" "float radius" %(c)g AttributeEnd',
    "distant by illuminance": 'LightSource "distant" "point3 from" [1 2 1] "point3 to" [0 0 0] "float illuminance" 5',
}
SCENE = """LookAt 0 %(b)g %(b)g  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 16
WorldBegin
%(light)s
Material "diffuse" "rgb reflectance" [.5 .5 .5]
Scale %(b)g %(b)g %(b)g Rotate -90 1 0 0 Shape "disk" "float radius" 4
"""


def rendered(light, size, **keywords):
    numbers = {"a": 1 * size, "b": 2 * size, "c": 0.25 * size}
    path = work("unit.pbrt")
    with open(path, "w", encoding="utf-8") as file:
        file.write(SCENE % {**numbers, "light": LIGHTS[light] % numbers})
    return numpy.asarray(velo.load(path, **keywords).render(seed=3))[..., :3].astype(float)


@case
def light_is_that_of_the_scene_in_metres():
    for light in LIGHTS:
        metres = rendered(light, 1)
        assert metres.mean() > 1e-3, light
        others = rendered(light, 64, scene_unit=1 / 64)
        assert abs(others - metres).max() < 1e-4 * metres.max(), light


@case
def without_a_unit_a_scene_is_in_metres():
    for light in ("point", "surface by power"):
        metres, others = rendered(light, 1), rendered(light, 64)
        assert abs(others * 4096 - metres).max() < 1e-4 * metres.max(), light
        assert (rendered(light, 1, scene_unit=1) == metres).all()


@case
def wrong_units_are_refused():
    for unit in (0, -1, 1e10, float("inf"), "cm"):
        with raises(velo.UsageError, "scene_unit"):
            rendered("point", 1, scene_unit=unit)


if __name__ == "__main__":
    cases.main()
