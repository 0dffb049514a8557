#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "library_fit/fit_kinds.h"
#include "twin/object_detector.h"
#include "twin/table_camera.h"
#include "twin/table_picture.h"

namespace simwright::twin {

// A table with known objects before a known camera, and what a perfect detector tells of it.
struct RenderedTable {
  TableScene scene;
  TablePicture picture;
  std::vector<Detection> detections;  // one an object, in their order
};

struct PlacedKind {
  const char* kind;
  std::uint64_t seed;
  double x, y, yaw;
};

// Renders the table's scene before a camera, and detects its objects.
inline void Picture(const TableCamera& camera, RenderedTable* table) {
  table->scene.camera = camera.At(320, 240);
  table->scene.light = render::SphericalHarmonicsLight::Studio({0.4f, -0.5f, 0.75f});
  table->picture = RenderTable(table->scene, {}, {2, 4, 2}, 1);
  for (size_t k = 0; k < table->scene.objects.size(); ++k) {
    Detection detection;
    detection.alpha = core::Image(320, 240, 1);
    detection.confidence = 1.0;
    for (size_t i = 0; i < table->picture.label.size(); ++i) {
      if (table->picture.label[i] != static_cast<std::int16_t>(k)) continue;
      detection.alpha.pixels[i] = 255;
      const Eigen::Vector2d at(static_cast<double>(i % 320), static_cast<double>(i / 320));
      detection.box.extend(at);
      detection.box.extend(at + Eigen::Vector2d::Ones());
    }
    table->detections.push_back(std::move(detection));
  }
}

inline RenderedTable RenderKinds(std::initializer_list<PlacedKind> placed,
                                 const TableCamera& camera) {
  RenderedTable table;
  for (const PlacedKind& of : placed) {
    TableObject object;
    object.instance = library_fit::SampleInstance(library_fit::FindFitKind(of.kind), of.seed);
    object.visual = library_fit::InstanceMesh(object.instance);
    object.world_from_object.linear() =
        Eigen::AngleAxisd(of.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    object.world_from_object.translation() = Eigen::Vector3d(of.x, of.y, 0.0);
    table.scene.objects.push_back(std::move(object));
  }
  table.scene.table.endless = true;
  Picture(camera, &table);
  return table;
}

}  // namespace simwright::twin
