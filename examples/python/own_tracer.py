"""own_tracer: a tracer of one's own: light that reaches the camera straight from lamps, or by at most two surfaces
(docs/own-code.md).

    python3 own_tracer.py SCENE IMAGE
    PYTHONPATH=build/release/python python3 examples/python/own_tracer.py examples/corner.pbrt two_surfaces.jpg
"""
import sys

import numpy
import velo


def two_surfaces(trace: velo.Trace, paths: velo.Paths) -> numpy.ndarray:
    radiance, beta = numpy.zeros((2, len(paths.x), 4), "f4")
    beta[:] = 1
    rays, sees_lamps = paths.rays, numpy.ones(len(paths.x), bool)
    for bounce in range(2):
        hits = trace.hits(rays)
        radiance += beta * hits.emission * sees_lamps[:, None]
        lights = trace.lights(bounce)
        visible = ~trace.occluded(lights.rays)
        radiance += beta * trace.bsdf(lights.direction)[0] * lights.radiance * visible[:, None]
        step = trace.bounce(bounce)
        beta = beta * step.weight
        rays, sees_lamps = step.rays, step.specular == 1  # the light samples above do not see lamps in mirrors
    return radiance


scene = velo.load(sys.argv[1])
image = scene.render(tracer=velo.OwnTracer(two_surfaces, name="two surfaces"))
image.write(sys.argv[2])
