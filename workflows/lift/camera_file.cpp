#include "workflows/lift/camera_file.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"

namespace simwright::workflows {
namespace {

using nlohmann::json;

double CameraNumber(const json& camera, const char* key, double least, const std::string& where) {
  const auto found = camera.find(key);
  if (found == camera.end() || !found->is_number()) {
    throw core::Error(std::string("has no number '") + key + "'", where);
  }
  const double value = found->get<double>();
  if (!std::isfinite(value) || value < least) {
    throw core::Error(std::string("'") + key + "' is " + found->dump() + ", too small", where);
  }
  return value;
}

Eigen::Isometry3d Pose(const json& camera, const std::string& where) {
  const char* expected = "expected 4 rows of 4 numbers: a rotation and a position";
  const auto rows = camera.find("world_from_camera");
  if (rows == camera.end() || !rows->is_array() || rows->size() != 4) {
    throw core::Error("has no 'world_from_camera'", where, expected);
  }
  Eigen::Matrix4d matrix;
  for (int r = 0; r < 4; ++r) {
    const json& row = (*rows)[static_cast<size_t>(r)];
    if (!row.is_array() || row.size() != 4) {
      throw core::Error("'world_from_camera' has a row of the wrong length", where, expected);
    }
    for (int c = 0; c < 4; ++c) {
      const json& value = row[static_cast<size_t>(c)];
      if (!value.is_number()) throw core::Error("'world_from_camera' has a non-number", where);
      matrix(r, c) = value.get<double>();
    }
  }
  const Eigen::Matrix3d turn = matrix.topLeftCorner<3, 3>();
  if (!matrix.allFinite() || turn.determinant() < 0.0 ||
      !(turn.transpose() * turn).isIdentity(1e-3) ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6)) {
    throw core::Error("'world_from_camera' is not a rotation and a position", where,
                      "its rotation's columns must be orthonormal and right-handed");
  }
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
  pose.translation() = matrix.topRightCorner<3, 1>();
  return pose;
}

}  // namespace

std::map<std::string, core::Camera> ReadCameraFile(const std::filesystem::path& path) {
  json file;
  try {
    file = json::parse(core::ReadFile(path, 1 << 26));
  } catch (const json::exception& error) {
    throw core::Error("is not JSON", path.string());
  }
  if (!file.is_object() || !file.contains("cameras") || !file["cameras"].is_array() ||
      file["cameras"].empty()) {
    throw core::Error("has no list 'cameras'", path.string());
  }
  std::map<std::string, core::Camera> cameras;
  for (size_t i = 0; i < file["cameras"].size(); ++i) {
    const json& entry = file["cameras"][i];
    std::string where = path.string() + ": camera " + std::to_string(i);
    if (!entry.is_object() || !entry.contains("photo") || !entry["photo"].is_string()) {
      throw core::Error("has no 'photo'", where);
    }
    const std::string photo = std::filesystem::path(entry["photo"].get<std::string>()).filename();
    where += " (" + photo + ")";
    core::Camera camera;
    camera.width = static_cast<int>(std::min(1e6, CameraNumber(entry, "width", 1, where)));
    camera.height = static_cast<int>(std::min(1e6, CameraNumber(entry, "height", 1, where)));
    camera.fx = CameraNumber(entry, "fx", 1e-3, where);
    camera.fy = CameraNumber(entry, "fy", 1e-3, where);
    camera.cx = CameraNumber(entry, "cx", -1e6, where);
    camera.cy = CameraNumber(entry, "cy", -1e6, where);
    camera.world_from_camera = Pose(entry, where);
    if (!cameras.emplace(photo, camera).second) throw core::Error("occurs twice", where);
  }
  return cameras;
}

}  // namespace simwright::workflows
