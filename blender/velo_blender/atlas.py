"""atlas.py: baking of what depends on the place on a mesh: each triangle gets a square block of texels of its own.

A block of k x k texels holds a triangle whose corners are the centres of the texels (0, 0), (k - 2, 0) and (0, k - 2); the texels beyond
its long side continue its plane, so that bilinear look-ups inside of it are exact for what varies linearly."""
import numpy

MAX_TEXELS = 2048  # along a side of the atlas
MAX_BLOCK = 512


class Corners:
    """What is known at the corners of the triangles of one slot of a mesh, made when it is asked for.

    arrays: geometry.MeshArrays. matrix: world from object, 4 x 4. names: the uv maps, the rendered one first."""

    def __init__(self, arrays, slot, matrix, names, texture_space):
        self._arrays, self._slot, self._matrix, self._names, self._space = arrays, slot, matrix, names, texture_space
        self.triangles = arrays.triangles[arrays.slots == slot]

    def fields(self):
        """{name: triangles x 3 x n}, for evaluate.Evaluator."""
        arrays = self._arrays
        points = arrays.positions[self.triangles].astype(float)
        normals = self._normals(points)
        low, size = self._space
        matrix = self._matrix
        found = {"object": points, "generated": (points - low) / numpy.where(size == 0, 1, size), "normal": normals,
                 "world position": points @ matrix[:3, :3].T + matrix[:3, 3]}
        turned = normals @ numpy.linalg.pinv(matrix[:3, :3])
        found["world normal"] = turned / numpy.maximum(numpy.linalg.norm(turned, axis=2, keepdims=True), 1e-30)
        for name in self._names:
            found["uv:" + name] = arrays.uvs[name][self.triangles].astype(float)
        if self._names:
            found["uv:"] = found["uv:" + self._names[0]]
        for name in arrays.color_names:
            found["color:" + name] = arrays.colors(name)[self.triangles].astype(float)
        if arrays.color_names:
            found["color:"] = arrays.colors("")[self.triangles].astype(float)
        for name in arrays.attribute_names:
            found["attribute:" + name] = arrays.attribute(name, self._slot)
        found["attributes"] = numpy.zeros(points.shape[:2] + (1,))  # says that all of them are known
        return found

    def _normals(self, points):
        if self._arrays.normals is not None:
            return self._arrays.normals[self.triangles].astype(float)
        flat = numpy.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
        flat = flat / numpy.maximum(numpy.linalg.norm(flat, axis=1, keepdims=True), 1e-30)
        return numpy.repeat(flat[:, None, :], 3, axis=1)


def block_side(triangles, side):
    """(texels along a block's side, blocks in a row) for an atlas of at most side x side; (0, 0): the triangles do not fit."""
    row = max(1, int(numpy.ceil(numpy.sqrt(triangles))))
    block = min(MAX_BLOCK, min(side, MAX_TEXELS) // row)
    return (block, row) if block >= 4 else (0, 0)


class Atlas:
    """The layout for a number of triangles. uvs: triangles x 3 x 2, v up; side: texels along a side."""

    def __init__(self, triangles, side):
        self.block, self.row = block_side(triangles, side)
        self.fits = self.block > 0
        if not self.fits:
            return
        self.side = self.block * self.row
        number = numpy.arange(triangles)
        self.corner = numpy.stack((number % self.row, number // self.row), axis=1) * self.block
        local = numpy.array([[0.5, 0.5], [self.block - 1.5, 0.5], [0.5, self.block - 1.5]])
        texels = self.corner[:, None, :] + local[None, :, :]
        self.uvs = (texels / self.side).astype(numpy.float32)
        self.uvs[..., 1] = 1 - self.uvs[..., 1]

    def weights(self):
        """Weights of a triangle's corners at its texels, block * block x 3."""
        y, x = numpy.meshgrid(numpy.arange(self.block), numpy.arange(self.block), indexing="ij")
        b, c = x.ravel() / (self.block - 2), y.ravel() / (self.block - 2)
        return numpy.stack((1 - b - c, b, c), axis=1)

    def inner(self, values):
        """Of the values at all texels, triangles * block^2 x n, those inside of their triangles."""
        inside = self.weights().min(axis=1) > -1e-6
        return values.reshape(len(self.corner), len(inside), -1)[:, inside]

    def points(self, corners):
        """Values at all texels, triangles * block^2 x n, from those at the triangles' corners, triangles x 3 x n."""
        return numpy.einsum("kc,tcn->tkn", self.weights(), corners).reshape(-1, corners.shape[2])

    def image(self, values):
        """side x side x channels from the values at all texels."""
        count = len(self.corner)
        blocks = values.reshape(count, self.block, self.block, -1)
        whole = numpy.zeros((self.row * self.row, self.block, self.block, blocks.shape[3]), dtype=numpy.float32)
        whole[:count] = blocks
        whole = whole.reshape(self.row, self.row, self.block, self.block, -1).swapaxes(1, 2)
        return whole.reshape(self.side, self.side, -1)
