// The search over partial scenes, with an inpainter that puts objects at random.
#include "steering/search/scene_search.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/dataset/tokens.h"
#include "steering/rewards/scene_rewards.h"
#include "steering/search/search_state.h"
#include "steering_scenes.h"

namespace simwright::steering {
namespace {

// Puts cups at random on the table, two of three times; a whole scene gets the table and two cups.
std::vector<float> RandomCups(const std::vector<float>& tokens, const scene::InpaintingMask& mask,
                              std::uint64_t seed) {
  const scene::Vocabulary vocabulary = TableVocabulary();
  std::string error;
  EXPECT_TRUE(mask.IsValid(tokens, vocabulary, &error)) << error;
  TokenScene scene;
  scene.tokens = tokens;
  scene.penetrating.resize(mask.pose.size());
  scene.unstable.resize(mask.pose.size());
  for (size_t i = 0; i < mask.pose.size(); ++i) {
    core::Rng rng = core::StreamRng(seed, i);
    if (!mask.pose[i]) continue;
    const auto entry = static_cast<int>(i);
    const bool whole = mask.forbidden.empty();
    const int number = entry % vocabulary.entries;
    scene::SceneObject object = ObjectAt("cup", core::Uniform(rng, -0.45, 0.45),
                                         core::Uniform(rng, -0.45, 0.45), kTableTop + 0.01);
    if (whole && number == 0) object = ObjectAt("table", 0, 0, 0);
    const bool there = whole ? number < 3 : core::Uniform(rng) < 0.67;
    scene.Set(entry, there ? &object : nullptr, vocabulary);
  }
  return scene.tokens;
}

class SceneSearchTest : public testing::Test {
 protected:
  SceneSearch NewSearch(SearchOptions options, RepairOptions repair = {}) const {
    return {vocabulary_, asset_set_, *mask_, *reward_, RandomCups, options, repair};
  }
  static void RunAll(SceneSearch* search) {
    while (!search->Finished()) search->Iterate();
  }
  static SearchOptions Short(int iterations) {
    SearchOptions options;
    options.iterations = iterations;
    options.fill = 1;
    return options;
  }

  scene::Vocabulary vocabulary_ = TableVocabulary();
  scene::AssetSet asset_set_ = TableAssets();
  std::unique_ptr<MaskGenerator> mask_ = MaskNamed("empty,penetrating,unstable", vocabulary_);
  std::unique_ptr<SceneReward> reward_ = FeasibleCountReward(vocabulary_);
};

void ExpectEqual(const SearchState& a, const SearchState& b) {
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (size_t i = 0; i < a.nodes.size(); ++i) {
    EXPECT_EQ(a.nodes[i].parent, b.nodes[i].parent);
    EXPECT_EQ(a.nodes[i].visits, b.nodes[i].visits);
    EXPECT_EQ(a.nodes[i].total, b.nodes[i].total);
    EXPECT_EQ(a.scenes[i].tokens, b.scenes[i].tokens) << "node " << i;
    EXPECT_EQ(a.scenes[i].unstable, b.scenes[i].unstable);
  }
  ASSERT_EQ(a.records.size(), b.records.size());
  EXPECT_EQ(a.best, b.best);
  EXPECT_EQ(a.best_reward, b.best_reward);
  EXPECT_EQ(a.samples, b.samples);
}

TEST_F(SceneSearchTest, FillsTheTable) {
  SceneSearch search = NewSearch(Short(60));
  search.Start();
  EXPECT_EQ(search.tree().nodes().front().reward, 3.0);  // the table and two cups
  RunAll(&search);
  EXPECT_TRUE(search.ReachedGoal());
  EXPECT_EQ(search.best_reward(), 8.0);
  const TokenScene& best = search.scenes()[static_cast<size_t>(search.best())];
  EXPECT_EQ(Judge(best.Judged(vocabulary_).objects, asset_set_).FeasibleCount(true), 8);
  const SearchRecord& last = search.records().back();
  EXPECT_EQ(last.samples, 1 + 3 * search.IterationCount());
  EXPECT_EQ(last.nodes, last.samples);
  // Kept objects never move: each child has its parent's feasible objects, bit by bit.
  const auto width = static_cast<size_t>(vocabulary_.TokenWidth());
  for (size_t i = 1; i < search.scenes().size(); ++i) {
    const TokenScene& child = search.scenes()[i];
    const auto parent = static_cast<size_t>(search.tree().nodes()[i].parent);
    const std::vector<char> mask = mask_->Mask(search.scenes()[parent]);
    for (size_t entry = 0; entry < mask.size(); ++entry) {
      if (mask[entry]) continue;
      EXPECT_TRUE(std::equal(&child.tokens[entry * width], &child.tokens[(entry + 1) * width - 1],
                             &search.scenes()[parent].tokens[entry * width]));
    }
  }
}

TEST_F(SceneSearchTest, RandomSearchDrawsAsManyScenes) {
  SearchOptions options = Short(5);
  options.random = true;
  SceneSearch search = NewSearch(options);
  search.Start();
  RunAll(&search);
  EXPECT_EQ(search.IterationCount(), 5);
  EXPECT_EQ(search.records().back().samples, 16);
  EXPECT_EQ(search.best_reward(), 3.0);
}

TEST_F(SceneSearchTest, ResumesBitByBit) {
  const core::TemporaryFolder folder;
  for (const bool random : {false, true}) {
    SearchOptions options = Short(6);
    options.random = random;
    options.backs_up_all = random;
    SceneSearch whole = NewSearch(options);
    whole.Start();
    RunAll(&whole);
    SceneSearch first = NewSearch(options);
    first.Start();
    for (int i = 0; i < 3; ++i) first.Iterate();
    WriteSearchState(first.State(), vocabulary_, "settings", folder.path() / "state");
    SceneSearch second = NewSearch(options);
    second.Resume(ReadSearchState(folder.path() / "state", vocabulary_, "settings"));
    RunAll(&second);
    ExpectEqual(whole.State(), second.State());
  }
  EXPECT_THROW(ReadSearchState(folder.path() / "state", vocabulary_, "others"), core::Error);
  EXPECT_THROW(ReadSearchState(folder.path() / "nothing", vocabulary_, "settings"), core::Error);
  scene::Vocabulary other = vocabulary_;
  other.entries = 9;
  EXPECT_THROW(ReadSearchState(folder.path() / "state", other, "settings"), core::Error);
  std::string bytes = core::ReadFile(folder.path() / "state");
  bytes[bytes.size() / 2] ^= 1;
  core::WriteFile(folder.path() / "state", bytes);
  EXPECT_THROW(ReadSearchState(folder.path() / "state", vocabulary_, "settings"), core::Error);
}

TEST_F(SceneSearchTest, DoesNotDependOnThreads) {
  SearchOptions options = Short(6);
  options.leaves = 2;
  std::vector<SearchState> states;
  for (const int threads : {1, 3}) {
    core::SetThreadCount(threads);
    SceneSearch search = NewSearch(options);
    search.Start();
    RunAll(&search);
    states.push_back(search.State());
  }
  core::SetThreadCount(0);
  EXPECT_EQ(states[0].records.size(), 6u);
  ExpectEqual(states[0], states[1]);
}

TEST_F(SceneSearchTest, StartsFromASceneAndEndsAtAFullOne) {
  TokenScene start = TokenScene::Empty(vocabulary_);
  std::vector<scene::SceneObject> objects = {ObjectAt("table", 0, 0, 0)};
  for (int i = 0; i < 7; ++i) objects.push_back(ObjectAt("cup", -0.42 + 0.14 * i, 0, kTableTop));
  EncodeScene(objects, vocabulary_, start.tokens.data());
  SceneSearch full = NewSearch(Short(10));
  full.StartWith(start);
  EXPECT_TRUE(full.Finished());
  EXPECT_EQ(full.best_reward(), 8.0);
  EXPECT_EQ(full.IterationCount(), 0);
}

TEST_F(SceneSearchTest, PublishedSettingsJudgeWithoutRepair) {
  SearchOptions options;
  options.iterations = 10;
  options.exploration = 1.4;
  options.scaled = options.backs_up_all = options.confirms = false;
  options.fill = 0;
  RepairOptions repair;
  repair.repair = Repair::kNone;
  SceneSearch search = NewSearch(options, repair);
  search.Start();
  RunAll(&search);
  const std::vector<TreeNode>& nodes = search.tree().nodes();
  EXPECT_EQ(nodes.front().visits, 1 + search.IterationCount());  // one child per expansion
  EXPECT_EQ(nodes.size(), 1u + 3u * static_cast<size_t>(search.IterationCount()));
  // The cups float by a centimetre, and are not lowered: none of them is feasible.
  EXPECT_EQ(search.best_reward(), 1.0);
}

TEST_F(SceneSearchTest, RefusesOptionsThatDoNotFit) {
  const auto refuses = [&](SearchOptions options) {
    EXPECT_THROW(NewSearch(options), core::Error);
  };
  SearchOptions options;
  options.iterations = 0;
  refuses(options);
  options = {};
  options.branching = 0;
  refuses(options);
  options = {};
  options.exploration = NAN;
  refuses(options);
  options = {};
  options.allowed = {1};
  refuses(options);
  SceneSearch search = NewSearch({});
  EXPECT_THROW(search.Resume({}), core::Error);
}

}  // namespace
}  // namespace simwright::steering
