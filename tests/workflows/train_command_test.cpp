// `train` and `rollout` with trainings too short to learn much: written files, resuming, reuse and
// rejected inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"
#include "running_program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr const char* kTrainCommandTin = R"(<robot name="tin"><link name="base">
  <contact><lateral_friction value="0.6"/></contact>
  <collision><origin xyz="0 0 0.04"/><geometry><box size="0.05 0.05 0.08"/></geometry></collision>
  <inertial><origin xyz="0 0 0.04"/><mass value="0.2"/>
    <inertia ixx="1.5e-4" iyy="1.5e-4" izz="8e-5" ixy="0" ixz="0" iyz="0"/></inertial>
</link></robot>
)";

class TrainCommand : public testing::Test {
 protected:
  TrainCommand() {
    fs::create_directories(folder_.path() / "tin");
    core::WriteFile(folder_.path() / "tin" / "tin.urdf", kTrainCommandTin);
    const Outcome made = RunProgram("tasks " + Path("tin") + " -o " + Path("tasks.json"));
    EXPECT_EQ(made.code, 0) << made.text;
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  Outcome Train(const std::string& task, const std::string& more) const {
    return RunProgram("train " + Path("tasks.json") + " --task " + task + " -o " + Path("run") +
                      " --envs 8 --steps 2048 --episodes 6 " + more);
  }

  core::TemporaryFolder folder_;
};

TEST_F(TrainCommand, WritesARunThatRolloutsReadAndResumeKeeps) {
  const Outcome trained = Train("pick_up_tin", "--json");
  ASSERT_EQ(trained.code, 0) << trained.text;
  const auto report = nlohmann::json::parse(core::ReadFile(Path("run/report.json")));
  ASSERT_EQ(report.at("subtasks").size(), 1u);
  EXPECT_EQ(report["subtasks"][0].at("name"), "pick_up_tin");
  EXPECT_EQ(report["subtasks"][0].at("samples"), 2048);
  EXPECT_EQ(report["subtasks"][0]["own_starts"].at("episodes"), 6);
  for (const char* file : {"policy.pt", "checkpoint.pt", "curves.svg"}) {
    EXPECT_TRUE(fs::exists(Path("run/1_pick_up_tin/") + file)) << file;
  }
  const std::string policy = core::ReadFile(Path("run/1_pick_up_tin/policy.pt"));

  const Outcome again = Train("pick_up_tin", "");
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--resume"), std::string::npos) << again.text;
  const Outcome resumed = Train("pick_up_tin", "--resume");
  EXPECT_EQ(resumed.code, 0) << resumed.text;
  EXPECT_EQ(core::ReadFile(Path("run/1_pick_up_tin/policy.pt")), policy);  // nothing was retrained

  const Outcome first = RunProgram("rollout " + Path("run") + " --episodes 6 --json");
  const Outcome second = RunProgram("rollout " + Path("run") + " --episodes 6 --json --threads 1");
  ASSERT_EQ(first.code, 0) << first.text;
  EXPECT_EQ(first.text, second.text);  // for any number of threads
  EXPECT_EQ(nlohmann::json::parse(first.text).at("episodes"), 6);

  core::WriteFile(folder_.path() / "tin" / "tin.urdf",
                  std::string(kTrainCommandTin) + "<!-- new -->\n");
  const Outcome changed = RunProgram("rollout " + Path("run"));
  EXPECT_EQ(changed.code, 1);
  EXPECT_NE(changed.text.find("'tin' has changed"), std::string::npos) << changed.text;
  fs::remove_all(folder_.path() / "tin");
  const Outcome gone = RunProgram("rollout " + Path("run"));
  EXPECT_EQ(gone.code, 1);
  EXPECT_NE(gone.text.find("'tin' no longer exists"), std::string::npos) << gone.text;
}

// Only one training may write into a folder at a time; a stopped one reports its kept results, and
// a killed one does not block others.
TEST_F(TrainCommand, OneTrainsInAFolderAndCtrlCKeepsWhatItLearnt) {
  const std::string long_training =
      "train " + Path("tasks.json") + " --task pick_up_tin -o " + Path("run") +
      " --envs 8 --steps 2000000 --minutes 0 --episodes 6 --threads 1";
  const auto begun = [&] { return fs::exists(Path("run/run.json")); };
  RunningProgram first(long_training, Path("first.txt"));
  ASSERT_TRUE(first.WaitFor(begun)) << core::ReadFile(Path("first.txt"));
  const Outcome second = RunProgram(long_training + " --resume");
  EXPECT_EQ(second.code, 1);
  EXPECT_NE(second.text.find("process " + std::to_string(first.pid())), std::string::npos)
      << second.text;
  EXPECT_EQ(std::count(second.text.begin(), second.text.end(), '\n'), 1) << second.text;
  first.EndBy(SIGKILL);
  const std::string table = Path("run/1_pick_up_tin/training.csv");
  fs::remove(table);

  RunningProgram resumed(long_training + " --resume", Path("resumed.txt"));
  const auto learns = [&] {  // the table has its first row
    if (!fs::exists(table)) return false;
    const std::string text = core::ReadFile(table);
    return std::count(text.begin(), text.end(), '\n') >= 2;
  };
  ASSERT_TRUE(resumed.WaitFor(learns)) << core::ReadFile(Path("resumed.txt"));
  EXPECT_EQ(core::ReadFile(Path("run/.lock")), std::to_string(resumed.pid()) + "\n");
  const Outcome stopped = resumed.EndBy(SIGINT);
  EXPECT_EQ(stopped.code, 130);
  EXPECT_NE(stopped.text.find("kept in " + Path("run")), std::string::npos) << stopped.text;
  EXPECT_NE(stopped.text.find("--resume"), std::string::npos) << stopped.text;
  EXPECT_EQ(stopped.text.find("nothing was written"), std::string::npos) << stopped.text;

  EXPECT_TRUE(fs::exists(Path("run/1_pick_up_tin/checkpoint.pt")));
  const Outcome ended = Train("pick_up_tin", "--resume --json");
  EXPECT_EQ(ended.code, 0) << ended.text;
  const auto report = nlohmann::json::parse(core::ReadFile(Path("run/report.json")));
  EXPECT_EQ(report["subtasks"][0].at("method"),
            "imitation of a scripted expert");  // 2048 of 65,536
  EXPECT_EQ(report["subtasks"][0].at("imitated"), report["subtasks"][0].at("samples"));
}

TEST_F(TrainCommand, RefusesWithOneLine) {
  const Outcome unknown = Train("pick_up_pan", "");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.text.find("pick_up_tin"), std::string::npos) << unknown.text;
  EXPECT_FALSE(fs::exists(Path("run")));
  const Outcome mixed = Train("'*'", "");
  EXPECT_EQ(mixed.code, 1);
  EXPECT_NE(mixed.text.find("number of subtasks"), std::string::npos) << mixed.text;
  const Outcome robot = Train("pick_up_tin", "--robot " + Path("tin/tin.urdf"));
  EXPECT_EQ(robot.code, 1);
  EXPECT_NE(robot.text.find("tin.json"), std::string::npos) << robot.text;
  const Outcome nothing = RunProgram("rollout " + Path("tin"));
  EXPECT_EQ(nothing.code, 1);
  EXPECT_NE(nothing.text.find("not a training folder"), std::string::npos) << nothing.text;
}

}  // namespace
}  // namespace simwright
