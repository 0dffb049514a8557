// The whole path against an HTTP server: good, flawed and hopeless answers, with the outcomes that
// docs/tasks.md describes.
#include "tasks/language/task_generation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "llm/make_chat_model.h"
#include "llm/openai_chat_model.h"
#include "llm/transcript.h"
#include "tasks/language/worked_example.h"
#include "tests/tasks/language/example_scene.h"

#include "tests/llm/chat_server.h"  // last: see there

namespace simwright::tasks {
namespace {

std::string Program(const std::string& joint) {
  return "def compute_reward(env):\n    s = env.get_joint_state(\"chest\", \"" + joint +
         "\")\n    return s, s > 0.2\n";
}

std::string AnswerTask(const std::string& name, const std::string& joint) {
  return "Task: " + name + "\nTask Description: do it\n```python\n" + Program(joint) + "```\n\n";
}

std::string AnswerProgram(const std::string& joint) {
  return "```python\n" + Program(joint) + "```";
}

const std::string kGood = AnswerTask("open_drawer", "drawer_slide");

llm::ChatServer::Handler Saying(std::vector<std::string> answers) {
  return [answers](int number, const httplib::Request&, httplib::Response& response) {
    const std::size_t last = answers.size() - 1;
    response.set_content(llm::GoodBody(answers[std::min(static_cast<std::size_t>(number), last)]),
                         "application/json");
  };
}

std::string LastMessage(const nlohmann::json& body) {
  return body.at("messages").back().at("content").get<std::string>();
}

class TaskGeneration : public testing::Test {
 protected:
  GeneratedTasks Generate(llm::ChatModel* model, int count = 1) {
    TaskGenerationOptions options;
    options.count = count;
    const std::vector<NamedModel> scene = ExampleScene();
    return GenerateTasksByModel(scene, options, model, CompilingVerification(NamesOfScene(scene)));
  }

  GeneratedTasks GenerateFrom(llm::ChatServer* server, int count = 1) {
    llm::OpenAiChatModel model(llm::OptionsFor(server->url()), clock_);
    return Generate(&model, count);
  }

  llm::StillClock clock_;
};

int CountOf(const core::Findings& findings, const std::string& code) {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [&](const auto& f) { return f.code == code; }));
}

TEST_F(TaskGeneration, AGoodAnswerNeedsNoRepair) {
  llm::ChatServer server(Saying({ExampleAnswer() + kGood}));
  const GeneratedTasks made = GenerateFrom(&server, 2);
  ASSERT_EQ(made.tasks.size(), 2u);
  EXPECT_TRUE(made.findings.empty());
  EXPECT_EQ(made.questions, 1);
  EXPECT_EQ(made.tasks[0].name, "store_block");
  EXPECT_EQ(made.tasks[0].source, "tiny");
  EXPECT_EQ(made.tasks[0].assets, (std::vector<std::string>{"chest", "block"}));
  EXPECT_EQ(made.tasks[1].assets, (std::vector<std::string>{"chest"}));
  for (const Task& task : made.tasks) {
    EXPECT_TRUE(task.valid());
    for (const Subtask& subtask : task.subtasks) {
      EXPECT_TRUE(subtask.attempts.empty());
      EXPECT_EQ(subtask.start.placements.size(), task.assets.size());  // from the verification
    }
  }
  EXPECT_NE(LastMessage(server.body(0)).find("drawer_slide"), std::string::npos);
}

TEST_F(TaskGeneration, AWrongJointGoesBackWithTheNearestNameAndIsRepaired) {
  llm::ChatServer server(
      Saying({AnswerTask("open_drawer", "drawer_slid"), AnswerProgram("drawer_slide")}));
  const GeneratedTasks made = GenerateFrom(&server);
  ASSERT_EQ(made.tasks.size(), 1u);
  const Subtask& subtask = made.tasks[0].subtasks.at(0);
  EXPECT_TRUE(made.tasks[0].valid());
  EXPECT_EQ(subtask.program, Program("drawer_slide"));
  ASSERT_EQ(subtask.attempts.size(), 1u);
  EXPECT_EQ(subtask.attempts[0].program, Program("drawer_slid"));
  ASSERT_EQ(subtask.attempts[0].findings.size(), 1u);
  EXPECT_NE(subtask.attempts[0].findings[0].sentence.find("drawer_slide"), std::string::npos);
  EXPECT_EQ(made.repaired, 1);
  EXPECT_EQ(made.questions, 2);
  const std::string asked = LastMessage(server.body(1));
  EXPECT_NE(asked.find(reward::RenderFinding(subtask.attempts[0].findings[0],
                                             subtask.attempts[0].program)),
            std::string::npos)
      << asked;
}

TEST_F(TaskGeneration, AHopelessOneIsAskedThreeTimesAndStaysWithItsFindings) {
  llm::ChatServer server(Saying({kGood + AnswerTask("bad", "lid"), AnswerProgram("flap"),
                                 "I will not.", AnswerProgram("flap")}));
  const GeneratedTasks made = GenerateFrom(&server, 2);
  EXPECT_EQ(server.bodies().size(), 4u);
  ASSERT_EQ(made.tasks.size(), 2u);
  EXPECT_TRUE(made.tasks[0].valid());
  const Task& bad = made.tasks[1];
  EXPECT_FALSE(bad.valid());
  const Subtask& subtask = bad.subtasks.at(0);
  EXPECT_EQ(subtask.program, Program("flap"));
  EXPECT_FALSE(subtask.findings.empty());
  ASSERT_EQ(subtask.attempts.size(), 3u);
  EXPECT_EQ(subtask.attempts[0].program, Program("lid"));
  EXPECT_EQ(subtask.attempts[1].program, "I will not.");
  EXPECT_EQ(subtask.attempts[1].findings.at(0).code, "answer-no-program");
  EXPECT_EQ(subtask.attempts[2].program, Program("flap"));
  EXPECT_EQ(CountOf(made.findings, "llm-gave-up"), 1);
  EXPECT_EQ(CountOf(bad.findings, "llm-gave-up"), 1);
  EXPECT_EQ(made.findings.back().place, "bad/bad");
  EXPECT_NE(LastMessage(server.body(2)).find("not right yet"), std::string::npos);
  EXPECT_NE(LastMessage(server.body(3)).find("no function"), std::string::npos);
}

TEST_F(TaskGeneration, AnAnswerWithoutATaskIsAskedForOnceMore) {
  llm::ChatServer server(Saying({"What a nice chest.", kGood}));
  const GeneratedTasks made = GenerateFrom(&server);
  ASSERT_EQ(made.tasks.size(), 1u);
  EXPECT_TRUE(made.tasks[0].valid());
  EXPECT_EQ(CountOf(made.findings, "answer-no-program"), 1);
  EXPECT_EQ(made.findings[0].severity, core::Severity::kWarning);
  EXPECT_EQ(server.body(1).at("messages").size(), 4u);  // with the answer and the complaint
  llm::ChatServer silent(Saying({"What a nice chest."}));
  const GeneratedTasks none = GenerateFrom(&silent);
  EXPECT_TRUE(none.tasks.empty());
  EXPECT_EQ(silent.bodies().size(), 2u);
  EXPECT_EQ(CountOf(none.findings, "llm-no-tasks"), 1);
}

TEST_F(TaskGeneration, ASubtaskThatWasOnlyNamedIsAskedFor) {
  llm::ChatServer server(Saying(
      {"Task: both\nSubtask 1: open\n" + AnswerProgram("drawer_slide") + "\nSubtask 2: shut\n",
       AnswerProgram("drawer_slide")}));
  const GeneratedTasks made = GenerateFrom(&server);
  ASSERT_EQ(made.tasks.at(0).subtasks.size(), 2u);
  EXPECT_TRUE(made.tasks[0].valid());
  EXPECT_EQ(made.tasks[0].subtasks[1].attempts.at(0).findings.at(0).code, "program-missing");
  EXPECT_NE(LastMessage(server.body(1)).find("missing"), std::string::npos);
}

TEST_F(TaskGeneration, ManyTasksAreAskedForInParts) {
  llm::ChatServer server([](int number, const httplib::Request&, httplib::Response& response) {
    std::string text;
    for (int i = 0; i < (number == 0 ? 8 : 2); ++i) {
      text += AnswerTask("t" + std::to_string(i), "drawer_slide");
    }
    response.set_content(llm::GoodBody(text), "application/json");
  });
  const GeneratedTasks made = GenerateFrom(&server, 11);
  EXPECT_EQ(server.bodies().size(), 2u);
  EXPECT_NE(LastMessage(server.body(0)).find("Give 8 different"), std::string::npos);
  EXPECT_NE(LastMessage(server.body(1)).find("Give 3 different"), std::string::npos);
  EXPECT_NE(LastMessage(server.body(1)).find("\"t7\""), std::string::npos);
  ASSERT_EQ(made.tasks.size(), 10u);
  EXPECT_EQ(made.tasks[8].name, "t0_2");
  EXPECT_EQ(CountOf(made.findings, "task-renamed"), 2);
  EXPECT_EQ(CountOf(made.findings, "llm-fewer-tasks"), 1);
}

TEST_F(TaskGeneration, AServerThatFailsLaterLosesNothing) {
  const std::string three = AnswerTask("a", "slide_1") + AnswerTask("b", "slide_2") + kGood;
  llm::ChatServer server([&](int number, const httplib::Request&, httplib::Response& response) {
    if (number == 0) {
      response.set_content(llm::GoodBody(three), "application/json");
    } else if (number == 1) {
      response.set_content(llm::GoodBody(AnswerProgram("drawer_slide")), "application/json");
    } else {
      response.status = 403;
      response.set_content("{\"error\": {\"message\": \"no more credit\"}}", "application/json");
    }
  });
  const GeneratedTasks made = GenerateFrom(&server, 3);
  ASSERT_EQ(made.tasks.size(), 3u);
  EXPECT_TRUE(made.tasks[0].valid());   // repaired before
  EXPECT_FALSE(made.tasks[1].valid());  // could not be repaired any more
  EXPECT_TRUE(made.tasks[2].valid());   // verified without the server
  EXPECT_EQ(CountOf(made.findings, "llm-failed"), 1);
  EXPECT_EQ(server.bodies().size(), 3u);
}

TEST_F(TaskGeneration, TasksThatWereOnlyNamedOutliveTheServer) {
  llm::ChatServer server([](int number, const httplib::Request&, httplib::Response& response) {
    response.status = number == 0 ? 200 : 403;
    response.set_content(number == 0 ? llm::GoodBody("Task: open\nSubtasks: pull, turn\n") : "{}",
                         "application/json");
  });
  const GeneratedTasks made = GenerateFrom(&server);
  ASSERT_EQ(made.tasks.size(), 1u);
  EXPECT_EQ(made.tasks[0].subtasks.size(), 2u);
  EXPECT_FALSE(made.tasks[0].valid());
  EXPECT_EQ(CountOf(made.findings, "llm-failed"), 1);
  EXPECT_EQ(CountOf(made.findings, "llm-gave-up"), 2);
}

TEST_F(TaskGeneration, AServerThatFailsAtOnceIsAnError) {
  llm::ChatServer server([](int, const httplib::Request&, httplib::Response& response) {
    response.status = 403;
    response.set_content("{\"error\": {\"message\": \"no credit\"}}", "application/json");
  });
  EXPECT_THROW(GenerateFrom(&server), core::Error);
}

TEST_F(TaskGeneration, CancellingEndsIt) {
  llm::ChatServer server([&](int number, const httplib::Request&, httplib::Response& response) {
    if (number > 0) clock_.cancelled = true;
    response.set_content(llm::GoodBody(AnswerTask("a", "slide_1")), "application/json");
    if (number > 0) response.status = 503;
  });
  EXPECT_THROW(GenerateFrom(&server), core::Cancelled);
}

TEST_F(TaskGeneration, ARecordedRunIsReplayed) {
  const core::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "tasks.jsonl";
  GeneratedTasks first;
  {
    llm::ChatServer server(Saying(
        {AnswerTask("a", "slide_1") + kGood, AnswerProgram("lid"), AnswerProgram("drawer_slide")}));
    llm::RecordingChatModel model(
        std::make_unique<llm::OpenAiChatModel>(llm::OptionsFor(server.url()), clock_), file, false);
    first = Generate(&model, 2);
  }
  llm::ReplayChatModel replay(file);
  const GeneratedTasks second = Generate(&replay, 2);
  ASSERT_EQ(second.tasks.size(), 2u);
  EXPECT_EQ(second.questions, 3);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(first.tasks[i].subtasks[0].program, second.tasks[i].subtasks[0].program);
    EXPECT_EQ(first.tasks[i].subtasks[0].attempts.size(),
              second.tasks[i].subtasks[0].attempts.size());
    EXPECT_TRUE(second.tasks[i].valid());
  }
}

TEST_F(TaskGeneration, WhatCannotBeAskedIsRefused) {
  llm::ChatServer server(Saying({kGood}));
  llm::OpenAiChatModel model(llm::OptionsFor(server.url()), clock_);
  EXPECT_THROW(Generate(&model, 0), core::Error);
  TaskGenerationOptions options;
  const VerifySubtask verify = [](const Task&, Subtask*) { return core::Findings(); };
  EXPECT_THROW(GenerateTasksByModel({}, options, &model, verify), core::Error);
  const std::vector<NamedModel> scene = {{"a b", &ExampleModels()[0]}};
  EXPECT_THROW(GenerateTasksByModel(scene, options, &model, verify), core::Error);
  const std::vector<NamedModel> twice = {{"a", &ExampleModels()[0]}, {"a", &ExampleModels()[1]}};
  EXPECT_THROW(GenerateTasksByModel(twice, options, &model, verify), core::Error);
  EXPECT_TRUE(server.bodies().empty());
}

}  // namespace
}  // namespace simwright::tasks
