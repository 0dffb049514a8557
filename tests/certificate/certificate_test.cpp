// Certificates of small scenes whose answers are known: what is solvable is proved by a replay of
// its file, and what is not has the right reason.
#include "certificate/certificate.h"

#include <gtest/gtest.h>

#include "certificate_scene.h"
#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "robot/limit_check.h"
#include "robot/panda_model.h"
#include "robot/trajectory_file.h"

namespace simwright::certificate {
namespace {

const Planner& ThePlanner() {
  static const Planner planner(robot::Panda(false));
  return planner;
}

TargetTask TaskOf(Goal goal, int target = kApple) {
  return {target, std::move(goal), InFrontOfTable()};
}

// Returns world_from_tool at a time of a trajectory.
Eigen::Isometry3d ToolAt(const robot::JointTrajectory& trajectory, Eigen::Index sample) {
  return InFrontOfTable() * robot::ForwardKinematics(robot::Panda(false).arm,
                                                     trajectory.positions.row(sample).head(7));
}

TEST(Certificate, LiftsALoneAppleAndItsFileReplays) {
  const PlacedScene scene = TableWithApple();
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "trajectory.json";
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())}, {}, file);
  ASSERT_TRUE(certificate.solvable()) << certificate.reason;
  EXPECT_EQ(certificate.target, kApple);
  EXPECT_TRUE(certificate.proof.held);
  EXPECT_NEAR(certificate.plan->grasp.width, 0.06, 2e-3);
  EXPECT_LT(certificate.Difficulty(), 0.9);
  // The file alone, in a fresh world, at another time step, and with tighter tolerances.
  const robot::JointTrajectory trajectory = robot::ReadTrajectory(file);
  EXPECT_EQ(trajectory.positions, certificate.trajectory.positions);
  ProofOptions options;
  options.time_step = 1.0 / 500.0;
  options.free_distance = HUGE_VAL;
  const Proof proof = Replay(ThePlanner(), scene, kApple, LiftGoal(), InFrontOfTable(), trajectory,
                             {trajectory.times.back()}, options);
  EXPECT_TRUE(proof.success) << proof.failure;
  ASSERT_EQ(proof.moments.size(), 1u);
  EXPECT_GE(proof.moments[0].poses[kApple].translation().z(), 0.335 + 0.05);
  // The tool is where forward kinematics has it, the apple within 2 cm of it.
  const Eigen::Isometry3d tool = ToolAt(trajectory, trajectory.size() - 1);
  EXPECT_LT((proof.moments[0].poses[kApple].translation() - tool.translation()).norm(), 0.03);
}

TEST(Certificate, TrajectoryMeetsTheLimitsOfThePanda) {
  const PlacedScene scene = TableWithApple();
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  ASSERT_TRUE(certificate.solvable()) << certificate.reason;
  std::vector<robot::JointLimits> limits;
  const robot::RobotModel& panda = robot::Panda(false);
  for (const int joint : panda.arm_joints) {
    limits.push_back(robot::CommandLimits(panda.limits[static_cast<size_t>(joint)], panda.margin));
  }
  limits.push_back(robot::CommandLimits(
      panda.limits[static_cast<size_t>(panda.gripper.joints.front())], panda.margin));
  EXPECT_TRUE(robot::CheckLimits(certificate.trajectory, limits).accepted());
}

TEST(Certificate, PlacesAnAppleNearTheFrontEdge) {
  PlacedScene scene = TableWithApple(0.3, 0.1);
  Put("can", BoxModel({0.06, 0.06, 0.1}), {0.06, 0.0, 0.3505}, &scene);
  const std::optional<Goal> goal = FrontGoal(scene, kApple);
  ASSERT_TRUE(goal);
  EXPECT_EQ(goal->kind, GoalKind::kPlace);
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(*goal)});
  ASSERT_TRUE(certificate.solvable()) << certificate.reason;
  EXPECT_LE(certificate.proof.others_moved, 0.005);
  const Eigen::Vector3d at = certificate.proof.moments.back().poses[kApple].translation();
  EXPECT_LT(at.x(), 0.15 + 0.03);  // the front quarter of the table
  EXPECT_NEAR(at.z(), 0.335, 3e-3);
  EXPECT_FALSE(certificate.proof.held);
}

TEST(Certificate, BringsAnAppleBesideAnObject) {
  PlacedScene scene = TableWithApple(0.15, 0.2);
  Put("can", BoxModel({0.06, 0.06, 0.1}), {0.25, -0.15, 0.3505}, &scene);
  const std::optional<Goal> goal = BesideGoal(scene, kApple, 2);
  ASSERT_TRUE(goal);
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(*goal)});
  ASSERT_TRUE(certificate.solvable()) << certificate.reason;
  const Eigen::Vector3d at = certificate.proof.moments.back().poses[kApple].translation();
  EXPECT_LT((at - Eigen::Vector3d(0.25, -0.15, at.z())).norm(), 0.06 + 0.04 + 0.03);
}

TEST(Certificate, NamesTheDoorThatBlocks) {
  PlacedScene scene = TableWithApple();
  AddCell(&scene);
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  EXPECT_EQ(certificate.verdict, Verdict::kBlocked);
  EXPECT_EQ(certificate.reason, "blocked by door");
  EXPECT_EQ(certificate.blockers, std::vector<std::string>{"door"});
  EXPECT_TRUE(certificate.blockers_verified);
  EXPECT_TRUE(certificate.trajectory.times.empty());
  EXPECT_EQ(certificate.Difficulty(), 1.0);
  EXPECT_FALSE(PlannedDifficulty(ThePlanner(), scene, {TaskOf(LiftGoal())}));
  const PlacedScene open = scene.Without({scene.Find("door")});
  EXPECT_TRUE(Certify(ThePlanner(), open, {TaskOf(LiftGoal())}).solvable());
}

TEST(Certificate, FurnitureThatBlocksIsNoBlocker) {
  PlacedScene scene = TableWithApple();
  AddCell(&scene);
  scene.bodies.back().fixed = true;
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  EXPECT_TRUE(certificate.verdict == Verdict::kNoGrasp ||
              certificate.verdict == Verdict::kUnreachable)
      << certificate.reason;
  EXPECT_TRUE(certificate.blockers.empty());
}

TEST(Certificate, ObjectBeyondReachIsUnreachable) {
  // The flange of a Panda reaches 0.855 m from its shoulder, the fingertips 0.21 m farther.
  PlacedScene scene = TableWithApple(0.9);
  scene.bodies[0].model = BoxModel({2.0, 0.8, 0.3});
  scene.bodies[0].world_from_body.translation().x() = 1.0;
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  EXPECT_EQ(certificate.verdict, Verdict::kUnreachable);
  EXPECT_EQ(certificate.counts.tried, certificate.counts.unreachable);
  EXPECT_GT(certificate.counts.tried, 10);
}

TEST(Certificate, ObjectWiderThanTheGripperHasNoGrasp) {
  const PlacedScene scene = TableWithApple(0.15, 0.0, 0.12, 0.12);
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  EXPECT_EQ(certificate.verdict, Verdict::kNoGrasp);
  EXPECT_EQ(certificate.counts.grasps, 0);
}

TEST(Certificate, TakesTheFirstTargetThatWorks) {
  PlacedScene scene = TableWithApple(0.15, 0.0, 0.12, 0.12);
  Put("small apple", ModelOf(assets::CylinderMesh(0.03, 0.07, 32), 0.15), {0.15, 0.2, 0.335},
      &scene);
  const std::vector<TargetTask> tasks = {TaskOf(LiftGoal()), TaskOf(LiftGoal(), 2)};
  const std::vector<TargetTask> sorted = EasiestFirst(ThePlanner(), scene, tasks);
  ASSERT_EQ(sorted.size(), 2u);
  EXPECT_EQ(sorted[0].target, 2);
  const Certificate certificate = Certify(ThePlanner(), scene, tasks);
  EXPECT_TRUE(certificate.solvable());
  EXPECT_EQ(certificate.target, 2);
}

TEST(Certificate, DoesNotDependOnThreads) {
  std::vector<PlacedScene> scenes;
  for (int i = 0; i < 4; ++i) scenes.push_back(TableWithApple(0.12 + 0.03 * i, 0.05 * i));
  std::vector<std::vector<Eigen::MatrixXd>> found;
  for (const int threads : {1, 3}) {
    core::SetThreadCount(threads);
    const Planner planner(robot::Panda(false));
    std::vector<Eigen::MatrixXd>& positions = found.emplace_back(scenes.size());
    core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
      const PlacedScene& scene = scenes[static_cast<size_t>(i)];
      positions[static_cast<size_t>(i)] =
          Certify(planner, scene, {TaskOf(LiftGoal())}).trajectory.positions;
    });
  }
  core::SetThreadCount(0);
  for (size_t i = 0; i < scenes.size(); ++i) {
    EXPECT_GT(found[0][i].rows(), 100) << i;
    EXPECT_TRUE(found[0][i] == found[1][i]) << i;
  }
}

TEST(Certificate, PlannedDifficultyIsThatOfTheCertificate) {
  PlacedScene scene = TableWithApple();
  const auto planned = PlannedDifficulty(ThePlanner(), scene, {TaskOf(LiftGoal())});
  const Certificate certificate = Certify(ThePlanner(), scene, {TaskOf(LiftGoal())});
  ASSERT_TRUE(planned);
  ASSERT_EQ(certificate.proofs, 1);
  EXPECT_DOUBLE_EQ(*planned, certificate.Difficulty());
  // Neighbours 4 cm from the apple make it harder.
  for (const double side : {-1.0, 1.0}) {
    Put("box", BoxModel({0.1, 0.04, 0.1}), {0.15, 0.09 * side, 0.3505}, &scene);
  }
  const auto crowded = PlannedDifficulty(ThePlanner(), scene, {TaskOf(LiftGoal())});
  ASSERT_TRUE(crowded);
  EXPECT_GT(*crowded, *planned);
}

TEST(Certificate, RejectsBadInput) {
  const PlacedScene scene = TableWithApple();
  EXPECT_THROW(Certify(ThePlanner(), scene, {}), core::Error);
  EXPECT_THROW(Certify(ThePlanner(), scene, {TaskOf(LiftGoal(), 7)}), core::Error);
  EXPECT_THROW(Certify(ThePlanner(), scene, {TaskOf(LiftGoal(), 0)}), core::Error);
  CertificateOptions options;
  options.motion.candidates = 0;
  EXPECT_THROW(Certify(ThePlanner(), scene, {TaskOf(LiftGoal())}, options), core::Error);
  options = {};
  options.proof.time_step = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Certify(ThePlanner(), scene, {TaskOf(LiftGoal())}, options), core::Error);
  GraspOptions grasps;
  grasps.approaches = 0;
  EXPECT_THROW(Planner(robot::Panda(false), grasps), core::Error);
  EXPECT_THROW(BodyModel(sim::RigidBody()), core::Error);
  EXPECT_EQ(Certify(ThePlanner(), scene, {{kApple, std::nullopt, InFrontOfTable()}}).verdict,
            Verdict::kNoPlace);
}

}  // namespace
}  // namespace simwright::certificate
