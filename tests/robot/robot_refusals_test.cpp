// Invalid robots: each gives a one-line error that names the file and the remedy.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files.h"
#include "robot/robot_model.h"

namespace simwright::robot {
namespace {
namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path kRobots = fs::path(SIMWRIGHT_SOURCE_DIR) / "robots";

class Refusal : public testing::Test {
 protected:
  Refusal()
      : urdf_(core::ReadFile(kRobots / "generic6/generic6.urdf")),
        side_(Json::parse(core::ReadFile(kRobots / "generic6/generic6.json"))) {}

  // Returns the error line for the current robot; empty if it loads.
  std::string Line() { return LineOfText(side_.dump(2)); }
  std::string LineOfText(const std::string& side) {
    const core::TemporaryFolder folder;
    core::WriteFile(folder.path() / "arm.urdf", urdf_);
    core::WriteFile(folder.path() / "arm.json", side);
    try {
      ReadRobot(folder.path() / "arm.urdf");
    } catch (const core::Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return error.what();
    }
    return "";
  }
  void Replace(const std::string& from, const std::string& to) {
    const std::size_t at = urdf_.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    urdf_.replace(at, from.size(), to);
  }

  std::string urdf_;
  Json side_;
};

void ExpectSays(const std::string& line, std::initializer_list<const char*> words) {
  for (const char* word : words) {
    EXPECT_NE(line.find(word), std::string::npos) << "'" << word << "' is not in: " << line;
  }
}

TEST_F(Refusal, NothingIsRefusedOfTheRobotAsItIs) {
  EXPECT_EQ(Line(), "");
  side_.erase("limits");
  side_.erase("margin");
  side_.erase("base_joints");
  side_.erase("ignored_collisions");
  EXPECT_EQ(Line(), "");
}

TEST_F(Refusal, OfASideFileThatIsMissing) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "arm.urdf", urdf_);
  try {
    ReadRobot(folder.path() / "arm.urdf");
    FAIL();
  } catch (const core::Error& error) {
    ExpectSays(error.what(), {"arm.json", "missing", "docs/robots.md"});
  }
}

TEST_F(Refusal, OfNamesThatTheUrdfLacks) {
  Json whole = side_;
  side_["gripper"]["joints"] = {"thumb"};
  ExpectSays(Line(), {"arm.json", "gripper.joints", "'thumb'"});
  side_ = whole;
  side_["gripper"]["finger_links"][0] = "thumb";
  ExpectSays(Line(), {"finger_links", "'thumb'"});
  side_ = whole;
  side_["tool_link"] = "hook";
  ExpectSays(Line(), {"tool_link", "'hook'"});
  side_ = whole;
  side_["arm_joints"][2] = "elbow";
  ExpectSays(Line(), {"arm_joints", "'elbow'"});
  side_ = whole;
  side_["limits"]["elbow"] = {{"velocity", 1.0}};
  ExpectSays(Line(), {"limits", "'elbow'"});
  side_ = whole;
  side_["ignored_collisions"][0][1] = "hook";
  ExpectSays(Line(), {"ignored_collisions", "'hook'"});
  side_ = whole;
  side_["home"]["elbow"] = 0.0;
  ExpectSays(Line(), {"home", "'elbow'"});
}

TEST_F(Refusal, OfAUrdfWithoutTheGripper) {
  const std::size_t from = urdf_.find("  <joint name=\"finger_a_joint\"");
  urdf_ = urdf_.substr(0, from) + "</robot>\n";
  ExpectSays(Line(), {"gripper.joints", "'finger_a_joint'"});
}

TEST_F(Refusal, OfJointsThatAreNoChain) {
  const Json whole = side_;
  std::swap(side_["arm_joints"][1], side_["arm_joints"][2]);
  ExpectSays(Line(), {"not a chain", "'joint3'", "'joint2'"});
  side_ = whole;
  side_["arm_joints"].erase(5);
  ExpectSays(Line(), {"'joint6' moves the tool"});
  side_ = whole;
  side_["arm_joints"].push_back("finger_a_joint");
  ExpectSays(Line(), {"'finger_a_joint' does not lead to the tool"});
  side_ = whole;
  side_["gripper"]["joints"][1] = "joint6";
  ExpectSays(Line(), {"'joint6'", "arm and of the gripper"});
}

TEST_F(Refusal, OfPositionsOutsideTheLimits) {
  const Json whole = side_;
  side_["home"]["joint2"] = 2.5;
  ExpectSays(Line(), {"home", "'joint2'", "2.5", "-2 to 2"});
  side_ = whole;
  side_["home"].erase("joint2");
  ExpectSays(Line(), {"home", "'joint2'"});
  side_ = whole;
  side_["gripper"]["open"] = 0.2;
  ExpectSays(Line(), {"0.2", "'finger_a_joint'", "0.045"});
  side_ = whole;
  side_["gripper"]["open"] = 0.0;
  ExpectSays(Line(), {"gripper", "same position"});
}

TEST_F(Refusal, OfALimitWithoutRange) {
  Replace("lower=\"-2.6\" upper=\"2.6\"", "lower=\"1.5\" upper=\"1.5\"");
  ExpectSays(Line(), {"arm.urdf", "'joint3'", "cannot move"});
}

TEST_F(Refusal, OfRatesThatAreNone) {
  const Json whole = side_;
  for (const double wrong : {0.0, -1.0}) {
    side_["limits"]["joint1"]["velocity"] = wrong;
    ExpectSays(Line(), {"limits.joint1.velocity", "above 0"});
  }
  side_ = whole;
  side_["limits"]["joint1"]["velocity"] = 0.01;  // less than the margin of 3 ms x 8 rad/s^2
  ExpectSays(Line(), {"limits.joint1", "margin"});
}

TEST_F(Refusal, OfTextThatIsNoSideFile) {
  const std::string whole = side_.dump(2);
  for (std::size_t length = 0; length < whole.size(); length += 97) {
    ExpectSays(LineOfText(whole.substr(0, length)), {"arm.json", "JSON"});
  }
  for (const char* number : {"NaN", "1e999", "-Infinity"}) {
    std::string text = whole;
    text.replace(text.find("1.5"), 3, number);
    ExpectSays(LineOfText(text), {"arm.json", "JSON"});
  }
}

TEST_F(Refusal, OfWrongTypesAndMembers) {
  const Json whole = side_;
  const std::vector<std::pair<Json::json_pointer, Json>> wrong = {
      {Json::json_pointer("/format"), 2},
      {Json::json_pointer("/format"), "1"},
      {Json::json_pointer("/tool_link"), 3},
      {Json::json_pointer("/arm_joints"), "joint1"},
      {Json::json_pointer("/arm_joints/0"), 1},
      {Json::json_pointer("/home"), Json::array()},
      {Json::json_pointer("/home/joint1"), "0"},
      {Json::json_pointer("/limits/joint1"), 3},
      {Json::json_pointer("/limits/joint1/speed"), 3},
      {Json::json_pointer("/gripper/joints"), Json::array()},
      {Json::json_pointer("/gripper/grip_force"), -1},
      {Json::json_pointer("/margin/delay"), -1},
      {Json::json_pointer("/ignored_collisions/0"), Json::array({"base"})},
      {Json::json_pointer("/surprise"), true},
  };
  for (const auto& [place, value] : wrong) {
    side_ = whole;
    side_[place] = value;
    EXPECT_NE(Line(), "") << place.to_string() << " = " << value;
  }
  for (const char* member : {"format", "tool_link", "arm_joints", "home", "gripper"}) {
    side_ = whole;
    side_.erase(member);
    ExpectSays(Line(), {member, "missing"});
  }
}

}  // namespace
}  // namespace simwright::robot
