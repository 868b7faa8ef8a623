"""Cases of test_calibration.py: a calibrated OpenCV camera, loaded in Blender, is calibrated back by OpenCV from the images of a board."""
import os

import bpy
import cv2
import mathutils
import numpy
import velo

from inside import FOLDER, add_object, case, material, new_scene

COLUMNS, ROWS, SIDE = 9, 6, 0.03  # inner corners of the board, metres
SIZE = (640, 480)
K = numpy.array([[520.0, 0, 325.3], [0, 518.0, 236.8], [0, 0, 1]])  # velo's; OpenCV has the first pixel's centre at 0, 0
DISTORTION = numpy.array([-0.25, 0.08, 0.001, -0.0015, 0.0])


def board():
    """A chessboard in the plane z = 0 whose first inner corner is the origin, on a white margin."""
    points, faces, slots = [], [], []
    for j in range(-2, ROWS + 1):
        for i in range(-2, COLUMNS + 1):
            first = len(points)
            points += [(SIDE * (i + x), SIDE * (j + y), 0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
            faces.append((first, first + 1, first + 2, first + 3))
            inside = -1 <= i < COLUMNS and -1 <= j < ROWS
            slots.append(1 if inside and (i + j) % 2 == 0 else 0)
    mesh = bpy.data.meshes.new("board")
    mesh.from_pydata(points, [], faces)
    for gray in (0.9, 0.03):
        mesh.materials.append(material("ShaderNodeBsdfDiffuse", Color=(gray, gray, gray))[0])
    mesh.polygons.foreach_set("material_index", slots)
    return mesh


def poses(count):
    """Cameras that see the board from all sides, some in each corner of the image."""
    rng = numpy.random.default_rng(2)
    middle = SIDE * numpy.array([(COLUMNS - 1) / 2, (ROWS - 1) / 2, 0])
    for number in range(count):
        around, up = 2 * numpy.pi * number / count, 0.5 + 0.5 * rng.random()
        eye = middle + 0.34 * numpy.array([numpy.cos(around) * numpy.cos(up), numpy.sin(around) * numpy.cos(up), numpy.sin(up)])
        look = middle + 0.05 * rng.uniform(-1, 1, 3) * (1, 1, 0)
        yield velo.Camera(*SIZE, K=K.tolist(), eye=eye.tolist(), lookat=look.tolist(), up=(rng.uniform(-0.3, 0.3), 1, 0.2))


def seen_corners(scene, camera):
    """The corners in the image that velo renders in Blender for a pose; None: the board was not found."""
    from velo_blender.camera import FLIP
    scene.camera.matrix_world = mathutils.Matrix((numpy.asarray(camera.world_from_camera) @ FLIP).tolist())
    bpy.ops.render.render(write_still=True)
    image = cv2.imread(scene.render.filepath, cv2.IMREAD_GRAYSCALE)
    assert image.shape == SIZE[::-1], image.shape
    found, corners = cv2.findChessboardCorners(image, (COLUMNS, ROWS))
    return cv2.cornerSubPix(image, corners, (5, 5), (-1, -1), (3, 50, 1e-4)) if found else None


@case
def an_opencv_camera_is_calibrated_back():
    scene = new_scene(world=(1, 1, 1), samples=32)
    path = os.path.join(FOLDER, "camera.yaml")
    velo.Camera(*SIZE, K=K.tolist(), distortion="opencv", distortion_coefficients=DISTORTION.tolist()).write(path, dialect="opencv")
    add_object(scene, "board", board())
    scene.camera.data.velo.file = path
    bpy.ops.velo.load_camera()
    scene.view_settings.view_transform, scene.render.filepath = "Standard", os.path.join(FOLDER, "board.png")
    scene.render.image_settings.file_format = "PNG"
    grid = numpy.zeros((COLUMNS * ROWS, 3), numpy.float32)
    grid[:, :2] = SIDE * numpy.mgrid[0:COLUMNS, 0:ROWS].T.reshape(-1, 2)
    corners = [found for found in (seen_corners(scene, camera) for camera in poses(20)) if found is not None]
    assert len(corners) >= 10, len(corners)
    rms, matrix, distortion, _, _ = cv2.calibrateCamera([grid] * len(corners), corners, SIZE, None, None, flags=cv2.CALIB_FIX_K3)
    expected = K - ((0, 0, 0.5), (0, 0, 0.5), (0, 0, 0))
    off = abs(matrix - expected)[[0, 1, 0, 1], [0, 1, 2, 2]]
    y, x = numpy.mgrid[20:480:40, 20:640:40]
    pixels = numpy.stack((x, y), axis=2).reshape(-1, 1, 2).astype(numpy.float64)
    rays = cv2.undistortPoints(pixels, expected, DISTORTION)
    back, _ = cv2.projectPoints(cv2.convertPointsToHomogeneous(rays), numpy.zeros(3), numpy.zeros(3), matrix, distortion)
    error = numpy.linalg.norm((back - pixels).reshape(-1, 2), axis=1)
    print("\n%d boards: rms %.4f px, fx fy cx cy off by %s px, pixels off by %.4f in the mean, %.4f at most"
          % (len(corners), rms, numpy.round(off, 3), error.mean(), error.max()))
    assert rms < 0.05 and off.max() < 0.5 and error.max() < 0.3, (rms, off, error.max())
