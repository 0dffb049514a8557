// Small scenes for tests of steering: cups and plates on a round table.
#pragma once

#include <string>
#include <vector>

#include "geometry/mass_properties.h"
#include "library/convex_shapes.h"
#include "scene/asset_set/asset_set.h"
#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::steering {

constexpr double kTableTop = 0.7, kCupHeight = 0.07, kPlateHeight = 0.02;  // m

// Returns a table of radius 0.6 m, cups of radius 0.05 m and plates of radius 0.1 m.
inline scene::AssetSet TableAssets() {
  scene::AssetSet asset_set;
  const auto add = [&](const std::string& category, double radius, double height) {
    sim::RigidBody body;
    body.name = category;
    body.friction = 0.6;
    body.parts = {library::Rod(Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, height), radius, 24)};
    const auto properties = geometry::SolidMassProperties(body.parts[0], 300.0);
    body.inertial = {properties.mass, properties.center_of_mass, properties.inertia};
    asset_set.Add(category, body);
  };
  add("table", 0.6, kTableTop);
  add("cup", 0.05, kCupHeight);
  add("plate", 0.1, kPlateHeight);
  return asset_set;
}

inline scene::Vocabulary TableVocabulary() {
  return {"test_table", 8, {"cup", "plate", "table"}, {false, false, true}};
}

inline scene::SceneObject ObjectAt(const std::string& category, double x, double y, double z) {
  scene::SceneObject object;
  object.category = category;
  object.world_from_object.translation() << x, y, z;
  object.welded = category == "table";
  return object;
}

}  // namespace simwright::steering
