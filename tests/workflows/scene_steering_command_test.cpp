// `simwright scene complete` and `scene rearrange`: what is kept stays, on scenes of every form;
// bad input is rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <map>

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
using Objects = std::vector<scene::SceneObject>;

// Two dimsum tables, made once; completed and rearranged with the shipped weights.
class SceneSteeringCommand : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void CompletesSeveralScenes();
  static void CompletesAsThePromptSays();
  static void RearrangesWhatIsNotKept();
  static void TakesAnExportedSceneAndPoses();
  static void NamesWhatTheModelDoesNotSee();
  static void SaysThatTheInputIsNotStable();
  static void RefusesWhatDoesNotFit();
  static void LeavesNothingWhenStopped();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    PlaceSceneAssets("dimsum", Dimsum());
    generated_ = RunProgram("scene generate --type dimsum --count 2 --seed 1000000021 --quiet -o " +
                            Dimsum());
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Dimsum() { return At("dimsum"); }
  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string Write(const std::string& name, const std::string& text) {
    core::WriteFile(At(name), text);
    return At(name);
  }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome generated_;
};

Objects ObjectsOf(const std::string& path, int index) {
  const scene::SceneDataset dataset{fs::path(path)};
  const std::vector<float> tokens = dataset.Read(index, 1);
  return DecodeScene(tokens.data(), dataset.vocabulary());
}

// Returns the number of objects of `before` that stand in `after`, of the same category, with the
// pose unchanged.
int StandingCount(const Objects& before, const Objects& after) {
  return static_cast<int>(std::count_if(before.begin(), before.end(), [&](const auto& one) {
    return std::any_of(after.begin(), after.end(), [&](const auto& other) {
      return one.category == other.category &&
             (one.world_from_object.matrix() - other.world_from_object.matrix()).norm() < 1e-6;
    });
  }));
}

std::map<std::string, int> CategoryCounts(const Objects& objects) {
  std::map<std::string, int> counts;
  for (const scene::SceneObject& object : objects) ++counts[object.category];
  return counts;
}

void SceneSteeringCommand::CompletesSeveralScenes() {
  const Outcome made = RunProgram(
      "scene complete " + Dimsum() + " --scene 0,1 --count 2 --json -o " + At("completed"),
      "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const json report = json::parse(made.text);
  EXPECT_EQ(report["command"], "complete");
  ASSERT_EQ(report["scenes"].size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const json& scene = report["scenes"][static_cast<size_t>(i)];
    EXPECT_EQ(scene["asked"], 2);
    EXPECT_EQ(scene["added"], 2);
    EXPECT_TRUE(scene["stable"].get<bool>());
    EXPECT_LE(scene["kept_displacement_mm"].get<double>(), 1.0);
    EXPECT_LE(scene["penetration_mm"].get<double>(), 0.1);
    const Objects before = ObjectsOf(Dimsum(), i), after = ObjectsOf(At("completed"), i);
    EXPECT_EQ(after.size(), before.size() + 2);
    EXPECT_EQ(StandingCount(before, after), static_cast<int>(before.size()));
    EXPECT_EQ(CategoryCounts(after)["table_round"], 1);
  }
  for (const char* const file : {"before_after.png", "scenes.png", "report.json"}) {
    EXPECT_TRUE(fs::exists(fs::path(At("completed")) / file)) << file;
  }
  EXPECT_EQ(json::parse(core::ReadFile(fs::path(At("completed")) / "report.json"))["scenes"],
            report["scenes"]);
  // The same seed gives the same scenes.
  ASSERT_EQ(
      RunProgram("scene complete " + Dimsum() + " --scene 0,1 --count 2 --quiet -o " + At("again"))
          .code,
      0);
  EXPECT_EQ(core::ReadFile(fs::path(At("again")) / scene::ShardName(0)),
            core::ReadFile(fs::path(At("completed")) / scene::ShardName(0)));
}

// The cup is new, and the plate is one that is there.
void SceneSteeringCommand::CompletesAsThePromptSays() {
  const Objects before = ObjectsOf(Dimsum(), 1);
  ASSERT_GT(CategoryCounts(before)["plate"], 0);
  const Outcome made = RunProgram("scene complete " + Dimsum() +
                                      " --scene 1 --prompt \"a cup to the left of the plate\" "
                                      "--json -o " +
                                      At("left"),
                                  "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const json scene = json::parse(made.text)["scenes"][0];
  EXPECT_EQ(scene["asked"], 1);
  EXPECT_EQ(scene["relations"], 1);
  const Objects after = ObjectsOf(At("left"), 0);
  bool left = false;
  const auto last = std::find_if(after.begin(), after.end(), [&](const auto& one) {
    return one.category == "cup" && StandingCount({one}, before) == 0;
  });
  ASSERT_NE(last, after.end());
  for (const scene::SceneObject& plate : before) {
    if (plate.category != "plate") continue;
    const Eigen::Vector3d offset =
        last->world_from_object.translation() - plate.world_from_object.translation();
    left = left || (offset.y() >= std::abs(offset.x()) && offset.head<2>().norm() < 0.45);
  }
  EXPECT_EQ(scene["relations_broken"].empty(), left) << made.text;
  EXPECT_TRUE(left);
  const Outcome nothing = RunProgram("scene complete " + Dimsum() +
                                     " --scene 1 --prompt \"the plate\" --quiet -o " + At("none"));
  EXPECT_EQ(nothing.code, 1);
  EXPECT_NE(nothing.text.find("another plate"), std::string::npos) << nothing.text;
}

void SceneSteeringCommand::RearrangesWhatIsNotKept() {
  const Objects before = ObjectsOf(Dimsum(), 1);
  std::string kept;  // an object on the table
  for (const scene::SceneObject& object : before) {
    if (object.category == "plate" || object.category == "teapot") kept = object.category + "_0";
  }
  ASSERT_FALSE(kept.empty());
  const Outcome made = RunProgram("scene rearrange " + Dimsum() + " --scene 1 --keep " + kept +
                                      " --json -o " + At("rearranged"),
                                  "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const json scene = json::parse(made.text)["scenes"][0];
  EXPECT_EQ(scene["kept"], 2);
  EXPECT_EQ(scene["moved"].get<size_t>() + scene["returned"].size(), before.size() - 2);
  const Objects after = ObjectsOf(At("rearranged"), 0);
  EXPECT_EQ(CategoryCounts(after), CategoryCounts(before));
  EXPECT_EQ(StandingCount(before, after), 2 + static_cast<int>(scene["returned"].size()));
}

void SceneSteeringCommand::TakesAnExportedSceneAndPoses() {
  ASSERT_EQ(
      RunProgram("scene export " + Dimsum() + " --scene 1 --format mjcf --quiet -o " + At("worlds"))
          .code,
      0);
  const Objects before = ObjectsOf(Dimsum(), 1);
  const Outcome exported = RunProgram("scene complete " + At("worlds") +
                                      "/scene_00001 --count 1 --quiet -o " + At("of_export"));
  ASSERT_EQ(exported.code, 0) << exported.text;
  EXPECT_EQ(StandingCount(before, ObjectsOf(At("of_export"), 0)), static_cast<int>(before.size()));
  // A list of poses with asset folders beside it.
  json poses = json::array();
  const json file = json::parse(core::ReadFile(fs::path(At("worlds")) / "scene_00001/scene.json"));
  for (const json& object : file["objects"]) {
    poses.push_back({{"asset", "dimsum/assets/" + object["slot"].get<std::string>()},
                     {"translation", object["translation"]},
                     {"quaternion_wxyz", object["quaternion_wxyz"]}});
  }
  const std::string written = Write("poses.json", poses.dump());
  EXPECT_EQ(RunProgram("scene complete " + written + " --quiet -o " + At("no_type")).code, 1);
  const Outcome listed = RunProgram("scene complete " + written +
                                    " --type dimsum --count 1 --quiet -o " + At("of_poses"));
  ASSERT_EQ(listed.code, 0) << listed.text;
  EXPECT_EQ(StandingCount(before, ObjectsOf(At("of_poses"), 0)), static_cast<int>(before.size()));
}

// A steamer that is copied to a name of its own, and a cup far away: both stay, and are named.
void SceneSteeringCommand::NamesWhatTheModelDoesNotSee() {
  fs::copy(Dimsum() + "/assets/steamer", At("gadget"), fs::copy_options::recursive);
  json asset = json::parse(core::ReadFile(fs::path(At("gadget")) / "asset.json"));
  asset["category"] = "gadget";
  core::WriteFile(fs::path(At("gadget")) / "asset.json", asset.dump());
  const json poses = {{{"asset", "dimsum/assets/table_round"}, {"translation", {0, 0, 0}}},
                      {{"asset", "gadget"}, {"translation", {0.2, 0, 0.785}}},
                      {{"asset", "dimsum/assets/cup"}, {"translation", {4, 0, 0}}}};
  const Outcome made = RunProgram("scene complete " + Write("unseen.json", poses.dump()) +
                                      " --type dimsum --count 2 --json -o " + At("unseen"),
                                  "/dev/null");
  const json report = json::parse(made.text);
  std::map<std::string, std::string> findings;
  for (const json& finding : report["findings"]) {
    findings[finding["code"]] = finding.dump();
  }
  EXPECT_NE(findings["asset-unseen"].find("gadget"), std::string::npos) << made.text;
  EXPECT_NE(findings["pose-out-of-range"].find("cup_0"), std::string::npos) << made.text;
  const Objects after = ObjectsOf(At("unseen"), 0);
  EXPECT_EQ(CategoryCounts(after)["gadget"], 1);
  EXPECT_GE(after.size(), 4u);
  EXPECT_TRUE(std::any_of(after.begin(), after.end(), [](const scene::SceneObject& object) {
    return object.category == "gadget" && object.welded;
  }));
}

// Two cups in one place are not made stable by being kept.
void SceneSteeringCommand::SaysThatTheInputIsNotStable() {
  const json cup = {{"asset", "dimsum/assets/cup"}, {"translation", {0.2, 0.1, 0.83}}};
  const json poses = {
      {{"asset", "dimsum/assets/table_round"}, {"translation", {0, 0, 0}}}, cup, cup};
  const Outcome made =
      RunProgram("scene complete " + Write("twice.json", poses.dump()) +
                     " --type dimsum --count 1 --steps 10 --json -o " + At("twice"),
                 "/dev/null");
  EXPECT_EQ(made.code, 1) << made.text;
  const json scene = json::parse(made.text)["scenes"][0];
  EXPECT_FALSE(scene["stable"].get<bool>());
  EXPECT_EQ(scene["unstable_kept"].size(), 2u) << made.text;
}

void SceneSteeringCommand::RefusesWhatDoesNotFit() {
  json crowd = json::array();
  for (int i = 0; i < 10'000; ++i) {
    crowd.push_back({{"asset", "dimsum/assets/cup"}, {"translation", {0.1, 0.1, 0.8}}});
  }
  const std::string cup = R"([{"asset": "dimsum/assets/cup", "translation": )";
  const struct {
    std::string arguments, reason;
  } cases[] = {
      {"complete " + At("nowhere"), "no such scene"},
      {"complete " + Write("empty.json", "[]") + " --type dimsum", "no objects"},
      {"complete " + Write("cut.json", "[{") + " --type dimsum", "cut.json"},
      {"complete " + Write("nan.json", cup + "[NaN, 0, 0]}]") + " --type dimsum", "nan.json"},
      {"complete " + Write("null.json", cup + "[null, 0, 0]}]") + " --type dimsum", "translation"},
      {"complete " + Write("huge.json", cup + "[1e999, 0, 0]}]") + " --type dimsum", "huge.json"},
      {"complete " + Write("twist.json", cup + "[0, 0, 1], \"quaternion_wxyz\": [0, 0, 0, 0]}]") +
           " --type dimsum",
       "quaternion"},
      {"complete " + Write("none.json", R"([{"asset": "nothing", "translation": [0, 0, 0]}])") +
           " --type dimsum",
       "nothing"},
      {"complete " + Write("out.json", R"([{"asset": "../../etc", "translation": [0, 0, 0]}])") +
           " --type dimsum",
       "outside"},
      {"complete " + Write("crowd.json", crowd.dump()) + " --type dimsum", "10000 objects"},
      {"complete " + Dimsum() + " --count 1000", "room for"},
      {"complete " + Dimsum() + " --scene 7", "no scene 7"},
      {"complete " + Dimsum() + " --type no_such_type", "no_such_type"},
      {"complete " + Dimsum() + " --attempts 0", "--attempts"},
      {"rearrange " + Dimsum() + " --keep lampshade_3", "the objects are"},
      {"rearrange " + Dimsum() + " --keep lampshade_3", "lampshade_3"},
  };
  for (const auto& [arguments, reason] : cases) {
    const Outcome refused = RunProgram("scene " + arguments + " --quiet -o " + At("refused"));
    EXPECT_EQ(refused.code, 1) << arguments << refused.text;
    EXPECT_NE(refused.text.find(reason), std::string::npos) << arguments << ": " << refused.text;
    EXPECT_EQ(std::count(refused.text.begin(), refused.text.end(), '\n'), 1) << refused.text;
    EXPECT_FALSE(fs::exists(At("refused"))) << arguments;
  }
}

void SceneSteeringCommand::LeavesNothingWhenStopped() {
  RunningProgram program("scene complete " + Dimsum() +
                             " --scene 0,1 --count 4 --candidates 50 --steps 1000 -o " +
                             At("stopped"),
                         At("stopped.log"));
  const auto staging = [] { return HasStagingFolderOf(At("stopped")); };
  ASSERT_TRUE(program.WaitFor(staging));
  program.EndBy(SIGINT);
  EXPECT_FALSE(staging()) << "it left a folder";
}

TEST_F(SceneSteeringCommand, KeepsWhatStands) {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  CompletesSeveralScenes();
  CompletesAsThePromptSays();
  RearrangesWhatIsNotKept();
  TakesAnExportedSceneAndPoses();
  NamesWhatTheModelDoesNotSee();
  SaysThatTheInputIsNotStable();
  RefusesWhatDoesNotFit();
  LeavesNothingWhenStopped();
}

}  // namespace
}  // namespace simwright::workflows
