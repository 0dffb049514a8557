#include "robot/robot_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "assets/joint_poses.h"
#include "core/files.h"
#include "geometry/mass_properties.h"
#include "robot/panda.h"
#include "robot/panda_model.h"
#include "tests/robot/random_configuration.h"

namespace simwright::robot {
namespace {

// Returns each link's pose from the URDF's tree, independently of `Arm`.
Eigen::Isometry3d LinkPose(const RobotModel& model, const Eigen::VectorXd& q,
                           const std::string& link) {
  assets::JointPositions positions;
  for (int j = 0; j < model.arm.size(); ++j) positions[model.arm.joints[j].name] = q[j];
  const auto poses = assets::LinkPoses(model.urdf, positions);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (model.urdf.links[i].name == link) return poses[i];
  }
  ADD_FAILURE() << "no link " << link;
  return Eigen::Isometry3d::Identity();
}

// Returns the largest element of the difference of two poses: m and components of unit vectors.
double Difference(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

TEST(PandaModel, UrdfAgreesWithTheTableOfJoints) {
  const RobotModel& model = Panda(false);
  ASSERT_EQ(model.arm.size(), 7);
  core::Rng rng(11);
  double worst = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Eigen::VectorXd q = RandomPosture(PandaArm(), rng);
    const Eigen::Isometry3d table = ForwardKinematics(PandaArm(), q);
    worst = std::max(worst, Difference(ForwardKinematics(model.arm, q), table));
    worst = std::max(worst, Difference(LinkPose(model, q, "panda_hand_tcp"), table));
  }
  EXPECT_LT(worst, 1e-12);
  for (int j = 0; j < 7; ++j) {
    EXPECT_EQ(model.arm.joints[j].name, PandaArm().joints[j].name);
    EXPECT_EQ(model.arm.joints[j].lower, PandaArm().joints[j].lower);
    EXPECT_EQ(model.arm.joints[j].upper, PandaArm().joints[j].upper);
  }
  EXPECT_TRUE(model.home().isApprox(PandaArm().ready, 1e-15));
  EXPECT_DOUBLE_EQ(model.gripper.MaxOpening(), kPandaGripperOpening);
}

// The manufacturer's joint origins, multiplied independently of this code.
TEST(PandaModel, MeetsPublishedPosesOfFlangeAndTool) {
  struct Golden {
    std::vector<double> q;
    Eigen::Vector3d flange, tool;
    Eigen::Quaterniond turn;
  };
  constexpr double kQuarter = 1.5707963267948966;
  const std::vector<Golden> all = {
      {{0, -kQuarter / 2, 0, -1.5 * kQuarter, 0, kQuarter, kQuarter / 2},
       {0.306890567, 0, 0.590282052},
       {0.306890567, 0, 0.486882052},
       {0, 1, 0, 0}},
      {{0, 0, 0, -1.57079, 0, 1.57079, -0.7853},
       {0.554499478, 0, 0.624502429},
       {0.554499478, 0, 0.521102429},
       {0, 0.707141486, 0.707072074, 0}},
      {{0.1, -0.2, 0.3, -1.5, 0.5, 1.2, -0.7},
       {0.374855281, 0.249967747, 0.733339483},
       {0.346015617, 0.282112390, 0.639389732},
       {-0.205092871, 0.513637207, 0.830950836, 0.060286333}}};
  for (const Golden& golden : all) {
    for (const bool on_base : {false, true}) {
      const RobotModel& model = Panda(on_base);
      Eigen::VectorXd q = Eigen::VectorXd::Zero(model.arm.size());
      q.tail(7) = Eigen::Map<const Eigen::VectorXd>(golden.q.data(), 7);
      const Eigen::Isometry3d flange = LinkPose(model, q, "panda_link8");
      const Eigen::Isometry3d tool = ForwardKinematics(model.arm, q);
      EXPECT_LT((flange.translation() - golden.flange).norm(), 1e-6);
      EXPECT_LT((tool.translation() - golden.tool).norm(), 1e-6);
      EXPECT_LT(golden.turn.normalized().angularDistance(Eigen::Quaterniond(tool.linear())), 1e-6);
    }
  }
}

// Jacobian and kinematics with prismatic joints, against finite differences.
TEST(PandaModel, BaseSlidesAndTheJacobianKnows) {
  const RobotModel& model = Panda(true);
  ASSERT_EQ(model.arm.size(), 9);
  EXPECT_EQ(model.base_joint_count, 2);
  core::Rng rng(12);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd q = RandomPosture(model.arm, rng);
    const Eigen::Isometry3d fixed = ForwardKinematics(PandaArm(), q.tail(7));
    Eigen::Isometry3d tool;
    const auto jacobian = Jacobian(model.arm, q, &tool);
    EXPECT_LT((tool.translation() - fixed.translation() - Eigen::Vector3d(q[0], q[1], 0)).norm(),
              1e-12);
    for (int j = 0; j < model.arm.size(); ++j) {
      constexpr double kStep = 1e-6;
      Eigen::VectorXd less = q, more = q;
      less[j] -= kStep;
      more[j] += kStep;
      const Eigen::Isometry3d a = ForwardKinematics(model.arm, less);
      const Eigen::Isometry3d b = ForwardKinematics(model.arm, more);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(b.linear() * a.linear().transpose()));
      Eigen::Matrix<double, 6, 1> expected;
      expected << (b.translation() - a.translation()), turn.angle() * turn.axis();
      EXPECT_LT((jacobian.col(j) - expected / (2 * kStep)).norm(), 1e-7);
    }
  }
}

// Masses and principal moments as published; the moments of link 4 are projected to the nearest
// physically valid ones, recomputed here.
TEST(PandaModel, MassesAndInertiasAreTheMakers) {
  const double masses[] = {2.3966, 2.7907, 2.5420, 2.2513, 2.2037, 2.2855, 1.353, 0.35973};
  const double moments[][3] = {
      {.006734, .01077, .0115},    {.004388, .01502, .01565},   {.00356, .01651, .01663},
      {.003519, .007625, .01041},  {.00368, .007956, .01274},   {.00347, .02179, .02297},
      {.000849, .002794, .002882}, {.000179, .000192, .000196},
  };
  const RobotModel& model = Panda(false);
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const std::string name = "panda_link" + std::to_string(i);
    const auto link = std::find_if(model.urdf.links.begin(), model.urdf.links.end(),
                                   [&](const auto& candidate) { return candidate.name == name; });
    ASSERT_TRUE(link != model.urdf.links.end() && link->inertial);
    EXPECT_DOUBLE_EQ(link->inertial->mass, masses[i]);
    sum += link->inertial->mass;
    Eigen::Vector3d expected(moments[i][0], moments[i][1], moments[i][2]);
    const double excess = expected[2] - expected[0] - expected[1];
    if (excess > 0.0) expected += excess / 3.0 * Eigen::Vector3d(1, 1, -1);
    const Eigen::Vector3d found =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link->inertial->inertia).eigenvalues();
    // Four digits are published.
    EXPECT_LT(((found - expected).array() / expected.array()).abs().maxCoeff(), 4e-3) << name;
    EXPECT_EQ(excess > 0.0, i == 4);
  }
  EXPECT_NEAR(sum, 16.18, 0.005);
}

// The full inertias as published, in the link axes: the principal inertias rotate back to them.
TEST(PandaModel, InertiaTurnsBackToTheLinksAxes) {
  const auto& links = Panda(false).urdf.links;
  const auto inertia_of = [&](const std::string& name) -> Eigen::Matrix3d {
    for (const auto& link : links) {
      if (link.name == name) return link.inertial->inertia;
    }
    return Eigen::Matrix3d::Zero();
  };
  Eigen::Matrix3d link1, link3, hand;
  link1 << .01564782655, .00000531236, -.00003676721, .00000531236, .01439883526, -.00248480843,
      -.00003676721, -.00248480843, .00500443991;
  link3 << .00631741992, .00097309955, .00292525834, .00097309955, .00866285493, .00093469224,
      .00292525834, .00093469224, .00657804051;
  hand << .00186, 0, 0, 0, .0003, -.00002, 0, -.00002, .00174;
  EXPECT_LT((inertia_of("panda_link1") - link1).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((inertia_of("panda_link3") - link3).cwiseAbs().maxCoeff(), 1e-11);
  EXPECT_LT((inertia_of("panda_hand") - hand).cwiseAbs().maxCoeff(), 1e-11);
}

class EveryRobot : public testing::TestWithParam<const char*> {};

TEST_P(EveryRobot, LoadsWithInertiasThatBodiesCanHave) {
  const RobotModel model =
      ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots" / GetParam());
  for (const core::Finding& finding : model.urdf.findings) {
    EXPECT_EQ(finding.severity, core::Severity::kInfo) << finding.sentence;
  }
  int with_mass = 0;
  for (const auto& link : model.urdf.links) {
    if (!link.inertial) continue;
    ++with_mass;
    const Eigen::Vector3d moments = geometry::PrincipalInertiaOf(link.inertial->inertia).moments;
    EXPECT_TRUE(geometry::SatisfiesTriangleInequality(moments, 1e-9)) << link.name;
  }
  EXPECT_GE(with_mass, 10);
  for (std::size_t i = 0; i < model.limits.size(); ++i) {
    if (!model.urdf.joints[i].Moves()) continue;
    EXPECT_GT(model.limits[i].upper, model.limits[i].lower);
    EXPECT_GT(CommandLimits(model.limits[i], model.margin).velocity, 0.0);
    EXPECT_GT(model.limits[i].effort, 0.0);
  }
  ASSERT_EQ(model.gripper.joints.size(), 2u);
  const auto& follower = model.urdf.joints[model.gripper.joints[1]];
  ASSERT_TRUE(follower.mimic);
  EXPECT_EQ(follower.mimic->joint, model.urdf.joints[model.gripper.joints[0]].name);
}

// The gap between the finger pads of an open gripper equals the opening of the model; a closed
// gripper has none.
TEST_P(EveryRobot, OpeningIsTheRoomBetweenThePads) {
  const RobotModel model =
      ReadRobot(std::filesystem::path(SIMWRIGHT_SOURCE_DIR) / "robots" / GetParam());
  const std::string leader = model.urdf.joints[model.gripper.joints[0]].name;
  for (const double position : {model.gripper.closed, model.gripper.open}) {
    const auto poses = assets::LinkPoses(model.urdf, {{leader, position}});
    const Eigen::Isometry3d tool_from_root = poses[model.tool_link].inverse();
    double lowest_above = 1.0, highest_below = -1.0;  // y of the tool: from finger to finger
    for (const int link : model.gripper.links) {
      const Eigen::Isometry3d pose = tool_from_root * poses[link];
      double least = 1.0, most = -1.0;
      for (const auto& shape : model.urdf.links[link].collisions) {
        for (const Eigen::Vector3d& point : shape.mesh.vertices) {
          const double y = (pose * point).y();
          least = std::min(least, y);
          most = std::max(most, y);
        }
      }
      if (most + least > 0.0) {
        lowest_above = least;
      } else {
        highest_below = most;
      }
    }
    EXPECT_NEAR(lowest_above - highest_below, model.gripper.Opening(position), 1e-4) << position;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, EveryRobot,
                         testing::Values("panda/panda.urdf", "panda/panda_on_base.urdf",
                                         "generic6/generic6.urdf"));

TEST(PandaModel, CommandsStayOffTheLimitsAsLibfrankaDoes) {
  const RobotModel& model = Panda(false);
  const JointLimits first = CommandLimits(model.ArmLimits()[0], model.margin);
  EXPECT_NEAR(first.velocity, 2.129, 1e-12);  // 2.175 - 0.001 - 0.003 * 15
  EXPECT_NEAR(first.acceleration, 14.999, 1e-12);
  EXPECT_NEAR(first.jerk, 7499.999, 1e-9);
}

}  // namespace
}  // namespace simwright::robot
