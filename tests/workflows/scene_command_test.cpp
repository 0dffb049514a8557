// `simwright scene`: a dataset is generated, continued, trained on and sampled; bad input is
// rejected.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json.hpp>

#include "assets/asset_folder.h"
#include "core/files.h"
#include "program.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/model/training.h"
#include "workflows/scenes/scene_generation.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

// The library's assets for dimsum tables, made once.
class SceneCommand : public testing::Test {
 protected:
  // One test runs all checks, because separate processes would each make all assets again.
  static void GeneratesScenesThatHold();
  static void GoesOnWhereItStopped();
  static void NamesASlotThatThereIsNot();
  static void LearnsAndSamples();
  static void AModelByShapeTakesANewAsset();
  static void AnAssetOfOnesOwnTakesASlot();
  static void RefusesWhatIsNone();

  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder();
    generated_ =
        RunProgram("scene generate --type dimsum --count 3 --part 2 --quiet -o " + Dimsum());
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Dimsum() { return (folder_->path() / "dimsum").string(); }
  static std::string At(const std::string& name) { return (folder_->path() / name).string(); }

  static inline core::TemporaryFolder* folder_ = nullptr;
  static inline Outcome generated_;
};

void SceneCommand::GeneratesScenesThatHold() {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  const scene::SceneDataset dataset(Dimsum());
  EXPECT_EQ(dataset.SceneCount(), 3);
  EXPECT_EQ(dataset.parts().size(), 2u);
  EXPECT_EQ(dataset.vocabulary().type, "dimsum");
  for (const char* const file : {"scenes.png", "statistics.json", "assets/steamer/asset.json"}) {
    EXPECT_TRUE(fs::exists(fs::path(Dimsum()) / file)) << file;
  }
  for (const scene::SceneAttempt& one : dataset.Attempts()) {
    if (!one.valid) continue;
    EXPECT_LE(one.penetration, 1e-4);
    EXPECT_LE(one.drift, 1e-3);
  }
  const auto json = nlohmann::json::parse(core::ReadFile(fs::path(Dimsum()) / "statistics.json"));
  EXPECT_EQ(json["scenes"], 3);
  EXPECT_GE(json["objects_mean"].get<double>(), 5.0);
}

void SceneCommand::GoesOnWhereItStopped() {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  const std::string copy = At("more");
  fs::copy(Dimsum(), copy, fs::copy_options::recursive);
  const Outcome more =
      RunProgram("scene generate --type dimsum --count 4 --part 2 --json -o " + copy);
  ASSERT_EQ(more.code, 0) << more.text;
  EXPECT_EQ(nlohmann::json::parse(more.text)["scenes"], 4);
  const scene::SceneDataset before{fs::path(Dimsum())}, after{fs::path(copy)};
  EXPECT_EQ(after.Read(0, 3), before.Read(0, 3));
  EXPECT_EQ(after.ReadPrompts(0, 3), before.ReadPrompts(0, 3));
  EXPECT_EQ(after.ReadPrompts(0, 4).size(), 4u);
  // A complete shard of an earlier version has no prompts: it gets the same ones.
  const fs::path shard = fs::path(copy) / scene::ShardName(0);
  const std::string bytes = core::ReadFile(shard);
  scene::SceneShard without = scene::SceneShardFile(shard).ReadAll();
  without.prompts.clear();
  scene::WriteShard(without, shard);
  EXPECT_NE(core::ReadFile(shard), bytes);
  ASSERT_EQ(RunProgram("scene generate --type dimsum --count 4 --part 2 --quiet -o " + copy).code,
            0);
  EXPECT_EQ(core::ReadFile(shard), bytes);
  // Other settings are another dataset.
  for (const char* const flags : {"--seed 2", "--step 0.003", "--hull steamer"}) {
    const Outcome other =
        RunProgram(std::string("scene generate --type dimsum --count 4 --part 2 ") + flags +
                   " --quiet -o " + copy);
    EXPECT_EQ(other.code, 1) << flags;
  }
}

void SceneCommand::NamesASlotThatThereIsNot() {
  const std::string output = At("no_such_slot");
  const Outcome refused =
      RunProgram("scene generate --type dimsum --count 1 --hull lampshade --quiet -o " + output);
  EXPECT_EQ(refused.code, 1);
  EXPECT_NE(refused.text.find("lampshade"), std::string::npos) << refused.text;
  EXPECT_NE(refused.text.find("steamer_lid"), std::string::npos) << refused.text;
  EXPECT_FALSE(fs::exists(fs::path(output) / "assets"));
}

void SceneCommand::LearnsAndSamples() {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  const Outcome trained =
      RunProgram("scene train " + Dimsum() + " --steps 4 --batch 2 --quiet -o " + At("model"));
  ASSERT_EQ(trained.code, 0) << trained.text;
  EXPECT_NE(core::ReadFile(fs::path(At("model")) / scene::kLossCurvesFile).find("</svg>"),
            std::string::npos);
  const Outcome again =
      RunProgram("scene train " + Dimsum() + " --steps 4 --batch 2 --quiet -o " + At("model"));
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.text.find("--resume"), std::string::npos) << again.text;
  const std::string sample = "scene sample " + At("model") +
                             "/model.pt --count 2 --steps 5 --raw " + "--assets " + Dimsum() +
                             "/assets --quiet -o ";
  const Outcome sampled = RunProgram(sample + At("sampled"));
  ASSERT_EQ(sampled.code, 0) << sampled.text;
  const scene::SceneDataset dataset{fs::path(At("sampled"))};
  EXPECT_EQ(dataset.SceneCount(), 2);
  EXPECT_EQ(dataset.vocabulary(), scene::SceneDataset(fs::path(Dimsum())).vocabulary());
  ASSERT_EQ(RunProgram(sample + At("again")).code, 0);
  EXPECT_EQ(core::ReadFile(fs::path(At("again")) / scene::ShardName(0)),
            core::ReadFile(fs::path(At("sampled")) / scene::ShardName(0)));
  // A model without text holds the counts of a prompt, and says that this is all.
  const Outcome prompted =
      RunProgram("scene sample " + At("model") + "/model.pt --count 3 --steps 5 --raw --assets " +
                 Dimsum() + "/assets --prompt \"two cups and a teapot\" -o " + At("prompted"));
  ASSERT_EQ(prompted.code, 0) << prompted.text;
  EXPECT_NE(prompted.text.find("only the counts are held"), std::string::npos) << prompted.text;
  const scene::SceneDataset held{fs::path(At("prompted"))};
  for (const auto& objects : DecodeScenes(held.Read(0, 3), held.vocabulary())) {
    std::map<std::string, int> counts;
    for (const scene::SceneObject& one : objects) ++counts[one.category];
    EXPECT_EQ(counts, (std::map<std::string, int>{{"cup", 2}, {"table_round", 1}, {"teapot", 1}}));
  }
  // A prompt alone is for the shipped model of all types, which reads it.
  const Outcome read =
      RunProgram("scene sample --count 2 --steps 20 --raw --assets " + Dimsum() +
                 "/assets --prompt \"a dim sum table with two cups\" -o " + At("read"));
  ASSERT_EQ(read.code, 0) << read.text;
  EXPECT_EQ(read.text.find("only the counts are held"), std::string::npos) << read.text;
  EXPECT_EQ(scene::SceneDataset(fs::path(At("read"))).vocabulary().type, "dimsum");
  // Fewer objects than a scene of the data has are enough if the prompt asks for no more.
  const Outcome few =
      RunProgram("scene sample --type dimsum --count 4 --steps 20 --assets " + Dimsum() +
                 "/assets --prompt \"two cups\" --quiet -o " + At("few"));
  ASSERT_EQ(few.code, 0) << few.text;
  EXPECT_GE(scene::SceneDataset(fs::path(At("few"))).SceneCount(), 3) << few.text;
  const Outcome free = RunProgram(sample + At("free") + " --free-counts --prompt \"two cups\"");
  EXPECT_EQ(free.code, 1) << free.text;
  EXPECT_NE(free.text.find("reads no prompts"), std::string::npos) << free.text;
  // Weights or a type must be given, and weights of one type have no other.
  for (const std::string& from : {std::string(), At("model") + "/model.pt --type pantry_shelf",
                                  std::string("--type no_such_type")}) {
    const Outcome refused = RunProgram("scene sample " + from + " --quiet -o " + At("refused"));
    EXPECT_EQ(refused.code, 1) << from;
    EXPECT_FALSE(fs::exists(At("refused"))) << from;
  }
  const Outcome unknown = RunProgram("scene sample --type no_such_type -o " + At("refused"));
  EXPECT_NE(unknown.text.find("dimsum"), std::string::npos)
      << "names those shipped: " << unknown.text;
  const Outcome over = RunProgram(sample + At("sampled"));
  EXPECT_EQ(over.code, 1);
  EXPECT_NE(over.text.find("exists"), std::string::npos) << over.text;
}

void SceneCommand::AModelByShapeTakesANewAsset() {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  const Outcome trained = RunProgram("scene train " + Dimsum() +
                                     " --by-shape --steps 2 --batch 2 --quiet -o " + At("shapes"));
  ASSERT_EQ(trained.code, 0) << trained.text;
  const std::string assets = Dimsum() + "/assets";
  const auto sample = [&](const std::string& model, const std::string& added,
                          const std::string& output) {
    return RunProgram("scene sample " + At(model) +
                      "/model.pt --count 2 --steps 5 --raw --assets " + assets + " " + added +
                      " --quiet -o " + At(output));
  };
  const Outcome sampled = sample("shapes", "--add mug=" + assets + "/cup", "with_mugs");
  ASSERT_EQ(sampled.code, 0) << sampled.text;
  const scene::SceneDataset dataset{fs::path(At("with_mugs"))};
  EXPECT_GE(dataset.vocabulary().ClassOf("mug"), 0);
  EXPECT_TRUE(assets::IsAssetFolder(fs::path(At("with_mugs")) / "assets" / "mug"));
  for (const std::string& added : {"--add mug=" + At("nowhere"), "--add ../mug=" + assets + "/cup",
                                   "--add cup=" + assets + "/cup", std::string("--add mug"),
                                   "--add mug=" + assets + "/cup mug=" + assets + "/plate"}) {
    const Outcome wrong = sample("shapes", added, "wrong");
    EXPECT_EQ(wrong.code, 1) << added;
    EXPECT_EQ(wrong.text.rfind("error: ", 0), 0u) << wrong.text;
  }
  const Outcome table = sample("model", "--add mug=" + assets + "/cup", "wrong");
  EXPECT_EQ(table.code, 1);
  EXPECT_NE(table.text.find("--by-shape"), std::string::npos) << table.text;
  EXPECT_FALSE(fs::exists(At("wrong")));
}

void SceneCommand::AnAssetOfOnesOwnTakesASlot() {
  ASSERT_EQ(generated_.code, 0) << generated_.text;
  // The teapot replaces the cup, by name or by category.
  const std::string teapot = Dimsum() + "/assets/teapot";
  const Outcome own =
      RunProgram("scene generate --type dimsum --count 1 --quiet --asset cup=" + teapot +
                 " --assets " + Dimsum() + "/assets -o " + At("own"));
  ASSERT_EQ(own.code, 0) << own.text;
  EXPECT_EQ(assets::ReadAsset(fs::path(At("own")) / "assets" / "cup").parameters.category,
            assets::ReadAsset(teapot).parameters.category);
  for (const std::string& flag :
       {std::string("--asset cup=" + At("nowhere")), std::string("--asset spoon=" + teapot),
        std::string("--asset cup"), "--assets " + At("nowhere")}) {
    const Outcome wrong =
        RunProgram("scene generate --type dimsum --count 1 --quiet " + flag + " -o " + At("wrong"));
    EXPECT_EQ(wrong.code, 1) << flag;
    EXPECT_EQ(wrong.text.rfind("error: ", 0), 0u) << wrong.text;
  }
}

void SceneCommand::RefusesWhatIsNone() {
  for (const std::string& arguments :
       {"scene generate --type banquet -o " + At("a"), std::string("scene generate --count 3"),
        "scene generate --type dimsum --count 0 -o " + At("a"),
        "scene train " + At("nowhere") + " -o " + At("a"),
        "scene sample " + At("nowhere.pt") + " -o " + At("a")}) {
    const Outcome outcome = RunProgram(arguments + " --quiet");
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_EQ(outcome.text.rfind("error: ", 0), 0u) << outcome.text;
  }
  EXPECT_FALSE(fs::exists(At("a") + "/part_00000.h5"));
  EXPECT_EQ(RunProgram("scene").code, 2);
}

TEST_F(SceneCommand, DoesAllOfIt) {
  {
    SCOPED_TRACE("GeneratesScenesThatHold");
    GeneratesScenesThatHold();
  }
  {
    SCOPED_TRACE("GoesOnWhereItStopped");
    GoesOnWhereItStopped();
  }
  {
    SCOPED_TRACE("NamesASlotThatThereIsNot");
    NamesASlotThatThereIsNot();
  }
  {
    SCOPED_TRACE("LearnsAndSamples");
    LearnsAndSamples();
  }
  {
    SCOPED_TRACE("AModelByShapeTakesANewAsset");
    AModelByShapeTakesANewAsset();
  }
  {
    SCOPED_TRACE("AnAssetOfOnesOwnTakesASlot");
    AnAssetOfOnesOwnTakesASlot();
  }
  {
    SCOPED_TRACE("RefusesWhatIsNone");
    RefusesWhatIsNone();
  }
}

}  // namespace
}  // namespace simwright::workflows
