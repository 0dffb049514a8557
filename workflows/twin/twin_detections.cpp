#include "workflows/twin/twin_detections.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "asset_lift/segmentation/box_matte.h"
#include "core/error.h"
#include "core/json.h"
#include "library_fit/fit_kinds.h"
#include "physics_params/category_resolution.h"
#include "twin/depth_objects.h"
#include "twin/detection_mask.h"
#include "twin/vision_objects.h"

namespace simwright::workflows {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostObjectsBytes = 1u << 20;
constexpr size_t kMostStated = 100;
constexpr double kSameBox = 0.5;  // IoU of a box and that of a piece above the plane

// Reads a mask beside the file, as grey, in the photo's size.
core::Image ReadMask(const core::JsonField& field, const fs::path& folder,
                     const core::Image& photo) {
  const fs::path name = field.Text();
  if (name.empty() || name.has_parent_path()) {
    field.Fail("must be the name of a file beside this one");
  }
  const core::Image read = core::Resize(core::ReadImage(folder / name), photo.width, photo.height);
  core::Image mask(photo.width, photo.height, 1);
  for (size_t i = 0; i < mask.pixels.size(); ++i) {
    mask.pixels[i] = read.pixels[i * static_cast<size_t>(read.channels)];
  }
  return mask;
}

// Keeps the largest boxes, in their order, with their kinds.
void KeepLargest(size_t most, TwinDetections* detections) {
  std::vector<twin::Detection>& objects = detections->found.objects;
  std::vector<size_t> order(objects.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return objects[a].box.volume() > objects[b].box.volume();
  });
  order.resize(std::min(most, order.size()));
  std::sort(order.begin(), order.end());
  std::vector<twin::Detection> kept;
  std::vector<std::vector<int>> kinds;
  for (const size_t index : order) {
    kept.push_back(std::move(objects[index]));
    if (index < detections->kinds.size()) kinds.push_back(detections->kinds[index]);
  }
  objects = std::move(kept);
  detections->kinds = std::move(kinds);
}

}  // namespace

TwinDetections ReadTwinObjects(const fs::path& file, const core::Image& photo, int width,
                               int height) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMostObjectsBytes);
  TwinDetections detections;
  detections.found.camera = twin::TableCameraGuess();
  const double sx = static_cast<double>(photo.width) / width;
  const double sy = static_cast<double>(photo.height) / height;
  const std::vector<core::JsonField> objects = document.root()["objects"].Elements();
  if (objects.size() > kMostStated)
    document.root()["objects"].Fail("must list at most 100 objects");
  for (const core::JsonField& object : objects) {
    object.RequireMembers({"box"}, {"category", "mask"});
    const Eigen::Vector4d box = object["box"].Vector<4>();
    if (!(box[0] < box[2]) || !(box[1] < box[3]) || box[2] <= 0.0 || box[3] <= 0.0 ||
        box[0] >= width || box[1] >= height) {
      object["box"].Fail("must be left, top, right, bottom in pixels of the photo");
    }
    twin::Detection detection = twin::DetectionOfMask(
        object.Has("mask")
            ? ReadMask(object["mask"], file.parent_path(), photo)
            : asset_lift::BoxMatte(photo, {Eigen::Vector2d(sx * box[0], sy * box[1]),
                                           Eigen::Vector2d(sx * box[2], sy * box[3])}));
    if (detection.box.isEmpty()) object.Fail("shows no pixel of an object");
    std::vector<int> kinds;
    if (object.Has("category")) {
      const std::string named = object["category"].Name();
      kinds = library_fit::KindsOfCategory(physics_params::RequireCategory(named).category->name);
      if (kinds.empty()) {
        object["category"].Fail("the library has no kind of this category",
                                "leave it out, or see simwright library --list");
      }
    }
    detections.found.objects.push_back(std::move(detection));
    detections.kinds.push_back(std::move(kinds));
  }
  return detections;
}

TwinDetections AskForTwinObjects(llm::ChatModel* model, const TwinPhoto& photo,
                                 core::Progress* progress, core::Findings* findings) {
  const twin::VisionObjects answer = twin::AskForObjects(model, photo.rgb, progress);
  findings->insert(findings->end(), answer.findings.begin(), answer.findings.end());
  std::vector<twin::Detection> pieces;
  if (photo.plane) pieces = twin::ObjectsAbovePlane(photo.depth, *photo.plane);
  TwinDetections detections;
  for (const twin::NamedBox& named : answer.boxes) {
    const auto piece = std::find_if(pieces.begin(), pieces.end(), [&](const auto& candidate) {
      const Eigen::AlignedBox2d both = candidate.box.intersection(named.box);
      if (both.isEmpty()) return false;
      const double joint = candidate.box.volume() + named.box.volume() - both.volume();
      return both.volume() > kSameBox * joint;
    });
    if (piece != pieces.end()) {
      detections.found.objects.push_back(std::move(*piece));
      pieces.erase(piece);
    } else {
      detections.found.objects.push_back(
          twin::DetectionOfMask(asset_lift::BoxMatte(photo.rgb, named.box)));
    }
    detections.kinds.push_back(named.kinds);
  }
  return detections;
}

void LimitDetections(int most, TwinDetections* detections, core::Findings* findings) {
  twin::Detections* found = &detections->found;
  const int count = static_cast<int>(found->objects.size());
  if (count > most) {
    KeepLargest(static_cast<size_t>(most), detections);
    findings->push_back({"twin-many-objects", core::Severity::kWarning, "",
                         std::to_string(count) + " objects are detected; the " +
                             std::to_string(most) + " largest are rebuilt",
                         static_cast<double>(count), "--most-objects takes more"});
  }
  if (found->left_out > 0) {
    findings->push_back({"twin-left-out", core::Severity::kInfo, "",
                         std::to_string(found->left_out) +
                             " places look like objects, with a confidence below 0.45; they are "
                             "left out",
                         static_cast<double>(found->left_out), "--objects gives boxes"});
  }
  const auto cut = std::count_if(found->objects.begin(), found->objects.end(),
                                 [](const twin::Detection& object) { return object.cut; });
  if (cut == 0) return;
  findings->push_back({"twin-cut-off", core::Severity::kInfo, "",
                       std::to_string(cut) + " of the objects reach the border of the photo; what "
                                             "lies beyond it is guessed",
                       static_cast<double>(cut), ""});
}

}  // namespace simwright::workflows
