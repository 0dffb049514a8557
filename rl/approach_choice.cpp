#include "rl/approach_choice.h"

#include <algorithm>
#include <limits>

#include "rl/hand_clearance.h"

namespace simwright::rl {
namespace {

using Eigen::Isometry3d;

constexpr double kSpacing = 0.01;    // m between the points of the hand that are looked at
constexpr double kInTheWay = 0.008;  // m: what goes deeper than this does not pass
constexpr double kWorkDone = 0.8;    // share of a joint's way by which its tasks are done

}  // namespace

Isometry3d ChooseApproach(const robot::RobotModel& robot, const SkillVariant& variant,
                          const sim::ArticulatedBody& body) {
  const Focus& focus = *variant.focus;
  const tasks::Thing& thing = variant.model.things[static_cast<size_t>(focus.thing)];
  const tasks::ThingJoint& joint = thing.joints[static_cast<size_t>(focus.joint)];
  const std::string& gripped = thing.links[static_cast<size_t>(focus.link)].name;
  const std::vector<Eigen::Vector3d> hand = HandSurface(robot, kSpacing);
  Isometry3d best = focus.approaches.front();
  double least = std::numeric_limits<double>::infinity();
  for (const Isometry3d& link_from_tool : focus.approaches) {
    double deepest = 0.0;
    for (const double share : {0.0, 0.5 * kWorkDone, kWorkDone}) {
      std::vector<double> joints = tasks::RestPositions(thing);
      joints[static_cast<size_t>(focus.joint)] =
          joint.rest() + share * (joint.far() - joint.rest());
      const std::vector<Isometry3d> poses =
          BodyPoses(body, thing, variant.start.roots[static_cast<size_t>(focus.thing)], joints);
      const int link = body.LinkIndex(gripped);
      deepest = std::max(
          deepest,
          DeepestPoint(hand, poses[static_cast<size_t>(link)] * link_from_tool, body, poses, link));
    }
    if (deepest < kInTheWay) return link_from_tool;
    if (deepest >= least) continue;
    least = deepest;
    best = link_from_tool;
  }
  return best;
}

}  // namespace simwright::rl
