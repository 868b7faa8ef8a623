#!/usr/bin/python3
"""As test_tools.py, for the dialects of scanners, datasets, devices and content tools: the numbers of each file are
written by hand from the tool's published equations."""
import io
import json
import math
import os
import struct
import sys
import tempfile
import zipfile

from test_tools import (AT_ORIGIN, C, CENTRED, CX, CY, FISH, FISHEYE, FIVE, FULL, FX, FY, GL, IDENTITY, K9, PLAIN,
                        QUATERNION, R, RAD, RAD5, RADTAN, RT, SIZE, T, Case, by_columns, fov, join, jpeg, main, opencv, png, radial,
                        result, rotation_vector, rows, run, write)

SUFFIXES = {"velo": ".json", "realitycapture": ".xmp", "nerfstudio": ".json", "visualsfm": ".nvm", "collada": ".dae", "dso": ".txt",
                 "polycam": ".json", "realsense": ".json", "panoptic": ".json", "nerfies": ".json", "threejs": ".json", "colmap": "",
                 "matrix": ".txt"}


def measured(r):
    """VisualSFM: the ray is (1 + r m^2) m, solved for m."""
    def plane(X, Y, Z):
        u = math.hypot(X, Y) / Z
        m = u
        for _ in range(50):
            m -= (m + r * m**3 - u) / (1 + 3 * r * m * m)
        return radial(X / Z, Y / Z, m / u if u else 1.0)
    return plane


def degrees(tangent):
    return 2 * math.degrees(math.atan(tangent))


def xmp(model, k):
    return """<x:xmpmeta xmlns:x="adobe:ns:meta/">
  <rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
    <rdf:Description xcr:Version="3" xcr:PosePrior="initial" xcr:Coordinates="absolute"
       xcr:DistortionModel="%s" xcr:FocalLength35mm="%r" xcr:Skew="0" xcr:AspectRatio="1"
       xcr:PrincipalPointU="%r" xcr:PrincipalPointV="%r" xcr:InTexturing="1"
       xmlns:xcr="http://www.capturingreality.com/ns/xcr/1.1#">
      <xcr:Rotation>%s</xcr:Rotation>
      <xcr:Position>%s</xcr:Position>
      <xcr:DistortionCoeficients>%s</xcr:DistortionCoeficients>
    </rdf:Description>
  </rdf:RDF>
</x:xmpmeta>
""" % (model, FX * 36 / 640, (CX + 0.5 - 320) / 640, (CY + 0.5 - 240) / 640, join(sum(R, []), " "), join(C, " "), join(k, " "))


# Rz(-heading) Rx(pitch) Ry(roll) has the columns right, up, back
PITCH = math.degrees(math.asin(GL[2][1]))
ROLL = math.degrees(math.atan2(-GL[2][0], GL[2][2]))
HEADING = -math.degrees(math.atan2(-GL[0][1], GL[1][1]))
REALITY_CSV = ("#cameras 3\n#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n"
               "east.jpg,1,2,3,90,90,0,%r,0,0,0,0,0,0,0,0\nb.jpg,%s,%r,%r,%r,%r,%r,%r,-0.2,0.05,0.01,0,0.001,-0.002\n"
               % (FX * 36 / 640, join(C, ","), HEADING, PITCH, ROLL, FX * 36 / 640, (CX + 0.5 - 320) / 640,
                  (CY + 0.5 - 240) / 640))
EAST = ([[0, -1.0, 0], [0, 0, -1.0], [1.0, 0, 0]], [2.0, 3.0, -1.0])  # x south, y down, z east; at (1, 2, 3)
CAMERA_PATH = json.dumps({"keyframes": [], "camera_type": "perspective", "render_height": 480, "render_width": 640, "fps": 24,
                          "seconds": 4, "camera_path": [
                              {"camera_to_world": rows(IDENTITY), "fov": 50, "aspect": 1},
                              {"camera_to_world": rows(GL, C), "fov": degrees(240 / FX), "aspect": 4 / 3}]}, indent=1)
NVM = 'NVM_V3%s\n\n2\n"a b.jpg"\t400 1 0 0 0 0 0 0 0 0\nb.jpg\t%r %s %s %r 0\n\n1\n1 2 3 255 0 0 1 0 5 1.5 2.5\n\n0\n'
ZED = """[LEFT_CAM_HD]
fx=700
fy=700
cx=640
cy=360
k1=0
k2=0

[RIGHT_CAM_HD]
fx=500
fy=510
cx=315.25
cy=245.5
k1=-0.2
k2=0.05
p1=0.001
p2=-0.002
k3=0.01

[STEREO]
Baseline=-1
TY=-2
TZ=-3
CV_HD=%r
RX_HD=%r
RZ_HD=%r
""" % tuple(rotation_vector()[i] for i in (1, 0, 2))
DAE = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><up_axis>Z_UP</up_axis></asset>
  <library_cameras>
    <camera id="lens" name="Lens">
      <optics><technique_common>
        <perspective>
          <xfov sid="xfov">%r</xfov>
          %s
          <znear sid="znear">0.1</znear>
          <zfar sid="zfar">1000</zfar>
        </perspective>
      </technique_common></optics>
    </camera>
  </library_cameras>
  <library_visual_scenes>
    <visual_scene id="Scene">
      <node id="lamp"/>
      <node id="turned" name="turned">
        <translate>0 0 5</translate>
        <rotate>0 1 0 180</rotate>
        <instance_camera url="#lens"/>
      </node>
      <node id="parent">
        <translate>%s</translate>
        <node id="Camera" name="Camera">
          <matrix sid="transform">%s</matrix>
          <instance_camera url="#lens"/>
        </node>
      </node>
      <node id="eye" name="eye">
        <lookat>1 2 3  1 2 0  0 1 0</lookat>
        <instance_camera url="#lens"/>
      </node>
    </visual_scene>
  </library_visual_scenes>
</COLLADA>
""" % (degrees(320 / FX), "%s", join(C, " "), join(rows(GL), " "))


def npy(values, count):
    header = "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }" % count
    header += " " * (117 - len(header)) + "\n"
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header.encode() + struct.pack("<%dd" % len(values), *values)


def npz(compression=zipfile.ZIP_STORED, **arrays):
    """As np.savez: an array for each name, of (dtype, shape, numbers)."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", compression) as archive:
        for name, (kind, shape, values) in arrays.items():
            header = "{'descr': '<%s', 'fortran_order': %s, 'shape': %r, }" % (kind.strip("F"), "F" in kind, shape)
            header += " " * (117 - len(header)) + "\n"
            letter = {"f8": "d", "f4": "f", "i8": "q"}[kind.strip("F")]
            with archive.open(name + ".npy", "w", force_zip64=True) as member:  # as NumPy does
                member.write(b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header.encode() +
                             struct.pack("<%d%s" % (len(values), letter), *values))
    return out.getvalue()


def damaged(archive):
    """With another digit in the first number of the first array."""
    at = archive.index(struct.pack("<d", K9[0]))
    return archive[:at + 6] + bytes([archive[at + 6] ^ 1]) + archive[at + 7:]


MTX = ("f8", (3, 3), K9)
DIST = ("f8", (1, 5), FIVE)
BY_COLUMNS = ("f8F", (3, 3), by_columns(K9, 3))
BOARDS = ("f8", (100, 3, 1), [0.5] * 300)


def llff(r, c):
    """down, right, back, centre, (height, width, focal length); near and far depth"""
    hwf = [480.0, 640.0, FX]
    return [x for i in range(3) for x in (r[i][1], r[i][0], -r[i][2], c[i], hwf[i])] + [0.1, 9.0]


K_CORNER = [FX, 0, CX + 0.5, 0, FY, CY + 0.5, 0, 0, 1]
POLYCAM = dict({"t_%d%d" % (i, j): (GL[i] + [C[i]])[j] for i in range(3) for j in range(4)}, fx=FX, fy=FY, cx=CX + 0.5,
               cy=CY + 0.5, width=640, height=480, blur_score=99.5, timestamp=1234)
ORDER = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"]


def oak(k, kind, extrinsics):
    return {"cameraType": kind, "distortionCoeff": list(k) + [0.0] * (14 - len(k)), "extrinsics": extrinsics, "width": 640,
            "height": 480, "intrinsicMatrix": [K9[:3], K9[3:6], K9[6:]], "lensPosition": 0, "specHfovDeg": 71.8}


def socket(to, r, t):
    return {"rotationMatrix": r, "toCameraSocket": to, "translation": dict(zip("xyz", t))}


OAK = json.dumps({"boardName": "OAK-D", "version": 6, "cameraData": [
    [1, oak(FISHEYE, 1, socket(-1, IDENTITY, [0, 0, 0]))], [0, oak(FULL, 0, socket(1, RT, C))],
    [3, dict(oak([], 0, {}), width=0)]]}, indent=1)
KINECT = json.dumps({"CalibrationInformation": {"Cameras": [
    {"Location": "CALIBRATION_CameraLocation" + name, "Intrinsics": {
        "ModelParameterCount": 14, "ModelType": "CALIBRATION_LensDistortionModelBrownConrady", "ModelParameters":
            [(CX + 0.5) / 640, (CY + 0.5) / 480, FX / 640, FY / 480, FULL[0], FULL[1], *FULL[4:8], 0, 0, FULL[3], FULL[2]]},
     "Rt": {"Rotation": sum(r, []), "Translation": t}, "SensorWidth": 640, "SensorHeight": 480}
    for name, r, t in (("D0", IDENTITY, [0, 0, 0]), ("PV0", R, T))]}}, indent=1)
REALSENSE = dict(width=640, height=480, fx=FX, fy=FY, ppx=CX, ppy=CY)
CALIBIO = json.dumps({"Calibration": {"cameras": [{"model": {
    "polymorphic_id": 2147483649, "polymorphic_name": "libCalib::CameraModelOpenCV", "ptr_wrapper": {"valid": 1, "data": {
        "parameters": dict({a: {"val": b, "state": 2} for a, b in zip(ORDER, FULL)}, f={"val": FX}, ar={"val": FY / FX},
                           cx={"val": CX}, cy={"val": CY}),
        "CameraModelCRT": {"CameraModelBase": {"imageSize": {"width": 640, "height": 480}}}}}},
    "transform": {"rotation": dict(zip(("rx", "ry", "rz"), rotation_vector())), "translation": dict(zip("xyz", T))}}]}}, indent=1)
NUSCENES = json.dumps([
    {"token": "lidar", "sensor_token": "a", "translation": [0, 0, 0], "rotation": [1, 0, 0, 0], "camera_intrinsic": []},
    {"token": "front", "sensor_token": "b", "translation": C, "rotation": [0.8, -0.2, 0.4, 0.4],
     "camera_intrinsic": [K9[:3], K9[3:6], K9[6:]]}], indent=1)
PANOPTIC = json.dumps({"calibDataSource": "x", "cameras": [
    {"name": "01_01", "type": "vga", "resolution": [64, 48], "K": IDENTITY, "distCoef": [0] * 5, "R": IDENTITY, "t": [[0]] * 3},
    {"name": "00_03", "type": "hd", "resolution": [640, 480], "panel": 0, "node": 3, "K": [K9[:3], K9[3:6], K9[6:]],
     "distCoef": FIVE, "R": R, "t": [[v] for v in T]}]}, indent=1)
NERFIES = json.dumps({"orientation": R, "position": C, "focal_length": FX, "principal_point": [CX + 0.5, CY + 0.5], "skew": 0.0,
                      "pixel_aspect_ratio": FY / FX, "radial_distortion": [-0.2, 0.05, 0.01],
                      "tangential_distortion": [0.001, -0.002], "image_size": [640, 480]}, indent=1)
THREEJS = json.dumps({"metadata": {"version": 4.6, "type": "Object"}, "object": {
    "uuid": "x", "type": "PerspectiveCamera", "name": "main", "fov": degrees(120 / FX), "zoom": 0.5, "near": 0.1, "far": 2000,
    "focus": 10, "aspect": 4 / 3, "filmGauge": 35, "matrix": by_columns(rows(GL, C), 4)}}, indent=1)
P_MATRIX = "\n".join(join([-2 * v for v in P], " ") for P in (
    [[sum(K9[3 * i + k] * (R[k] + [T[k]])[j] for k in range(3)) for j in range(4)] for i in range(3)]))
ROWS3 = "\n".join(join(K9[i:i + 3], " ") for i in (0, 3, 6)) + "\n"
SCANNET = {"pose/7.txt": "\n".join(join(rows(RT, C)[i:i + 4], " ") for i in (0, 4, 8, 12)) + "\n",
           "intrinsic/intrinsic_color.txt": "500 0 315.25 0\n0 510 245.5 0\n0 0 1 0\n0 0 0 1\n", "color/7.jpg": jpeg(640, 480)}


# Project Aria, "Camera Intrinsic Models": k0 to k5, p0 p1, s0 to s3
F624 = [0.4, -0.5, 0.35, -0.15, 0.03, -0.002, 0.003, -0.004, 0.002, 0.001, -0.003, 0.002]


def fisheye624(X, Y, Z):
    k, p, s = F624[:6], F624[6:8], F624[8:]
    theta, across = math.atan2(math.hypot(X, Y), Z), math.hypot(X, Y)
    r = theta + sum(k[i] * theta ** (2 * i + 3) for i in range(6))
    u, v = (X / across * r, Y / across * r) if across else (0.0, 0.0)
    return (u + p[0] * (2 * u * u + r * r) + 2 * p[1] * u * v + s[0] * r**2 + s[1] * r**4,
            v + p[1] * (2 * v * v + r * r) + 2 * p[0] * u * v + s[2] * r**2 + s[3] * r**4)


def aria(label, name, parameters, quaternion, translation):
    return {"Label": label, "SerialNumber": "", "Calibrated": True, "Projection": {"Name": name, "Params": parameters},
            "T_Device_Camera": {"Translation": translation, "UnitQuaternion": [quaternion[0], quaternion[1:]]}}


ARIA_CAMERAS = [aria("camera-slam-left", "FisheyeRadTanThinPrism", [240, 320, 240] + [0] * 12, [1, 0, 0, 0], [0, 0, 0]),
                aria("camera-et-left", "KannalaBrandtK3", [FX, FY, CX, CY] + FISHEYE, [0.8, -0.2, 0.4, 0.4], C),
                aria("camera-rgb", "FisheyeRadTanThinPrism", [FX, CX, CY] + F624, [0.8, -0.2, 0.4, 0.4], C)]
ARIA = json.dumps({"CameraCalibrations": ARIA_CAMERAS, "DeviceClassInfo": {"BuildVersion": "DVT-S", "DeviceClass": "Aria"}}, indent=1)
ARIA_ONLINE = json.dumps({"tracking_timestamp_us": 1357695322, "utc_timestamp_ns": 1669844355099598323,
                          "ImageSizes": [[640, 480]] * 3, "CameraCalibrations": ARIA_CAMERAS})


def own(dialect, *other):
    return dict(targets=[dialect, "velo", *other])


CASES = [
    # ROS 2 prints messages with lower-case names and a line after them; OpenVINS has Kalibr's pose the other way round
    Case("ros2.yaml", "header:\n  frame_id: camera\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nd:\n" +
         "".join("- %r\n" % v for v in FIVE) + "k:\n" + "".join("- %r\n" % float(v) for v in K9) +
         "r: [1, 0, 0, 0, 1, 0, 0, 0, 1]\np: [500, 0, 315.25, 0, 0, 510, 245.5, 0, 0, 0, 1, 0]\nbinning_x: 0\n---\n", "ros",
         pose=AT_ORIGIN, **RAD5, **own("x"), damage=False),
    Case("openvins.yaml", "%%YAML:1.0\n\ncam0:\n  T_imu_cam: #rotation from camera to IMU\n%s  camera_model: pinhole\n"
         "  distortion_coeffs: [%s]\n  distortion_model: radtan\n  intrinsics: [%s] #fu, fv, cu, cv\n"
         "  resolution: [640, 480]\n" % ("".join("    - [%s]\n" % join(rows(RT, C)[i:i + 4]) for i in (0, 4, 8, 12)),
                                         join(RADTAN), join([FX, FY, CX, CY])), "kalibr", **RAD, **own("x"), damage=False),
    # RealityCapture
    Case("IMG_1.xmp", {"IMG_1.xmp": xmp("brown3t2", [-0.2, 0.05, 0.01, 0, 0.001, -0.002]), "IMG_1.png": png(640, 480)},
         "realitycapture", k=(FX, FX, CX, CY), **RAD5, **own("realitycapture")),
    Case("plain.xmp", xmp("perspective", [0.0] * 6), "realitycapture", options=SIZE, k=(FX, FX, CX, CY), **PLAIN,
         **own("realitycapture", "visualsfm")),
    Case("export.csv", REALITY_CSV, "realitycapture", options=SIZE, frame="b.jpg", k=(FX, FX, CX, CY), **RAD5, **own("x")),
    Case("east.csv", REALITY_CSV, "realitycapture", options=SIZE, pose=EAST, k=CENTRED, **PLAIN, **own("nerfstudio"),
         damage=False),
    Case("camera_path.json", CAMERA_PATH, "nerfstudio", frame="1", k=CENTRED, **PLAIN, **own("nerfstudio", "threejs")),
    Case("model.nvm", NVM % ("", FX, QUATERNION, join(C, " "), 0.04), "visualsfm", options=SIZE, frame="b.jpg", k=CENTRED,
         plane=measured(0.04), **own("x")),
    Case("fixed.nvm", NVM % (" FixedK %r %r %r %r" % (FX, CX + 0.5, FY, CY + 0.5), 1, QUATERNION, join(C, " "), 0),
         "visualsfm", options=SIZE, frame="1", **PLAIN, **own("visualsfm")),
    Case("SN123.conf", ZED, "zed", frame="RIGHT_CAM_HD", size=(1280, 720), **RAD5, **own("x")),
    Case("left.conf", ZED, "zed", size=(1280, 720), pose=AT_ORIGIN, k=(700, 700, 640, 360), **PLAIN, **own("x"), damage=False),
    Case("camera.dae", DAE % "<yfov>%r</yfov>" % degrees(240 / FX), "collada", options=SIZE, frame="Camera", k=CENTRED, **PLAIN,
         **own("collada")),
    Case("turned.dae", DAE % "<aspect_ratio>1.3333333333333333</aspect_ratio>", "collada", options=SIZE,
         pose=([[-1.0, 0, 0], [0, -1.0, 0], [0, 0, 1.0]], [0, 0, -5.0]), k=CENTRED, **PLAIN, **own("collada"), damage=False),
    Case("eye.dae", DAE % "", "collada", options=SIZE, frame="eye",
         pose=([[1.0, 0, 0], [0, -1.0, 0], [0, 0, -1.0]], [-1.0, 2.0, 3.0]), k=CENTRED, **PLAIN, **own("collada"), damage=False),
    Case("camera.txt", "RadTan 500 510 315.25 245.5 -0.2 0.05 0.001 -0.002\n640 480\ncrop\n320 240\n", "dso", pose=AT_ORIGIN,
         **RAD, **own("dso")),
    Case("shares.txt", "%r %r %r %r 0.93\n640 480\nnone\n640 480\n" % (FX / 640, FY / 480, (CX + 0.5) / 640, (CY + 0.5) / 480),
         "dso", pose=AT_ORIGIN, plane=fov(0.93), **own("dso")),
    Case("fisheye.txt", "KannalaBrandt 500 510 315.25 245.5 %s\n640 480\nfull\n640 480\n" % join(FISHEYE, " "), "dso",
         pose=AT_ORIGIN, **FISH, **own("dso", "realsense")),
    Case("poses_bounds.npy", npy(llff(IDENTITY, [0.0] * 3) + llff(RT, C), 2), "llff", frame="1", k=CENTRED, **PLAIN, **own("x")),
    Case("calibration.npz", npz(ret=("f8", (), [0.3]), mtx=MTX, dist=DIST, rvecs=BOARDS, tvecs=BOARDS), "opencv", options=SIZE,
         pose=AT_ORIGIN, **RAD5, **own("opencv")),
    Case("sized.npz", npz(K=BY_COLUMNS, D=("f8", (5, 1), FIVE), image_size=("i8", (2,), [640, 480])), "opencv", pose=AT_ORIGIN,
         **RAD5, **own("x")),
    Case("metadata", json.dumps({"w": 640, "h": 480, "fps": 60, "K": by_columns(K_CORNER, 3), "poses": [
        [0, 0, 0, 1, 0, 0, 0], [0.8, 0.4, -0.4, 0.2, *C]]}, indent=1), "record3d", frame="1", **PLAIN, **own("x")),
    Case("keyframe.json", json.dumps(POLYCAM, indent=1), "polycam", **PLAIN, **own("polycam")),
    Case("frame_00001.json", {"frame_00001.json": json.dumps(dict(cameraPoseARFrame=rows(GL, C), intrinsics=K_CORNER, time=1.5),
                                                             indent=1), "frame_00001.jpg": jpeg(640, 480)}, "scanner3d",
         **PLAIN, **own("x")),
    Case("oak.json", OAK, "depthai", frame="socket0", plane=opencv(FULL), judge=("opencv", FULL), **own("x")),
    Case("oak_fisheye.json", OAK, "depthai", pose=AT_ORIGIN, **FISH, **own("x"), damage=False),
    Case("k4a.json", KINECT, "kinect", frame="PV0", plane=opencv(FULL), judge=("opencv", FULL), **own("x")),
    Case("realsense.json", json.dumps({"depth": dict(REALSENSE, fx=9), "color": dict(
        REALSENSE, model="distortion.brown_conrady", coeffs=FIVE)}, indent=1), "realsense", frame="color", pose=AT_ORIGIN,
        **RAD5, **own("realsense")),
    Case("inverse.json", json.dumps(dict(REALSENSE, model="Inverse Brown Conrady", coeffs=[0.0] * 5)), "realsense",
         pose=AT_ORIGIN, **PLAIN, **own("realsense")),
    Case("calibio.json", CALIBIO, "calibio", plane=opencv(FULL), judge=("opencv", FULL), **own("x")),
    Case("calibrated_sensor.json", NUSCENES, "nuscenes", options=SIZE, frame="front", **PLAIN, **own("x")),
    Case("calibration_panoptic.json", PANOPTIC, "panoptic", frame="00_03", **RAD5, **own("panoptic")),
    Case("nerfies.json", NERFIES, "nerfies", **RAD5, **own("nerfies")),
    Case("three.json", THREEJS, "threejs", options=SIZE, k=CENTRED, **PLAIN, **own("threejs")),
    Case("K.txt", ROWS3, "matrix", options=SIZE, pose=AT_ORIGIN, **PLAIN, **own("matrix")),
    Case("camera_matrix.csv", ROWS3.replace(" ", ","), "matrix", options=SIZE, pose=AT_ORIGIN, **PLAIN, **own("x"), damage=False),
    *(Case("pose beside " + image, {"pose/frame-17.pose.txt": SCANNET["pose/7.txt"], "camera-intrinsics.txt": ROWS3, image: png(640, 480)},
           "matrix", path="pose/frame-17.pose.txt", targets=["velo"], damage=False, **PLAIN)
      for image in ("pose/frame-17.color.png", "pose/frame-17.png", "color/frame-17.png", "rgb/frame-17.png", "images/frame-17.png",
                    "image/frame-17.png", "color/0.png", "pose/color/0.png", "color/000000.png")),
    Case("scannet", SCANNET, "matrix", path="pose/7.txt", **PLAIN, **own("x")),
    Case("factory.json", ARIA, "aria", options=SIZE, frame="camera-et-left", **FISH, **own("x")),
    Case("online.json", ARIA_ONLINE, "aria", frame="camera-rgb", plane=fisheye624, k=(FX, FX, CX, CY), **own("x", "colmap"), damage=False),
    Case("projection.txt", P_MATRIX, "matrix", options=SIZE, **PLAIN, **own("matrix"), damage=False),
]

KALIBR = """cam0:
  camera_model: pinhole
  distortion_coeffs: [0.1, 0.0, 0.0, 0.0]
  distortion_model: equidistant
  intrinsics: [500, 500, 320, 240]
  resolution: [640, 480]
  line_delay: %s
  T_cam_imu:
  - [%s, 0, 0, 0]
  - [0, 1, 0, 0]
  - [0, 0, %s, 0]
  - [%s, 0, 0, 1]
"""
EUROC = """sensor_type: camera
T_BS:
  cols: 4
  rows: 4
  data: [%s]
resolution: [640, 480]
camera_model: pinhole
intrinsics: [500, 500, 320, 240]
distortion_model: equidistant
distortion_coefficients: [0.1, 0.0, 0.0, 0.0]
"""
ANGLE = '{"w":640,"h":480,"%s":500,"%s":%s,"frames":[{"file_path":"a","transform_matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}'

# broken files: the place and the format in the message, and what it must not blame
BROKEN = [
    ("online_calibration.jsonl", 2 * (ARIA_ONLINE + "\n"), "give one line", "YAML"),
    ("aria_crop.json", ARIA_ONLINE.replace("640, 480", "300, 300", 1), "aria: the axis 320, 240 lies outside", "YAML"),
    ("other.conf", "[main]\na=3\n", "other.conf:1:1: no camera of a known dialect", "JSON"),
    ("bad.conf", "[LEFT_CAM_HD]\nfx=700\nfy=7x0\n", 'bad.conf:3:5: zed: no finite number: "x0"', "JSON"),
    ("poses.txt", "0 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n", "poses.txt:1:1: no camera of a known dialect", "matrix"),
    ("bad.nvm", "NVM_V3\n\n1\na.jpg 500 1 0 x 0 0 0 0 0 0\n", "bad.nvm:4:15: visualsfm: no finite number", "YAML"),
    ("mirror.yaml", KALIBR % (0, -1, 1, 0), "kalibr: the pose is no rotation and translation: it mirrors", "JSON"),
    ("scaled.yaml", KALIBR % (0, 1, 2, 0), "kalibr: the pose is no rotation and translation: its axes have the lengths 1, 1, 0.5", "JSON"),
    ("transposed.yaml", KALIBR % (0, 1, 1, 0.5), "the last row of world_from_camera is -0.5 0 0 1", "JSON"),
    ("delay.yaml", KALIBR % (2e-5, 1, 1, 0), 'delay.yaml:7:15: kalibr: "line_delay" is not understood', "JSON"),
    ("columns.yaml", EUROC % "1,0,0,0,0,1,0,0,0,0,1,0,0.1,0.2,0.3,1", "the last row of world_from_camera is 0.1 0.2 0.3 1", "JSON"),
    ("sheared.yaml", EUROC % "1,0.1,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "euroc: the pose is no rotation and translation: its axes are not", "JSON"),
    ("angle.json", ANGLE % ("fl_x", "camera_angle_x", 0.7), 'angle.json:1:25: nerf: "fl_x" is 500, but "camera_angle_x"', "YAML"),
    ("angle.json", ANGLE.replace('"w"', '"fl_x":500,"w"') % ("fl_y", "camera_angle_y", 0.7), 'nerf: "fl_y" is 500, but "camera_angle_y"', "YAML"),
    ("dji.xmp", '<x:xmpmeta><a drone-dji:CalibratedFocalLength="3666.6"/></x:xmpmeta>', "DJI's data of an image", "dialect"),
    ("micmac.xml", "<ExportAPERO><CalibrationInternConique/></ExportAPERO>", "MicMac's orientation", "dialect"),
    ("calib.txt", "#polynomial coefficients for the DIRECT mapping function\n5 -188\n", "OCamCalib's polynomial", "dialect"),
    ("a.json.gz", b"\x1f\x8b\x08\0\0\0\0\0", "a file packed by gzip", "JSON"),
    ("waymo.json", '{"name":"FRONT","rolling_shutter_direction":"LEFT_TO_RIGHT"}', "Waymo's calibration", "dialect"),
    ("bad.txt", "500 0 320\n0 500 24o\n0 0 1\n", "bad.txt:2:7: matrix: no finite number", "YAML"),
    ("bad.dae", '<COLLADA><library_visual_scenes><visual_scene><node id="a">\n<translate>0 0</translate>'
     '<instance_camera url="#x"/></node></visual_scene></library_visual_scenes>\n<library_cameras><camera id="x"><optics>'
     "<technique_common><perspective><xfov>40</xfov><yfov>30</yfov></perspective></technique_common></optics></camera>"
     "</library_cameras></COLLADA>\n", "bad.dae:2:1: collada: <translate> must hold 3 finite numbers", "JSON"),
    ("bad.csv", "#name,x,y,alt,heading,pitch,roll,f\na.jpg,1,2,3,0,0,no,50\n", 'bad.csv:2:17: realitycapture: "roll" is "no"',
     "YAML"),
    ("four.npz", npz(mtx=MTX, dist=("f8", (4, 1), [0.1, 0, 0, 0])), 'npz: "dist" holds 4 numbers, which may be those of a fisheye',
     "JSON"),
    ("arrays.npz", npz(arr_0=MTX, arr_1=DIST), "npz: the arrays have no names", "JSON"),
    ("packed.npz", npz(zipfile.ZIP_DEFLATED, mtx=MTX, dist=DIST), 'npz: "mtx" is compressed', "JSON"),
    ("other.npz", npz(mtx=MTX, dist=DIST, warp=DIST), 'npz: "warp" is no field of OpenCV\'s cameras', "JSON"),
    ("cut.npz", npz(mtx=MTX, dist=DIST)[:-40], "npz: the archive is cut off", "JSON"),
    ("damaged.npz", damaged(npz(mtx=MTX, dist=DIST)), 'npz: "mtx" is damaged: its CRC is another', "JSON"),
    ("nan.npz", npz(mtx=MTX, dist=("f8", (1, 5), [math.nan] * 5)), 'npz: "dist" must be an array of finite', "JSON"),
]


def check_broken():
    with tempfile.TemporaryDirectory() as work:
        for name, text, wanted, blamed in BROKEN:
            write(work, {name: text})
            code, _, err = run("info", os.path.join(work, name), *SIZE)
            result(code == 3 and wanted in err and blamed not in err, "says where " + name + " is wrong", err)


def check_note():
    """A field that the dialect does not know is named by a note with its line."""
    frame = {"file_path": "a.png", "transform_matrix": rows(GL, C)}
    camera = dict(w=640, h=480, fl_x=500, frames=[frame], scale=3, gain=1, hue=2, tone=3, grain=4)
    with tempfile.TemporaryDirectory() as work:
        write(work, {"a.json": json.dumps(camera)})
        code, _, err = run("info", os.path.join(work, "a.json"))
        wanted = 'a.json:1: not understood and without effect: "scale", "gain", "hue" and 2 more'
        result(code == 0 and wanted in err, "names the fields that are not understood", err)


def check_good():
    """Numbers that are rounded, and files that begin with a byte order mark."""
    rounded = "0.01,-1.0,0.0,0,1.0,0.01,0.03,0,-0.03,0.0,1.0,0,0,0,0,1"
    with tempfile.TemporaryDirectory() as work:
        write(work, {"kalibr.yaml": KALIBR % (0, 1, 1, 0), "euroc.yaml": EUROC % rounded,
                     "angle.json": ANGLE % ("fl_x", "camera_angle_x", 1.1386),
                     "model/cameras.txt": "\ufeff1 PINHOLE 640 480 500 501 320 240\r\n"})
        for name in ("kalibr.yaml", "euroc.yaml", "angle.json", "model"):
            code, _, err = run("info", os.path.join(work, name))
            result(code == 0, "reads " + name, err)


if __name__ == "__main__":
    check_broken()
    check_good()
    check_note()
    sys.exit(main(CASES, SUFFIXES, ()))
