#include "certificate/grasp.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "certificate/body_lines.h"
#include "certificate/robot_clearance.h"
#include "manipulation/grasp_ranking.h"

namespace simwright::certificate {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kTouching = 5e-4;                // m between the open gripper and the body
constexpr double kBackedOff = 0.03;               // m behind the grasp, checked too
constexpr std::array kHeights = {0.5, 0.3, 0.7};  // of the body's height, for horizontal axes

// The offsets that are tried for a closing axis and an approach, in this order, until the palm is
// free of the body (m): the line of contact moves towards the palm, and the contacts towards the
// fingertips.
struct Offset {
  double line = 0.0, tip = 0.0;
};
constexpr std::array<Offset, 4> kOffsets = {
    {{0.0, 0.0}, {0.0, 0.006}, {0.006, 0.006}, {0.012, 0.006}}};

// A closing axis: a line through the body.
struct ClosingAxis {
  Vector3d point, direction;
};

double FingertipFriction(const robot::RobotModel& robot) {
  double friction = 1e9;
  for (const int link : robot.gripper.links) {
    friction = std::min(friction, robot.urdf.links[static_cast<size_t>(link)].friction);
  }
  return friction;
}

std::vector<ClosingAxis> ClosingAxes(const BodyModel& body, const BodyLines& lines,
                                     std::uint64_t seed, const GraspOptions& options) {
  std::vector<ClosingAxis> axes;
  const Vector3d middle = body.box.center();
  for (int i = 0; i < options.yaws; ++i) {
    const double yaw = std::numbers::pi * i / options.yaws;
    for (const double height : kHeights) {
      const double z = body.box.min().z() + height * body.box.sizes().z();
      axes.push_back({{middle.x(), middle.y(), z}, {std::cos(yaw), std::sin(yaw), 0.0}});
    }
  }
  core::Rng rng = core::StreamRng(seed, 0);
  for (int i = 0; i < options.surface_samples; ++i) {
    const auto sample = lines.SampleSurface(rng);
    if (sample) axes.push_back({sample->point, -sample->normal});
  }
  return axes;
}

// Finds grasps at one body.
class GraspSampler {
 public:
  GraspSampler(const BodyModel& body, const robot::RobotModel& robot, const GraspOptions& options)
      : body_(body),
        robot_(robot),
        options_(options),
        lines_(body),
        shapes_(robot),
        obstacles_(SceneOf(body)),
        clearance_(shapes_, obstacles_, Isometry3d::Identity(), {kTouching, kTouching, 0.0}) {
    const double cone = std::atan(FingertipFriction(robot) * body.friction);
    least_cosine_ = std::cos(std::min(cone, options.largest_angle));
    clearance_.IgnoreFloor();
  }

  std::vector<Grasp> Sample(std::uint64_t seed) {
    std::vector<Grasp> grasps;
    for (const ClosingAxis& axis : ClosingAxes(body_, lines_, seed, options_)) {
      if (!GraspableAt(axis.point, axis.direction)) continue;
      const Vector3d first = axis.direction.unitOrthogonal();
      for (int i = 0; i < options_.approaches; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / options_.approaches;
        const Vector3d approach = Eigen::AngleAxisd(angle, axis.direction) * first;
        AddGrasp(axis, approach, &grasps);
      }
    }
    return grasps;
  }

 private:
  static PlacedScene SceneOf(const BodyModel& body) {
    PlacedScene scene;
    scene.bodies.push_back({"body", std::shared_ptr<const BodyModel>(&body, [](auto*) {}),
                            Eigen::Isometry3d::Identity(), false});
    return scene;
  }

  std::optional<Chord> GraspableAt(const Vector3d& point, const Vector3d& direction) const {
    const auto chord = lines_.ChordAt(point, direction);
    if (!chord) return std::nullopt;
    const double width = chord->leave - chord->enter;
    if (width > robot_.gripper.MaxOpening() - 2.0 * options_.least_clearance) return std::nullopt;
    if (-chord->enter_normal.dot(direction) < least_cosine_) return std::nullopt;
    if (chord->leave_normal.dot(direction) < least_cosine_) return std::nullopt;
    return chord;
  }

  void AddGrasp(const ClosingAxis& axis, const Vector3d& approach, std::vector<Grasp>* grasps) {
    for (const Offset& offset : kOffsets) {
      const Vector3d point = axis.point - offset.line * approach;
      const auto chord = GraspableAt(point, axis.direction);
      if (!chord) continue;
      Grasp grasp;
      grasp.width = chord->leave - chord->enter;
      const Vector3d between = point + 0.5 * (chord->enter + chord->leave) * axis.direction;
      grasp.body_from_tool.linear().col(0) = axis.direction.cross(approach);
      grasp.body_from_tool.linear().col(1) = axis.direction;
      grasp.body_from_tool.linear().col(2) = approach;
      grasp.body_from_tool.translation() = between - offset.tip * approach;
      const double opening = grasp.width + 2.0 * options_.finger_clearance;
      const robot::Gripper& gripper = robot_.gripper;
      grasp.leader = gripper.closed + (gripper.open - gripper.closed) *
                                          std::min(1.0, opening / gripper.MaxOpening());
      const Vector3d from_center = between - body_.center_of_mass;
      grasp.center_offset = (from_center - from_center.dot(axis.direction) * axis.direction).norm();
      if (TouchesOpen(grasp)) continue;
      grasps->push_back(grasp);
      return;
    }
  }

  // Returns true if the open gripper touches the body at the grasp or a little behind it.
  bool TouchesOpen(const Grasp& grasp) {
    clearance_.SetLeader(grasp.leader);
    for (const double back : {0.0, kBackedOff}) {
      Isometry3d tool = grasp.body_from_tool;
      tool.translation() -= back * tool.linear().col(2);
      if (clearance_.GripperHit(tool) != kFree) return true;
    }
    return false;
  }

  const BodyModel& body_;
  const robot::RobotModel& robot_;
  const GraspOptions& options_;
  BodyLines lines_;
  RobotShapes shapes_;
  Obstacles obstacles_;
  RobotClearance clearance_;
  double least_cosine_ = 1.0;
};

}  // namespace

bool GraspOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* text) {
    if (error != nullptr) *error = text;
    return false;
  };
  if (surface_samples < 0 || surface_samples > 100000 || yaws < 0 || yaws > 1000) {
    return fail("the numbers of closing axes must be 0 to 100000 and 0 to 1000");
  }
  if (surface_samples + yaws == 0) return fail("a grasp search needs closing axes");
  if (approaches < 1 || approaches > 1000) return fail("approaches must be 1 to 1000");
  if (!(least_clearance >= 0.0) || !(finger_clearance >= least_clearance)) {
    return fail("finger_clearance must be at least least_clearance, which must not be negative");
  }
  if (!(largest_angle > 0.0)) return fail("largest_angle must be positive");
  return true;
}

std::vector<Grasp> ProvedGraspsOf(const BodyModel& body, const robot::RobotModel& robot) {
  std::vector<Grasp> grasps;
  const robot::Gripper& gripper = robot.gripper;
  for (const manipulation::Grasp& proved : body.grasps) {
    if (proved.width >= gripper.MaxOpening()) continue;
    Grasp grasp;
    grasp.body_from_tool = proved.object_from_tool;
    grasp.width = proved.width;
    grasp.leader = gripper.LeaderAt(proved.opening);
    grasp.center_offset = manipulation::CenterOffset(proved, body.center_of_mass);
    grasp.quality = proved.quality;
    grasps.push_back(grasp);
  }
  return grasps;
}

std::vector<Grasp> SampleGrasps(const BodyModel& body, const robot::RobotModel& robot,
                                std::uint64_t seed, const GraspOptions& options) {
  return GraspSampler(body, robot, options).Sample(seed);
}

}  // namespace simwright::certificate
