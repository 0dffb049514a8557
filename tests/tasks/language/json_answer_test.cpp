// Answers in valid and nearly valid JSON.
#include <gtest/gtest.h>

#include <string>

#include "tests/tasks/language/answer_shape.h"

namespace simwright::tasks {
namespace {

TEST(JsonAnswer, TasksWithSubtasks) {
  const std::string text =
      R"json(Here you are: {"tasks": [{"task_name": "Bake bread", "Task Description": "Bake.",
      "subtasks": [
        {"name": "open", "description": "Open.", "success": "it is open",
         "reward_function":
  "def compute_reward(env):\n    s = env.get_joint_state('oven', 'door')\n    return s, s > 1"},
        {"subtask": "turn", "code": ["def compute_reward(env):",
         "    s = env.get_joint_state('oven', 'knob')", "    return s, s > 1"]}]}]} Enjoy.)json";
  const TaskAnswer answer = ReadTaskAnswer(text);
  EXPECT_EQ(Shape(answer), "Bake_bread(open:door turn:knob)");
  EXPECT_EQ(answer.tasks[0].subtasks[0].success, "it is open");
  EXPECT_EQ(answer.tasks[0].subtasks[1].success, "s > 1");
  EXPECT_EQ(answer.tasks[0].description, "Bake.");
}

TEST(JsonAnswer, JsonOfManyShapes) {
  const std::string program =
      "def compute_reward(env):\\n    s = env.get_state_by_joint_name("
      "'oven', 'door')\\n    return s, s > 1";
  EXPECT_EQ(ShapeOf("```json\n[{\"name\": \"a\", \"reward\": \"" + program +
                    "\"}, {\"name\": "
                    "\"b\", \"program\": \"" +
                    program + "\"}]\n```"),
            "a(a:door) b(b:door)");
  EXPECT_EQ(ShapeOf("{\"zeta\": {\"code\": \"" + program +
                    "\"}, \"alpha\": {\"subtasks\": "
                    "{\"two\": \"" +
                    program + "\", \"one\": \"" + program + "\"}}}"),
            "zeta(zeta:door) alpha(two:door one:door)");
  EXPECT_EQ(ShapeOf("{\"task\": \"t\", \"subtasks\": [\"x\", \"y\"], \"reward_functions\": [\"" +
                    program + "\", {\"code\": \"" + program + "\"}]}"),
            "t(x:door y:door)");
  EXPECT_EQ(ShapeOf("{\"task\": \"t\", \"reward\": \"```python\\n" + program + "\\n```\",}"),
            "t(t:door)");
}

TEST(JsonAnswer, JsonWithLineBreaksAndTripleQuotes) {
  EXPECT_EQ(ShapeOf("{\"task\": \"t\", \"reward\": \"def compute_reward(env):\n    s = "
                    "env.get_state_by_joint_name('oven', 'door')\n    return s, s > 1\n\"}"),
            "t(t:door)");
  EXPECT_EQ(ShapeOf("{\"task\": \"t\", \"reward\": \"\"\"\n" + Function("door") + "\"\"\"}"),
            "t(t:door)");
}

TEST(JsonAnswer, APlanInJsonAndTheFunctionsBelowIt) {
  EXPECT_EQ(ShapeOf("```json\n[{\"task\": \"bake\", \"subtasks\": [\"open\", {\"name\": "
                    "\"turn\"}]}]\n```\nThe functions:\n" +
                    Fenced(Function("door")) + Fenced(Function("knob"))),
            "bake(open:door turn:knob)");
}

}  // namespace
}  // namespace simwright::tasks
