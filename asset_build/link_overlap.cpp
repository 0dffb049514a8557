#include "asset_build/link_overlap.h"

#include <algorithm>
#include <limits>

#include "assets/joint_poses.h"
#include "geometry/distance.h"

namespace simwright::asset_build {
namespace {

constexpr double kStands = 5e-3;  // m: links that reach below this stand on the floor

}  // namespace

LinkGroups::LinkGroups(const assets::UrdfModel& model)
    : parent_(model.links.size(), -1), top_(model.links.size(), 0) {
  const std::vector<int> parents = assets::ParentLinks(model);
  for (size_t i = 0; i < model.joints.size(); ++i) {
    parent_[i + 1] = parents[i];
    top_[i + 1] = model.joints[i].Moves() ? i + 1 : top_[static_cast<size_t>(parents[i])];
  }
}

bool LinkGroups::Adjacent(size_t link_a, size_t link_b) const {
  const auto hangs_on = [&](size_t child, size_t parent) {
    const int above = parent_[top_[child]];
    return above >= 0 && top_[static_cast<size_t>(above)] == top_[parent];
  };
  return !Rigid(link_a, link_b) && (hangs_on(link_a, link_b) || hangs_on(link_b, link_a));
}

std::vector<bool> LinkGroups::CarriedBy(size_t joint) const {
  std::vector<bool> carried(parent_.size(), false);
  for (size_t i = 1; i < parent_.size(); ++i) {
    carried[i] = i == joint + 1 || carried[static_cast<size_t>(parent_[i])];
  }
  return carried;
}

double OverlapOf(const assets::UrdfModel& model, const std::vector<Eigen::Isometry3d>& poses,
                 size_t link_a, size_t link_b) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const assets::UrdfShape& shape : model.links[link_b].collisions) {
    boxes.push_back(core::Bounds(shape.mesh).transformed(poses[link_b]));
  }
  double deepest = 0.0;
  for (const assets::UrdfShape& a : model.links[link_a].collisions) {
    const Eigen::AlignedBox3d box = core::Bounds(a.mesh).transformed(poses[link_a]);
    for (size_t i = 0; i < boxes.size(); ++i) {
      if (!box.intersects(boxes[i])) continue;
      const assets::UrdfShape& b = model.links[link_b].collisions[i];
      deepest = std::max(deepest, -geometry::SignedDistance({a.mesh.vertices}, poses[link_a],
                                                            {b.mesh.vertices}, poses[link_b])
                                       .distance);
    }
  }
  return deepest;
}

double LowestOf(const assets::UrdfLink& link, const Eigen::Isometry3d& pose) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const assets::UrdfShape& shape : link.collisions) {
    for (const Eigen::Vector3d& v : shape.mesh.vertices) lowest = std::min(lowest, (pose * v).z());
  }
  return lowest;
}

std::vector<bool> SupportingLinks(const assets::UrdfModel& model) {
  const std::vector<Eigen::Isometry3d> poses = assets::LinkPosesAtZero(model);
  const LinkGroups groups(model);
  std::vector<bool> bears(model.links.size(), false);
  for (size_t i = 0; i < model.links.size(); ++i) {
    const bool low = LowestOf(model.links[i], poses[i]) < kStands;
    if (low && groups.Rigid(i, 0)) return std::vector<bool>(model.links.size(), false);
    bears[i] = low;
  }
  return bears;
}

bool IsExcluded(const assets::UrdfModel& model, size_t link_a, size_t link_b) {
  const std::string &a = model.links[link_a].name, &b = model.links[link_b].name;
  return std::any_of(model.excluded_pairs.begin(), model.excluded_pairs.end(),
                     [&](const assets::ExcludedPair& pair) {
                       return (pair.first == a && pair.second == b) ||
                              (pair.first == b && pair.second == a);
                     });
}

}  // namespace simwright::asset_build
