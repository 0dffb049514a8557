#include "transfer/twin_tasks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "block_twin.h"
#include "core/error.h"
#include "transfer/pick_choice.h"
#include "transfer/twin_ranges.h"
#include "transfer/twin_run.h"

namespace simwright::transfer {
namespace {

const std::vector<PlacedBlock> kBlocks = {{-0.08, 0.7, 0.3}, {0.12, 0.75, -0.6}, {0.02, 0.95, 0.1}};

std::string Refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(MakeTwinTasks, StartsEveryTaskInTheTwinsLayout) {
  const core::TemporaryFolder folder;
  const workflows::TwinRecord record = WriteBlockTwin(folder.path(), kBlocks);
  const workflows::TasksReport report = BlockTasks(folder.path());
  EXPECT_TRUE(report.passed());
  int picked = 0;
  for (const tasks::Task& task : report.set.tasks) {
    picked += task.name.starts_with("pick_up_block_");
    const tasks::InitialState& start = task.subtasks.front().start;
    ASSERT_EQ(start.placements.size(), record.objects.size()) << task.name;
    for (size_t k = 0; k < record.objects.size(); ++k) {
      EXPECT_EQ(start.placements[k].asset, record.objects[k].name);
      EXPECT_TRUE(
          start.placements[k].world_from_asset.isApprox(record.objects[k].world_from_object, 1e-12))
          << task.name;
    }
    EXPECT_EQ(start.world_from_robot.translation().z(), 0.0);
    EXPECT_EQ(task.assets.size(), record.objects.size()) << task.name;
  }
  EXPECT_EQ(picked, 3);
}

TEST(MakeTwinTasks, StandsTheRobotOnTheCamerasSideWithinReach) {
  const core::TemporaryFolder folder;
  WriteBlockTwin(folder.path(), kBlocks);
  const workflows::TasksReport report = BlockTasks(folder.path());
  const Eigen::Isometry3d robot = report.set.tasks.front().subtasks.front().start.world_from_robot;
  EXPECT_LT(robot.translation().y(), 0.5);
  for (const PlacedBlock& block : kBlocks) {
    const Eigen::Vector3d seen = robot.inverse() * Eigen::Vector3d(block.x, block.y, 0.0);
    EXPECT_GT(seen.x(), 0.2);
    EXPECT_LT(seen.norm(), 0.8);
  }
  ASSERT_FALSE(report.findings.empty());
  EXPECT_EQ(report.findings.front().code, "twin-robot-placed");
  EXPECT_EQ(report.findings.front().figure, 3.0);
}

TEST(MakeTwinTasks, KeepsTheStatedRobotAndNamesWhatItDoesNotReach) {
  const core::TemporaryFolder folder;
  WriteBlockTwin(folder.path(), {{0.0, 0.7, 0.0}, {0.0, 2.2, 0.0}});
  TwinTasksRequest request;
  request.twin = folder.path();
  request.output = folder.path() / "tasks.json";
  request.robot = Eigen::Vector3d(0.1, 0.2, 1.5);
  core::Progress silent;
  const workflows::TasksReport report = MakeTwinTasks(request, &silent);
  const Eigen::Isometry3d robot = report.set.tasks.front().subtasks.front().start.world_from_robot;
  EXPECT_TRUE(robot.translation().isApprox(Eigen::Vector3d(0.1, 0.2, 0.0)));
  EXPECT_NEAR(std::atan2(robot.linear()(1, 0), robot.linear()(0, 0)), 1.5, 1e-12);
  const auto far =
      std::find_if(report.findings.begin(), report.findings.end(),
                   [](const core::Finding& one) { return one.code == "twin-out-of-reach"; });
  ASSERT_NE(far, report.findings.end());
  EXPECT_EQ(far->place, "block_2");
  for (const tasks::Task& task : report.set.tasks) {
    EXPECT_EQ(task.name.find("block_2"), std::string::npos) << task.name;
  }
}

TEST(MakeTwinTasks, RefusesInOneLine) {
  const core::TemporaryFolder folder;
  TwinTasksRequest request;
  request.twin = folder.path();
  request.output = folder.path() / "tasks.json";
  core::Progress silent;
  const auto make = [&] { MakeTwinTasks(request, &silent); };
  EXPECT_NE(Refusal(make).find("the folder holds no twin"), std::string::npos);
  WriteBlockTwin(folder.path(), {});
  EXPECT_NE(Refusal(make).find("the twin has no objects"), std::string::npos);
  WriteBlockTwin(folder.path(), kBlocks);
  request.robot = Eigen::Vector3d(5.0, 0.0, 0.0);
  EXPECT_NE(Refusal(make).find("reaches none"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(request.output));
}

TEST(RunTwin, RefusesATwinWithoutAGraspableObject) {
  const core::TemporaryFolder folder;
  WriteBlockTwin(folder.path() / "twin", {{0.0, 0.7, 0.0, 0.3}});  // 30 cm wide
  TwinRunRequest request;
  request.twin = folder.path() / "twin";
  request.output = folder.path() / "run";
  core::Progress silent;
  const auto run = [&] { RunTwin(request, &silent); };
  EXPECT_NE(Refusal(run).find("no object of the twin can be picked up"), std::string::npos)
      << Refusal(run);
  // The findings of the tasks stay in the run, and are made again after a stop between the two.
  request.resume = true;
  const std::filesystem::path findings = request.output / "task_findings.json";
  const std::string text = core::ReadFile(findings);
  EXPECT_NE(text.find("twin-robot-placed"), std::string::npos) << text;
  std::filesystem::remove(findings);
  EXPECT_NE(Refusal(run).find("can be picked up"), std::string::npos) << Refusal(run);
  EXPECT_EQ(core::ReadFile(findings), text);
  request.sigmas = 3.0;
  EXPECT_NE(Refusal(run).find("other options"), std::string::npos) << Refusal(run);
  std::filesystem::create_directories(folder.path() / "mine");
  request.output = folder.path() / "mine";
  request.force = true;
  EXPECT_NE(Refusal(run).find("no run on a twin"), std::string::npos) << Refusal(run);
}

TEST(SurestPicks, BeginWithTheObjectThatLeavesTheFingersMostRoom) {
  const core::TemporaryFolder folder;
  workflows::TwinRecord record = WriteBlockTwin(
      folder.path(), {{-0.1, 0.7, 0.0, 0.06}, {0.1, 0.7, 0.0, 0.04}, {0.0, 0.9, 0.0, 0.05}});
  record.objects[1].position_error = 0.02;
  const tasks::TaskSet set = BlockTasks(folder.path()).set;
  // The fingers open 8 cm.
  EXPECT_NEAR(GripRoom(record.objects[0]), 0.01 / 0.004, 1e-9);
  EXPECT_NEAR(GripRoom(record.objects[1]), 0.02 / 0.02, 1e-9);
  EXPECT_EQ(SurestPicks(set, record),
            (std::vector<std::string>{"pick_up_block_3", "pick_up_block_1", "pick_up_block_2"}));
}

TEST(TrainTask, RefusesTheRangesOfAnotherTwin) {
  const core::TemporaryFolder folder;
  WriteBlockTwin(folder.path() / "twin", kBlocks);
  BlockTasks(folder.path() / "twin");
  WriteBlockTwin(folder.path() / "other", {kBlocks[0], kBlocks[1]});
  workflows::TrainRequest request;
  request.task_file = folder.path() / "twin/tasks.json";
  request.tasks = {"pick_up_block_1"};
  request.output = folder.path() / "run";
  request.placement_ranges = PlacementRanges(folder.path() / "other", 2.0);
  core::Progress silent;
  for (const bool randomized : {true, false}) {
    request.randomized = randomized;
    const std::string refusal = Refusal([&] { workflows::TrainTask(request, &silent); });
    EXPECT_EQ(refusal.rfind("asset 'block_3': the twin has no object of that name", 0), 0u)
        << refusal;
    EXPECT_FALSE(std::filesystem::exists(request.output));
  }
}

TEST(PlacementRanges, AreMultiplesOfTheTwinsErrors) {
  const core::TemporaryFolder folder;
  WriteBlockTwin(folder.path(), kBlocks, 0.007);
  const auto ranges = PlacementRanges(folder.path(), 2.0);
  ASSERT_EQ(ranges.size(), 3u);
  EXPECT_DOUBLE_EQ(ranges.at("block_2").position, 0.014);
  EXPECT_DOUBLE_EQ(ranges.at("block_2").yaw, 0.1);
  EXPECT_DOUBLE_EQ(PlacementRanges(folder.path(), 100.0).at("block_1").yaw, M_PI);
  WriteBlockTwin(folder.path(), {});  // no ranges would mean the default ones
  EXPECT_THROW(PlacementRanges(folder.path(), 2.0), core::Error);
}

}  // namespace
}  // namespace simwright::transfer
