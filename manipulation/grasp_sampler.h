#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/random.h"
#include "manipulation/grasp.h"
#include "sim/gripper_model.h"

namespace simwright::manipulation {

struct GraspSamplerOptions {
  int candidates = 3000;              // at most, collision-free
  int samples = 20000;                // surface points, at most
  int approaches = 4;                 // random approach directions tried per pair of contacts
  int downward_approaches = 2;        // and such near the steepest downwards
  double largest_tip_offset = 0.008;  // m, contacts lie up to so much nearer to the tips than the
                                      // tool frame: flat objects on a table need it
  double largest_angle = 0.25;     // rad between closing axis and normals, within the friction cone
  double least_width = 0.003;      // m: thinner objects pass between the pads' contacts
  double finger_clearance = 0.01;  // m that each finger opens beyond its contact, if it can
  double least_clearance = 0.002;  // m that it must open beyond it
  double approach = 0.10;          // m, the straight path to the grasp, collision-free
  double margin = 0.0005;          // m between gripper and object on the path

  bool IsValid(std::string* error) const;
};

// Why pairs of contacts were no grasps.
struct GraspSampling {
  std::vector<Grasp> grasps;
  int samples = 0;         // surface points
  int pairs = 0;           // of contacts on one line
  int too_wide = 0;        // the fingers do not open so far
  int too_thin = 0;        // below least_width
  int oblique = 0;         // outside of the friction cone
  int colliding = 0;       // gripper or approach hit the object, from all tried directions
  double narrowest = 0.0;  // m, of all antipodal pairs; 0 if there are none

  // Returns one sentence on why there are no grasps; empty if there are some.
  std::string WhyNone(const sim::GripperModel& gripper) const;
};

// Samples antipodal grasps on the surface of an object (area-weighted points, closing axes within
// the friction cone about the normal), with random approach directions about the closing axis. The
// open gripper and its straight approach are collision-free. Deterministic in `rng`. Throws
// core::Error for invalid options or an empty surface.
GraspSampling SampleAntipodalGrasps(const GraspObject& object, const sim::GripperModel& gripper,
                                    const GraspSamplerOptions& options, core::Rng& rng);

// Collision checks of a gripper against an object and its obstacles, at a pose and on the last
// `approach` (m) of a straight path to it along the tool's z axis; at the pose alone against
// GraspObject::passed.
class GraspClearance {
 public:
  GraspClearance(const GraspObject& object, const sim::GripperModel& gripper, double approach,
                 double margin);
  ~GraspClearance();
  GraspClearance(const GraspClearance&) = delete;
  GraspClearance& operator=(const GraspClearance&) = delete;

  bool IsFree(const Eigen::Isometry3d& object_from_tool, double opening) const;
  // Returns the least height (m) above the support of the open gripper there and on the path.
  double LowestPoint(const Eigen::Isometry3d& object_from_tool) const;

 private:
  struct Parts;
  struct Shapes;
  bool IsFreeOf(const Parts& parts, const Eigen::Isometry3d& object_from_tool, double opening,
                double approach) const;

  std::unique_ptr<const Shapes> shapes_;
  double approach_, margin_;
  Eigen::Isometry3d support_from_object_;
};

}  // namespace simwright::manipulation
