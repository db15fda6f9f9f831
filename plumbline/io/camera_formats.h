// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "plumbline/geometry/calibration.h"
#include "plumbline/geometry/camera.h"
#include "plumbline/geometry/se3.h"
#include "plumbline/io/cameras/yaml_section.h"
#include "plumbline/io/datasets/image_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumbline {

// Reads the camera of a CamOdoCal file, as used by VINS-Mono and VINS-Fusion:
//
//   image_width, image_height
//   model_type: PINHOLE         projection_parameters fx fy cx cy,
//                               distortion_parameters k1 k2 p1 p2
//   model_type: KANNALA_BRANDT  projection_parameters mu mv u0 v0, k2 k3 k4 k5
//                               (equidistant k1 to k4)
//   model_type: MEI             projection_parameters gamma1 gamma2 u0 v0,
//                               mirror_parameters xi, distortion_parameters k1 k2 p1 p2 (omni)
//
// rate_hz and depth_factor may be added. Throws InputError naming the key, also for SCARAMUZZA,
// whose polynomial is no model here.
Calibration ReadCamodocal(const YamlSection& root);

// Reads a camchain.yaml of the calibration tool Kalibr: cam0 becomes the left camera, cam1, if any,
// the right camera with right_from_left = T_cn_cnm1, or without it (OpenVINS) from T_cam_imu or
// T_imu_cam of both. Further cameras, other extrinsics of an inertial sensor, time shifts and
// topics are ignored. Models: pinhole with radtan, equidistant, fov or no distortion; omni with
// radtan or none (intrinsics xi, fx, ...); ds (xi, alpha, fx, ...) and eucm (alpha, beta, fx, ...)
// with none. rate_hz and depth_factor, which Kalibr does not write, may be added at the top or to
// cam0. Throws InputError naming the key for others.
Calibration ReadKalibr(const YamlSection& root);

// Reads a calibration of Basalt, JSON with the group value0: intrinsics[i] with camera_type
// pinhole, pinhole-radtan8 (rational), kb4 (equidistant), ds, eucm, ucm (eucm with beta = 1) or
// fov, and resolution[i]; of a pair right_from_left = T_imu_cam[1]^-1 T_imu_cam[0]. Further cameras
// and all of the inertial sensor are ignored. rate_hz and depth_factor may be added beside value0.
// Throws InputError naming the key.
Calibration ReadBasalt(const YamlSection& root);

// Reads the camera from a settings file of stella_vslam or OpenVSLAM, as groups (`Camera: {fx:
// ...}`) or with whole keys (`Camera.fx`). Camera.model: perspective (k1 k2 p1 p2 k3) or fisheye
// (equidistant k1 to k4). Camera.setup: monocular; RGBD with depthmap_factor; stereo: rectified, of
// baseline focal_x_baseline / fx, or raw by StereoRectifier, K, D and R of both cameras (its model
// is perspective unless given). Throws InputError naming the key, also for equirectangular and
// radial_division.
Calibration ReadStellaVslam(const YamlSection& root);

// Reads the camera of a cameras.txt of COLMAP with one camera: CAMERA_ID, MODEL, WIDTH, HEIGHT,
// parameters. All models but those of a thin prism. A comment `# rate_hz: 20` gives the rate.
// Throws InputError "source:line: expected ..., found ...".
Calibration ReadColmapCameras(const std::string& text, const std::string& source);
// Returns true if the first row that is no comment is one of a cameras.txt.
bool IsColmapCameras(const std::string& text);

// Reads the calibration of one camera as written by OpenCV's calibration programs (FileStorage,
// YAML or JSON) and by ROS's camera_calibration (ost.yaml, the files of camera_info):
//
//   image_width, image_height
//   camera_matrix            3x3 without skew
//   distortion_coefficients  k1 k2 p1 p2 [k3 [k4 k5 k6 [zeros]]]; of a fisheye k1 k2 k3 k4
//   xi                       of cv::omnidir, with k1 k2 p1 p2
//   distortion_model         plumb_bob, rational_polynomial, equidistant or fisheye; OpenCV's
//                            programs have fisheye_model, 0 or 1, in its place
//
// rate_hz and depth_factor, which neither writes, may be added. All other keys are ignored for one
// camera: its name, its rectification for a pair, and the process of its calibration. Throws
// InputError naming the key.
Calibration ReadOpenCvCalibration(const YamlSection& root);

// Reads the camera from a settings file of ORB-SLAM2 or ORB-SLAM3, in the form with and without
// `File.version: "1.0"`; all other settings are ignored. Sensors by keys:
//
//   LEFT.K, .D, .R, .P, RIGHT.*  a raw stereo pair with its rectification: x_rect = R x and
//                                P_right = K [I | t] give right_from_left =
//                                (R_right^T R_left, R_right^T t)
//   Camera2.*                    a raw stereo pair, right_from_left = (Stereo.T_c1_c2)^-1, in
//                                older files Tlr^-1: the pose of camera 2 in camera 1
//   DepthMapFactor, RGBD.DepthMapFactor
//                                colour and depth; bf and b are of no real camera then
//   Camera.bf, Stereo.b          a rectified stereo pair of baseline bf / fx, or b
//   none of these                one camera
//
// Camera.type: PinHole (k1 k2 p1 p2 [k3]), KannalaBrandt8 (k1 k2 k3 k4) or Rectified. Throws
// InputError naming the key; the image size is required, as images are checked against it.
Calibration ReadOrbSlamSettings(const YamlSection& root);

// Contents of a EuRoC sensor.yaml of one camera.
struct EurocSensor {
  Camera camera;
  Rigid3 body_from_camera;  // T_BS
  double rate_hz = 0;
};

// Throws InputError "path:line: key: expected ..., found ...".
EurocSensor ReadEurocSensor(const std::filesystem::path& path);
EurocSensor ReadEurocSensor(const YamlSection& root);

// Returns the files of configs/cameras, in the order of their names: name without .yaml, and
// contents. They are compiled into the program, so that it needs no installed files.
const std::vector<std::pair<std::string, std::string>>& BuiltInCameraFiles();

// KITTI cameras in use: 0 and 1 are grey, 2 and 3 have colours.
struct KittiCameras {
  int left = 0;
  std::optional<int> right;
};

// Reads the rows `P0: 12 numbers` of the cameras from a calib.txt of KITTI odometry. Its images are
// rectified; `size` is their size, which is not in the file.
//
// body_from_left becomes the pose of the left camera in the frame of camera 0, which is that of the
// ground truth, unless it is camera 0 itself. The cameras 2 and 3 are offset by some millimetres
// vertically and in depth: their pair is not `rectified`.
//
// Throws InputError "FILE:LINE: expected ..., found ..." for rows that are missing or malformed.
Calibration ReadKittiCalibration(const std::filesystem::path& file,
                                 const KittiCameras& cameras,
                                 ImageSize size);

// Images of a KITTI raw drive: rectified (`_sync`) or as taken (`_extract`).
enum class KittiImages { kRectified, kAsTaken };

// Reads the cameras from the calib_cam_to_cam.txt of a KITTI raw drive. The kind of images follows
// from their size: that of S_rect_00 rectified (P_rect_00 is their calibration), that of S_00 as
// taken (K_00, D_00, and R_00, T_00, the motion from camera 0). It is written to `images`, if not
// null. If both sizes are the same, it is `otherwise`.
//
// body_from_left becomes the pose of the left camera in the rectified frame of camera 0
// (R_rect_00), that of the poses of KITTI odometry, unless it is that camera. Throws InputError as
// above.
Calibration ReadKittiRawCalibration(const std::filesystem::path& file,
                                    const KittiCameras& cameras,
                                    ImageSize size,
                                    KittiImages otherwise,
                                    KittiImages* images = nullptr);

}  // namespace plumbline
