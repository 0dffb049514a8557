#include "render/rigid_scene.h"

#include <utility>

#include "core/error.h"

namespace simwright::render {

int RigidScene::Add(std::shared_ptr<const RigidMesh> mesh, std::int32_t label,
                    const Eigen::Isometry3d& world_from_part) {
  if (!mesh) throw core::Error("a part needs a mesh");
  if (label < 0) {
    throw core::Error("the label of a part must not be negative", std::to_string(label),
                      "-1 means that nothing is hit");
  }
  parts_.push_back({std::move(mesh), label, world_from_part, {}});
  return size() - 1;
}

void RigidScene::SetPose(int part, const Eigen::Isometry3d& world_from_part) {
  parts_.at(static_cast<std::size_t>(part)).world_from_part = world_from_part;
}

void RigidScene::SetLook(int part, const SurfaceLook& look) {
  parts_.at(static_cast<std::size_t>(part)).look = look;
}

}  // namespace simwright::render
