#include "tasks/articulated_object.h"

#include <algorithm>
#include <map>
#include <numbers>

#include "core/error.h"
#include "tasks/receptacles.h"
#include "tasks/reward_names.h"

namespace simwright::tasks {
namespace {

constexpr int kAround = 36;  // directions about z: the width of a round object errs by 0.4 %

// Returns 98 directions, the axes, the diagonals and those between them, and more about z.
std::vector<Eigen::Vector3d> OutwardDirections() {
  std::vector<Eigen::Vector3d> directions;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const int largest = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const bool multiple = largest == 2 && x % 2 == 0 && y % 2 == 0 && z % 2 == 0;
        if (largest > 0 && !multiple) directions.emplace_back(x, y, z);
      }
    }
  }
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * M_PI * i / kAround;
    directions.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  return directions;
}

// Returns the extreme points along OutwardDirections, each once.
std::vector<Eigen::Vector3d> Outermost(const std::vector<const core::TriangleMesh*>& meshes) {
  std::vector<Eigen::Vector3d> outline;
  for (const Eigen::Vector3d& direction : OutwardDirections()) {
    const Eigen::Vector3d* farthest = nullptr;
    for (const core::TriangleMesh* mesh : meshes) {
      for (const Eigen::Vector3d& vertex : mesh->vertices) {
        if (farthest == nullptr || direction.dot(vertex) > direction.dot(*farthest)) {
          farthest = &vertex;
        }
      }
    }
    if (farthest == nullptr) return {};
    if (std::find(outline.begin(), outline.end(), *farthest) == outline.end()) {
      outline.push_back(*farthest);
    }
  }
  return outline;
}

ObjectLink LinkOf(const assets::UrdfLink& source, const assets::SemanticModel& model) {
  ObjectLink link;
  const auto known = model.semantics.find(source.name);
  if (known != model.semantics.end()) link.label = known->second.label;
  std::vector<const core::TriangleMesh*> meshes;
  for (const assets::UrdfShape& shape : source.collisions) meshes.push_back(&shape.mesh);
  if (meshes.empty()) {
    for (const assets::UrdfShape& shape : source.visuals) meshes.push_back(&shape.mesh);
  }
  link.extreme_points = Outermost(meshes);
  for (const core::TriangleMesh* mesh : meshes) link.parts.push_back(core::Bounds(*mesh));
  for (const Eigen::Vector3d& point : link.extreme_points) link.box.extend(point);
  if (!link.box.isEmpty()) link.middle = link.box.center();
  if (source.inertial) link.mass = source.inertial->mass;
  return link;
}

bool IsHandle(const std::string& label) {
  return label == "handle" || label == "knob" || label == "lever" || label == "pull";
}

// Returns the first handle on the part that the joint moves, fixed or movable; else the link
// itself.
int GripOf(const ArticulatedObject& object, int moved) {
  const std::vector<bool> carried = object.kinematics->Subtree(moved);
  for (std::size_t i = static_cast<std::size_t>(moved) + 1; i < object.links.size(); ++i) {
    const ObjectLink& link = object.links[i];
    if (carried[i] && IsHandle(link.label) && !link.extreme_points.empty())
      return static_cast<int>(i);
  }
  return moved;
}

void AddCavities(const assets::SemanticModel& model, ArticulatedObject* object) {
  for (std::size_t i = 0; i < model.model.links.size(); ++i) {
    std::vector<core::TriangleMesh> parts;
    for (const assets::UrdfShape& shape : model.model.links[i].collisions) {
      parts.push_back(shape.mesh);
    }
    for (const Receptacle& receptacle : FindReceptacles(static_cast<int>(i), parts)) {
      object->receptacles.push_back(receptacle);
    }
  }
  std::stable_sort(
      object->receptacles.begin(), object->receptacles.end(),
      [](const Receptacle& a, const Receptacle& b) { return a.box.volume() > b.box.volume(); });
  AssignDoors(object);
}

}  // namespace

int ArticulatedObject::FindLink(const std::string& wanted) const {
  return kinematics->FindLink(wanted);
}

int ArticulatedObject::FindJoint(const std::string& wanted) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == wanted) return static_cast<int>(i);
  }
  return -1;
}

ArticulatedObject MakeArticulatedObject(const std::string& name,
                                        const assets::SemanticModel& model) {
  ArticulatedObject object;
  object.name = name;
  object.category = model.category;
  object.graspable = model.graspable;
  object.kinematics = assets::MakeKinematicModel(model.model);
  std::map<std::string, reward::RewardJoint> moving;  // with the limits that programs read
  for (const reward::RewardJoint& joint : MakeRewardAsset(name, model.model).joints) {
    if (joint.type != reward::RewardJointType::kFixed) moving[joint.name] = joint;
  }
  for (std::size_t i = 0; i < model.model.links.size(); ++i) {
    ObjectLink link = LinkOf(model.model.links[i], model);
    if (i > 0) {
      const assets::Joint& source = model.model.joints[i - 1];
      const auto joint = moving.find(source.name);
      if (joint != moving.end()) {
        link.joint = static_cast<int>(object.joints.size());
        ObjectJoint moves;
        moves.name = source.name;
        moves.type = joint->second.type;
        moves.link = static_cast<int>(i);
        moves.axis = source.axis;
        moves.lower = joint->second.lower;
        moves.upper = joint->second.upper;
        object.joints.push_back(moves);
      }
    }
    object.mass += link.mass;
    object.links.push_back(std::move(link));
  }
  for (const assets::Joint& source : model.model.joints) {
    const int follower = object.FindJoint(source.name);
    if (follower < 0 || !source.mimic) continue;
    ObjectJoint& joint = object.joints[static_cast<std::size_t>(follower)];
    joint.leader = object.FindJoint(source.mimic->joint);
    joint.multiplier = source.mimic->multiplier;
    joint.offset = source.mimic->offset;
  }
  for (ObjectJoint& joint : object.joints) joint.grasp_link = GripOf(object, joint.link);
  const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(object, RestPositions(object));
  for (std::size_t i = 0; i < object.links.size(); ++i) {
    for (const Eigen::Vector3d& point : object.links[i].extreme_points)
      object.box.extend(poses[i] * point);
  }
  if (object.box.isEmpty()) object.box.extend(Eigen::Vector3d::Zero());
  AddCavities(model, &object);
  return object;
}

double JointPosition(const ArticulatedObject& object, const std::vector<double>& positions,
                     std::size_t index) {
  const ObjectJoint& joint = object.joints[index];
  if (joint.leader < 0) return positions[index];
  // A mimic joint whose leader is itself a mimic joint follows the leader's own position: chains
  // are not resolved.
  return joint.multiplier * positions[static_cast<std::size_t>(joint.leader)] + joint.offset;
}

std::vector<Eigen::Isometry3d> LinkPosesOf(const ArticulatedObject& object,
                                           const std::vector<double>& positions) {
  std::vector<Eigen::Isometry3d> poses;
  LinkPosesOf(object, positions, &poses);
  return poses;
}

void LinkPosesOf(const ArticulatedObject& object, const std::vector<double>& positions,
                 std::vector<Eigen::Isometry3d>* result) {
  if (positions.size() != object.joints.size()) {
    throw core::Error("got " + std::to_string(positions.size()) + " joint positions, there are " +
                          std::to_string(object.joints.size()) + " joints",
                      object.name);
  }
  std::vector<Eigen::Isometry3d>& poses = *result;
  poses.assign(object.links.size(), Eigen::Isometry3d::Identity());
  const assets::KinematicModel& tree = *object.kinematics;
  for (std::size_t i = 1; i < object.links.size(); ++i) {
    const ObjectLink& link = object.links[i];
    poses[i] = poses[static_cast<std::size_t>(tree.parents()[i - 1])] *
               tree.joints()[i - 1].parent_from_joint;
    if (link.joint < 0) continue;
    const ObjectJoint& joint = object.joints[static_cast<std::size_t>(link.joint)];
    const double q = JointPosition(object, positions, static_cast<std::size_t>(link.joint));
    if (joint.type == reward::RewardJointType::kPrismatic) {
      poses[i].translate(q * joint.axis);
    } else {
      poses[i].rotate(Eigen::AngleAxisd(q, joint.axis));
    }
  }
}

std::vector<double> RestPositions(const ArticulatedObject& object) {
  std::vector<double> positions;
  for (const ObjectJoint& joint : object.joints) positions.push_back(joint.rest());
  return positions;
}

}  // namespace simwright::tasks
