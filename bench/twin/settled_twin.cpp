#include "settled_twin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/files.h"
#include "core/finding.h"
#include "core/progress.h"
#include "workflows/twin/twin_objects.h"
#include "workflows/twin/twin_pictures.h"
#include "workflows/twin/twin_record.h"
#include "workflows/twin/twin_settling.h"

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

// Moves a fit as physics moved its object.
void MovePose(const Eigen::Isometry3d& after_from_before, twin::TablePose* pose) {
  const Eigen::Isometry3d moved = after_from_before * pose->WorldFromObject();
  pose->x = moved.translation().x();
  pose->y = moved.translation().y();
  pose->yaw = std::atan2(moved.linear()(1, 0), moved.linear()(0, 0));
}

}  // namespace

SettledTwin SettleReconstruction(const core::Image& photo, const twin::Detections& detections,
                                 std::uint64_t seed, twin::TableReconstruction* table) {
  const core::TemporaryFolder folder;
  core::Progress silent;
  core::Findings findings;
  workflows::TwinRecord record;
  record.camera = table->camera.At(photo.width, photo.height);
  const std::vector<twin::TableAsset> assets;
  const workflows::TwinPlacements placements;
  std::map<std::string, int> names;
  const workflows::TwinAssetSources sources{*table,     photo, detections, assets,
                                            placements, 0.0,   seed};
  record.objects = workflows::WriteTwinAssets(sources, folder.path(), &names, &silent, &findings);
  SettledTwin settled;
  settled.complete = record.objects.size() == table->objects.size();
  if (record.objects.empty()) return settled;
  const std::vector<workflows::TwinObject> before = record.objects;
  workflows::SettleTwin(folder.path(), &record, &findings);
  settled.stands = record.stands;
  settled.penetration = record.penetration;
  settled.picture = SideBySide(photo, workflows::RenderTwin(record, folder.path(), photo).overlay);
  // Objects without an asset are left out of the record.
  size_t at = 0;
  for (twin::ReconstructedObject& object : table->objects) {
    const Eigen::AlignedBox2d& box = detections.objects[static_cast<size_t>(object.detection)].box;
    if (at == before.size() || !before[at].box.isApprox(box)) continue;
    MovePose(record.objects[at].world_from_object * before[at].world_from_object.inverse(),
             &object.fit.pose);
    ++at;
  }
  return settled;
}

core::Image DetectionsPicture(const core::Image& photo, const twin::Detections& detections) {
  constexpr std::array<std::array<int, 3>, 6> kColors{{{230, 60, 60},
                                                       {60, 200, 80},
                                                       {70, 110, 240},
                                                       {240, 200, 40},
                                                       {200, 80, 220},
                                                       {50, 210, 220}}};
  core::Image picture = photo;
  for (size_t k = 0; k < detections.objects.size(); ++k) {
    const core::Image& alpha = detections.objects[k].alpha;
    for (size_t p = 0; p < alpha.pixels.size(); ++p) {
      if (alpha.pixels[p] < 128) continue;
      for (size_t c = 0; c < 3; ++c) {
        std::uint8_t& value = picture.pixels[3 * p + c];
        value = static_cast<std::uint8_t>((value + kColors[k % kColors.size()][c]) / 2);
      }
    }
  }
  return picture;
}

core::Image SideBySide(const core::Image& left, const core::Image& right) {
  core::Image both(left.width + right.width, std::min(left.height, right.height), 3);
  for (int y = 0; y < both.height; ++y) {
    std::copy_n(left.At(0, y), 3 * left.width, both.At(0, y));
    std::copy_n(right.At(0, y), 3 * right.width, both.At(left.width, y));
  }
  return both;
}

}  // namespace simwright::bench
