/* camera_files/other_tools.c: files of other programs that hold no camera velo can read: which
 * program a file seems to be from, and what to give instead. */
#include <string.h>

#include "camera_files/formats.h"

#define EXPORT_SCENE "export glTF, USD (.usda) or COLLADA"
#define GIVE_OPENCV "give OpenCV's YAML with camera_matrix"
#define GIVE_MATCHED "export the cameras for COLMAP, Bundler (bundle.out) or nerfstudio"

typedef struct {
  const char *mark, *advice;
} Tool;

/* By the first bytes. */
static const Tool by_beginning[] = {
    {"BLENDER", "Blender's own file; " EXPORT_SCENE},
    {"Kaydara FBX Binary", "an FBX file; " EXPORT_SCENE},
    {"; FBX ", "an FBX file; " EXPORT_SCENE},
    {"Ogawa", "an Alembic file; " EXPORT_SCENE},
    {"//Maya ASCII", "a scene of Maya; " EXPORT_SCENE},
    {"FOR4", "a scene of Maya; " EXPORT_SCENE},
    {"Begin Map", "a scene of Unreal Engine; " EXPORT_SCENE},
    {"Begin Object", "a scene of Unreal Engine; " EXPORT_SCENE},
    {"#VRML", "a VRML scene, as Webots'; " EXPORT_SCENE},
    {"##RenderMan", "a RenderMan scene; " EXPORT_SCENE},
    {"v = ", "a RADIANCE view; velo has no reader for it; write velo's or OpenCV's fields"},
    {"#?RADIANCE", "an image; give the camera's file"},
    {"ply\n", "a mesh or a point cloud, which holds no camera"},
    {"ply\r", "a mesh or a point cloud, which holds no camera"},
    {"solid ", "an STL mesh, which holds no camera"},
    {"# Blender", "an OBJ mesh, which holds no camera"},
    {"MATLAB 5.0 MAT-file", "MATLAB's binary file; " GIVE_OPENCV},
    {"\x89HDF", "an HDF5 file; " GIVE_OPENCV},
    {"\x80\x02", "a Python pickle; " GIVE_OPENCV},
    {"\x80\x03", "a Python pickle; " GIVE_OPENCV},
    {"\x80\x04", "a Python pickle; " GIVE_OPENCV},
    {"\x80\x05", "a Python pickle; " GIVE_OPENCV},
    {"SQLite format 3", "a database, as COLMAP's; give the model's cameras and images"},
    {"#ROSBAG", "a recording of ROS; give the YAML of its camera_info message"},
    {"\x89MCAP", "a recording of ROS 2; give the YAML of its camera_info message"},
    {"\x89PNG", "an image; give the camera's file"},
    {"\xff\xd8\xff", "an image; give the camera's file"},
    {"Adobe After Effects", "key frames of After Effects; " EXPORT_SCENE},
    {"# boujou export", "boujou's tracks; " EXPORT_SCENE},
    {"#! /", "a script, which holds no camera"},
    {"# ptGui project file",
     "a project of PTGui, whose lenses are those of panoramas; " GIVE_OPENCV},
    {"# hugin project file",
     "a project of Hugin, whose lenses are those of panoramas; " GIVE_OPENCV},
    {"#MVE view meta data", "a view of MVE; " GIVE_MATCHED},
    {"fileName imageWidth imageHeight", "parameters of Pix4D; " GIVE_MATCHED},
    {"\x1f\x8b", "a file packed by gzip; unpack it: gunzip"},
    {"PK\x03\x04", "a ZIP archive; unpack it"},
    {"ARROW1", "a table of Apache Arrow, as Argoverse 2's calibration; " GIVE_OPENCV},
    {"#polynomial coefficients for the DIRECT mapping",
     "OCamCalib's polynomial, which is no projection of velo; calibrate it as Kalibr's omni-radtan or "
     "as OpenCV's fisheye"},
    {"PXR-USDC", "USD's binary form; velo reads its text form: usdcat in.usd -o out.usda"},
    {"\x93NUMPY", "a NumPy array, which does not say what its numbers mean"},
};

/* By a text in the first bytes. */
static const Tool by_text[] = {
    {"tag:unity3d.com",
     "a scene of Unity; " EXPORT_SCENE
     ", or give projection_matrix and view_matrix with graphics_api: opengl"},
    {"# PhotoID, X, Y, Z", "Metashape's angles; export the cameras as XML"},
    {"ParGroup:", "parameters of HALCON; " GIVE_OPENCV},
    {"drone-dji:", "DJI's data of an image, without a camera's model; " GIVE_MATCHED},
    {"<ExportAPERO", "MicMac's orientation; " GIVE_MATCHED},
    {"<OrientationConique", "MicMac's orientation; " GIVE_MATCHED},
    {"\"rolling_shutter_direction\"", "Waymo's calibration, as it seems; " GIVE_OPENCV
                                      " of its f_u, f_v, c_u, c_v, k1, k2, p1, p2, k3"},
    {"<BlocksExchange", "a block of ContextCapture; " GIVE_MATCHED},
    {"<sdf", "a model of Gazebo; give the YAML of its camera_info message"},
    {"<robot", "a robot's description (URDF); give the YAML of its camera_info message"},
    {"<mujoco", "a model of MuJoCo; write its fovy as yfov in velo's JSON"},
    {"<cycles", "a scene of Cycles; " EXPORT_SCENE},
    {"camera_data_", "Argoverse's calibration; " GIVE_OPENCV},
    {"\"SettingsVersion\"", "AirSim's settings; give camera_angle_x in a transforms.json"},
    {"\"image_size_x\"",
     "CARLA's attributes of a sensor; give camera_angle_x in a "
     "transforms.json"},
    {"sensor.camera.", "CARLA's sensors; give camera_angle_x in a transforms.json"},
    {"\"CamMatrix\"", "A2D2's calibration; " GIVE_OPENCV},
    {"\"u0\"", "Cityscapes' camera, as it seems; " GIVE_OPENCV " of fx, fy, u0, v0"},
    {"LENSMODEL_", "a camera model of mrcal; " GIVE_OPENCV},
    {"\"radial_poly\"",
     "WoodScape's calibration, whose lens is a polynomial of the angle; " GIVE_OPENCV},
    {"\"nominalSensor2Rig", "a rig of NVIDIA DRIVE, whose lenses are f-theta; " GIVE_OPENCV},
    {"\"cameraViewTransform\"",
     "Omniverse Replicator's camera_params; give projection_matrix and view_matrix with "
     "graphics_api: opengl"},
    {"\"camera_intrinsics_type\"", "Theia's intrinsics; " GIVE_MATCHED},
    {"settings_camera_fov",
     "Hypersim's table of cameras; give camera_angle_x in a transforms.json"},
    {"CAHV", "a CAHV model of JPL; " GIVE_OPENCV},
    {"fx_color", "ScanNet's description of a scene; give intrinsic_color.txt"},
    {"IntrinsicMatrix", "MATLAB's camera parameters; " GIVE_OPENCV " (the transposed matrix)"},
    {"Camera2 {", "a script of Nuke; " EXPORT_SCENE},
    {"Camera3 {", "a script of Nuke; " EXPORT_SCENE},
};

static bool contains(const char *text, size_t size, const char *word) {
  const size_t length = strlen(word);
  for (size_t i = 0; i + length <= size; i++)
    if (memcmp(text + i, word, length) == 0)
      return true;
  return false;
}

const char *vl_camera_other_tool(const char *text, size_t size) {
  enum { MAX_SEARCHED = 4096 };
  for (size_t i = 0; i < VL_LENGTH(by_beginning); i++) {
    const size_t length = strlen(by_beginning[i].mark);
    if (size >= length && memcmp(text, by_beginning[i].mark, length) == 0)
      return by_beginning[i].advice;
  }
  const size_t searched = size < MAX_SEARCHED ? size : MAX_SEARCHED;
  for (size_t i = 0; i < VL_LENGTH(by_text); i++)
    if (contains(text, searched, by_text[i].mark))
      return by_text[i].advice;
  return NULL;
}
