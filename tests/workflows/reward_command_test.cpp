// `reward`, the linter for reward programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr const char* kOven = R"(<robot name="oven_0042">
  <link name="base"><inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
    iyz="0"/></inertial></link>
  <link name="door"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
    iyz="0"/></inertial></link>
  <joint name="door_hinge" type="revolute">
    <parent link="base"/><child link="door"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="1.5" effort="10" velocity="1"/>
  </joint>
</robot>
)";

constexpr const char* kOpens = R"(def compute_reward(env):
    handle = env.get_pose_by_link_name("oven", "door")
    reach = torch.norm(env.get_robot_gripper_pose() - handle, dim=-1)
    angle = env.get_state_by_joint_name("oven", "door_hinge")
    left = torch.abs(env.get_limits_by_joint_name("oven", "door_hinge")["upper"] - angle)
    return -reach - left, left < 0.1
)";

class RewardCommand : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) const {
    const fs::path path = folder_.path() / name;
    fs::create_directories(path.parent_path());
    core::WriteFile(path, text);
    return path.string();
  }
  // A folder in PartNet-Mobility's layout.
  std::string Oven() const {
    Write("oven/mobility.urdf", kOven);
    return (folder_.path() / "oven").string();
  }
  // One line "error: ...", exit 1.
  static void ExpectRefused(const std::string& arguments, const std::string& word) {
    const Outcome outcome = RunProgram(arguments);
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_NE(outcome.text.find(word), std::string::npos) << outcome.text;
  }

  core::TemporaryFolder folder_;
};

TEST_F(RewardCommand, SaysWhatASoundProgramReadsAndGives) {
  const Outcome outcome = RunProgram("reward " + Write("open.py", kOpens) + " --assets " + Oven());
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* part :
       {"passes: compute_reward gives a reward and success",
        "reads link_position of oven, door [N, 3]", "reads gripper_position [N, 3]",
        "reads joint_state of oven, door_hinge [N]"}) {
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << "\n" << outcome.text;
  }
  // The limit is a constant, because the scene is known.
  EXPECT_EQ(outcome.text.find("joint_upper"), std::string::npos) << outcome.text;
}

TEST_F(RewardCommand, PointsAtAWrongNameAndSaysTheNearest) {
  std::string wrong = kOpens;
  wrong.replace(wrong.find("\"door_hinge\")\n"), 12, "\"dor_hinge\"");
  const Outcome outcome = RunProgram("reward " + Write("open.py", wrong) + " --assets " + Oven());
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("open.py:4:"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("'door_hinge'"), std::string::npos) << outcome.text;
  // The line itself, and a caret below the fault.
  const std::string line = "    angle = env.get_state_by_joint_name(\"oven\", \"dor_hinge\")";
  const std::size_t at = outcome.text.find(line);
  ASSERT_NE(at, std::string::npos) << outcome.text;
  const std::size_t below = outcome.text.find('\n', at) + 1;
  const std::string caret = outcome.text.substr(below, outcome.text.find('\n', below) - below);
  EXPECT_EQ(caret, std::string(line.find("\"dor") + 4, ' ') + "^") << outcome.text;
  EXPECT_NE(outcome.text.find("does not pass: 1 error"), std::string::npos) << outcome.text;
}

TEST_F(RewardCommand, JsonHoldsFindingsOrWhatIsRead) {
  const std::string program = Write("open.py", kOpens);
  const Outcome good = RunProgram(
      "reward " + program + " --json --assets oven=" + Write("elsewhere/anything.urdf", kOven));
  EXPECT_EQ(good.code, 0) << good.text;
  const nlohmann::json sound = nlohmann::json::parse(good.text);
  EXPECT_TRUE(sound["passed"]);
  EXPECT_EQ(sound["function"], "compute_reward");
  EXPECT_EQ(sound["reads"].size(), 3u);
  const Outcome bad = RunProgram("reward " + program + " --json --assets " +
                                 Write("elsewhere/anything.urdf", kOven));
  EXPECT_EQ(bad.code, 1) << bad.text;
  const nlohmann::json flawed = nlohmann::json::parse(bad.text);
  EXPECT_FALSE(flawed["passed"]);
  ASSERT_GE(flawed["findings"].size(), 1u);
  EXPECT_EQ(flawed["findings"][0]["severity"], "error");
  EXPECT_EQ(flawed["findings"][0]["place"].get<std::string>().substr(0, 2), "2:");
}

TEST_F(RewardCommand, AFunctionAloneTakesItsParametersAsInputs) {
  const std::string program = Write("reach.py",
                                    "import torch\n"
                                    "@torch.jit.script\n"
                                    "def compute_reward(hand_pos: torch.Tensor, goal_pos: "
                                    "torch.Tensor):\n"
                                    "    left = torch.norm(hand_pos - goal_pos, p=2, dim=-1)\n"
                                    "    near = torch.exp(-4.0 * left)\n"
                                    "    return near, {\"near\": near}\n");
  const Outcome outcome = RunProgram("reward " + program + " --no-scene");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("in components near"), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("reads parameter hand_pos"), std::string::npos) << outcome.text;
}

TEST_F(RewardCommand, WhatCannotBeReadIsSaidInOneLine) {
  const std::string program = Write("open.py", kOpens);
  ExpectRefused("reward " + program, "--no-scene");
  ExpectRefused("reward " + program + " --assets nowhere", "nowhere");
  ExpectRefused("reward missing.py --no-scene", "missing.py");
  ExpectRefused("reward " + program + " --assets " + Oven() + " oven=" + Oven(), "two assets");
  fs::create_directories(folder_.path() / "empty");
  ExpectRefused("reward " + program + " --assets " + (folder_.path() / "empty").string(),
                "holds no URDF");
}

TEST_F(RewardCommand, AProgramOfAMegabyteGetsOneFinding) {
  std::string large = "def compute_reward(env):\n";
  while (large.size() < (1u << 20)) large += "    # nothing\n";
  const Outcome outcome = RunProgram("reward --no-scene " + Write("large.py", large));
  EXPECT_EQ(outcome.code, 1) << outcome.text.substr(0, 500);
  EXPECT_NE(outcome.text.find("does not pass: 1 error"), std::string::npos)
      << outcome.text.substr(0, 500);
}

}  // namespace
}  // namespace simwright
