#include "assets/kinematic_model.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"

namespace simwright::assets {
namespace {

template <typename Items>
int FindByName(const Items& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

int Required(int index, const std::string& kind, const std::string& model,
             const std::string& name) {
  if (index < 0) throw core::Error("has no such " + kind, model, name);
  return index;
}

template <typename Items>
std::map<std::string, int> IndicesByName(const Items& items, const std::string& kind,
                                         const std::string& model) {
  std::map<std::string, int> indices;
  for (size_t i = 0; i < items.size(); ++i) {
    if (!indices.emplace(items[i].name, static_cast<int>(i)).second) {
      throw core::Error("two " + kind + "s have the same name",
                        model + " " + kind + " '" + items[i].name + "'", "rename one of them");
    }
  }
  return indices;
}

}  // namespace

KinematicModel::KinematicModel(std::string name, std::vector<KinematicLink> links,
                               std::vector<Joint> joints,
                               const std::vector<ExcludedPair>& excluded_pairs)
    : name_(std::move(name)), links_(std::move(links)), joints_(std::move(joints)) {
  if (links_.size() != joints_.size() + 1) {
    throw core::Error("a kinematic tree of " + std::to_string(links_.size()) + " links has " +
                          std::to_string(joints_.size()) + " joints",
                      name_, "give it one joint fewer than links");
  }
  const std::map<std::string, int> link_index = IndicesByName(links_, "link", name_);
  const std::map<std::string, int> joint_index = IndicesByName(joints_, "joint", name_);
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    const auto parent = link_index.find(joint.parent);
    if (joint.child != links_[i + 1].name || parent == link_index.end() ||
        parent->second > static_cast<int>(i)) {
      throw core::Error(
          "a joint must lead from a link before its child to the link '" + links_[i + 1].name + "'",
          name_ + " joint '" + joint.name + "'",
          "it leads from '" + joint.parent + "' to '" + joint.child + "'");
    }
    parents_.push_back(parent->second);
    const auto leader = joint.mimic ? joint_index.find(joint.mimic->joint) : joint_index.end();
    leaders_.push_back(leader == joint_index.end() ? -1 : leader->second);
    if (joint.Moves()) moving_joints_.push_back(static_cast<int>(i));
  }
  for (const auto& [first, second] : excluded_pairs) {
    const auto a = link_index.find(first), b = link_index.find(second);
    if (a == link_index.end() || b == link_index.end()) continue;
    excluded_pairs_.insert(std::minmax(a->second, b->second));
  }
}

int KinematicModel::FindLink(const std::string& name) const {
  return FindByName(links_, name);
}

int KinematicModel::FindJoint(const std::string& name) const {
  return FindByName(joints_, name);
}

int KinematicModel::LinkIndex(const std::string& name) const {
  return Required(FindLink(name), "link", name_, name);
}

int KinematicModel::JointIndex(const std::string& name) const {
  return Required(FindJoint(name), "joint", name_, name);
}

std::vector<bool> KinematicModel::Subtree(int link) const {
  std::vector<bool> inside(links_.size(), false);
  inside.at(static_cast<size_t>(link)) = true;
  for (size_t i = static_cast<size_t>(link); i < joints_.size(); ++i) {
    if (inside[static_cast<size_t>(parents_[i])]) inside[i + 1] = true;
  }
  return inside;
}

bool KinematicModel::RigidlyJoined(int link_a, int link_b) const {
  const auto carrier = [&](int link) {
    while (link > 0 && !joints_[static_cast<size_t>(link) - 1].Moves()) {
      link = parents_[static_cast<size_t>(link) - 1];
    }
    return link;
  };
  return carrier(link_a) == carrier(link_b);
}

std::vector<Eigen::Isometry3d> KinematicModel::LinkPoses(
    const std::vector<double>& positions) const {
  if (positions.size() != joints_.size()) {
    throw core::Error("got " + std::to_string(positions.size()) + " joint positions, there are " +
                          std::to_string(joints_.size()) + " joints",
                      name_);
  }
  std::vector<Eigen::Isometry3d> poses(links_.size(), Eigen::Isometry3d::Identity());
  for (size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    double position = positions[i];
    if (joint.mimic) {
      const double leader = leaders_[i] < 0 ? 0.0 : positions[static_cast<size_t>(leaders_[i])];
      position = joint.mimic->multiplier * leader + joint.mimic->offset;
    }
    poses[i + 1] = poses[static_cast<size_t>(parents_[i])] * joint.parent_from_joint *
                   JointMotion(joint, position);
  }
  return poses;
}

std::shared_ptr<const KinematicModel> MakeKinematicModel(const UrdfModel& model) {
  std::vector<KinematicLink> links;
  for (const UrdfLink& link : model.links) {
    links.push_back({link.name, link.inertial.value_or(Inertial())});
  }
  return std::make_shared<KinematicModel>(model.name, std::move(links), model.joints,
                                          model.excluded_pairs);
}

std::shared_ptr<const KinematicModel> MakeKinematicModel(const ArticulatedAsset& asset) {
  std::vector<KinematicLink> links;
  for (const ArticulatedLink& link : asset.links) links.push_back({link.name, link.inertial});
  return std::make_shared<KinematicModel>(asset.name, std::move(links), asset.joints,
                                          asset.excluded_pairs);
}

}  // namespace simwright::assets
