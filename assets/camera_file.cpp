#include "assets/camera_file.h"

#include "core/files.h"
#include "core/json.h"

namespace simwright::assets {
namespace {

constexpr double kMaxPixels = 1e6;

Eigen::Isometry3d CameraPose(const core::JsonField& field) {
  Eigen::Matrix4d matrix;
  const std::vector<core::JsonField> rows = field.Elements(4);
  for (int r = 0; r < 4; ++r) {
    matrix.row(r) = rows[static_cast<size_t>(r)].Vector<4>();
  }
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  if (turn.determinant() < 0.0 || !(turn.transpose() * turn).isIdentity(1e-3) ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6)) {
    field.Fail("is not a rotation and a position",
               "its rotation's columns must be orthonormal and right-handed");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

core::Camera CameraFrom(const core::JsonField& field) {
  core::Camera camera;
  camera.width = static_cast<int>(field["width"].NumberWithin(1.0, kMaxPixels));
  camera.height = static_cast<int>(field["height"].NumberWithin(1.0, kMaxPixels));
  camera.fx = field["fx"].NumberWithin(1e-3);
  camera.fy = field["fy"].NumberWithin(1e-3);
  camera.cx = field["cx"].NumberWithin(-kMaxPixels);
  camera.cy = field["cy"].NumberWithin(-kMaxPixels);
  camera.world_from_camera = CameraPose(field["world_from_camera"]);
  return camera;
}

}  // namespace

std::map<std::string, core::Camera> ReadCameraFile(const std::filesystem::path& path) {
  const core::JsonDocument document = core::JsonDocument::Read(path, 1 << 26);
  const core::JsonField list = document.root()["cameras"];
  std::map<std::string, core::Camera> cameras;
  for (const core::JsonField& entry : list.Elements()) {
    const std::string photo = std::filesystem::path(entry["photo"].Text()).filename();
    if (!cameras.emplace(photo, CameraFrom(entry)).second) {
      entry.Fail("the photo '" + photo + "' occurs twice");
    }
  }
  if (cameras.empty()) list.Fail("has no camera");
  return cameras;
}

void WriteCameraFile(const std::map<std::string, core::Camera>& cameras,
                     const std::filesystem::path& path) {
  core::OrderedJson json;
  json["cameras"] = core::OrderedJson::array();
  for (const auto& [photo, camera] : cameras) {
    core::OrderedJson pose = core::OrderedJson::array();
    for (int r = 0; r < 4; ++r) {
      const Eigen::RowVector4d row = camera.world_from_camera.matrix().row(r);
      pose.push_back({row[0], row[1], row[2], row[3]});
    }
    json["cameras"].push_back({{"photo", photo},
                               {"width", camera.width},
                               {"height", camera.height},
                               {"fx", camera.fx},
                               {"fy", camera.fy},
                               {"cx", camera.cx},
                               {"cy", camera.cy},
                               {"world_from_camera", std::move(pose)}});
  }
  core::WriteFile(path, core::JsonText(json));
}

}  // namespace simwright::assets
