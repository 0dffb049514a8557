#include "scene/palette.h"

#include <utility>

#include "core/error.h"

namespace simwright::scene {
namespace {

SlotSize SizeOfBody(const sim::RigidBody& body) {
  Eigen::AlignedBox3d box;
  for (const core::TriangleMesh& part : body.parts) {
    for (const Eigen::Vector3d& vertex : part.vertices) box.extend(vertex);
  }
  // About the origin, which is where grammars place it.
  const Eigen::Vector3d farthest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs());
  return BoxSize(farthest.x(), farthest.y(), box.max().z());
}

}  // namespace

void Palette::Add(const std::string& slot, sim::RigidBody body, core::TexturedMesh visual) {
  if (Has(slot)) throw core::Error("two assets are to stand for one slot", slot);
  if (body.parts.empty()) throw core::Error("an asset needs collision parts", slot);
  PaletteAsset asset;
  asset.size = SizeOfBody(body);
  for (const core::TriangleMesh& part : body.parts) asset.parts.push_back({part.vertices, 0.0});
  if (visual.mesh.triangles.empty()) {
    for (const core::TriangleMesh& part : body.parts) core::Append(part, &visual.mesh);
  }
  asset.visual = std::move(visual);
  asset.body = std::move(body);
  assets_.emplace(slot, std::move(asset));
}

const PaletteAsset& Palette::At(const std::string& slot) const {
  const auto found = assets_.find(slot);
  if (found == assets_.end()) {
    throw core::Error("no asset stands for this slot of the scene", slot, "add one to the palette");
  }
  return found->second;
}

SlotSizes Palette::Sizes(const SlotSizes& others) const {
  SlotSizes sizes = others;
  for (const auto& [slot, asset] : assets_) sizes[slot] = asset.size;
  return sizes;
}

}  // namespace simwright::scene
