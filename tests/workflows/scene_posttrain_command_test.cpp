// `simwright scene posttrain`: its files, a stopped run that continues to the same figures, and
// rejected inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"
#include "running_program.h"
#include "scene/model/scene_model.h"
#include "shared_scene_assets.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class ScenePosttrainCommand : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void WritesWhatItDid();
  static void ContinuesAStoppedRun();
  static void RefusesOtherSettings();
  static void RefusesWhatDoesNotFit();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    PlaceSceneAssets("dimsum", Data());
    generated_ = RunProgram("scene generate --type dimsum --raw --count 24 --quiet -o " + Data());
    trained_ = RunProgram("scene train " + Data() +
                          " --method continuous --steps 2 --batch 2 --quiet -o " + At("model"));
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string Data() { return At("data"); }
  // Few scenes and steps suffice for a test.
  static std::string Command(const std::string& arguments, const std::string& output) {
    return "scene posttrain " + At("model/model.pt") +
           " --scenes 4 --steps 6 --gradient-steps 2 --updates 1 --score-every 2 --scored 8 "
           "--quiet " +
           arguments + " -o " + At(output);
  }
  // Physics and pictures of the samples take most of the time: one run has them.
  static Outcome PostTrain(const std::string& arguments, const std::string& output,
                           int settled = 0) {
    return RunProgram(Command(
        "--data " + Data() + " --count 8 --settled " + std::to_string(settled) + " " + arguments,
        output));
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome generated_, trained_;
};

int LineCount(const fs::path& file) {
  const std::string text = core::ReadFile(file);
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

void ScenePosttrainCommand::WritesWhatItDid() {
  const Outcome made = PostTrain("--rounds 4 --more-slots 3 --json", "whole", 2);
  ASSERT_EQ(made.code, 0) << made.text;
  const fs::path folder = At("whole");
  const json report = json::parse(core::ReadFile(folder / "report.json"));
  EXPECT_EQ(report["objective"], "objects");
  EXPECT_EQ(LineCount(folder / "rounds.csv"), 1 + 4);
  EXPECT_EQ(LineCount(folder / "checkpoints.csv"), 1 + 3) << "rounds 0, 2 and 4";
  for (const char* const name : {"reward.svg", "before_after.png", "checkpoint_000004.pt"}) {
    EXPECT_TRUE(fs::exists(folder / name)) << name;
  }
  // The model has the additional entries, and can be sampled.
  const scene::SceneModelMetadata before = scene::ReadSceneModelMetadata(At("model/model.pt"));
  const scene::SceneModelMetadata after = scene::ReadSceneModelMetadata(folder / "model.pt");
  EXPECT_EQ(after.vocabulary.entries, before.vocabulary.entries + 3);
  const Outcome sampled = RunProgram("scene sample " + At("whole/model.pt") +
                                     " --count 2 --steps 5 --raw --quiet --assets " + Data() +
                                     "/assets -o " + At("sampled"));
  EXPECT_EQ(sampled.code, 0) << sampled.text;
}

void ScenePosttrainCommand::ContinuesAStoppedRun() {
  RunningProgram program(
      Command("--rounds 100000 --more-slots 3 --count 8 --settled 2 --data " + Data(), "stopped"),
      At("stopped.log"));
  ASSERT_TRUE(program.WaitFor([] { return fs::exists(At("stopped/training.pt")); }));
  const Outcome ended = program.EndBy(SIGINT);
  EXPECT_EQ(ended.code, 130) << ended.text;
  const Outcome over = PostTrain("--rounds 4 --more-slots 3", "stopped");
  EXPECT_EQ(over.code, 1) << "it exists already";
  EXPECT_NE(over.text.find("--resume"), std::string::npos) << over.text;
  // The first round is that of the uninterrupted run; the rate of later ones depends on how many
  // are planned.
  const std::string whole = core::ReadFile(At("whole/rounds.csv"));
  const size_t first_round = whole.find("\n2,") + 1;
  ASSERT_GT(first_round, 1u);
  EXPECT_EQ(core::ReadFile(At("stopped/rounds.csv")).substr(0, first_round),
            whole.substr(0, first_round));
}

void ScenePosttrainCommand::RefusesOtherSettings() {
  const Outcome none = PostTrain("--rounds 2 --resume", "resumed");
  EXPECT_EQ(none.code, 1) << none.text;
  EXPECT_NE(none.text.find("no post-training to resume"), std::string::npos) << none.text;
  ASSERT_EQ(PostTrain("--rounds 2", "resumed").code, 0);
  const struct {
    std::string arguments, name;
  } cases[] = {
      {"--seed 2", "--seed"},
      {"--objective feasible", "--objective"},
      {"--more-slots 5", "--more-slots"},
  };
  for (const auto& [arguments, name] : cases) {
    const Outcome refused = PostTrain("--rounds 4 --resume " + arguments, "resumed");
    EXPECT_EQ(refused.code, 1) << arguments << refused.text;
    EXPECT_NE(refused.text.find("another value of " + name), std::string::npos) << refused.text;
  }
  const Outcome longer = PostTrain("--rounds 4 --resume --rate 1e-5", "resumed");
  EXPECT_EQ(longer.code, 0) << longer.text;
  EXPECT_EQ(LineCount(At("resumed/rounds.csv")), 1 + 4);
  EXPECT_EQ(LineCount(At("resumed/checkpoints.csv")), 1 + 3) << "rounds 0, 2 and 4";
  const Outcome shorter = PostTrain("--rounds 2 --resume", "resumed");
  EXPECT_EQ(shorter.code, 1) << shorter.text;
  EXPECT_NE(shorter.text.find("more rounds already"), std::string::npos) << shorter.text;
  EXPECT_EQ(PostTrain("--rounds 2 --seed 2 --force", "resumed").code, 0);
}

void ScenePosttrainCommand::RefusesWhatDoesNotFit() {
  const std::string data = "--data " + Data() + " ";
  const struct {
    std::string arguments, reason;
  } cases[] = {
      {data + "--rounds 0", "round"},
      {data + "--updates 0", "update"},
      {data + "--largest-accuracy 0.4", "0.5 to 1"},
      {data + "--count 2", "at least 8"},
      {data + "--settled=-1", "--settled"},
      {data + "--more-slots=-1", "--more-slots"},
      {data + "--objective \"count(unicorn)\"", "unicorn"},
      {data + "--objective \"count(cup\"", "does not parse"},
      {data + "--objective \"count(cup)/0\"", "divisor"},
      {data + "--prompt \"two unicorns\"", "unicorn"},
      {data + "--type dimsum", "either"},
      {"--data " + At("nowhere"), "nowhere"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome refused = RunProgram(Command(arguments, "refused"));
    EXPECT_NE(refused.code, 0) << arguments << refused.text;
    EXPECT_NE(refused.text.find(reason), std::string::npos) << arguments << ": " << refused.text;
    EXPECT_EQ(std::count(refused.text.begin(), refused.text.end(), '\n'), 1) << refused.text;
    EXPECT_FALSE(fs::exists(At("refused"))) << arguments;
  }
}

TEST_F(ScenePosttrainCommand, DoesAllOfIt) {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  ASSERT_EQ(trained_.code, 0) << trained_.text;
  WritesWhatItDid();
  ContinuesAStoppedRun();
  RefusesOtherSettings();
  RefusesWhatDoesNotFit();
}

}  // namespace
}  // namespace simwright::workflows
