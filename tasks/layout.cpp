#include "tasks/layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "robot/inverse_kinematics.h"
#include "robot/panda.h"

namespace simwright::tasks {
namespace {

// The vertical component of an opening direction below which the receptacle is side-opening. An
// object in such a receptacle is placed in its front, where the gripper reaches it: a horizontal
// gripper is as long as a cabinet is deep.
constexpr double kSideOpening = 0.5;
constexpr double kBehindOpening = 0.03;  // m

constexpr double kGap = 0.02;         // m between objects
constexpr double kRobotRadius = 0.2;  // m; half the side of the base's footprint
// Heights of the robot's base to try: first on the floor, then on a pedestal.
constexpr std::array<double, 6> kBaseHeights = {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
// Shares of a joint's path that the arm must be able to follow: the whole path if possible.
constexpr std::array<double, 2> kPathShares = {1.0, 0.8};
constexpr double kDegree = std::numbers::pi / 180.0;

using Pose = Eigen::Isometry3d;

Pose Turned(double angle) {
  return Pose(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

// Returns the yaw that turns the object's front, the side of its handles and receptacles, to -x.
double YawToFront(const ArticulatedObject& object) {
  const std::vector<Pose> poses = LinkPosesOf(object, RestPositions(object));
  Eigen::Vector2d front = Eigen::Vector2d::Zero();
  const Eigen::AlignedBox3d& body =
      object.links[0].extreme_points.empty() ? object.box : object.links[0].box;
  const Eigen::Vector2d middle = body.center().head<2>();
  for (const ObjectJoint& joint : object.joints) {
    const auto grip = static_cast<std::size_t>(joint.grasp_link);
    const Eigen::Vector3d point = poses[grip] * object.links[grip].middle;
    // The side on which the handle is located or protrudes.
    const Eigen::Vector2d out =
        (point.head<2>() - middle).cwiseQuotient(body.sizes().head<2>().cwiseMax(1e-6));
    const int axis = std::abs(out.x()) >= std::abs(out.y()) ? 0 : 1;
    front[axis] += out[axis] > 0.0 ? 1.0 : -1.0;
  }
  for (const Receptacle& receptacle : object.receptacles) {
    front +=
        (poses[static_cast<std::size_t>(receptacle.link)].linear() * receptacle.opening).head<2>();
  }
  if (front.norm() < 0.05) return 0.0;  // library assets face -x
  const int axis = std::abs(front.x()) >= std::abs(front.y()) ? 0 : 1;
  const double angle = axis == 0 ? (front.x() > 0.0 ? 0.0 : std::numbers::pi)
                                 : (front.y() > 0.0 ? 0.5 : -0.5) * std::numbers::pi;
  return std::numbers::pi - angle;
}

class LayoutPlanner {
 public:
  LayoutPlanner(const WorldModel& model, const LayoutRequest& request, core::Rng& rng)
      : model_(model), request_(request), rng_(rng) {}

  std::optional<InitialState> Plan() {
    for (double share : kPathShares) {
      path_share_ = share;
      for (double height : kBaseHeights) {
        start_ = InitialState{};
        start_.joints = request_.joints;
        start_.world_from_robot = Eigen::Translation3d(0, 0, height) * Pose::Identity();
        occupied_ = {Eigen::AlignedBox2d(Eigen::Vector2d::Constant(-kRobotRadius),
                                         Eigen::Vector2d::Constant(kRobotRadius))};
        if (PlaceAll()) return start_;
      }
      if (request_.operated.empty()) break;
    }
    return std::nullopt;
  }

 private:
  bool IsSupported(int object) const {
    return std::any_of(request_.supports.begin(), request_.supports.end(),
                       [&](const SupportRelation& supports) { return supports.object == object; });
  }

  bool PlaceAll() {
    int articulated = 0;
    for (int object : request_.objects) {
      if (!model_.objects[static_cast<std::size_t>(object)].articulated() || IsSupported(object))
        continue;
      constexpr std::array<double, 4> kDirections = {0.0, 80.0, -80.0, 160.0};
      if (articulated == static_cast<int>(kDirections.size())) return false;
      if (!PlaceArticulated(object,
                            kDirections[static_cast<std::size_t>(articulated++)] * kDegree)) {
        return false;
      }
    }
    for (int object : request_.objects) {
      if (model_.objects[static_cast<std::size_t>(object)].articulated() || IsSupported(object))
        continue;
      if (!PlaceBeside(object)) return false;
    }
    for (const SupportRelation& supports : request_.supports) {
      if (!PlaceResting(supports)) return false;
    }
    return true;
  }

  void Add(int object, const Pose& pose) {
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
    start_.placements.push_back({known.name, pose, known.articulated()});
  }

  WorldState State() const { return StateOf(model_, start_); }

  // Returns the grasp positions of the operated joints along their paths, in the root's frame.
  std::vector<Eigen::Vector3d> GripPoints(int object) const {
    const auto t = static_cast<std::size_t>(object);
    const ArticulatedObject& known = model_.objects[t];
    std::vector<double> positions = RestPositions(known);
    std::vector<Eigen::Vector3d> points;
    for (const auto& [owner, j] : request_.operated) {
      if (owner != object) continue;
      const ObjectJoint& joint = known.joints[static_cast<std::size_t>(j)];
      const auto grip = static_cast<std::size_t>(joint.grasp_link);
      for (double share : {0.0, 0.5, 1.0}) {
        positions[static_cast<std::size_t>(j)] =
            joint.rest() + share * path_share_ * (joint.far() - joint.rest());
        points.push_back(LinkPosesOf(known, positions)[grip] * known.links[grip].middle);
      }
      positions[static_cast<std::size_t>(j)] = joint.rest();
    }
    return points;
  }

  // Returns the AABB that the object sweeps, including the grasp positions of its operated joints,
  // in the root's frame.
  Eigen::AlignedBox3d SweptBox(int object) const {
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
    Eigen::AlignedBox3d box = known.box;
    for (const Eigen::Vector3d& point : GripPoints(object)) box.extend(point);
    return box;
  }

  bool PlaceArticulated(int object, double direction) {
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
    const Pose turn = Turned(YawToFront(known));
    Eigen::AlignedBox3d turned;
    for (int corner = 0; corner < 8; ++corner) {
      turned.extend(turn * known.box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
    const std::vector<Eigen::Vector3d> grips = GripPoints(object);
    for (double distance : {0.45, 0.35, 0.55, 0.65, 0.75, 0.9, 1.05}) {
      for (double aside : {0.0, 0.2, -0.2, 0.4, -0.4, 0.6, -0.6, 0.8, -0.8}) {
        const Eigen::Vector3d shift(distance - turned.min().x(), aside - turned.center().y(),
                                    -turned.min().z());
        const Pose pose = Turned(direction) * Eigen::Translation3d(shift) * turn;
        const bool reached =
            std::all_of(grips.begin(), grips.end(), [&](const Eigen::Vector3d& point) {
              // A swinging part must not hit the robot's base.
              return (pose * point).head<2>().norm() > kRobotRadius + 0.05 &&
                     IsPointReachable(start_.world_from_robot, pose * point);
            });
        if (!reached || !IsFree(pose, known.box)) continue;
        Add(object, pose);
        Occupy(pose, SweptBox(object));
        return true;
      }
    }
    return false;
  }

  Eigen::AlignedBox2d FlatBox(const Pose& pose, const Eigen::AlignedBox3d& box) const {
    Eigen::AlignedBox2d flat;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d point =
          pose * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
      flat.extend(Eigen::Vector2d(point.head<2>()));
    }
    return flat;
  }

  bool IsFree(const Pose& pose, const Eigen::AlignedBox3d& box) const {
    Eigen::AlignedBox2d flat = FlatBox(pose, box);
    flat.min().array() -= kGap;
    flat.max().array() += kGap;
    return std::none_of(occupied_.begin(), occupied_.end(),
                        [&](const Eigen::AlignedBox2d& other) { return flat.intersects(other); });
  }

  void Occupy(const Pose& pose, const Eigen::AlignedBox3d& box) {
    occupied_.push_back(FlatBox(pose, box));
  }

  // Places an object on free floor within reach.
  bool PlaceBeside(int object) {
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(object)];
    const double turn = core::Uniform(rng_, -0.3, 0.3);
    const int first = static_cast<int>(core::UniformIndex(rng_, 4));
    constexpr std::array<double, 4> kRadii = {0.45, 0.55, 0.38, 0.65};
    for (int i = 0; i < 4; ++i) {
      const double radius = kRadii[static_cast<std::size_t>((first + i) % 4)];
      for (int step = 0; step < 17; ++step) {
        const double angle = 15.0 * kDegree * ((step + 1) / 2) * (step % 2 == 0 ? 1.0 : -1.0);
        const Eigen::Vector3d middle = known.box.center();
        const Pose pose = Eigen::Translation3d(radius * std::cos(angle), radius * std::sin(angle),
                                               -known.box.min().z()) *
                          Turned(turn) * Eigen::Translation3d(-middle.x(), -middle.y(), 0.0);
        if (!IsFree(pose, known.box)) continue;
        if (!IsPointReachable(start_.world_from_robot, pose * middle, -Eigen::Vector3d::UnitZ()))
          continue;
        Add(object, pose);
        Occupy(pose, known.box);
        return true;
      }
    }
    return false;
  }

  bool PlaceResting(const SupportRelation& supports) {
    const ArticulatedObject& known = model_.objects[static_cast<std::size_t>(supports.object)];
    const ArticulatedObject& holder = model_.objects[static_cast<std::size_t>(supports.holder)];
    const WorldState state = State();
    const auto h = static_cast<std::size_t>(supports.holder);
    Eigen::Vector3d base;  // position of the centre of its underside
    if (supports.receptacle < 0) {
      const Eigen::AlignedBox3d box = WorldAabb(model_, state, supports.holder, 0);
      base << box.center().head<2>(), box.max().z();
    } else {
      const Receptacle& receptacle =
          holder.receptacles[static_cast<std::size_t>(supports.receptacle)];
      Eigen::Vector3d floor = receptacle.box.center();
      const Pose link =
          state.roots[h] *
          LinkPosesOf(holder, state.joints[h])[static_cast<std::size_t>(receptacle.link)];
      base = link * floor;
      base.z() -= 0.5 * receptacle.box.sizes().z();
      const Eigen::Vector3d opening = link.linear() * receptacle.opening;
      if (std::abs(opening.z()) < kSideOpening) {
        const double depth = std::abs(receptacle.box.sizes().dot(receptacle.opening));
        const double half = 0.5 * known.box.sizes().head<2>().maxCoeff();
        base += std::max(0.0, 0.5 * depth - half - kBehindOpening) * opening;
      }
    }
    const Eigen::Vector3d under(known.box.center().x(), known.box.center().y(),
                                known.box.min().z());
    const Pose pose = Eigen::Translation3d(base - under) * Pose::Identity();
    if (!IsPointReachable(start_.world_from_robot, pose * known.box.center())) return false;
    Add(supports.object, pose);
    return true;
  }

  const WorldModel& model_;
  const LayoutRequest& request_;
  core::Rng& rng_;
  double path_share_ = 1.0;
  InitialState start_;
  std::vector<Eigen::AlignedBox2d> occupied_;
};

}  // namespace

std::optional<InitialState> PlanLayout(const WorldModel& model, const LayoutRequest& request,
                                       core::Rng& rng) {
  return LayoutPlanner(model, request, rng).Plan();
}

bool IsPointReachable(const Eigen::Isometry3d& world_from_robot, const Eigen::Vector3d& point,
                      const std::optional<Eigen::Vector3d>& approach) {
  const Pose robot_from_world = world_from_robot.inverse();
  if (!point.allFinite()) return false;
  robot::ToolTarget target;
  target.position = robot_from_world * point;
  if (approach) target.approach = robot_from_world.linear() * *approach;
  // The span of the stretched arm from its second joint: 0.316 + 0.384 m to the wrist, a 0.088 m
  // offset of the flange axis, and 0.21 m of flange and gripper.
  constexpr double kSpan = 0.316 + 0.384 + 0.088 + 0.2104;
  if ((target.position - Eigen::Vector3d(0, 0, 0.333)).norm() > kSpan) return false;
  core::Rng rng(1);  // a fixed seed gives the same answer for the same point
  robot::InverseKinematicsOptions options;
  options.position_tolerance = 5e-3;
  options.approach_tolerance = 0.2;
  return robot::SolveInverseKinematics(robot::PandaArm(), target, rng, options).reached;
}

}  // namespace simwright::tasks
