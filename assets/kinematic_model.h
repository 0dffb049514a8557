#pragma once

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "assets/articulated_asset.h"
#include "assets/asset.h"
#include "assets/joint.h"
#include "assets/urdf_reader.h"

namespace simwright::assets {

// A link of a kinematic tree.
struct KinematicLink {
  std::string name;
  Inertial inertial;  // in the link's frame; mass 0 where the source gives none
};

// The kinematic tree of an object or a robot: links, joints, and the pairs of links whose contacts
// are disabled. Immutable and thread-safe. Simulation (sim::ArticulatedBody), tasks
// (tasks::ArticulatedObject) and planning (robot::RobotModel) share one as a
// `std::shared_ptr<const KinematicModel>` and add only what is theirs; the indices of links and
// joints are the same in all of them.
class KinematicModel {
 public:
  // `links`: the root first; joints[i] leads to links[i + 1], and parents precede their children.
  // Excluded pairs with an unknown link are left out: the model may be a part of a larger one.
  // Throws core::Error, naming the element, if there is no link, the number of joints is not one
  // less, a joint's child or parent is not as above, or two links or two joints share a name.
  KinematicModel(std::string name, std::vector<KinematicLink> links, std::vector<Joint> joints,
                 const std::vector<ExcludedPair>& excluded_pairs = {});

  const std::string& name() const { return name_; }
  const std::vector<KinematicLink>& links() const { return links_; }
  const std::vector<Joint>& joints() const { return joints_; }
  // Returns the parent link of each joint. (joints)
  const std::vector<int>& parents() const { return parents_; }
  // Returns the parent of a link; -1 for the root.
  int ParentLink(int link) const {
    return link == 0 ? -1 : parents_[static_cast<std::size_t>(link) - 1];
  }
  // Returns the joints that are not fixed, in order, as indices into joints().
  const std::vector<int>& moving_joints() const { return moving_joints_; }
  // Returns the pairs of links whose contacts are disabled, the lesser index first.
  const std::set<std::pair<int, int>>& excluded_pairs() const { return excluded_pairs_; }

  // Return the index by name, or -1 if there is none.
  int FindLink(const std::string& name) const;
  int FindJoint(const std::string& name) const;
  // Return the index by name. Throw core::Error for an unknown one.
  int LinkIndex(const std::string& name) const;
  int JointIndex(const std::string& name) const;

  // Returns, by link, true if it is `link` or one of its descendants.
  std::vector<bool> Subtree(int link) const;
  // Returns true if all joints between two links are fixed.
  bool RigidlyJoined(int link_a, int link_b) const;

  // Returns the pose of each link in the root's frame for joint positions (rad or m, by joint;
  // those of fixed joints are ignored). A mimic joint follows its leader's position, regardless of
  // its own; a leader that does not exist counts as 0. Throws core::Error for a wrong length.
  std::vector<Eigen::Isometry3d> LinkPoses(const std::vector<double>& positions) const;

 private:
  std::string name_;
  std::vector<KinematicLink> links_;
  std::vector<Joint> joints_;
  std::vector<int> parents_;        // (joints)
  std::vector<int> leaders_;        // (joints); -1 if the joint is no mimic joint or has no leader
  std::vector<int> moving_joints_;  // indices into joints_
  std::set<std::pair<int, int>> excluded_pairs_;
};

// Make the model of a description; shapes are left out. Throw the errors of the constructor.
std::shared_ptr<const KinematicModel> MakeKinematicModel(const UrdfModel& model);
std::shared_ptr<const KinematicModel> MakeKinematicModel(const ArticulatedAsset& asset);

}  // namespace simwright::assets
