#!/usr/bin/python3
"""Camera files of other tools, each written here by hand for cameras whose numbers are known: what velo projects through
each file is compared with the tool's published equations, written a second time below, and with OpenCV's own functions
where it has them. Then every file is damaged in many ways: one line on stderr with the file's name, exit code 3, no crash.
Every camera is also converted to dialects that hold it, and read back."""
import json
import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

VELO = os.environ.get("VELO") or "build/release/bin/velo"
try:
    import cv2
    import numpy
except ImportError:
    cv2 = None

# camera from world, exact in decimals; quaternion w x y z = 0.8 0.2 -0.4 -0.4
R = [[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]]
T = [1.0, 2.0, 3.0]
C = [-0.2, -3.6, -1.0]  # the camera's centre
RT = [[R[j][i] for j in range(3)] for i in range(3)]  # world from camera
IDENTITY = [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
FX, FY, CX, CY = 500.0, 510.0, 315.25, 245.5  # the first pixel's centre is (0, 0)
RADTAN = [-0.2, 0.05, 0.001, -0.002]
FULL = [0.1, -0.05, 0.001, -0.002, 0.01, 0.12, -0.03, 0.004]
FISHEYE = [0.02, -0.01, 0.003, -0.0004]


def rows(m, last=None):
    """A 4 x 4 matrix in one list of 16."""
    t = last if last else [0.0, 0.0, 0.0]
    return [x for i in range(3) for x in m[i] + [t[i]]] + [0.0, 0.0, 0.0, 1.0]


def join(values, separator=", "):
    return separator.join(repr(float(v)) for v in values)


def by_columns(m, n):
    return [m[n * j + i] for i in range(n) for j in range(n)]


FROM_CAMERA = join(rows(RT, C))  # world (body) from camera
FROM_WORLD = join(rows(R, T))


# ---- the equations, from the camera's space to the lens's plane ----

def radial(x, y, factor):
    return x * factor, y * factor


def opencv(k):
    k = list(k) + [0.0] * (8 - len(k))

    def plane(X, Y, Z):
        x, y = X / Z, Y / Z
        r = x * x + y * y
        f = (1 + k[0] * r + k[1] * r**2 + k[4] * r**3) / (1 + k[5] * r + k[6] * r**2 + k[7] * r**3)
        return (x * f + 2 * k[2] * x * y + k[3] * (r + 2 * x * x), y * f + k[2] * (r + 2 * y * y) + 2 * k[3] * x * y)
    return plane


def fisheye(k):
    def plane(X, Y, Z):
        a, r = math.atan2(math.hypot(X, Y), Z), math.hypot(X, Y)
        d = a * (1 + k[0] * a**2 + k[1] * a**4 + k[2] * a**6 + k[3] * a**8)
        return (X * d / r, Y * d / r) if r else (0.0, 0.0)
    return plane


def fov(w):
    def plane(X, Y, Z):
        r = math.hypot(X, Y) / Z
        f = math.atan(2 * r * math.tan(w / 2)) / (w * r) if r else 1.0
        return radial(X / Z, Y / Z, f)
    return plane


def unified(xi, k):
    bend = opencv(k)

    def plane(X, Y, Z):
        d = math.sqrt(X * X + Y * Y + Z * Z)
        return bend(X, Y, Z + xi * d)
    return plane


def eucm(alpha, beta):
    def plane(X, Y, Z):
        d = alpha * math.sqrt(beta * (X * X + Y * Y) + Z * Z) + (1 - alpha) * Z
        return X / d, Y / d
    return plane


def double_sphere(xi, alpha):
    def plane(X, Y, Z):
        d1 = math.sqrt(X * X + Y * Y + Z * Z)
        z = xi * d1 + Z
        d = alpha * math.sqrt(X * X + Y * Y + z * z) + (1 - alpha) * z
        return X / d, Y / d
    return plane


def metashape(k1, k2, k3, k4, p1, p2):
    def plane(X, Y, Z):
        x, y = X / Z, Y / Z
        r = x * x + y * y
        f = 1 + k1 * r + k2 * r**2 + k3 * r**3 + k4 * r**4
        return x * f + p1 * (r + 2 * x * x) + 2 * p2 * x * y, y * f + p2 * (r + 2 * y * y) + 2 * p1 * x * y
    return plane


PINHOLE = opencv([0.0])


class Case:
    """A file and what it means. origin: what its (cx, cy) count from the first pixel's centre. size: 640 x 480."""

    def __init__(self, name, files, dialect, plane, options=(), pose=(R, T), k=(FX, FY, CX, CY), frame=None, judge=None,
                 skew=0.0, path=None, damage=True, size=(640, 480), targets=None):
        self.name, self.dialect, self.plane, self.options, self.pose, self.k = name, dialect, plane, list(options), pose, k
        self.files = files if isinstance(files, dict) else {name: files}
        self.path = path or next(iter(self.files))
        self.frame, self.judge, self.skew, self.damage = frame, judge, skew, damage
        self.size, self.targets = size, targets  # the dialects that it is written to; None: some of SUFFIXES


AT_ORIGIN = (IDENTITY, [0.0, 0.0, 0.0])
SIZE = ["--size", "640x480"]
QUATERNION = "0.8 0.2 -0.4 -0.4"


def png(width, height):
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sIIBBBBB", 13, b"IHDR", width, height, 8, 2, 0, 0, 0) + b"\0" * 16


def jpeg(width, height):
    return (b"\xff\xd8\xff\xe0\x00\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0" +
            b"\xff\xc0\x00\x11\x08" + struct.pack(">HH", height, width) + b"\x03" + b"\0" * 40)


def colmap_bin():
    cameras = struct.pack("<QIiQQ", 2, 7, 1, 640, 480) + struct.pack("<4d", 400, 400, 320, 240)
    cameras += struct.pack("<IiQQ", 9, 4, 640, 480) + struct.pack("<8d", FX, FY, CX + 0.5, CY + 0.5, *RADTAN)
    images = struct.pack("<QI", 2, 1) + struct.pack("<7d", 1, 0, 0, 0, 0, 0, 0) + struct.pack("<I", 7) + b"a.jpg\0"
    images += struct.pack("<Q", 2) + struct.pack("<ddqddq", 1, 2, 3, 4, 5, -1)
    images += struct.pack("<I", 2) + struct.pack("<7d", 0.8, 0.2, -0.4, -0.4, *T) + struct.pack("<I", 9)
    images += b"b c.jpg\0" + struct.pack("<Q", 0)
    return {"cameras.bin": cameras, "images.bin": images}


def matrix(name, r, c, data):
    return "%s: !!opencv-matrix\n   rows: %d\n   cols: %d\n   dt: d\n   data: [ %s ]\n" % (name, r, c, join(data))


def xml_matrix(name, r, c, data):
    return ('<%s type_id="opencv-matrix">\n  <rows>%d</rows>\n  <cols>%d</cols>\n  <dt>d</dt>\n  <data>\n    %s</data></%s>\n'
            % (name, r, c, join(data, " "), name))


K9 = [FX, 0, CX, 0, FY, CY, 0, 0, 1]
GL = [[RT[i][0], -RT[i][1], -RT[i][2]] for i in range(3)]  # y up, z back
ANGLE_X = 2 * math.atan(320 / FX)
SYNTHETIC = json.dumps({"camera_angle_x": ANGLE_X, "frames": [
    {"file_path": "./train/r_0", "rotation": 0.01, "transform_matrix": [GL[i] + [C[i]] for i in range(3)] + [[0, 0, 0, 1]]}]},
    indent=1)
CENTRED = (FX, FX, 319.5, 239.5)


def basalt(kind, extra):
    return json.dumps({"value0": {
        "T_imu_cam": [dict(px=0, py=0, pz=0, qx=0, qy=0, qz=0, qw=1),
                      dict(px=C[0], py=C[1], pz=C[2], qx=-0.2, qy=0.4, qz=0.4, qw=0.8)],
        "intrinsics": [{"camera_type": "pinhole", "intrinsics": dict(fx=1, fy=1, cx=2, cy=2)},
                       {"camera_type": kind, "intrinsics": dict(dict(fx=FX, fy=FY, cx=CX, cy=CY), **extra)}],
        "resolution": [[640, 480], [640, 480]], "calib_accel_bias": [0.0] * 9}}, indent=2)


def camodocal(kind, lens, plane, mirror=""):
    return ("%%YAML:1.0\n---\nmodel_type: %s\ncamera_name: camera\nimage_width: 640\nimage_height: 480\n%s%s"
            "projection_parameters:\n%s" % (kind, mirror, lens, plane))


PARAMETERS = "   fx: 500.\n   fy: 510.\n   cx: 315.25\n   cy: 245.5\n"
DISTORTION = "distortion_parameters:\n   k1: -0.2\n   k2: 0.05\n   p1: 0.001\n   p2: -0.002\n"


def kalibr(model, intrinsics, lens, k, pose="", more=""):
    return ("cam0:\n  cam_overlaps: [1]\n  camera_model: %s\n  distortion_coeffs: [%s]\n  distortion_model: %s\n"
            "  intrinsics: [%s]\n  resolution: [640, 480]\n  rostopic: /cam0/image_raw\n%s%s"
            % (model, join(k), lens, join(intrinsics), pose, more))


T_CAM_IMU = "  T_cam_imu:\n" + "".join("  - [%s]\n" % join(rows(R, T)[i:i + 4]) for i in (0, 4, 8, 12)) + \
    "  timeshift_cam_imu: 0.01\n"


def metashape_xml(calibration, version="1.5.0", transform="", kind="frame"):
    return """<?xml version="1.0" encoding="UTF-8"?>
<document version="%s">
  <chunk label="Chunk 1" enabled="1">
    <sensors next_id="2">
      <sensor id="0" label="other" type="frame">
        <resolution width="64" height="48"/>
        <calibration type="frame" class="initial">
          <resolution width="64" height="48"/>
          <f>80</f>
        </calibration>
      </sensor>
      <sensor id="1" label="unknown" type="%s">
        <resolution width="640" height="480"/>
        <property name="layer_index" value="0"/>
        <calibration type="%s" class="initial">
          <resolution width="640" height="480"/>
          <f>600</f>
        </calibration>
        <calibration type="%s" class="adjusted">
          <resolution width="640" height="480"/>
%s        </calibration>
      </sensor>
    </sensors>
    <cameras next_id="3" next_group_id="1">
      <camera id="0" sensor_id="0" label="not aligned"/>
      <group id="0" label="Group" type="folder">
        <camera id="1" sensor_id="1" label="IMG_1.JPG">
          <transform>%s</transform>
          <orientation>1</orientation>
        </camera>
      </group>
    </cameras>
%s  </chunk>
</document>
""" % (version, kind, kind, kind, "".join("          <%s>%r</%s>\n" % (a, b, a) for a, b in calibration),
       join(rows(RT, C), " "), transform)


def meshroom(version, intrinsic):
    base = {"intrinsicId": "77", "width": "640", "height": "480", "serialNumber": "x", "initializationMode": "unknown"}
    base.update(intrinsic)
    return json.dumps({
        "version": version, "featuresFolders": [""],
        "views": [{"viewId": "5", "poseId": "5", "intrinsicId": "77", "path": "/data/without_pose.jpg", "width": "640",
                   "height": "480"},
                  {"viewId": "6", "poseId": "6", "intrinsicId": "77", "path": "/data/b.jpg", "width": "640",
                   "height": "480"}],
        "intrinsics": [base],
        "poses": [{"poseId": "6", "pose": {"transform": {
            "rotation": [repr(R[i][j]) for j in range(3) for i in range(3)], "center": [repr(c) for c in C]},
            "locked": "1"}}]}, indent=4)


AXIS = None  # rotation vector of R


def rotation_vector():
    angle = 2 * math.acos(0.8)
    s = math.sin(angle / 2)
    return [0.2 * angle / s, -0.4 * angle / s, -0.4 * angle / s]


def opensfm(camera):
    return json.dumps([{"cameras": {"v2 cam 640 480": camera},
                        "shots": {"1.jpg": {"rotation": rotation_vector(), "translation": T, "camera": "v2 cam 640 480",
                                            "gps_dop": 15.0}}, "points": {"0": {"coordinates": [1, 2, 3]}}}], indent=2)


BROWN = {"projection_type": "brown", "width": 640, "height": 480, "focal_x": FX / 640, "focal_y": FY / 640,
         "c_x": (CX - 319.5) / 640, "c_y": (CY - 239.5) / 640, "k1": -0.2, "k2": 0.05, "p1": 0.001, "p2": -0.002,
         "k3": 0.01}

INI = """# oST version 5.0 parameters


[image]

width
640

height
480

[narrow_stereo]

camera matrix
500.0 0.0 315.25
0.0 510.0 245.5
0.0 0.0 1.0

distortion
-0.2 0.05 0.001 -0.002 0.01

rectification
1.0 0.0 0.0
0.0 1.0 0.0
0.0 0.0 1.0

projection
480.0 0.0 300.0 0.0
0.0 480.0 240.0 0.0
0.0 0.0 1.0 0.0
"""

ORB = "%%YAML:1.0\n\n#------\n# Camera Parameters\n#------\n%sCamera.fps: 30.0\nCamera.RGB: 1\nORBextractor.nFeatures: 1000\n"
ORB_OLD = ORB % ("Camera.fx: 500.0\nCamera.fy: 510.0\nCamera.cx: 315.25\nCamera.cy: 245.5\n\nCamera.k1: -0.2\n"
                 "Camera.k2: 0.05\nCamera.p1: 0.001\nCamera.p2: -0.002\nCamera.k3: 0.01\n")
ORB_OLD += "Viewer.PointSize:2\n"  # as in ORB-SLAM 2's own files: no blank after the colon
P_VALUES = [500.0, 0, 315.25, 500.0 * T[0] + 315.25 * T[2], 0, 510.0, 245.5, 510.0 * T[1] + 245.5 * T[2], 0, 0, 1, T[2]]
KITTI_RAW = ("calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\nS_00: 640 480\nK_00: %s\nD_00: 0 0 0 0 0\n"
             "R_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\nS_rect_00: 600 400\nP_rect_00: %s\nS_01: 640 480\nK_01: %s\nD_01: %s\n"
             "R_01: %s\nT_01: %s\nS_rect_01: 600 400\n" %
             (join(K9, " "), join(P_VALUES, " "), join(K9, " "), join(RADTAN + [0.01], " "), join(sum(R, []), " "),
              join(T, " ")))
VISP = """<?xml version="1.0"?>
<root>
  <!--This file stores intrinsic camera parameters used
   in the vpCameraParameters Class of ViSP. -->
  <camera>
    <!--Name of the camera-->
    <name>Camera</name>
    <image_width>640</image_width>
    <image_height>480</image_height>
    <!--Intrinsic camera parameters computed for each projection model-->
    <model>
      <type>perspectiveProjWithoutDistortion</type>
      <px>500</px>
      <py>510</py>
      <u0>315.25</u0>
      <v0>245.5</v0>
    </model>
    <model>
      <type>perspectiveProjWithDistortion</type>
      <px>500</px>
      <py>510</py>
      <u0>315.25</u0>
      <v0>245.5</v0>
      <kud>-0.1</kud>
      <kdu>0.11</kdu>
    </model>
    <model>
      <type>ProjWithKannalaBrandtDistortion</type>
      <px>500</px>
      <py>510</py>
      <u0>315.25</u0>
      <v0>245.5</v0>
      <k1>0.02</k1>
      <k2>-0.01</k2>
      <k3>0.003</k3>
      <k4>-0.0004</k4>
      <k5>0</k5>
    </model>
  </camera>
</root>
"""
NCAMERA = """label: "Euroc"
id: 412eab8e4058621f7036b5e765dfe812
cameras:
- camera:
    label: cam0
    id: 54812562fa109c40fe90b29a59dd7798
    line-delay-nanoseconds: 0
    image_height: 480
    image_width: 640
    type: %s
    intrinsics:
      cols: 1
      rows: %d
      data: [%s]
    distortion:
      type: %s
      parameters:
        cols: 1
        rows: %d
        data: [%s]
  T_B_C:
    cols: 4
    rows: 4
    data: [%s]
  serial_no: 0
"""


def ncamera(kind, f, lens, k):
    return NCAMERA % (kind, len(f), join(f), lens, len(k), join(k), FROM_CAMERA)


F4 = [FX, FY, CX, CY]
FIVE = RADTAN + [0.01]
O3D = {"class_name": "PinholeCameraParameters", "extrinsic": by_columns(rows(R, T), 4),
       "intrinsic": {"height": 480, "intrinsic_matrix": by_columns(K9, 3), "width": 640}, "version_major": 1,
       "version_minor": 0}
RAD = dict(plane=opencv(RADTAN), judge=("opencv", RADTAN))
RAD5 = dict(plane=opencv(FIVE), judge=("opencv", FIVE))
FISH = dict(plane=fisheye(FISHEYE), judge=("fisheye", FISHEYE))
PLAIN = dict(plane=PINHOLE, judge=("opencv", [0.0] * 4))

MIDDLEBURY = ("cam0=[%r 0 %r; 0 %r %r; 0 0 1]\ncam1=[%r 0 %r; 0 %r %r; 0 0 1]\ndoffs=3\nbaseline=536.62\nwidth=640\nheight=480\n"
              "ndisp=170\nisint=0\nvmin=55\nvmax=142\ndyavg=0\ndymax=0\n" % (FX, CX, FY, CY, FX, CX + 3, FX, CY))
MVSNET = "extrinsic\n%s\n0.0 0.0 0.0 1.0\n\nintrinsic\n%r 0 %r\n0 %r %r\n0 0 1\n\n425.0 2.5 192 933.8\n" % (
    "\n".join(join(R[i] + [T[i]], " ") for i in range(3)), FX, CX, FY, CY)
BUNDLER = "# Bundle file v0.3\n3 1\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n%r -0.2 0.05\n%s\n%s\n400 0 0\n1 0 0\n0 -1 0\n0 0 -1\n0 0 0\n" \
          "1 2 3\n255 0 0\n1 0 5 1.5 2.5\n" % (FX, "\n".join(join([s * v for v in R[i]], " ") for i, s in enumerate((1, -1, -1))),
                                             join([T[0], -T[1], -T[2]], " "))


def openmvg(kind, distortion, nested=False):
    def lens(extra, focal=FX):
        size, rest = {"width": 640, "height": 480}, dict(focal_length=focal, principal_point=[CX + 0.5, CY + 0.5])
        return dict({"value0": dict({"value0": size}, **rest)}, **extra) if nested else dict(size, **rest, **extra)

    def view(key, pose, name):
        return {"key": key, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2147483649 + key, "data": dict(
            local_path="/", filename=name, width=640, height=480, id_view=key, id_intrinsic=1, id_pose=pose)}}}
    return json.dumps({
        "sfm_data_version": "0.3", "root_path": "/x", "views": [view(0, 4294967295, "a.jpg"), view(1, 5, "b.jpg")],
        "intrinsics": [{"key": 0, "value": {"polymorphic_id": 2147483649, "polymorphic_name": kind,
                                            "ptr_wrapper": {"id": 2147483660, "data": lens(distortion, 9.0)}}},
                       {"key": 1, "value": {"polymorphic_id": 1, "ptr_wrapper": {"id": 2147483661, "data": lens(distortion)}}}],
        "extrinsics": [{"key": 4, "value": {"rotation": IDENTITY, "center": T}}, {"key": 5, "value": {"rotation": R, "center": C}}],
        "structure": [], "control_points": []}, indent=1)


CASES = [
    # COLMAP's binary model
    Case("colmap_bin", colmap_bin(), "colmap", frame="b c.jpg", path=".", damage=False, **RAD),
    Case("colmap_bin_images", colmap_bin(), "colmap", frame="1", path="images.bin", damage=False, **RAD),
    Case("colmap_project", {"sparse/0/" + k: v for k, v in colmap_bin().items()}, "colmap", frame="1", path=".",
         damage=False, **RAD),
    # NeRF's synthetic scenes
    Case("transforms_train.json", {"transforms_train.json": SYNTHETIC, "train/r_0.png": png(640, 480)}, "nerf",
         k=CENTRED, **PLAIN),
    Case("transforms_jpeg.json", {"transforms_jpeg.json": SYNTHETIC, "train/r_0.jpg": jpeg(640, 480)}, "nerf",
         k=CENTRED, **PLAIN),
    Case("transforms_size.json", SYNTHETIC, "nerf", options=SIZE, k=CENTRED, **PLAIN),
    # EuRoC
    Case("sensor.yaml", "%%YAML:1.0\n# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor cam0 (MT9M034)\n\n"
         "T_BS:\n  cols: 4\n  rows: 4\n  data: [%s]\n\nrate_hz: 20\nresolution: [640, 480]\ncamera_model: pinhole\n"
         "intrinsics: [500., 510., 315.25, 245.5] #fu, fv, cu, cv\ndistortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.2, 0.05, 0.001, -0.002]\n" % FROM_CAMERA, "euroc", **RAD),
    # Kalibr
    Case("camchain_imu.yaml", kalibr("pinhole", F4, "radtan", RADTAN, T_CAM_IMU), "kalibr", **RAD),
    Case("camchain_chain.yaml", kalibr("pinhole", F4, "radtan", [0.0] * 4, "", "cam1:\n  T_cn_cnm1:\n" + "".join(
        "  - [%s]\n" % join(rows(R, T)[i:i + 4]) for i in (0, 4, 8, 12)) + kalibr(
            "pinhole", F4, "equidistant", FISHEYE)[6:]), "kalibr", frame="cam1", **FISH),
    Case("camchain_two.yaml", kalibr("pinhole", F4, "radtan", RADTAN, T_CAM_IMU.replace("0.36", "0.36")) + kalibr(
        "ds", [-0.2, 0.6] + F4, "none", [], T_CAM_IMU).replace("cam0:", "cam1:", 1), "kalibr", frame="cam1",
        plane=double_sphere(-0.2, 0.6)),
    Case("camchain_omni.yaml", kalibr("omni", [0.9] + F4, "radtan", RADTAN, T_CAM_IMU), "kalibr",
         plane=unified(0.9, RADTAN)),
    # OpenCV
    Case("intrinsics.yml", "%YAML:1.0\n---\n" + matrix("M1", 3, 3, K9) + matrix("D1", 1, 5, FIVE) +
         matrix("M2", 3, 3, K9) + matrix("D2", 1, 5, [0.0] * 5), "opencv", options=SIZE, pose=AT_ORIGIN, **RAD5),
    Case("stereo.yml", "%YAML:1.0\n---\n" + matrix("M1", 3, 3, [9, 0, 9, 0, 9, 9, 0, 0, 1]) + matrix("D1", 1, 5, [0.0] * 5) +
         matrix("M2", 3, 3, K9) + matrix("D2", 1, 5, FIVE) + matrix("R", 3, 3, sum(R, [])) + matrix("T", 3, 1, T),
         "opencv", options=SIZE, frame="right", **RAD5),
    Case("legacy.yml", "%YAML:1.0\ncalibration_Time: \"Tue\"\nnrOfFrames: 9\nimage_Width: 640\nimage_Height: 480\n"
         "board_Width: 9\n" + matrix("Camera_Matrix", 3, 3, K9) + matrix("Distortion_Coefficients", 5, 1, FIVE) +
         "Avg_Reprojection_Error: 0.3\n", "opencv", pose=AT_ORIGIN, **RAD5),
    Case("calibration.xml", '<?xml version="1.0"?>\n<opencv_storage>\n<calibration_time>"Tue Mar  5"</calibration_time>\n'
         "<image_width>640</image_width>\n<image_height>480</image_height>\n<flags>0</flags>\n" +
         xml_matrix("camera_matrix", 3, 3, K9) + xml_matrix("distortion_coefficients", 5, 1, FIVE) +
         "<avg_reprojection_error>2.8e-01</avg_reprojection_error>\n</opencv_storage>\n", "opencv", pose=AT_ORIGIN, **RAD5),
    Case("nested.yaml", "camera_matrix:\n- - 500.0\n  - 0.0\n  - 315.25\n- - 0.0\n  - 510.0\n  - 245.5\n- - 0.0\n  - 0.0\n"
         "  - 1.0\ndist_coeff:\n- - -0.2\n  - 0.05\n  - 0.001\n  - -0.002\n  - 0.01\n", "opencv", options=SIZE,
         pose=AT_ORIGIN, **RAD5),
    Case("nested.json", json.dumps({"mtx": [K9[:3], K9[3:6], K9[6:]], "dist": [FIVE], "image_size": [640, 480]}), "opencv",
         pose=AT_ORIGIN, **RAD5),
    Case("omnidir.yml", "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n" + matrix("camera_matrix", 3, 3, K9) +
         matrix("distortion_coefficients", 1, 4, RADTAN) + "xi: 0.9\n", "opencv", pose=AT_ORIGIN,
         plane=unified(0.9, RADTAN)),
    Case("anchors.yaml", "defaults: &base\n  unused: 1\nk: &k [500., 0, 315.25, 0, 510., 245.5, 0, 0, 1]\nimage_width: 640\n"
         "image_height: 480\nmore: {<<: *base, own: 2}\ncamera_matrix: *k\ndistortion_coefficients: [0, 0, 0, 0]\n",
         "opencv", pose=AT_ORIGIN, **PLAIN),
    # camodocal, VINS
    Case("pinhole.yaml", camodocal("PINHOLE", DISTORTION, PARAMETERS), "camodocal", pose=AT_ORIGIN, **RAD),
    Case("mei.yaml", camodocal("MEI", DISTORTION, "   gamma1: 500.\n   gamma2: 510.\n   u0: 315.25\n   v0: 245.5\n",
                               "mirror_parameters:\n   xi: 1.9\n"), "camodocal", pose=AT_ORIGIN, plane=unified(1.9, RADTAN)),
    Case("kb.yaml", camodocal("KANNALA_BRANDT", "", "   k2: 0.02\n   k3: -0.01\n   k4: 0.003\n   k5: -0.0004\n   mu: 500.\n"
                              "   mv: 510.\n   u0: 315.25\n   v0: 245.5\n"), "camodocal", pose=AT_ORIGIN, **FISH),
    Case("full.yaml", camodocal("PINHOLE_FULL", "distortion_parameters:\n" + "".join(
        "   %s: %r\n" % (n, v) for n, v in zip("k1 k2 p1 p2 k3 k4 k5 k6".split(), FULL)), PARAMETERS), "camodocal",
        pose=AT_ORIGIN, plane=opencv(FULL), judge=("opencv", FULL)),
    Case("vins_mono.yaml", "%YAML:1.0\n\n#common parameters\nimu_topic: \"/imu0\"\n" +
         camodocal("PINHOLE", DISTORTION, PARAMETERS)[14:] + matrix("extrinsicRotation", 3, 3, sum(RT, [])) +
         matrix("extrinsicTranslation", 3, 1, C), "camodocal", **RAD),
    Case("vins_fusion.yaml", {"vins_fusion.yaml": "%YAML:1.0\n\nnum_of_cam: 2\ncam0_calib: \"cam0_pinhole.yaml\"\n"
                              "cam1_calib: \"cam0_pinhole.yaml\"\nimage_width: 640\n" +
                              matrix("body_T_cam0", 4, 4, rows(IDENTITY)) + matrix("body_T_cam1", 4, 4, rows(RT, C)),
                              "cam0_pinhole.yaml": camodocal("PINHOLE", DISTORTION, PARAMETERS)}, "camodocal", frame="1",
         **RAD),
    # Basalt
    Case("basalt_kb4.json", basalt("kb4", dict(zip("k1 k2 k3 k4".split(), FISHEYE))), "basalt", frame="1", **FISH),
    Case("basalt_ds.json", basalt("ds", dict(xi=-0.2, alpha=0.6)), "basalt", frame="1", plane=double_sphere(-0.2, 0.6)),
    Case("basalt_eucm.json", basalt("eucm", dict(alpha=0.6, beta=1.1)), "basalt", frame="1", plane=eucm(0.6, 1.1)),
    Case("basalt_ucm.json", basalt("ucm", dict(alpha=0.6)), "basalt", frame="1", plane=eucm(0.6, 1.0)),
    Case("basalt_radtan8.json", basalt("pinhole-radtan8", dict(zip("k1 k2 p1 p2 k3 k4 k5 k6".split(), FULL), rpmax=0.0)),
         "basalt", frame="1", plane=opencv(FULL), judge=("opencv", FULL)),
    # ORB-SLAM
    Case("TUM1.yaml", ORB_OLD, "orbslam", options=SIZE, pose=AT_ORIGIN, **RAD5),
    Case("orb3.yaml", ORB % ('File.version: "1.0"\nCamera.type: "KannalaBrandt8"\nCamera1.fx: 1.0\nCamera1.fy: 1.0\n'
                             "Camera1.cx: 2.0\nCamera1.cy: 2.0\nCamera1.k1: 0.0\nCamera1.k2: 0.0\nCamera1.k3: 0.0\n"
                             "Camera1.k4: 0.0\nCamera2.fx: 500.0\nCamera2.fy: 510.0\nCamera2.cx: 315.25\nCamera2.cy: 245.5\n"
                             "Camera2.k1: 0.02\nCamera2.k2: -0.01\nCamera2.k3: 0.003\nCamera2.k4: -0.0004\n"
                             "Camera.width: 640\nCamera.height: 480\n" + matrix("Stereo.T_c1_c2", 4, 4, rows(RT, C))),
         "orbslam", frame="1", **FISH),
    # OKVIS
    Case("okvis.yaml", "%%YAML:1.0\ncameras:\n     - {T_SC:\n        [%s],\n        image_dimension: [640, 480],\n"
         "        distortion_coefficients: [-0.2, 0.05, 0.001, -0.002],\n        distortion_type: radialtangential,\n"
         "        focal_length: [500., 510.],\n        principal_point: [315.25, 245.5]}\n\ncamera_params:\n"
         "    camera_rate: 20\n" % FROM_CAMERA, "okvis", **RAD),
    # SVO
    Case("svo_pinhole.yaml", "cam_model: Pinhole\ncam_width: 640\ncam_height: 480\ncam_fx: 500\ncam_fy: 510\ncam_cx: 315.25\n"
         "cam_cy: 245.5\ncam_d0: -0.2\ncam_d1: 0.05\ncam_d2: 0.001\ncam_d3: -0.002\n", "svo", pose=AT_ORIGIN, **RAD),
    Case("svo_atan.yaml", "cam_model: ATAN\ncam_width: 640\ncam_height: 480\ncam_fx: %r\ncam_fy: %r\ncam_cx: %r\ncam_cy: %r\n"
         "cam_d0: 0.9\n" % (FX / 640, FY / 480, (CX + 0.5) / 640, (CY + 0.5) / 480), "svo", pose=AT_ORIGIN, plane=fov(0.9)),
    Case("svo_rig.yaml", ncamera("pinhole", F4, "equidistant", FISHEYE), "svo", **FISH),
    Case("svo_omni.yaml", ncamera("omni", [0.9] + F4, "radial-tangential", RADTAN), "svo", plane=unified(0.9, RADTAN)),
    # ROS
    Case("ost.ini", INI, "ros", pose=AT_ORIGIN, **RAD5),
    # KITTI
    Case("calib.txt", "P0: %s\nP1: %s\nTr: 1 0 0 0 0 1 0 0 0 0 1 0\n" % (join(K9[:3] + [0] + K9[3:6] + [0] + K9[6:] + [0], " "),
                                                                  join(P_VALUES, " ")), "kitti", options=SIZE, frame="P1",
         pose=(IDENTITY, T), **PLAIN),
    Case("000007.txt", {"000007.txt": "P0: %s\nR0_rect: 1 0 0 0 1 0 0 0 1\n" % join(P_VALUES, " "),
                        "image_0/000000.png": png(640, 480)}, "kitti", pose=(IDENTITY, T), **PLAIN),
    Case("calib_cam_to_cam.txt", KITTI_RAW, "kitti", frame="01", **RAD5),
    # BOP
    Case("scene_camera.json", json.dumps({"3": {"cam_K": K9, "depth_scale": 1.0}, "0": {
        "cam_K": K9, "cam_R_w2c": sum(R, []), "cam_t_w2c": T, "depth_scale": 0.1}}), "bop", options=SIZE, frame="0", **PLAIN),
    Case("scene_images.json", {"scene_images.json": json.dumps({"12": {"cam_K": K9, "cam_R_w2c": sum(R, []), "cam_t_w2c": T}}),
                               "rgb/000012.png": png(640, 480)}, "bop", **PLAIN),
    Case("camera.json", json.dumps(dict(cx=CX, cy=CY, depth_scale=0.1, fx=FX, fy=FY, height=480, width=640)), "bop",
         pose=AT_ORIGIN, **PLAIN),
    # 3D Gaussian splatting
    Case("cameras.json", json.dumps([{"id": 0, "img_name": "a", "width": 64, "height": 48, "position": [0, 0, 0],
                                      "rotation": IDENTITY, "fy": 9, "fx": 9},
                                     {"id": 1, "img_name": "00001", "width": 640, "height": 480, "position": C,
                                      "rotation": RT, "fy": FY, "fx": FX}]), "gaussians", frame="00001",
         k=(FX, FY, 319.5, 239.5), **PLAIN),
    # Metashape
    Case("metashape.xml", metashape_xml([("f", FY), ("cx", CX + 0.5 - 320), ("cy", CY + 0.5 - 240), ("b1", FX - FY), ("b2", 0.7),
                                         ("k1", -0.2), ("k2", 0.05), ("k3", 0.01), ("k4", -0.003), ("p1", -0.002),
                                         ("p2", 0.001)]), "metashape", skew=0.7,
         plane=metashape(-0.2, 0.05, 0.01, -0.003, -0.002, 0.001)),
    Case("metashape_k3.xml", metashape_xml([("f", FY), ("cx", CX + 0.5 - 320), ("cy", CY + 0.5 - 240), ("b1", FX - FY),
                                            ("k1", -0.2), ("k2", 0.05), ("k3", 0.01), ("p1", -0.002), ("p2", 0.001)]),
         "metashape", **RAD5),
    Case("photoscan.xml", metashape_xml([("fx", FX), ("fy", FY), ("cx", CX + 0.5), ("cy", CY + 0.5), ("k1", -0.2),
                                         ("k2", 0.05)], "1.0.0"), "metashape", plane=opencv([-0.2, 0.05, 0, 0]),
         judge=("opencv", [-0.2, 0.05, 0.0, 0.0])),
    Case("fisheye.xml", metashape_xml([("f", FX), ("cx", CX + 0.5 - 320), ("cy", CY + 0.5 - 240), ("k1", 0.02), ("k2", -0.01),
                                       ("k3", 0.003), ("k4", -0.0004)], kind="fisheye"), "metashape", k=(FX, FX, CX, CY),
         **FISH),
    Case("agisoft_calibration.xml", '<?xml version="1.0" encoding="UTF-8"?>\n<calibration>\n  <projection>frame</projection>\n'
         "  <width>640</width>\n  <height>480</height>\n  <f>500</f>\n  <cx>-4.25</cx>\n  <cy>6</cy>\n  <k1>-0.2</k1>\n"
         "  <k2>0.05</k2>\n  <date>2019-01-01T00:00:00Z</date>\n</calibration>\n", "metashape", pose=AT_ORIGIN,
         k=(FX, FX, CX, CY), plane=opencv([-0.2, 0.05, 0, 0])),
    # Meshroom
    Case("cameras.sfm", meshroom(["1", "2", "8"], {
        "sensorWidth": "36", "sensorHeight": "27", "type": "pinhole", "focalLength": repr(FX * 36 / 640),
        "pixelRatio": repr(FY / FX), "principalPoint": [repr(CX + 0.5 - 320), repr(CY + 0.5 - 240)],
        "distortionType": "radialk3", "distortionParams": ["-0.2", "0.05", "0.01"]}), "meshroom",
        plane=opencv([-0.2, 0.05, 0, 0, 0.01]), judge=("opencv", [-0.2, 0.05, 0.0, 0.0, 0.01])),
    Case("sfm_old.json", meshroom(["1", "0", "0"], {
        "type": "brown", "pxFocalLength": repr(FX), "principalPoint": [repr(CX + 0.5), repr(CY + 0.5)],
        "distortionParams": ["-0.2", "0.05", "0.01", "0.001", "-0.002"]}), "meshroom", k=(FX, FX, CX, CY), **RAD5),
    # OpenSfM
    Case("reconstruction.json", opensfm(BROWN), "opensfm", **RAD5),
    Case("perspective.json", opensfm({"projection_type": "perspective", "width": 640, "height": 480, "focal": FX / 640,
                                      "k1": -0.2, "k2": 0.05}), "opensfm", k=CENTRED, plane=opencv([-0.2, 0.05, 0, 0])),
    Case("camera_models.json", json.dumps({"v2 x": dict(BROWN)}), "opensfm", pose=AT_ORIGIN, **RAD5),
    # Open3D
    Case("open3d.json", json.dumps(O3D), "open3d", **PLAIN),
    Case("open3d_trajectory.json", json.dumps({"class_name": "PinholeCameraTrajectory", "parameters": [
        dict(O3D, extrinsic=rows(IDENTITY)), O3D], "version_major": 1, "version_minor": 0}), "open3d", frame="1", **PLAIN),
    Case("open3d_intrinsic.json", json.dumps(O3D["intrinsic"]), "open3d", pose=AT_ORIGIN, **PLAIN),
    # ViSP
    Case("visp.xml", VISP, "visp", pose=AT_ORIGIN, **PLAIN),
    Case("visp_bent.xml", VISP, "visp", frame="1", pose=AT_ORIGIN, plane=opencv([-0.1]), judge=("opencv", [-0.1, 0, 0, 0])),
    Case("visp_fisheye.xml", VISP, "visp", frame="2", pose=AT_ORIGIN, **FISH),
    # Middlebury's stereo: camera 1 stands at x = baseline
    Case("calib.txt", MIDDLEBURY, "middlebury", pose=AT_ORIGIN, **PLAIN),
    Case("calib_right.txt", MIDDLEBURY, "middlebury", frame="cam1", pose=(IDENTITY, [-536.62, 0, 0]), k=(FX, FX, CX + 3, CY),
         plane=PINHOLE),
    Case("old/calib.txt", {"old/calib.txt": MIDDLEBURY.split("width")[0], "old/im0.png": png(640, 480)}, "middlebury",
         pose=AT_ORIGIN, **PLAIN),
    # MVSNet: with --size, and with the image
    Case("00000007_cam.txt", MVSNET, "mvsnet", options=SIZE, **PLAIN),
    Case("cams/00000007_cam.txt", {"cams/00000007_cam.txt": MVSNET, "images/00000007.jpg": jpeg(640, 480)}, "mvsnet", **PLAIN),
    *(Case("cams/%d_cam.txt" % i, {"cams/%d_cam.txt" % i: MVSNET, image % i: data}, "mvsnet", targets=["velo"], damage=False, **PLAIN)
      for i, (image, data) in enumerate([("images/%d.png", png(640, 480)), ("blended_images/%d.jpg", jpeg(640, 480)),
                                         ("blended_images/%d.png", png(640, 480))])),
    # Bundler: the first camera was not reconstructed
    Case("bundle.out", BUNDLER, "bundler", options=SIZE, k=(FX, FX, 320 - 0.5, 240 - 0.5), plane=opencv([-0.2, 0.05])),
    Case("bundle_named.out", BUNDLER, "bundler", options=SIZE, frame="2", pose=AT_ORIGIN, k=(400, 400, 319.5, 239.5),
         plane=PINHOLE),
    # OpenMVG: the first view has no pose; the second intrinsic names its class by number; base classes as older versions do
    Case("sfm_data.json", openmvg("pinhole_brown_t2", {"disto_t2": [-0.2, 0.05, 0.01, 0.001, -0.002]}), "openmvg",
         k=(FX, FX, CX, CY), **RAD5),
    Case("sfm_radial.json", openmvg("pinhole_radial_k3", {"disto_k3": [-0.2, 0.05, 0.01]}, nested=True), "openmvg",
         k=(FX, FX, CX, CY), plane=opencv([-0.2, 0.05, 0, 0, 0.01])),
    Case("sfm_fisheye.json", openmvg("fisheye", {"fisheye": FISHEYE}), "openmvg", k=(FX, FX, CX, CY), plane=fisheye(FISHEYE)),
    # USD: a neighbour moves
    Case("stage.usda", "#usda 1.0\n( metersPerUnit = 1 )\ndef Xform \"mover\" {\n  double3 xformOp:translate.timeSamples = { 1: (0, 0, 0),"
         " 2: (1, 0, 0) }\n  uniform token[] xformOpOrder = [\"xformOp:translate\"]\n}\ndef Camera \"main\" {\n"
         "  float focalLength = 0.28125\n  float horizontalAperture = 0.36\n  float verticalAperture = 0.27\n  matrix4d "
         "xformOp:transform = ( (1, 0, 0, 0), (0, -1, 0, 0), (0, 0, -1, 0), (0, 0, 0, 1) )\n"
         "  uniform token[] xformOpOrder = [\"xformOp:transform\"]\n}\n", "usd", options=SIZE, pose=AT_ORIGIN, k=CENTRED,
         **PLAIN),
]


def run(*arguments):
    done = subprocess.run([VELO, "camera"] + list(arguments), stdin=subprocess.DEVNULL, capture_output=True, timeout=60)
    return done.returncode, done.stdout.decode("utf-8", "replace"), done.stderr.decode("utf-8", "replace")


failures = 0


def result(good, name, why=""):
    global failures
    failures += not good
    print("%s %s" % ("ok" if good else "not ok", name))
    if not good:
        print("  | " + str(why)[:600].replace("\n", "\n  | "))


def write(folder, files):
    for name, content in files.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as file:
            file.write(content if isinstance(content, bytes) else content.encode())


def points_of(pose, count=60):
    """Points of the world before the camera, within 30 degrees."""
    generator = random.Random(7)
    r, t = pose
    points = []
    for _ in range(count):
        z = generator.uniform(1, 9)
        c = [z * generator.uniform(-0.5, 0.5) - t[0], z * generator.uniform(-0.4, 0.4) - t[1], z - t[2]]
        points.append([sum(r[i][k] * c[i] for i in range(3)) for k in range(3)])
    return points


def wanted(case, point):
    r, t = case.pose
    c = [sum(r[i][k] * point[k] for k in range(3)) + t[i] for i in range(3)]
    x, y = case.plane(*c)
    return case.k[0] * x + case.skew * y + case.k[2], case.k[1] * y + case.k[3]


def projected(path, points, work, options):
    with open(os.path.join(work, "points.csv"), "w", encoding="utf-8") as file:
        file.write("".join("%r,%r,%r\n" % tuple(p) for p in points))
    code, out, err = run("project", "--camera", path, "--pixel-origin", "center", *options,
                         os.path.join(work, "points.csv"))
    if code != 0:
        return None, err
    return [[float(x) for x in line.split(",")] for line in out.splitlines()[1:]], err


def options_of(case):
    return case.options + (["--frame", case.frame] if case.frame is not None else [])


def compare(case, folder, work):
    path = os.path.join(folder, case.path)
    code, out, err = run("info", "--json", path, *options_of(case))
    if code != 0:
        return err
    info = json.loads(out)
    if (info["dialect"], info["width"], info["height"]) != (case.dialect, *case.size):
        return "%s %d x %d" % (info["dialect"], info["width"], info["height"])
    points = points_of(case.pose)
    pixels, err = projected(path, points, work, options_of(case))
    if pixels is None:
        return err
    worst = 0.0
    for point, pixel in zip(points, pixels):
        want = wanted(case, point)
        if not pixel[3]:
            return "not valid: %s" % point
        worst = max(worst, abs(pixel[0] - want[0]), abs(pixel[1] - want[1]))
    if not worst < 1e-8:
        return "off by %g pixels; %s" % (worst, out)
    if cv2 and case.judge:
        kind, k = case.judge
        r, t = case.pose
        vector = cv2.Rodrigues(numpy.array(r))[0]
        k3 = numpy.array([[case.k[0], 0, case.k[2]], [0, case.k[1], case.k[3]], [0, 0, 1.0]])
        judge = cv2.fisheye.projectPoints if kind == "fisheye" else cv2.projectPoints
        shape = (-1, 1, 3)
        seen = judge(numpy.array(points).reshape(shape), vector, numpy.array(t), k3, numpy.array(k))[0].reshape(-1, 2)
        off = float(numpy.abs(seen - numpy.array(pixels)[:, :2]).max())
        if not off < 1e-8:
            return "OpenCV is off by %g pixels" % off
    return None


def check_damage(case, folder, work):
    """Lines left out, values replaced, the file cut: never a crash, never two lines; a place in the file."""
    generator = random.Random(case.name)
    path = os.path.join(folder, case.path)
    text = case.files[case.path]
    if isinstance(text, bytes):
        return None
    lines = text.split("\n")
    numbers = [m.span() for m in re.finditer(r"(?<![\w.])-?\d+\.?\d*(?![\w.])", text)]
    variants = ["\n".join(lines[:i] + lines[i + 1:]) for i in generator.sample(range(len(lines)), min(4, len(lines)))]
    variants += [text[:a] + word + text[b:] for a, b in generator.sample(numbers, min(2, len(numbers)))
                 for word in ("nan", "\"x\"", "-1e999")]
    variants += [text[:generator.randrange(len(text))] for _ in range(3)]
    placed = total = 0
    for variant in variants:
        with open(path, "w", encoding="utf-8") as file:
            file.write(variant)
        code, _, err = run("info", path, *options_of(case))
        if code not in (0, 2, 3, 4):
            return "exit code %d: %s\n%s" % (code, err, variant)
        if code == 0:
            continue
        said = [line for line in err.splitlines() if not line.startswith("velo: note") and "warning" not in line]
        if len(said) != 1:
            return "%s\n%s" % (err, variant)
        total += 1
        placed += bool(re.search(r":\d+:\d+: ", said[0]))
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return None if placed * 2 >= total else "only %d of %d errors have a place" % (placed, total)


SUFFIXES = {"velo": ".json", "opencv": ".yaml", "ros": ".yaml", "nerf": ".json", "kalibr": ".yaml", "euroc": ".yaml",
            "camodocal": ".yaml", "basalt": ".json", "orbslam": ".yaml", "okvis": ".yaml", "svo": ".yaml", "kitti": ".txt",
            "bop": ".json", "gaussians": ".json", "metashape": ".xml", "meshroom": ".sfm", "opensfm": ".json",
            "open3d": ".json", "visp": ".xml", "middlebury": ".txt", "mvsnet": "_cam.txt", "bundler": ".out", "openmvg": ".json",
            "colmap": ""}
SIZELESS = ("mvsnet", "bundler", "realitycapture", "visualsfm", "collada", "threejs", "matrix")


def some_targets(case):
    """The case's own dialect, velo, and four others, which differ from case to case."""
    others = [d for d in SUFFIXES if d not in ("velo", case.dialect)]
    first = 4 * CASES.index(case)
    return ["velo", case.dialect] * (case.dialect in SUFFIXES) + [others[(first + i) % len(others)] for i in range(4)]


def check_written(case, folder, work, written, suffixes=SUFFIXES):
    """To dialects that take it, and back: the same pixels."""
    path = os.path.join(folder, case.path)
    points = points_of(case.pose, 12)
    want, _ = projected(path, points, work, options_of(case))
    extra = [("opencv", "copy.xml"), ("ros", "copy.ini"), ("colmap", "bin/cameras.bin")]
    targets = [d for d in case.targets if d in suffixes] if case.targets else some_targets(case)
    extra = [] if case.targets or case.dialect not in ("opencv", "ros", "colmap") else extra
    for dialect, name in [(d, "copy_%s%s" % (d, suffixes[d])) for d in targets] + extra:
        copy = os.path.join(work, case.name + "_" + name if "/" not in name else name)
        os.makedirs(os.path.dirname(copy), exist_ok=True)
        code, _, err = run("convert", path, copy, "--to", dialect, *options_of(case))
        if code == 3:
            continue  # the dialect cannot hold it, and says so
        if code != 0:
            return "%s: %d %s" % (dialect, code, err)
        back, err = projected(copy, points, work, ["--size", "%dx%d" % case.size] if dialect in SIZELESS else [])
        if back is None:
            return "%s: %s" % (dialect, err)
        if max(abs(a - b) for p, q in zip(want, back) for a, b in zip(p[:2], q[:2])) > 1e-7:
            return "%s changes the pixels" % dialect
        written[name if (dialect, name) in extra else dialect] = written.get(dialect, 0) + 1
    return None


def main(cases=None, suffixes=SUFFIXES, extra=("copy.xml", "copy.ini", "bin/cameras.bin")):
    only_skipped = os.environ.get("VELO_ONLY_SKIPPED") is not None  # the rest does not need OpenCV
    with tempfile.TemporaryDirectory() as work:
        written = {}
        for case in cases or CASES:
            folder = os.path.join(work, "files_" + case.name)
            write(folder, case.files)
            why = compare(case, folder, work)
            result(why is None, "reads " + case.name, why)
            if only_skipped:
                continue
            if why is None:
                why = check_written(case, folder, work, written, suffixes)
                result(why is None, "writes what it read of " + case.name, why)
            if case.damage:
                why = check_damage(case, folder, work)
                result(why is None, "survives a damaged " + case.name, why)
        for name in [] if only_skipped else list(suffixes) + list(extra):
            result(written.get(name, 0) > 0, "some camera is written as " + name)
        if not cv2:
            print("skip opencv's own functions: python3-opencv is not installed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
