#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/rigid_mesh.h"
#include "skills/skill.h"

namespace simwright::skills {

// Segmentation ids. Those of objects follow from their index in SkillVariant::model, so that they
// are the same in all variants that list their objects in the same order.
inline constexpr std::int32_t kBackdropLabel = 0;  // floor and walls
inline constexpr std::int32_t kRobotLabel = 1;     // links before the gripper
inline constexpr std::int32_t kGripperLabel = 2;   // the link that carries the fingers, and on
constexpr std::int32_t ObjectLabel(int object) {
  return 3 + 2 * object;
}
// The links of an object that the joint of the interaction target moves: the drawer to be opened,
// with its handle. The other links have ObjectLabel.
constexpr std::int32_t TargetLinkLabel(int object) {
  return 4 + 2 * object;
}

// An entry of the legend of segmentation ids.
struct LabelName {
  std::int32_t label = 0;
  std::string name;        // "floor", "robot", "gripper", "microwave", "microwave/door"
  bool is_target = false;  // the object or link that the skill acts on
};

// The visual shapes of a skill's robot and objects, read and prepared once, shared by all episodes.
// Immutable and thread-safe.
class SkillVisuals {
 public:
  // The shapes of one link.
  struct Piece {
    std::shared_ptr<const render::RigidMesh> mesh;  // link frame
    int object = -1;                                // in SkillVariant::model; -1: the robot
    int link = 0;  // of the object's kinematic model, or in the robot's urdf.links
    std::int32_t label = 0;
  };

  // Reads the mesh files, each once. Throws core::Error, naming the file, if one cannot be read.
  explicit SkillVisuals(const Skill& skill);

  // Returns the pieces of a variant: the robot's, then those of the objects that it places.
  const std::vector<Piece>& Pieces(int variant) const {
    return pieces_[static_cast<std::size_t>(variant)];
  }
  // Returns the ids of a variant with their names, ascending, and -1, "nothing", first.
  const std::vector<LabelName>& Legend(int variant) const {
    return legends_[static_cast<std::size_t>(variant)];
  }

 private:
  std::vector<std::vector<Piece>> pieces_;       // by variant
  std::vector<std::vector<LabelName>> legends_;  // by variant
};

// Returns, by link of the robot's URDF, true if it belongs to the gripper: the link that carries
// the fingers and its descendants.
std::vector<bool> GripperLinks(const robot::RobotModel& robot);

}  // namespace simwright::skills
