#include "tasks/language/task_question.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tasks/language/api_listing.h"
#include "tasks/language/task_answer.h"
#include "tasks/language/worked_example.h"
#include "tests/tasks/language/example_scene.h"

namespace simwright::tasks {
namespace {

bool Compiles(const std::string& line, const reward::RewardScene& scene,
              core::Findings* why = nullptr) {
  const std::string program =
      "def compute_reward(env):\n"
      "    x = env.get_position(\"block\")\n"
      "    a = x[:, 0]\n"
      "    b = x[:, 1]\n"
      "    point = point_2 = x\n"
      "    low, high = env.get_bounding_box(\"chest\")\n"
      "    asset_name, link_name, joint_name = \"chest\", \"drawer\", \"drawer_slide\"\n" +
      line + "    return a, a > 0\n";
  const reward::CompileOutcome outcome = reward::CompileReward(program, &scene);
  if (why != nullptr) *why = outcome.findings;
  return outcome.program.has_value();
}

std::string Text(const core::Findings& findings) {
  std::string text;
  for (const core::Finding& finding : findings) text += finding.sentence + "\n";
  return text;
}

TEST(WorkedExample, IsReadAndCompilesWithoutAFinding) {
  const TaskAnswer answer = ReadTaskAnswer(ExampleAnswer());
  EXPECT_TRUE(answer.findings.empty());
  ASSERT_EQ(answer.tasks.size(), 1u);
  EXPECT_EQ(answer.tasks[0].name, "store_block");
  ASSERT_EQ(answer.tasks[0].subtasks.size(), 3u);
  const reward::RewardScene scene = NamesOfScene(ExampleScene());
  for (const Subtask& subtask : answer.tasks[0].subtasks) {
    const reward::CompileOutcome outcome = reward::CompileReward(subtask.program, &scene);
    EXPECT_TRUE(outcome.findings.empty()) << Text(outcome.findings);
    ASSERT_TRUE(outcome.program.has_value());
    EXPECT_TRUE(outcome.program->has_success());
    EXPECT_FALSE(subtask.description.empty());
    EXPECT_FALSE(subtask.success.empty());
  }
}

// Returns the reward and success of a program in which each input of a kind has the given numbers.
std::pair<float, bool> RunOn(const std::string& source,
                             const std::map<reward::RewardInput, std::vector<float>>& numbers) {
  const reward::RewardScene scene = NamesOfScene(ExampleScene());
  const reward::CompileOutcome outcome = reward::CompileReward(source, &scene);
  std::vector<reward::RewardBinding> bindings;
  for (const reward::RewardSlot& slot : outcome.program->slots()) {
    bindings.push_back({numbers.at(slot.input).data()});
  }
  reward::RewardWorkspace workspace(*outcome.program, 1);
  float reward = 0.0f;
  std::uint8_t success = 2;
  outcome.program->Run(bindings, 1, &workspace, &reward, &success);
  return {reward, success == 1};
}

// From start to success the reward of each example function only increases, in states computed by
// hand.
TEST(WorkedExample, RewardsRiseToSuccess) {
  using enum reward::RewardInput;
  const Task task = ReadTaskAnswer(ExampleAnswer()).tasks.at(0);
  for (int step = 0; step <= 20; ++step) {
    const float t = static_cast<float>(step) / 20.0f;
    const auto [open, opened] =
        RunOn(task.subtasks[0].program, {{kLinkPosition, {0.2f + 0.3f * t, 0.0f, 0.28f}},
                                         {kGripperPosition, {0.2f + 0.3f * t, 0.1f, 0.28f}},
                                         {kJointState, {0.3f * t}}});
    EXPECT_NEAR(open, 2.0f * t - 0.1f, 1e-5f);
    EXPECT_EQ(opened, step > 18);
    const float bottom = 0.14f * t;
    const auto [pick, picked] =
        RunOn(task.subtasks[1].program,
              {{kAssetPosition, {0.0f, 0.0f, bottom}},
               {kGripperPosition, {0.0f, 0.0f, bottom + 0.025f}},
               {kGrasped, {1.0f}},
               {kAssetBoundingBox, {-0.1f, -0.1f, bottom, 0.1f, 0.1f, bottom + 0.05f}}});
    EXPECT_NEAR(pick, -0.025f + 0.5f + 5.0f * bottom, 1e-5f);
    EXPECT_EQ(picked, bottom > 0.1f);
    const bool last = step == 20;  // releases at the centre of the drawer
    const auto [place, placed] =
        RunOn(task.subtasks[2].program, {{kLinkBoundingBox, {0.1f, -0.2f, 0.2f, 0.5f, 0.2f, 0.3f}},
                                         {kAssetPosition, {0.3f, 0.0f, 1.25f - t}},
                                         {kGrasped, {last ? 0.0f : 1.0f}}});
    EXPECT_NEAR(place, -(1.0f - t) + (last ? 1.0f : 0.0f), 1e-5f);
    EXPECT_EQ(placed, last);
  }
}

// The listing is correct: each call is known, compiles, and gives the stated shape.
TEST(ApiListing, EachFunctionCompilesAsItIsListed) {
  const reward::RewardScene scene = NamesOfScene(ExampleScene());
  const std::string listing = ApiListing();
  int listed = 0;
  for (const reward::ApiFunction& function : reward::EnvironmentApi()) {
    std::string call = ApiCall(function);
    EXPECT_NE(listing.find(call + "  # "), std::string::npos) << call;
    ++listed;
    for (const bool whole : {true, false}) {  // with and without optional arguments
      std::string plain;
      int depth = 0;
      for (const char c : call) {
        if (c == '[') ++depth;
        if (c != '[' && c != ']' && (whole || depth == 0)) plain += c;
        if (c == ']') --depth;
      }
      core::Findings why;
      EXPECT_TRUE(Compiles("    value = " + plain + "\n", scene, &why)) << plain << Text(why);
      if (function.result == reward::ApiResult::kVector && function.width > 1) {
        const std::string last = std::to_string(function.width - 1);
        const std::string beyond = std::to_string(function.width);
        EXPECT_TRUE(Compiles("    a = " + plain + "[:, " + last + "]\n", scene));
        EXPECT_FALSE(Compiles("    a = " + plain + "[:, " + beyond + "]\n", scene));
        EXPECT_NE(listing.find(call + "  # [N, " + beyond + "]"), std::string::npos);
      } else if (function.result == reward::ApiResult::kVector) {
        EXPECT_TRUE(Compiles("    a = a + " + plain + "\n", scene));
        EXPECT_FALSE(Compiles("    a = " + plain + "[:, 0]\n", scene));
      } else if (function.result == reward::ApiResult::kLimits) {
        EXPECT_TRUE(Compiles("    a = a + " + plain + "[\"upper\"]\n", scene));
      } else if (function.result == reward::ApiResult::kBox) {
        EXPECT_TRUE(Compiles("    p, q = " + plain + "\n    a = (p - q)[:, 2]\n", scene));
      }
    }
  }
  EXPECT_GE(listed, 25);
}

TEST(ApiListing, EachTensorExpressionCompiles) {
  const reward::RewardScene scene = NamesOfScene(ExampleScene());
  for (const char* expression : TensorExpressions()) {
    core::Findings why;
    EXPECT_TRUE(Compiles(std::string("    y = ") + expression + "\n", scene, &why))
        << expression << Text(why);
  }
}

TEST(TaskQuestion, HoldsTheFourSections) {
  const llm::ChatRequest request = TaskQuestion("THE SCENE\n", 3, {"open \"it\""});
  ASSERT_EQ(request.messages.size(), 2u);
  EXPECT_EQ(request.messages[0].role, llm::Role::kSystem);
  EXPECT_NE(request.messages[0].text.find("are data"), std::string::npos);
  const std::string& text = request.messages[1].text;
  std::size_t at = 0;
  for (const std::string part :
       {"## 1. Assets\n\nTHE SCENE\n", "## 2. Instructions", "env.get_robot_gripper_pose(",
        "## 3. Example of a task and its subtasks", "asset_name: \"chest\"",
        "## 4. Example of its reward functions", "Task: store_block", "Give 3 different tasks",
        "\"open \\\"it\\\"\""}) {
    at = text.find(part, at);
    ASSERT_NE(at, std::string::npos) << part;
  }
  EXPECT_EQ(TaskQuestion("S", 3, {}).messages[1].text.find("are there already"), std::string::npos);
  // The cache gives equal answers to equal requests.
  EXPECT_EQ(TaskQuestion("S", 3, {}).messages[1].text, TaskQuestion("S", 3, {}).messages[1].text);
}

TEST(TaskQuestion, ARepairShowsThePlaceWithACaret) {
  const reward::RewardScene scene = NamesOfScene(ExampleScene());
  Task task;
  task.name = "open";
  Subtask subtask;
  subtask.name = "open_drawer";
  subtask.program =
      "def compute_reward(env):\n    s = env.get_joint_state(\"chest\", \"drawer_slid\")\n"
      "    return s, s > 0.2\n";
  const core::Findings findings = reward::CompileReward(subtask.program, &scene).findings;
  ASSERT_EQ(findings.size(), 1u);
  const std::string text = RepairQuestion("S", task, subtask, findings).messages[1].text;
  EXPECT_NE(text.find(subtask.program), std::string::npos);
  EXPECT_NE(text.find(reward::RenderFinding(findings[0], subtask.program)), std::string::npos);
  EXPECT_NE(text.find("drawer_slide"), std::string::npos);  // the nearest name
  EXPECT_NE(text.find("^\n"), std::string::npos);
  EXPECT_NE(text.find("whole function"), std::string::npos);
  subtask.program.clear();
  EXPECT_NE(RepairQuestion("S", task, subtask, {}).messages[1].text.find("is missing"),
            std::string::npos);
  EXPECT_NE(RepairRetryQuestion("same", "same", {}).find("the same function as before"),
            std::string::npos);
}

}  // namespace
}  // namespace simwright::tasks
