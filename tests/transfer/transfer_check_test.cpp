#include "transfer/transfer_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "block_twin.h"
#include "core/error.h"
#include "rl/policy_file.h"
#include "rl/training.h"
#include "scripted_expert.h"
#include "skills/skill_evaluation.h"
#include "transfer/motion_choice.h"
#include "transfer/twin_ranges.h"

namespace simwright::transfer {
namespace {
namespace fs = std::filesystem;

// A twin of two blocks, the run of picking one up by the scripted expert, and a motion of it.
class BlockTransfer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new core::TemporaryFolder;
    record_ = WriteBlockTwin(Twin(), {{-0.08, 0.7, 0.3}, {0.14, 0.75, -0.6}});
    workflows::SkillRun run = ExpertRun(BlockTasks(Twin()).set, "pick_up_block_1", Run());
    workflows::WriteRun(run);
    task_ = new TransferTask(workflows::ReadRun(Run()));
    fs::create_directories(task_->skills().front().folder);
    rl::WritePolicy(ExpertPolicy(*task_), task_->skills().front().folder / rl::kPolicyFile);
    policies_ = PoliciesOf(*task_);
    const MotionRecorder recorder(*task_, policies_, PlacementRanges(Twin(), 2.0));
    const std::vector<TransferMotion> motions = recorder.Record(1, 0);
    if (!motions.empty()) motion_ = motions.front();
  }
  static void TearDownTestSuite() {
    delete task_;
    delete shared_;
  }
  static fs::path Twin() { return shared_->path() / "twin"; }
  static fs::path Run() { return shared_->path() / "run"; }

  // Returns how often the motion succeeds in `worlds` twins with the position error.
  static int Successes(double position_error, double scale, int worlds) {
    workflows::TwinRecord record = record_;
    for (workflows::TwinObject& object : record.objects) object.position_error = position_error;
    const PerturbedTwin twin = PerturbedTwinOf(*task_, record, Twin());
    return RateAt(
               [&](double at, std::uint64_t index) {
                 return task_->Replays(twin.World(at, 5, index), *motion_);
               },
               scale, worlds)
        .successes;
  }

  inline static core::TemporaryFolder* shared_ = nullptr;
  inline static workflows::TwinRecord record_;
  inline static TransferTask* task_ = nullptr;
  inline static std::vector<rl::Policy> policies_;
  inline static std::optional<TransferMotion> motion_;
};

TEST_F(BlockTransfer, SucceedsWithoutUncertaintyAndFailsWithALargeOne) {
  ASSERT_TRUE(motion_);
  EXPECT_EQ(Successes(0.004, 0.0, 4), 4);
  EXPECT_GE(Successes(0.002, 1.0, 12), 10);
  // Fingers that open 8 cm miss a block of 5 cm that is 6 cm off along both axes.
  EXPECT_LE(Successes(0.06, 1.0, 12), 4);
}

TEST_F(BlockTransfer, ActsWhereTheObjectIs) {
  const PerturbedTwin twin = PerturbedTwinOf(*task_, record_, Twin());
  TransferWorld world = task_->described();
  world.objects[0].world_from_asset.pretranslate(Eigen::Vector3d(-0.06, 0.05, 0.0));
  core::Rng rng(1);
  EXPECT_TRUE(task_->Acts(world, {&policies_.front()}, rng));
  EXPECT_FALSE(task_->Replays(world, *motion_));
}

TEST_F(BlockTransfer, PerturbsByTheTwinsErrors) {
  workflows::TwinRecord record = record_;
  record.log_scale_error = 0.03;
  record.objects[0].position_error = 0.01;
  record.objects[0].size_error = 0.05;  // 0.04 of its own
  record.objects[1].position_error = 0.0;
  record.objects[1].size_error = 0.03;  // the common one alone
  const PerturbedTwin twin = PerturbedTwinOf(*task_, record, Twin());
  const TransferWorld& described = task_->described();
  constexpr int kWorlds = 400;
  double x = 0.0, yaw = 0.0, ratio = 0.0, scale = 0.0, mass = 0.0;
  for (int i = 0; i < kWorlds; ++i) {
    const TransferWorld world = twin.World(1.0, 3, static_cast<std::uint64_t>(i));
    const auto volume = [&](size_t k) {
      return std::log(BoundsOf(PartsOf(world.objects[k].model)).volume() /
                      BoundsOf(PartsOf(described.objects[k].model)).volume()) /
             3.0;
    };
    // The second block states the common scale: it is where that moves it.
    const double common = volume(1);
    const Eigen::Vector3d& at = described.objects[1].world_from_asset.translation();
    EXPECT_NEAR(world.objects[1].world_from_asset.translation().y(), std::exp(common) * at.y(),
                1e-9);
    scale += common * common / kWorlds;
    const Eigen::Isometry3d& pose = world.objects[0].world_from_asset;
    const Eigen::Isometry3d& was = described.objects[0].world_from_asset;
    const double off = pose.translation().x() - std::exp(common) * was.translation().x();
    x += off * off / kWorlds;
    const Eigen::AngleAxisd turn(pose.linear() * was.linear().transpose());
    yaw += turn.angle() * turn.angle() / kWorlds;
    ratio += std::pow(volume(0) - common, 2) / kWorlds;
    mass += std::log(world.objects[0].mass) / kWorlds;
    EXPECT_GE(world.objects[0].mass, 0.5);
    EXPECT_LE(world.objects[0].mass, 2.0);
    EXPECT_NEAR(pose.translation().z(), 0.0, 1e-12);
  }
  // Standard deviations of 400 samples are within 3.6 % of the true ones, one sigma.
  EXPECT_NEAR(std::sqrt(x), 0.01, 0.0013);
  EXPECT_NEAR(std::sqrt(yaw), 0.05, 0.007);
  EXPECT_NEAR(std::sqrt(ratio), 0.04, 0.005);
  EXPECT_NEAR(std::sqrt(scale), 0.03, 0.004);
  EXPECT_NEAR(mass, 0.0, 0.07);
}

TEST_F(BlockTransfer, IsAPureFunctionOfTheSeed) {
  const PerturbedTwin twin = PerturbedTwinOf(*task_, record_, Twin());
  const auto pose = [&](std::uint64_t seed, std::uint64_t index) {
    return twin.World(1.0, seed, index).objects[0].world_from_asset.matrix().eval();
  };
  EXPECT_TRUE(pose(1, 7) == pose(1, 7));
  EXPECT_FALSE(pose(1, 7) == pose(1, 8));
  EXPECT_FALSE(pose(1, 7) == pose(2, 7));
  const TransferWorld none = twin.World(0.0, 1, 7);
  EXPECT_TRUE(none.objects[0].world_from_asset.isApprox(
      task_->described().objects[0].world_from_asset, 1e-12));
  EXPECT_EQ(none.objects[0].mass, 1.0);
}

TEST_F(BlockTransfer, ChecksAnExportedMotion) {
  MotionChoiceRequest choice;
  choice.run = Run();
  choice.twin = Twin();
  choice.output = shared_->path() / "pick.yaml";
  choice.episodes = 4;
  choice.worlds = 6;
  core::Progress silent;
  const MotionChoice chosen = ExportChosenMotion(choice, &silent);
  EXPECT_GE(chosen.recorded, 2);
  EXPECT_GE(chosen.rate.successes, chosen.first.successes);
  TransferRequest request;
  request.motion = choice.output;
  request.twin = Twin();
  request.worlds = 10;
  const TransferReport report = CheckTransfer(request, &silent);
  EXPECT_EQ(report.task, "pick_up_block_1");
  EXPECT_GE(report.replay.rate.successes, 8);  // 4 mm and 2 % are little for 3 cm of room
  ASSERT_TRUE(report.policy);
  EXPECT_GE(report.policy->rate.successes, 8);
  EXPECT_GT(report.replay.largest_scale, 0.5);
  EXPECT_EQ(TransferJson(report), TransferJson(CheckTransfer(request, &silent)));
}

TEST_F(BlockTransfer, RefusesAnotherTwin) {
  const fs::path other = shared_->path() / "other";
  WriteBlockTwin(other, {{-0.08, 0.7, 0.3}, {0.14, 0.8, -0.6}});
  try {
    PerturbedTwinOf(*task_, workflows::ReadTwin(other), other);
    FAIL();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("has 'block_2' elsewhere"), std::string::npos);
  }
  WriteBlockTwin(other, {{-0.08, 0.7, 0.3}});
  EXPECT_THROW(PerturbedTwinOf(*task_, workflows::ReadTwin(other), other), core::Error);
}

TEST_F(BlockTransfer, PlacesObjectsWithinTheTwinsRangesInTraining) {
  workflows::SkillRun run = task_->run();
  run.randomized = true;
  run.options.placement_ranges = {{"block_1", {0.01, 0.1}}};
  run.folder = shared_->path() / "ranges";
  workflows::WriteRun(run);
  const workflows::SkillRun read = workflows::ReadRun(run.folder);
  EXPECT_EQ(read.options.placement_ranges.at("block_1").position, 0.01);
  EXPECT_TRUE(read.randomized);
  const auto skill = workflows::PrepareSkills(read).front().evaluated;
  double widest = 0.0;
  for (const skills::StartState& start : skills::SampleStarts(*skill, 40, 1)) {
    const Eigen::Vector3d off = start.state.roots[0].translation() -
                                task_->described().objects[0].world_from_asset.translation();
    widest = std::max(widest, off.cwiseAbs().maxCoeff());
    EXPECT_LE(off.head<2>().cwiseAbs().maxCoeff(), 0.01 + 0.002);  // turns about its middle
    EXPECT_TRUE(
        start.state.roots[1].isApprox(task_->described().objects[1].world_from_asset, 1e-12));
  }
  EXPECT_GT(widest, 0.008);
}

}  // namespace
}  // namespace simwright::transfer
