#include "manipulation/parallel_gripper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "assets/kinematic_model.h"
#include "assets/urdf_reader.h"
#include "core/error.h"
#include "robot/panda_model.h"
#include "sim/articulated_body.h"

namespace simwright::manipulation {
namespace fs = std::filesystem;
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kOpposed = 0.99;       // cosine between the fingers' directions
constexpr double kTipInset = 0.01;      // m from the fingertips to a tool frame that is not given
constexpr double kGuessedForce = 20.0;  // N
constexpr const char* kNeeds = "give a gripper whose two fingers slide towards each other";

// The links of a gripper with their shapes, and their poses when it is open, in any one frame.
struct GripperLinks {
  const sim::ArticulatedBody* body = nullptr;
  std::vector<Isometry3d> poses;  // by link
  std::array<std::vector<int>, 2> fingers;
  std::vector<int> palm;
};

core::TriangleMesh Moved(core::TriangleMesh mesh, const Isometry3d& pose) {
  core::Transform(Eigen::Affine3d(pose), &mesh);
  return mesh;
}

std::vector<core::TriangleMesh> PartsOf(const GripperLinks& links, const std::vector<int>& which,
                                        const Isometry3d& tool_from_frame) {
  std::vector<core::TriangleMesh> parts;
  for (const int link : which) {
    const auto l = static_cast<size_t>(link);
    for (const core::TriangleMesh& part : links.body->links[l].parts) {
      parts.push_back(Moved(part, tool_from_frame * links.poses[l]));
    }
  }
  return parts;
}

// Returns the range of the vertices along `axis`, m.
std::pair<double, double> Extent(const std::vector<core::TriangleMesh>& parts,
                                 const Vector3d& axis) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const core::TriangleMesh& part : parts) {
    for (const Vector3d& vertex : part.vertices) {
      low = std::min(low, vertex.dot(axis));
      high = std::max(high, vertex.dot(axis));
    }
  }
  return {low, high};
}

// Fills in the shapes. fingers[0] becomes the one at positive y.
void SetShapes(const GripperLinks& links, const Isometry3d& tool_from_frame,
               ParallelGripper* gripper) {
  sim::GripperModel& model = gripper->model;
  for (size_t i = 0; i < 2; ++i) {
    model.fingers[i] = PartsOf(links, links.fingers[i], tool_from_frame);
    if (!model.fingers[i].empty()) continue;
    throw core::Error("a finger has no collision shape", model.name, "add a <collision> to it");
  }
  std::pair<double, double> first = Extent(model.fingers[0], Vector3d::UnitY());
  std::pair<double, double> second = Extent(model.fingers[1], Vector3d::UnitY());
  if (first.first + first.second < second.first + second.second) {
    std::swap(model.fingers[0], model.fingers[1]);
    std::swap(first, second);
    std::swap(gripper->joints[0], gripper->joints[1]);
  }
  model.max_opening = first.first - second.second;
  if (!(model.max_opening > 1e-3)) {
    throw core::Error("the open fingers overlap along the closing axis", model.name, kNeeds);
  }
  for (const int link : links.palm) {
    const auto l = static_cast<size_t>(link);
    const sim::RigidBody& body = links.body->links[l];
    const Isometry3d pose = tool_from_frame * links.poses[l];
    for (size_t p = 0; p < body.parts.size(); ++p) {
      model.palm.push_back(Moved(body.parts[p], pose));
      std::optional<sim::Capsule> capsule;
      if (p < body.capsules.size()) capsule = body.capsules[p];
      if (capsule) *capsule = {pose * capsule->a, pose * capsule->b, capsule->radius};
      model.palm_capsules.push_back(capsule);
    }
  }
}

double PadFriction(const GripperLinks& links) {
  double friction = HUGE_VAL;
  for (const auto& finger : links.fingers) {
    for (const int link : finger) {
      const sim::RigidBody& body = links.body->links[static_cast<size_t>(link)];
      if (!body.parts.empty()) friction = std::min(friction, body.friction);
    }
  }
  return friction;
}

std::vector<int> SubtreeLinks(const assets::KinematicModel& kinematics, int link) {
  std::vector<int> links;
  const std::vector<bool> in = kinematics.Subtree(link);
  for (size_t i = 0; i < in.size(); ++i) {
    if (in[i]) links.push_back(static_cast<int>(i));
  }
  return links;
}

// A URDF of a gripper alone.
class GripperUrdf {
 public:
  GripperUrdf(const assets::UrdfModel& urdf, std::string place)
      : urdf_(urdf),
        place_(std::move(place)),
        kinematics_(assets::MakeKinematicModel(urdf)),
        body_(sim::ArticulatedBodyFrom(urdf, kinematics_)) {}

  ParallelGripper Read() {
    FindFingers();
    FindOpenPositions();
    if (const auto& mimic = Joint(1).mimic) {
      const double leader = open_[static_cast<size_t>(joints_[0])];
      open_[static_cast<size_t>(joints_[1])] = mimic->multiplier * leader + mimic->offset;
    }
    links_.poses = kinematics_->LinkPoses(open_);
    ParallelGripper gripper;
    gripper.model.name = urdf_.name;
    gripper.findings = urdf_.findings;
    for (size_t i = 0; i < 2; ++i) {
      const assets::Joint& joint = Joint(i);
      const double open = open_[static_cast<size_t>(joints_[i])];
      const double closing = std::abs(open - joint.lower) < std::abs(open - joint.upper) ? 1 : -1;
      gripper.joints.push_back({joint.name, open, closing});
    }
    const int base = kinematics_->parents()[static_cast<size_t>(joints_[0])];
    gripper.base_link = kinematics_->links()[static_cast<size_t>(base)].name;
    const Isometry3d root_from_tool = ToolFrame(&gripper.findings);
    gripper.tool_from_base = root_from_tool.inverse() * links_.poses[static_cast<size_t>(base)];
    SetShapes(links_, root_from_tool.inverse(), &gripper);
    gripper.model.friction = PadFriction(links_);
    gripper.model.force = Force(&gripper.findings);
    return gripper;
  }

 private:
  const assets::Joint& Joint(size_t i) const {
    return kinematics_->joints()[static_cast<size_t>(joints_[i])];
  }
  [[noreturn]] void Fail(const std::string& what) const { throw core::Error(what, place_, kNeeds); }

  void FindFingers() {
    joints_ = kinematics_->moving_joints();
    if (joints_.size() != 2) {
      Fail("a parallel gripper has two moving joints, this one " + std::to_string(joints_.size()));
    }
    const std::vector<Isometry3d> poses =
        kinematics_->LinkPoses(std::vector<double>(kinematics_->joints().size(), 0.0));
    std::array<Vector3d, 2> axes;
    for (size_t i = 0; i < 2; ++i) {
      if (Joint(i).type != assets::JointType::kPrismatic) {
        Fail("joint '" + Joint(i).name + "' is not prismatic");
      }
      if (!(Joint(i).upper - Joint(i).lower > 1e-3)) {
        Fail("joint '" + Joint(i).name + "' has no range");
      }
      axes[i] = poses[static_cast<size_t>(joints_[i]) + 1].linear() * Joint(i).axis;
      links_.fingers[i] = SubtreeLinks(*kinematics_, joints_[i] + 1);
    }
    axis_ = axes[0];
    if (std::abs(axes[0].dot(axes[1])) < kOpposed) Fail("the fingers do not slide along one line");
    for (size_t l = 0; l < kinematics_->links().size(); ++l) {
      const auto link = static_cast<int>(l);
      const auto moves = [&](const std::vector<int>& finger) {
        return std::find(finger.begin(), finger.end(), link) != finger.end();
      };
      if (!moves(links_.fingers[0]) && !moves(links_.fingers[1])) links_.palm.push_back(link);
    }
    links_.body = &body_;
  }

  // Finds the ends of the joints' ranges at which the fingers are farthest apart.
  void FindOpenPositions() {
    double widest = -HUGE_VAL;
    for (const bool first_high : {false, true}) {
      for (const bool second_high : {false, true}) {
        std::vector<double> positions(kinematics_->joints().size(), 0.0);
        positions[static_cast<size_t>(joints_[0])] = first_high ? Joint(0).upper : Joint(0).lower;
        positions[static_cast<size_t>(joints_[1])] = second_high ? Joint(1).upper : Joint(1).lower;
        links_.poses = kinematics_->LinkPoses(positions);
        const auto a = Extent(PartsOf(links_, links_.fingers[0], Isometry3d::Identity()), axis_);
        const auto b = Extent(PartsOf(links_, links_.fingers[1], Isometry3d::Identity()), axis_);
        const double gap = std::max(a.first - b.second, b.first - a.second);
        if (gap <= widest) continue;
        widest = gap;
        open_ = positions;
      }
    }
  }

  Isometry3d ToolFrame(core::Findings* findings) const {
    for (size_t l = 0; l < kinematics_->links().size(); ++l) {
      const std::string& name = kinematics_->links()[l].name;
      if (name.find("tcp") == std::string::npos && name.find("tool") == std::string::npos) continue;
      Isometry3d tool = links_.poses[l];
      if (std::abs(tool.linear().col(0).dot(axis_)) > kOpposed) {
        tool.rotate(Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()));
      }
      if (std::abs(tool.linear().col(1).dot(axis_)) > kOpposed) return tool;
      Fail("neither x nor y of the tool frame '" + name + "' is the fingers' closing axis");
    }
    findings->push_back({"gripper-tool-guessed", core::Severity::kWarning, place_,
                         "has no link named 'tcp' or 'tool': the tool frame is placed between the "
                         "fingers, 1 cm behind their tips",
                         0.0, "add a link for it to the URDF"});
    return GuessedToolFrame();
  }

  Isometry3d GuessedToolFrame() const {
    std::vector<core::TriangleMesh> fingers =
        PartsOf(links_, links_.fingers[0], Isometry3d::Identity());
    for (auto& part : PartsOf(links_, links_.fingers[1], Isometry3d::Identity())) {
      fingers.push_back(std::move(part));
    }
    Eigen::AlignedBox3d box, palm;
    for (const core::TriangleMesh& part : fingers) box.extend(core::Bounds(part));
    for (const auto& part : PartsOf(links_, links_.palm, Isometry3d::Identity())) {
      palm.extend(core::Bounds(part));
    }
    Vector3d approach = palm.isEmpty() ? Vector3d(box.center()) : box.center() - palm.center();
    approach -= approach.dot(axis_) * axis_;
    if (!(approach.norm() > 1e-3)) Fail("the side of the palm cannot be told without a tool frame");
    approach.normalize();
    Isometry3d tool = Isometry3d::Identity();
    tool.linear() << axis_.cross(approach), axis_, approach;
    const double tip = Extent(fingers, approach).second - kTipInset;
    tool.translation() = box.center() + (tip - box.center().dot(approach)) * approach;
    return tool;
  }

  double Force(core::Findings* findings) const {
    const double effort = std::min(Joint(0).effort, Joint(1).effort);
    if (effort > 0.0) return effort;
    findings->push_back({"gripper-force-guessed", core::Severity::kWarning, place_,
                         "the finger joints have no effort limit: each presses with 20 N",
                         kGuessedForce, "add effort to their <limit>"});
    return kGuessedForce;
  }

  const assets::UrdfModel& urdf_;
  std::string place_;
  std::shared_ptr<const assets::KinematicModel> kinematics_;
  sim::ArticulatedBody body_;
  std::vector<int> joints_;
  Vector3d axis_ = Vector3d::UnitY();  // root frame
  std::vector<double> open_;           // by joint
  GripperLinks links_;
};

}  // namespace

double ParallelGripper::JointPosition(size_t joint, double opening) const {
  const Joint& one = joints.at(joint);
  return one.open + one.closing * 0.5 * (model.max_opening - opening);
}

ParallelGripper GripperOf(const robot::RobotModel& robot) {
  const robot::Gripper& fingers = robot.gripper;
  if (fingers.joints.size() != 2 || fingers.links.size() != 2) {
    throw core::Error("the gripper does not have two fingers", robot.name, kNeeds);
  }
  const sim::ArticulatedBody body = sim::ArticulatedBodyFrom(robot.urdf, robot.kinematics);
  GripperLinks links;
  links.body = &body;
  links.poses = robot.LinkPoses(Eigen::VectorXd::Zero(robot.arm.size()), fingers.open);
  const Isometry3d root_from_tool = links.poses[static_cast<size_t>(robot.tool_link)];
  ParallelGripper gripper;
  gripper.model.name = robot.name;
  std::array<double, 2> along{};
  for (size_t i = 0; i < 2; ++i) {
    const assets::Joint& joint = robot.urdf.joints[static_cast<size_t>(fingers.joints[i])];
    links.fingers[i] = {fingers.links[i]};
    const Vector3d axis =
        links.poses[static_cast<size_t>(fingers.joints[i]) + 1].linear() * joint.axis;
    along[i] = axis.dot(root_from_tool.linear().col(1));
    if (joint.type != assets::JointType::kPrismatic || std::abs(along[i]) < kOpposed) {
      throw core::Error(
          "finger joint '" + joint.name + "' does not slide along the tool frame's y axis",
          robot.name, kNeeds);
    }
    gripper.joints.push_back({joint.name, fingers.open, fingers.open > fingers.closed ? -1. : 1.});
  }
  if (along[0] * along[1] > 0.0) {
    throw core::Error("both fingers slide in the same direction", robot.name, kNeeds);
  }
  const std::vector<int> hand = SubtreeLinks(*robot.kinematics, robot.arm_joints.back() + 1);
  for (const int link : hand) {
    if (link != fingers.links[0] && link != fingers.links[1]) links.palm.push_back(link);
  }
  const int base = robot.kinematics->parents()[static_cast<size_t>(fingers.joints[0])];
  gripper.base_link = robot.urdf.links[static_cast<size_t>(base)].name;
  gripper.tool_from_base = root_from_tool.inverse() * links.poses[static_cast<size_t>(base)];
  SetShapes(links, root_from_tool.inverse(), &gripper);
  gripper.model.force = fingers.grip_force;
  gripper.model.friction = PadFriction(links);
  return gripper;
}

ParallelGripper ReadGripper(const std::string& name_or_urdf) {
  if (name_or_urdf == "panda") return GripperOf(robot::Panda(false));
  const fs::path path(name_or_urdf);
  if (!fs::is_regular_file(path)) {
    throw core::Error("no such gripper", name_or_urdf, "give panda or the file of a URDF");
  }
  fs::path side = path;
  if (fs::is_regular_file(side.replace_extension(".json"))) {
    return GripperOf(robot::ReadRobot(path));
  }
  return GripperUrdf(assets::ReadUrdf(path), path.string()).Read();
}

}  // namespace simwright::manipulation
