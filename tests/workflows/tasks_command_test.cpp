// `tasks` by rules, and by a language model whose answers are good, flawed and then repaired, or
// hopeless. The server is a real one, started here.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"
#include "tasks/task_file.h"

#include "tests/llm/chat_server.h"  // last: see there

namespace simwright {
namespace {
namespace fs = std::filesystem;

// A chest, 0.3 m high, whose drawer slides 0.25 m towards -x.
constexpr const char* kChest = R"(<robot name="chest">
  <link name="body">
    <collision><origin xyz="0 0 0.01"/><geometry><box size="0.4 0.4 0.02"/></geometry></collision>
    <collision><origin xyz="0 0 0.29"/><geometry><box size="0.4 0.4 0.02"/></geometry></collision>
    <collision><origin xyz="0.19 0 0.15"/><geometry><box size="0.02 0.4 0.26"/></geometry></collision>
    <inertial><mass value="9"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="drawer">
    <collision><geometry><box size="0.34 0.34 0.01"/></geometry></collision>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="handle">
    <collision><geometry><box size="0.02 0.12 0.02"/></geometry></collision>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="drawer_joint" type="prismatic">
    <parent link="body"/><child link="drawer"/><origin xyz="-0.02 0 0.1"/><axis xyz="-1 0 0"/>
    <limit lower="0" upper="0.25" effort="10" velocity="1"/>
  </joint>
  <joint name="handle_joint" type="fixed">
    <parent link="drawer"/><child link="handle"/><origin xyz="-0.2 0 0.05"/>
  </joint>
</robot>
)";

constexpr const char* kTasksCommandTin = R"(<robot name="tin"><link name="base">
  <collision><origin xyz="0 0 0.04"/><geometry><box size="0.06 0.06 0.08"/></geometry></collision>
  <inertial><mass value="0.3"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link></robot>
)";

std::string Program(const std::string& joint, const std::string& sign) {
  return "def compute_reward(env):\n"
         "    handle = env.get_pose_by_link_name('chest', 'handle')\n"
         "    reach = torch.norm(env.get_robot_gripper_pose() - handle, dim=-1)\n"
         "    q = env.get_state_by_joint_name('chest', '" +
         joint +
         "')\n"
         "    return " +
         sign + "q - reach, q >= 0.2\n";
}

std::string Fenced(const std::string& program) {
  return "```python\n" + program + "```\n";
}

std::string AnswerTask(const std::string& name, const std::string& program) {
  return "Task: " + name + "\nTask Description: \"Open the drawer of the chest.\"\n" +
         Fenced(program);
}

llm::ChatServer::Handler Saying(const std::vector<std::string>& answers) {
  return [answers](int number, const httplib::Request&, httplib::Response& response) {
    const auto at = std::min(static_cast<std::size_t>(number), answers.size() - 1);
    response.set_content(llm::GoodBody(answers[at]), "application/json");
  };
}

class TasksCommand : public testing::Test {
 protected:
  TasksCommand() {
    for (const auto& [name, text] : {std::pair{"chest", kChest}, {"tin", kTasksCommandTin}}) {
      fs::create_directories(folder_.path() / "assets" / name);
      core::WriteFile(folder_.path() / "assets" / name / (std::string(name) + ".urdf"), text);
    }
  }
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Assets() const { return Path("assets"); }
  tasks::TaskSet Read(const std::string& name) const { return tasks::ReadTaskFile(Path(name)); }

  core::TemporaryFolder folder_;
};

TEST_F(TasksCommand, RulesMakeATableAFileAndAPage) {
  const Outcome outcome = RunProgram("tasks " + Assets() + " -o " + Path("tasks.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("open_chest_drawer"), std::string::npos) << outcome.text;
  const tasks::TaskSet set = Read("tasks.json");
  ASSERT_EQ(set.assets.size(), 2u);
  EXPECT_EQ(set.assets[0].name, "chest");
  EXPECT_GE(set.tasks.size(), 5u);
  for (const tasks::Task& task : set.tasks) EXPECT_TRUE(task.valid()) << task.name;
  const std::string page = core::ReadFile(Path("tasks.html"));
  EXPECT_NE(page.find("open_chest_drawer"), std::string::npos);
  EXPECT_NE(page.find("<svg"), std::string::npos);

  const Outcome again = RunProgram("tasks " + Assets() + " -o " + Path("tasks.json"));
  EXPECT_EQ(again.code, 1);
  EXPECT_EQ(again.text.rfind("error: ", 0), 0u) << again.text;
  EXPECT_EQ(std::count(again.text.begin(), again.text.end(), '\n'), 1) << again.text;
}

TEST_F(TasksCommand, TheSameSeedGivesTheSameBytes) {
  for (const char* name : {"a.json", "b.json"}) {
    ASSERT_EQ(RunProgram("tasks " + Assets() + " --seed 7 -o " + Path(name)).code, 0);
  }
  EXPECT_EQ(core::ReadFile(Path("a.json")), core::ReadFile(Path("b.json")));
}

TEST_F(TasksCommand, AGoodAnswerIsTakenAsItIs) {
  llm::ChatServer server(Saying({AnswerTask("open_it", Program("drawer_joint", "2 * "))}));
  const Outcome outcome = RunProgram("tasks " + Assets() + " --count 1 --llm " + server.url() +
                                     " --record " + Path("good.jsonl") + " -o " + Path("t.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const tasks::TaskSet set = Read("t.json");
  ASSERT_EQ(set.tasks.size(), 1u);
  EXPECT_TRUE(set.tasks[0].valid());
  EXPECT_TRUE(set.tasks[0].subtasks[0].attempts.empty());
  EXPECT_EQ(server.bodies().size(), 1u);

  // Another machine replays it without a server.
  const Outcome replay = RunProgram("tasks " + Assets() + " --count 1 --replay " +
                                    Path("good.jsonl") + " -o " + Path("r.json"));
  EXPECT_EQ(replay.code, 0) << replay.text;
  EXPECT_EQ(Read("r.json").tasks[0].subtasks[0].program, set.tasks[0].subtasks[0].program);
}

TEST_F(TasksCommand, AWrongSignGoesBackAndIsRepaired) {
  llm::ChatServer server(
      Saying({AnswerTask("open_it", Program("drawer_joint", "-2 * ")),
              Fenced(Program("drawer_join", "2 * ")), Fenced(Program("drawer_joint", "2 * "))}));
  const Outcome outcome = RunProgram("tasks " + Assets() + " --count 1 --llm " + server.url() +
                                     " -o " + Path("t.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const tasks::TaskSet set = Read("t.json");
  ASSERT_EQ(set.tasks.size(), 1u);
  const tasks::Subtask& subtask = set.tasks[0].subtasks[0];
  EXPECT_TRUE(subtask.valid());
  ASSERT_EQ(subtask.attempts.size(), 2u);  // every attempt is kept with its findings
  EXPECT_EQ(subtask.attempts[0].findings[0].code, "sign-against-success");
  EXPECT_EQ(subtask.attempts[1].findings[0].code, "unknown-joint");
  EXPECT_EQ(server.bodies().size(), 3u);
}

TEST_F(TasksCommand, AHopelessOneStaysInTheFileAndFailsTheRun) {
  llm::ChatServer server(Saying({AnswerTask("open_it", Program("drawer_joint", "2 * ")) +
                                     AnswerTask("bad", Program("drawer_joint", "-2 * ")),
                                 Fenced(Program("drawer_joint", "-3 * ")), "I cannot.",
                                 Fenced(Program("drawer_joint", "-4 * "))}));
  const Outcome outcome = RunProgram("tasks " + Assets() + " --count 2 --llm " + server.url() +
                                     " -o " + Path("t.json"));
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("not valid"), std::string::npos) << outcome.text;
  const tasks::TaskSet set = Read("t.json");
  ASSERT_EQ(set.tasks.size(), 2u);
  EXPECT_TRUE(set.tasks[0].valid());
  EXPECT_FALSE(set.tasks[1].valid());
  EXPECT_EQ(set.tasks[1].subtasks[0].attempts.size(), 3u);
  EXPECT_NE(core::ReadFile(Path("t.html")).find("not valid"), std::string::npos);
}

// Five hundred drawers, one of them a mimic joint, and a floating part.
TEST_F(TasksCommand, AThingOfFiveHundredJointsIsDoneInSeconds) {
  std::string urdf =
      "<robot name=\"rack\"><link name=\"body\">"
      "<collision><geometry><box size=\"0.2 0.2 0.2\"/></geometry></collision></link>";
  for (int i = 0; i < 500; ++i) {
    const std::string n = std::to_string(i);
    urdf += "<link name=\"drawer_" + n +
            "\"><collision><geometry><box size=\"0.1 0.1 0.01\"/></geometry></collision></link>"
            "<joint name=\"slide_" +
            n + "\" type=\"" + (i == 499 ? "floating" : "prismatic") +
            "\"><parent link=\"body\"/><child link=\"drawer_" + n +
            "\"/><axis xyz=\"-1 0 0\"/><limit lower=\"0\" upper=\"0.1\" effort=\"1\" "
            "velocity=\"1\"/>" +
            (i == 7 ? "<mimic joint=\"slide_6\"/>" : "") + "</joint>";
  }
  fs::create_directories(folder_.path() / "rack");
  core::WriteFile(folder_.path() / "rack/rack.urdf", urdf + "</robot>");
  const Outcome outcome =
      RunProgram("tasks " + Path("rack") + " --count 20 --json -o " + Path("t.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.text.substr(0, 2000);
  EXPECT_EQ(Read("t.json").tasks.size(), 20u);
  const Outcome none = RunProgram("tasks far=" + Path("assets/tin/tin.urdf") +
                                  " --count 3 --json -o " + Path("n.json"));
  EXPECT_EQ(none.code, 0) << none.text;
}

TEST_F(TasksCommand, WhatCannotBeReadIsSaidInOneLine) {
  core::WriteFile(folder_.path() / "empty.jsonl", "");
  for (const std::string& arguments : {"tasks --quiet " + Path("nowhere") + " -o " + Path("x.json"),
                                       "tasks --quiet " + Path("assets/tin") +
                                           " tin=" + Path("assets/chest") + " -o " + Path("x.json"),
                                       "tasks --quiet " + Assets() + " --replay " +
                                           Path("empty.jsonl") + " -o " + Path("x.json")}) {
    const Outcome outcome = RunProgram(arguments);
    EXPECT_EQ(outcome.code, 1) << outcome.text;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    EXPECT_FALSE(fs::exists(Path("x.json")));
  }
}

}  // namespace
}  // namespace simwright
