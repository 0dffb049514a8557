// `simwright scene search`: the result passes physics, is the same after an interruption and for
// any number of threads; bad input is rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "core/files.h"
#include "program.h"
#include "running_program.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "shared_scene_assets.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;

class SceneSearchCommand : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void FindsAScene();
  static void ResumesBitByBit();
  static void StartsFromAScene();
  static void TakesPrompts();
  static void SavesWhenStopped();
  static void RefusesWhatDoesNotFit();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    PlaceSceneAssets("dimsum", Dimsum());
    generated_ = RunProgram("scene generate --type dimsum --count 1 --seed 1000000023 --quiet -o " +
                            Dimsum());
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Dimsum() { return At("dimsum"); }
  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }
  // Few denoising steps suffice for a test.
  static std::string Search(const std::string& arguments, const std::string& output) {
    return "scene search --type dimsum --steps 8 --quiet --assets " + Dimsum() + "/assets " +
           arguments + " -o " + At(output);
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome generated_;
};

json SearchReportIn(const std::string& folder) {
  return json::parse(core::ReadFile(fs::path(folder) / "search.json"));
}

void SceneSearchCommand::FindsAScene() {
  const Outcome made = RunProgram(Search("--iterations 4 --threads 2 --random", "found"));
  ASSERT_EQ(made.code, 0) << made.text;
  const json report = SearchReportIn(At("found"));
  EXPECT_EQ(report["iterations"].size(), 4u);
  EXPECT_EQ(report["random"].size(), 4u);
  EXPECT_EQ(report["iterations"][3]["samples"], 13);
  EXPECT_EQ(report["random"][3]["samples"], 13);
  EXPECT_EQ(report["goal"], 34.0);
  EXPECT_GE(report["best_reward"], report["start_reward"]);
  // Below the goal, MuJoCo sees the scene at the end only, and may find an object that creeps.
  EXPECT_LE(report["final_reward"], report["best_reward"]);
  EXPECT_GE(report["final_reward"].get<double>(), report["best_reward"].get<double>() - 2.0);
  EXPECT_TRUE(report["still"]);
  const scene::SceneDataset dataset{fs::path(At("found"))};
  ASSERT_EQ(dataset.SceneCount(), 1);
  const std::vector<float> tokens = dataset.Read(0, 1);
  EXPECT_EQ(DecodeScene(tokens.data(), dataset.vocabulary()).size(), report["objects"]);
  for (const char* name : {"search.svg", "best_path.png", "scenes.png", "search.state"}) {
    EXPECT_TRUE(fs::exists(fs::path(At("found")) / name)) << name;
  }
  const Outcome checked =
      RunProgram("scene export " + At("found") + " --check --quiet -o " + At("exported"));
  EXPECT_EQ(checked.code, 0) << checked.text;
}

void SceneSearchCommand::ResumesBitByBit() {
  ASSERT_NE(RunProgram(Search("--iterations 2 --threads 1", "resumed")).code, 2);
  const Outcome made = RunProgram(Search("--iterations 4 --threads 1 --resume", "resumed"));
  ASSERT_EQ(made.code, 0) << made.text;
  for (const char* name : {"search.state", "part_00000.h5"}) {
    EXPECT_TRUE(core::ReadFile(fs::path(At("resumed")) / name) ==
                core::ReadFile(fs::path(At("found")) / name))
        << name << " depends on the interruption or the threads";
  }
}

void SceneSearchCommand::StartsFromAScene() {
  // A full table: each child costs seconds of physics.
  const Outcome made =
      RunProgram(Search("--iterations 1 --branching 1 --start " + Dimsum(), "fuller"));
  ASSERT_EQ(made.code, 0) << made.text;
  const json report = SearchReportIn(At("fuller"));
  const scene::SceneDataset dataset{fs::path(Dimsum())};
  const std::vector<float> tokens = dataset.Read(0, 1);
  EXPECT_EQ(DecodeScene(tokens.data(), dataset.vocabulary()).size(), report["start_reward"]);
  EXPECT_GE(report["best_reward"], report["start_reward"]);
}

void SceneSearchCommand::TakesPrompts() {
  const Outcome made =
      RunProgram(Search("--iterations 3 --prompt \"two cups and a teapot\"", "prompted"));
  EXPECT_NE(made.code, 2) << made.text;
  const json report = SearchReportIn(At("prompted"));
  EXPECT_EQ(report["goal"], 1.0);
  EXPECT_GT(report["best_reward"], report["start_reward"]);
  const Outcome counted =
      RunProgram(Search("--iterations 1 --objective \"feasible(cup) - count(plate)\"", "counted"));
  EXPECT_NE(counted.code, 2) << counted.text;
  EXPECT_EQ(SearchReportIn(At("counted"))["objective"], "feasible(cup) - count(plate)");
}

void SceneSearchCommand::SavesWhenStopped() {
  RunningProgram program(Search("--iterations 100000 --save-every 1 --exploration 50", "stopped"),
                         At("stopped.log"));
  ASSERT_TRUE(program.WaitFor([] { return fs::exists(At("stopped") + "/search.state"); }));
  const Outcome ended = program.EndBy(SIGINT);
  EXPECT_EQ(ended.code, 130) << ended.text;
  EXPECT_TRUE(fs::exists(At("stopped") + "/part_00000.h5"));
  EXPECT_TRUE(SearchReportIn(At("stopped"))["interrupted"]);
}

void SceneSearchCommand::RefusesWhatDoesNotFit() {
  json crowd = json::array();
  for (int i = 0; i < 35; ++i) {
    crowd.push_back({{"asset", "dimsum/assets/cup"}, {"translation", {0.1, 0.1, 0.8}}});
  }
  core::WriteFile(At("crowd.json"), crowd.dump());
  ASSERT_EQ(RunProgram("library --kind apple --quiet -o " + At("apples")).code, 0);
  fs::path apple;
  for (const auto& entry : fs::directory_iterator(At("apples"))) {
    if (entry.is_directory()) apple = fs::relative(entry.path(), At("")).string();
  }
  core::WriteFile(At("unknown.json"),
                  json::array({{{"asset", apple.string()}, {"translation", {0, 0, 1}}}}).dump());
  const struct {
    std::string arguments, reason;
  } cases[] = {
      {"--iterations 0", "at least 1 iteration"},
      {"--branching 0", "children"},
      {"--eta=2", "eta"},
      {"--fill=-2", "fill"},
      {"--exploration nan", "exploration"},
      {"--save-every 0", "--save-every"},
      {"--leaves 0", "leaves"},
      {"--mask empty,upside", "upside"},
      {"--mask \"\"", "no mask"},
      {"--objective \"feasible(unicorn)\"", "unicorn"},
      {"--objective \"count(cup\"", "does not parse"},
      {"--prompt \"two unicorns\"", "unicorn"},
      {"--start " + At("nowhere"), "no such scene"},
      {"--start " + Dimsum() + " --start-scene 7", "no scene 7"},
      {"--start " + At("crowd.json"), "35 objects"},
      {"--start " + At("unknown.json"), "does not know"},
      {"--resume", "no search to resume"},
      {At("no_model.pt"), "not both"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome refused = RunProgram(Search(arguments, "refused"));
    EXPECT_EQ(refused.code, 1) << arguments << refused.text;
    EXPECT_NE(refused.text.find(reason), std::string::npos) << arguments << ": " << refused.text;
    EXPECT_EQ(std::count(refused.text.begin(), refused.text.end(), '\n'), 1) << refused.text;
    EXPECT_FALSE(fs::exists(At("refused"))) << arguments;
  }
  EXPECT_EQ(RunProgram(Search("--repair maybe", "refused")).code, 2);
  const Outcome other = RunProgram(Search("--iterations 4 --resume --fill 2", "found"));
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.text.find("fill was 4 and is now 2"), std::string::npos) << other.text;
  EXPECT_EQ(RunProgram(Search("--iterations 4", "found")).code, 1) << "it exists already";
}

TEST_F(SceneSearchCommand, FindsAndResumesAndRefuses) {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  FindsAScene();
  ResumesBitByBit();
  StartsFromAScene();
  TakesPrompts();
  SavesWhenStopped();
  RefusesWhatDoesNotFit();
}

}  // namespace
}  // namespace simwright::workflows
