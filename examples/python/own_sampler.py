"""own_sampler: a sampler of one's own: in each dimension the samples of a pixel go round by steps of one angle (a Kronecker
sequence); each pixel starts elsewhere (docs/own-code.md).

    python3 own_sampler.py SCENE IMAGE
    PYTHONPATH=build/release/python python3 examples/python/own_sampler.py examples/corner.pbrt sampler.jpg
"""
import sys

import numpy
import velo


def hashed(*keys: numpy.ndarray) -> numpy.ndarray:
    h = numpy.uint64(1)
    for key in keys:
        h = (h ^ numpy.asarray(key).astype("u8")) * numpy.array([0x9e3779b97f4a7c15], "u8")
        h = h ^ h >> numpy.uint64(29)
    return (h >> numpy.uint64(11)) * 2.0**-53


def kronecker(samples: velo.Samples) -> numpy.ndarray:
    columns = []
    for dimension in range(samples.dimension, samples.dimension + samples.dimensions):
        start = hashed(samples.x, samples.y, dimension, samples.seed)
        columns.append((start + samples.index * hashed(dimension, samples.seed)) % 1)
    return numpy.stack(columns, axis=1)


scene = velo.load(sys.argv[1])
image = scene.render(sampler=velo.OwnSampler(kronecker, name="Kronecker"))
image.write(sys.argv[2])
