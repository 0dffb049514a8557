#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "certificate/placed_scene.h"
#include "robot/robot_model.h"

namespace simwright::certificate {

// An antipodal grasp of a body by a gripper with two parallel fingers.
struct Grasp {
  // The tool frame lies between the fingertips: z along the approach, y from finger to finger.
  Eigen::Isometry3d body_from_tool = Eigen::Isometry3d::Identity();
  double width = 0.0;          // m between the contacts
  double leader = 0.0;         // position of the gripper's first joint before the fingers close
  double center_offset = 0.0;  // m from the line between the contacts to the centre of mass
  double quality = 0.0;        // manipulation::Grasp::quality; 0: not proved
};

struct GraspOptions {
  int surface_samples = 96;        // closing axes along normals at random points of the surface
  int yaws = 12;                   // horizontal closing axes, over half a turn
  int approaches = 24;             // approach directions about each closing axis
  double finger_clearance = 0.01;  // m that each finger opens beyond the contact, if it can
  double least_clearance = 0.002;  // m that it must open beyond it
  bool proved_alone = false;       // a body with proved grasps gets no sampled ones beside them
  double largest_angle = 0.35;     // rad between closing axis and normals, within the friction cone

  bool IsValid(std::string* error) const;
};

// Returns the proved grasps of a body (BodyModel::grasps) for the gripper of `robot`, without those
// that are wider than it.
std::vector<Grasp> ProvedGraspsOf(const BodyModel& body, const robot::RobotModel& robot);

// Returns grasps of a body: both contacts lie within the friction cone of the pair of body and
// fingertip, the gripper opens wide enough, and it does not touch the body before it closes.
// Closing axes are horizontal lines through the body's middle at several heights, and the normals
// at random points of its surface. Deterministic in `seed`. Empty if the body is wider than the
// gripper.
std::vector<Grasp> SampleGrasps(const BodyModel& body, const robot::RobotModel& robot,
                                std::uint64_t seed, const GraspOptions& options = {});

}  // namespace simwright::certificate
