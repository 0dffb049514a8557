#include "scene/metrics/label_render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Core>

#include "core/error.h"
#include "render/forward.h"
#include "render/scene.h"
#include "scene/grammar/category_size.h"
#include "scene/scene_types/scene_types.h"

namespace simwright::scene {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// The vertical field of view: a room of 10 m fills it from 13 m, a table of 1.25 m from 1.7 m.
constexpr double kLabelFieldOfView = 0.25 * std::numbers::pi;
// The field of view for shelves: from the edge of the lowest board to a bottle on the uppermost.
constexpr double kShelfView = 55.0 / 180.0 * std::numbers::pi;
// Camera distances, m.
constexpr double kBreakfast = 1.5, kDimsum = 1.7, kRoom = 13.0, kShelf = 1.2, kAboveMiddle = 0.1;
constexpr double kShelfMiddle = 0.407;  // m above its base (scene/grammar/shelf_boards)

// Converts an sRGB colour to CIELAB under D65.
Eigen::Vector3d LabOf(const Colour& colour) {
  Eigen::Vector3d linear;
  for (int i = 0; i < 3; ++i) {
    const double value = colour[static_cast<size_t>(i)] / 255.0;
    linear[i] = value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  }
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz = (to_xyz * linear).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  const double x = f(xyz.x()), y = f(xyz.y()), z = f(xyz.z());
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

std::vector<Colour> MakeColours() {
  std::vector<Colour> candidates;
  for (int i = 0; i < 216; ++i) {
    candidates.push_back({static_cast<std::uint8_t>(51 * (i % 6)),
                          static_cast<std::uint8_t>(51 * (i / 6 % 6)),
                          static_cast<std::uint8_t>(51 * (i / 36))});
  }
  std::vector<double> apart(candidates.size(), std::numeric_limits<double>::infinity());
  std::vector<Colour> colours;
  Colour last = {255, 255, 255};
  while (static_cast<int>(colours.size()) < kMaxLabels) {
    for (size_t i = 0; i < candidates.size(); ++i) {
      apart[i] = std::min(apart[i], (LabOf(candidates[i]) - LabOf(last)).norm());
    }
    const auto farthest = std::max_element(apart.begin(), apart.end()) - apart.begin();
    last = candidates[static_cast<size_t>(farthest)];
    colours.push_back(last);
  }
  return colours;
}

core::Camera LookingAlong(const Eigen::Vector3d& position, const Eigen::Vector3d& right,
                          const Eigen::Vector3d& along, double field_of_view) {
  core::Camera camera;
  camera.width = kLabelWidth, camera.height = kLabelHeight;
  camera.fx = camera.fy = 0.5 * kLabelHeight / std::tan(0.5 * field_of_view);
  camera.cx = 0.5 * kLabelWidth, camera.cy = 0.5 * kLabelHeight;
  camera.world_from_camera.linear().col(0) = right;
  camera.world_from_camera.linear().col(1) = along.cross(right);
  camera.world_from_camera.linear().col(2) = along;
  camera.world_from_camera.translation() = position;
  return camera;
}

core::Camera FromAbove(double height) {
  return LookingAlong({0.0, 0.0, height}, Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitZ(),
                      kLabelFieldOfView);
}

double TopOf(const std::string& table) {
  return SizeOf(DefaultCategorySizes(), table).height;
}

}  // namespace

std::array<std::uint8_t, 3> LabelColour(int index) {
  static const std::vector<Colour> colours = MakeColours();
  if (index < 0 || index >= kMaxLabels) {
    throw core::Error("there are " + std::to_string(kMaxLabels) + " class colours",
                      "class " + std::to_string(index));
  }
  return colours[static_cast<size_t>(index)];
}

core::Camera LabelCamera(const std::string& type) {
  SceneTypeNamed(type);  // throws for an unknown type
  if (type.starts_with("breakfast")) return FromAbove(TopOf("table_breakfast") + kBreakfast);
  if (type.starts_with("dimsum")) return FromAbove(TopOf("table_round") + kDimsum);
  if (type.starts_with("restaurant")) return FromAbove(kRoom);
  // Our shelves open to their -x, the published ones to +x.
  return LookingAlong({-kShelf, 0.0, kShelfMiddle + kAboveMiddle}, -Eigen::Vector3d::UnitY(),
                      Eigen::Vector3d::UnitX(), kShelfView);
}

core::Image LabelRender(const std::vector<SceneObject>& objects, const Vocabulary& vocabulary,
                        const AssetSet& asset_set, const core::Camera& camera) {
  core::Image image(camera.width, camera.height, 3, 255);
  if (objects.empty()) return image;
  render::Scene scene;
  std::vector<Colour> colours;
  for (const SceneObject& object : objects) {
    const int index = vocabulary.ClassOf(object.category);
    if (index < 0) throw core::Error("the vocabulary has no such category", object.category);
    colours.push_back(LabelColour(index));
    scene.Add(&asset_set.At(object.category).visual, object.world_from_object);
  }
  scene.Commit();
  const render::ForwardBuffers buffers = render::RenderForward(scene, camera);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const std::int32_t label = buffers.label[buffers.Index(x, y)];
      if (label < 0) continue;
      const Colour& colour = colours[static_cast<size_t>(label)];
      std::copy(colour.begin(), colour.end(), image.At(x, y));
    }
  }
  return image;
}

}  // namespace simwright::scene
