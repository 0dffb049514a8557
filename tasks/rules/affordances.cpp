#include "tasks/rules/affordances.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <vector>

namespace simwright::tasks {
namespace {

constexpr double kPushable = 8.0;           // kg
constexpr double kRimHeight = 0.3;          // m; a higher object is not grasped by its rim
constexpr double kLongestAffordance = 0.5;  // m; longest object that one gripper carries
constexpr double kMargin = 0.01;            // m
constexpr double kMinHeight = 0.015;  // m; lowest object that fingers can grasp from the floor
constexpr double kMinTurn = 0.6;      // rad; smallest range of a door
constexpr double kMinSlide = 0.06;    // m; smallest range of a drawer
constexpr double kMinPress = 0.002;   // m

template <std::size_t N>
bool Holds(const std::string& text, const std::array<const char*, N>& words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

// Returns the label, or else the link's own name, in lower case.
std::string Called(const ArticulatedObject& object, const ObjectJoint& joint) {
  const ObjectLink& link = object.links[static_cast<std::size_t>(joint.link)];
  std::string name = link.label.empty() ? object.LinkName(joint.link) : link.label;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

// Returns the bounds of the object's highest points, within 3 mm: its support surface. If `lowest`
// is true, returns those of the lowest points: its footprint.
Eigen::AlignedBox2d Top(const ArticulatedObject& object, bool lowest) {
  const std::vector<Eigen::Isometry3d> poses = LinkPosesOf(object, RestPositions(object));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : object.links[0].extreme_points) box.extend(poses[0] * point);
  Eigen::AlignedBox2d top;
  for (const Eigen::Vector3d& point : object.links[0].extreme_points) {
    const Eigen::Vector3d at = poses[0] * point;
    const double away = lowest ? at.z() - box.min().z() : box.max().z() - at.z();
    if (away < 3e-3) top.extend(Eigen::Vector2d(at.head<2>()));
  }
  return top;
}

Eigen::Vector3d OpeningOf(const ArticulatedObject& holder, const Receptacle& receptacle) {
  return LinkPosesOf(holder, RestPositions(holder))[static_cast<std::size_t>(receptacle.link)]
             .linear() *
         receptacle.opening;
}

bool OpensUpwards(const ArticulatedObject& object) {
  return std::any_of(
      object.receptacles.begin(), object.receptacles.end(),
      [&](const Receptacle& receptacle) { return OpeningOf(object, receptacle).z() > 0.7; });
}

}  // namespace

JointUse GetJointUse(const ArticulatedObject& object, const ObjectJoint& joint) {
  const std::string name = Called(object, joint);
  const bool slides = joint.type == reward::RewardJointType::kPrismatic;
  const double range = joint.upper - joint.lower;
  if (joint.leader >= 0 || range < (slides ? kMinPress : 0.1)) return JointUse::kNone;
  if (slides && Holds(name, std::array{"door", "window", "sash", "shutter", "screen"})) {
    return JointUse::kSlide;
  }
  if (Holds(name, std::array{"door", "lid", "drawer", "window", "sash", "cover", "flap", "shutter",
                             "screen", "tray", "rack"})) {
    return JointUse::kOpen;
  }
  if (Holds(name, std::array{"button", "key", "pedal"})) return JointUse::kPress;
  const int parent = object.kinematics->ParentLink(joint.link);
  const bool on_a_door = parent > 0 && object.links[static_cast<std::size_t>(parent)].joint >= 0;
  if (on_a_door && !slides && Holds(name, std::array{"knob", "lever", "handle"})) {
    return JointUse::kLatch;
  }
  if (Holds(name, std::array{"knob", "dial", "valve", "tap", "faucet", "wheel"})) {
    return JointUse::kTurn;
  }
  if (Holds(name, std::array{"lever", "handle", "spout"})) {
    return slides ? JointUse::kPress : JointUse::kTurn;
  }
  if (Holds(name, std::array{"switch", "toggle"})) return JointUse::kSwitch;
  if (slides) return range >= kMinSlide ? JointUse::kOpen : JointUse::kPress;
  return range >= kMinTurn ? JointUse::kOpen : JointUse::kSwitch;
}

std::string PartName(const ArticulatedObject& object, const ObjectJoint& joint) {
  const std::string kind = Called(object, joint);
  int same = 0, number = 0;
  for (const ObjectJoint& other : object.joints) {
    if (Called(object, other) != kind) continue;
    ++same;
    if (&other == &joint) number = same;
  }
  std::string name = kind;
  std::replace(name.begin(), name.end(), '_', ' ');
  return same > 1 ? name + " " + std::to_string(number) : name;
}

bool HasHandle(const ArticulatedObject& object) {
  constexpr double kOut = 0.02;  // m
  Eigen::AlignedBox3d bulk;
  std::vector<Eigen::AlignedBox3d> slim;
  for (const Eigen::AlignedBox3d& part : object.links[0].parts) {
    Eigen::Vector3d sides = part.sizes();
    std::sort(sides.data(), sides.data() + 3);
    if (sides[1] > kMaxGraspWidth) {
      bulk.extend(part);
    } else {
      slim.push_back(part);
    }
  }
  return std::any_of(slim.begin(), slim.end(), [&](const Eigen::AlignedBox3d& part) {
    if (bulk.isEmpty()) {
      Eigen::Vector3d sides = part.sizes();
      std::sort(sides.data(), sides.data() + 3);
      return sides[2] >= 2.0 * sides[1];
    }
    const Eigen::Vector3d beyond = (part.max() - bulk.max()).cwiseMax(bulk.min() - part.min());
    return beyond.head<2>().maxCoeff() >= kOut;
  });
}

bool CanBeLifted(const ArticulatedObject& object) {
  if (object.articulated() || object.mass > kPayload) return false;
  if (object.graspable) return *object.graspable;
  const Eigen::Vector3d size = object.box.sizes();
  if (size.maxCoeff() > kLongestAffordance || size.z() < kMinHeight) return false;
  const bool narrow = size.head<2>().minCoeff() <= kMaxGraspWidth;
  return narrow || (OpensUpwards(object) && size.z() <= kRimHeight) || HasHandle(object);
}

UnusableReason ExplainUnusable(const ArticulatedObject& object) {
  char text[160];
  if (object.articulated()) {
    const bool used = std::any_of(
        object.joints.begin(), object.joints.end(),
        [&](const ObjectJoint& joint) { return GetJointUse(object, joint) != JointUse::kNone; });
    if (used) return {};
    return {"none of its joints moves far enough for the gripper: 0.1 rad or 2 mm",
            "widen its limits"};
  }
  if (CanBeLifted(object) || CanBePushed(object)) return {};
  const Eigen::Vector3d size = object.box.sizes();
  if (object.box.isEmpty()) return {"it has no shape", "give it collision shapes"};
  if (object.mass > kPushable) {
    std::snprintf(text, sizeof(text), "its mass of %.3g kg exceeds the pushable %.3g kg",
                  object.mass, kPushable);
    return {text, "give its true --mass or --size on import"};
  }
  if (size.maxCoeff() > 2.0 * kLongestAffordance) {
    std::snprintf(text, sizeof(text), "its size of %.3g m exceeds the pushable %.3g m",
                  size.maxCoeff(), 2.0 * kLongestAffordance);
    return {text, "give its true --size on import"};
  }
  if (object.graspable) {
    return {
        "none of its proved grasps clears the plane on which it stands, and it is too flat to "
        "push",
        "place it on a support that its edge overhangs, or try `simwright grasps --count 1000`"};
  }
  std::snprintf(text, sizeof(text), "it is %.3g m high, too flat to grasp or to push", size.z());
  return {text, "place it on a support, or make it thicker"};
}

bool CanBePushed(const ArticulatedObject& object) {
  return !object.articulated() && object.mass <= kPushable && object.height() >= 0.02 &&
         object.box.sizes().maxCoeff() <= 2.0 * kLongestAffordance;
}

bool CanPour(const ArticulatedObject& object) {
  const bool spout = Holds(
      object.category, std::array{"teapot", "kettle", "jug", "pitcher", "carafe", "watering can",
                                  "coffee pot", "creamer", "gravy boat", "bottle"});
  return CanBeLifted(object) && (OpensUpwards(object) || spout) &&
         object.height() >= 0.5 * object.box.sizes().head<2>().minCoeff();
}

bool CanStandOn(const ArticulatedObject& object, const ArticulatedObject& holder) {
  const Eigen::AlignedBox2d top = Top(holder, false), footprint = Top(object, true);
  if (top.isEmpty() || footprint.isEmpty() || OpensUpwards(holder)) return false;
  const Eigen::Vector2d whole = holder.box.sizes().head<2>();
  const bool level = (top.sizes().array() >= 0.6 * whole.array()).all();
  return level && (footprint.sizes().array() + kMargin <= top.sizes().array()).all();
}

bool FitsInto(const ArticulatedObject& object, const ArticulatedObject& holder, int index) {
  const Receptacle& receptacle = holder.receptacles[static_cast<std::size_t>(index)];
  const Eigen::Vector3d opening = OpeningOf(holder, receptacle);
  if (opening.z() < -0.3) return false;
  const Eigen::Isometry3d pose =
      LinkPosesOf(holder, RestPositions(holder))[static_cast<std::size_t>(receptacle.link)];
  const Eigen::Vector3d space = (pose.linear() * receptacle.box.sizes()).cwiseAbs();
  const Eigen::Vector3d size = object.box.sizes();
  const bool upwards = opening.z() > 0.7;
  // An object may protrude from a top-opening receptacle, as a spoon from a cup, unless a door
  // closes it.
  const double height = upwards && receptacle.door < 0 ? 2.0 * space.z() : space.z() - kMargin;
  return size.x() + kMargin <= space.x() && size.y() + kMargin <= space.y() && size.z() <= height;
}

}  // namespace simwright::tasks
