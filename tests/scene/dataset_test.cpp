// Scenes in HDF5: written files are readable, also by h5py; damaged ones are rejected.
#include "scene/dataset/scene_dataset.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>

#include "core/error.h"
#include "core/files.h"
#include "core/hdf5.h"
#include "scene/dataset/pose_range.h"
#include "scene/dataset/scene_stream.h"
#include "scene/dataset/shard_claim.h"
#include "scene/dataset/tokens.h"
#include "scene/scene_types/dimsum.h"

namespace simwright::scene {
namespace {
namespace fs = std::filesystem;

Vocabulary DatasetWords() {
  return {"test", 4, {"bowl", "cup", "table"}, {false, false, true}};
}

SceneObject DatasetArticulatedObject(const std::string& category, double x, double turn) {
  SceneObject object;
  object.category = category;
  object.welded = category == "table";
  object.world_from_object = Eigen::Translation3d(x, -x, 0.7) *
                             Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, 3).normalized());
  return object;
}

// Scene i: a table, and a cup whose position encodes i.
SceneShard Part(int number, int scenes) {
  SceneShard part{DatasetWords(), {5, number, "{}", "{}", "1"}, {}, {}};
  const size_t size = static_cast<size_t>(DatasetWords().entries * DatasetWords().TokenWidth());
  for (int i = 0; i < scenes; ++i) {
    part.tokens.resize(part.tokens.size() + size);
    EncodeScene({DatasetArticulatedObject("table", 0.0, 0.1),
                 DatasetArticulatedObject("cup", 100 * number + i, 0.3 * i)},
                DatasetWords(), &part.tokens[part.tokens.size() - size]);
    part.attempts.push_back({3, 2, 1, true, true, 1e-3 * i, 1e-5, 2e-4});
    part.attempts.push_back({4, 1, 3, false, false, 0.0, 0.5, 0.1});
  }
  return part;
}

int NumberOf(const float* tokens) {
  return static_cast<int>(tokens[DatasetWords().TokenWidth()]);
}

TEST(SceneTokens, ComeBackAsTheyWere) {
  const std::vector<SceneObject> objects = {DatasetArticulatedObject("table", 0.0, 0.0),
                                            DatasetArticulatedObject("cup", 0.31, 2.9),
                                            DatasetArticulatedObject("bowl", -0.2, -1.0)};
  std::vector<float> tokens(
      static_cast<size_t>(DatasetWords().entries * DatasetWords().TokenWidth()));
  EncodeScene(objects, DatasetWords(), tokens.data());
  EXPECT_EQ(ValidateTokens(tokens.data(), DatasetWords()), "");
  EXPECT_EQ(tokens[12 + 2], 1.0f);  // a table is class 2 of (bowl, cup, table, empty)
  EXPECT_EQ(tokens[static_cast<size_t>(3 * DatasetWords().TokenWidth() + 12 + 3)], 1.0f);
  const std::vector<SceneObject> back = DecodeScene(tokens.data(), DatasetWords());
  ASSERT_EQ(back.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back[i].category, objects[i].category);
    EXPECT_EQ(back[i].welded, objects[i].welded);
    EXPECT_TRUE(back[i].world_from_object.isApprox(objects[i].world_from_object, 1e-6));
  }
  EXPECT_THROW(
      EncodeScene({DatasetArticulatedObject("spoon", 0, 0)}, DatasetWords(), tokens.data()),
      core::Error);
  EXPECT_THROW(EncodeScene(std::vector<SceneObject>(5, DatasetArticulatedObject("cup", 0, 0)),
                           DatasetWords(), tokens.data()),
               core::Error);
}

TEST(SceneTokens, TheNearestRotationIsTheNearest) {
  // A rotation times a symmetric positive matrix is nearest to that rotation (polar decomposition).
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  Eigen::Matrix3d stretch;
  stretch << 2.0, 0.3, 0.1, 0.3, 1.0, -0.2, 0.1, -0.2, 0.5;
  EXPECT_TRUE(NearestRotation(turn * stretch).isApprox(turn, 1e-12));
  // For a reflection the result is still a rotation, and none of many others is nearer.
  Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, 0.9, -0.3).asDiagonal();
  mirror(0, 1) = 0.2;
  const Eigen::Matrix3d nearest = NearestRotation(mirror);
  EXPECT_NEAR(nearest.determinant(), 1.0, 1e-12);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d other = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    EXPECT_GE((other - mirror).norm(), (nearest - mirror).norm() - 1e-12);
  }
}

TEST(SceneTokens, SayWhatIsWrong) {
  std::vector<float> sound(
      static_cast<size_t>(DatasetWords().entries * DatasetWords().TokenWidth()));
  EncodeScene({DatasetArticulatedObject("cup", 0.1, 0.5)}, DatasetWords(), sound.data());
  const auto fault = [&](size_t index, float value) {
    std::vector<float> tokens = sound;
    tokens[index] = value;
    return ValidateTokens(tokens.data(), DatasetWords());
  };
  EXPECT_NE(fault(1, NAN).find("finite"), std::string::npos);
  EXPECT_NE(fault(12, 1.0f).find("one-hot"), std::string::npos);
  EXPECT_NE(fault(13, 0.5f).find("one-hot"), std::string::npos);
  EXPECT_NE(fault(4, 3.0f).find("rotation"), std::string::npos);
  EXPECT_NE(fault(16, 3.0f).find("entry 1"), std::string::npos);
}

TEST(SceneVocabulary, IsTheGrammars) {
  const Vocabulary vocabulary = VocabularyOf(DimsumTable());
  EXPECT_EQ(vocabulary.entries, 34);
  EXPECT_EQ(vocabulary.ClassCount(), 8);  // seven slots and the empty one, as published
  EXPECT_TRUE(vocabulary.welded[static_cast<size_t>(vocabulary.ClassOf("table_round"))]);
  EXPECT_FALSE(vocabulary.welded[static_cast<size_t>(vocabulary.ClassOf("cup"))]);
  EXPECT_EQ(vocabulary.ClassOf("spoon"), -1);
}

TEST(SceneDataset, ReadsAcrossItsParts) {
  const core::TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) WriteShard(Part(i, 5 + i), folder.path() / ShardName(i));
  const SceneDataset dataset(folder.path());
  EXPECT_EQ(dataset.SceneCount(), 18);
  EXPECT_EQ(dataset.vocabulary(), DatasetWords());
  EXPECT_EQ(dataset.Attempts().size(), 36u);
  EXPECT_EQ(dataset.Attempts()[2], Part(0, 5).attempts[2]);
  const size_t size = static_cast<size_t>(DatasetWords().entries * DatasetWords().TokenWidth());
  const std::vector<float> tokens = dataset.Read(3, 9);
  ASSERT_EQ(tokens.size(), 9 * size);
  std::vector<int> numbers;
  for (size_t i = 0; i < 9; ++i) numbers.push_back(NumberOf(&tokens[i * size]));
  EXPECT_EQ(numbers, (std::vector<int>{3, 4, 100, 101, 102, 103, 104, 105, 200}));
  EXPECT_THROW(dataset.Read(10, 9), core::Error);
  EXPECT_THROW(dataset.Read(-1, 2), core::Error);
  EXPECT_EQ(SceneDataset(folder.path() / ShardName(1)).SceneCount(), 6);
}

// Returns a shard whose scene i has the prompt "prompt NUMBER i".
SceneShard PartWithPrompts(int number, int scenes) {
  SceneShard part = Part(number, scenes);
  for (int i = 0; i < scenes; ++i) {
    part.prompts.push_back("prompt " + std::to_string(number) + " " + std::to_string(i));
  }
  return part;
}

TEST(SceneDataset, AnEmptyPromptStaysEmpty) {
  const core::TemporaryFolder folder;
  SceneShard part = PartWithPrompts(0, 3);
  part.prompts[1].clear();
  WriteShard(part, folder.path() / ShardName(0));
  EXPECT_EQ(SceneDataset(folder.path()).ReadPrompts(0, 3), part.prompts);
}

TEST(SceneDataset, ReadsPromptsAcrossItsParts) {
  const core::TemporaryFolder folder;
  for (int i = 0; i < 2; ++i) WriteShard(PartWithPrompts(i, 3), folder.path() / ShardName(i));
  {
    const SceneDataset dataset(folder.path());
    EXPECT_EQ(dataset.ReadPrompts(1, 3),
              (std::vector<std::string>{"prompt 0 1", "prompt 0 2", "prompt 1 0"}));
    EXPECT_TRUE(dataset.ReadPrompts(6, 0).empty());
    EXPECT_THROW(dataset.ReadPrompts(4, 3), core::Error);
    EXPECT_EQ(dataset.parts()[1].ReadAll().prompts, PartWithPrompts(1, 3).prompts);
    EXPECT_THROW(dataset.parts()[1].Prompts(2, 2), core::Error);
  }
  // A shard of an earlier version has none: then the dataset has none for its scenes.
  WriteShard(Part(1, 3), folder.path() / ShardName(1));
  const SceneDataset mixed(folder.path());
  EXPECT_EQ(mixed.ReadPrompts(0, 3).size(), 3u);
  EXPECT_TRUE(mixed.ReadPrompts(0, 4).empty());
  EXPECT_TRUE(mixed.parts()[1].ReadAll().prompts.empty());
}

TEST(SceneDataset, PromptsAreOneForEachScene) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / ShardName(0);
  SceneShard part = PartWithPrompts(0, 3);
  part.prompts.pop_back();
  EXPECT_THROW(WriteShard(part, path), core::Error);
  EXPECT_FALSE(fs::exists(path));
}

TEST(SceneDataset, H5pyReadsTheSame) {
  const core::TemporaryFolder folder;
  WriteShard(PartWithPrompts(0, 5), folder.path() / ShardName(0));
  const std::string script =
      "import h5py, numpy as np, sys\n"
      "f = h5py.File(sys.argv[1])\n"
      "s = f['scenes']\n"
      "assert s.shape == (5, 4, 16) and s.dtype == np.float32 and s.compression == 'gzip', s\n"
      "assert s.chunks == (5, 4, 16), s.chunks\n"
      "assert [x.decode() for x in f['slots'][:]] == ['bowl', 'cup', 'table']\n"
      "assert f['welded'][:].tolist() == [0, 0, 1]\n"
      "assert f['prompts'].shape == (5,) and f['prompts'][3].decode() == 'prompt 0 3'\n"
      "assert f.attrs['type'] == 'test' and f.attrs['seed'] == 5 and f.attrs['version'] == 1\n"
      "assert np.allclose(s[:, 1, 0], np.arange(5)) and np.allclose(s[:, 0, 2], 0.7)\n"
      "assert np.all(s[:, :, 12:].sum(-1) == 1) and np.all(s[:, 2:, 15] == 1)\n"
      "r = s[:, 1, 3:12].reshape(-1, 3, 3)\n"
      "assert np.allclose(r @ r.transpose(0, 2, 1), np.eye(3), atol=1e-6)\n"
      "assert f['attempt_counts'].shape == (10, 5) and f['attempt_figures'].shape == (10, 3)\n";
  core::WriteFile(folder.path() / "read.py", script);
  const std::string command = "/usr/bin/python3 " + (folder.path() / "read.py").string() + " " +
                              (folder.path() / ShardName(0)).string();
  EXPECT_EQ(std::system(command.c_str()), 0);
}

std::string DatasetErrorOf(const fs::path& path) {
  try {
    const SceneDataset dataset(path);
    dataset.Read(0, dataset.SceneCount());
  } catch (const core::Error& error) {
    return error.what();
  }
  return "";
}

TEST(SceneDataset, RefusesWhatIsDamaged) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / ShardName(0);
  EXPECT_NE(DatasetErrorOf(folder.path()).find("no scenes"), std::string::npos);
  WriteShard(Part(0, 40), path);
  const std::string bytes = core::ReadFile(path);
  EXPECT_EQ(DatasetErrorOf(path), "");
  for (const double share : {0.0, 0.3, 0.7, 0.99}) {
    core::WriteFile(path, bytes.substr(0, static_cast<size_t>(share * bytes.size())));
    EXPECT_NE(DatasetErrorOf(path).find(path.string()), std::string::npos) << share;
  }
  core::WriteFile(path, "no HDF5 at all");
  EXPECT_NE(DatasetErrorOf(path).find("HDF5"), std::string::npos);
  {
    core::Hdf5Writer writer(path);
    writer.root().SetAttribute("format", "simwright scenes");
    writer.root().SetAttribute("version", std::int64_t{2});
    writer.Commit();
  }
  EXPECT_NE(DatasetErrorOf(path).find("version 2"), std::string::npos);
  SceneShard part = Part(0, 3);
  part.tokens[20] = NAN;
  WriteShard(part, path);
  EXPECT_NE(DatasetErrorOf(path).find("scene 0: entry 1: a number is not finite"),
            std::string::npos);
  part = Part(0, 3);
  part.attempts[0].valid = false;
  part.tokens.resize(part.tokens.size() / 3 * 2);
  part.attempts.push_back({3, 3, 0, true, true, 0, 0, 0});
  WriteShard(part, path);
  EXPECT_EQ(DatasetErrorOf(path), "");  // valid scenes are counted at any position
}

// Flips bytes at all positions: libhdf5 alone would crash for one in forty.
TEST(SceneDataset, RefusesEveryFlippedByte) {
  const core::TemporaryFolder folder;
  const fs::path path = folder.path() / ShardName(0);
  WriteShard(Part(0, 40), path);
  const std::string bytes = core::ReadFile(path);
  core::Rng rng = core::StreamRng(1, 0);
  for (int i = 0; i < 500; ++i) {
    std::string damaged = bytes;
    // Bytes outside the seal; damage to the seal only leaves the file without one.
    const auto at =
        static_cast<size_t>(core::Uniform(rng, 0, static_cast<double>(bytes.size() - 40)));
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (i % 8)));
    core::WriteFile(path, damaged);
    ASSERT_NE(DatasetErrorOf(path).find("damaged"), std::string::npos) << at;
  }
  std::string unsealed = bytes.substr(0, bytes.size() - 39);
  core::WriteFile(path, unsealed);  // as another program writes it
  EXPECT_EQ(DatasetErrorOf(path), "");
}

TEST(SceneDataset, RefusesPartsThatDoNotBelongTogether) {
  const core::TemporaryFolder folder;
  WriteShard(Part(0, 3), folder.path() / ShardName(0));
  SceneShard other = Part(1, 3);
  other.origin.seed = 6;
  WriteShard(other, folder.path() / ShardName(1));
  EXPECT_NE(DatasetErrorOf(folder.path()).find(ShardName(1)), std::string::npos);
}

TEST(SceneStream, GivesEveryScenePerRound) {
  const core::TemporaryFolder folder;
  for (int i = 0; i < 4; ++i) WriteShard(Part(i, 20), folder.path() / ShardName(i));
  const SceneDataset dataset(folder.path());
  const size_t size = static_cast<size_t>(DatasetWords().entries * DatasetWords().TokenWidth());
  std::vector<float> tokens(60 * size);
  const auto numbers = [&](SceneStream* stream) {
    stream->Next(60, tokens.data());
    std::vector<int> result;
    for (size_t i = 0; i < 60; ++i) result.push_back(NumberOf(&tokens[i * size]));
    return result;
  };
  // A buffer that holds all: the 60 scenes from the tenth on, each once, then each once in another
  // order.
  SceneStream whole(dataset, {10, 60, 100, 8}, 3);
  const std::vector<int> first = numbers(&whole), second = numbers(&whole);
  EXPECT_EQ(std::set<int>(first.begin(), first.end()).size(), 60u);
  EXPECT_EQ(std::set<int>(second.begin(), second.end()).size(), 60u);
  EXPECT_EQ(*std::min_element(first.begin(), first.end()), 10);
  EXPECT_NE(first, second);
  SceneStream again(dataset, {10, 60, 100, 8}, 3);
  EXPECT_EQ(numbers(&again), first);
  // A buffer of a quarter: over ten epochs every scene comes about ten times, in random order.
  SceneStream streamed(dataset, {10, 60, 15, 8}, 3);
  std::map<int, int> counts;
  for (int round = 0; round < 10; ++round) {
    for (const int number : numbers(&streamed)) ++counts[number];
  }
  EXPECT_EQ(counts.size(), 60u);
  for (const auto& [number, count] : counts) EXPECT_NEAR(count, 10, 4) << number;
  EXPECT_THROW(SceneStream(dataset, {70, 20, 15, 8}, 3), core::Error);
  EXPECT_THROW(SceneStream(dataset, {0, 20, 0, 8}, 3), core::Error);
}

TEST(PoseRange, BringsFeaturesToTheUnitRange) {
  const core::TemporaryFolder folder;
  WriteShard(Part(0, 5), folder.path() / ShardName(0));
  const SceneDataset dataset(folder.path());
  const PoseRange range = PoseRange::Of(dataset, 0, 5);
  EXPECT_EQ(range.low()[0], 0.0);
  EXPECT_EQ(range.high()[0], 4.0);
  EXPECT_EQ(range.low()[2], 0.0);  // of the padding
  EXPECT_NEAR(range.high()[2], 0.7, 1e-6);
  const std::vector<float> tokens = dataset.Read(4, 1);
  float unit[kPoseWidth], pose[kPoseWidth];
  range.ToUnit(&tokens[static_cast<size_t>(DatasetWords().TokenWidth())], unit);
  EXPECT_FLOAT_EQ(unit[0], 1.0f);
  EXPECT_FLOAT_EQ(unit[1], -1.0f);
  range.FromUnit(unit, pose);
  for (size_t i = 0; i < kPoseWidth; ++i) {
    EXPECT_NEAR(pose[i], tokens[static_cast<size_t>(DatasetWords().TokenWidth()) + i], 1e-6);
  }
  const PoseRange back = PoseRange::FromText(range.Text());
  EXPECT_EQ(back.low(), range.low());
  EXPECT_EQ(back.high(), range.high());
  EXPECT_THROW(PoseRange::FromText("{\"low\": 3}"), core::Error);
}

TEST(ShardClaim, OneWorkerHasIt) {
  const core::TemporaryFolder folder;
  const fs::path part = folder.path() / ShardName(0);
  {
    const ShardClaim mine(part);
    EXPECT_TRUE(mine.held());
    EXPECT_FALSE(ShardClaim(part).held());
  }
  EXPECT_TRUE(ShardClaim(part).held());
  // A lock file of a dead worker blocks no other worker.
  std::ofstream(part.string() + ".lock") << "";
  EXPECT_TRUE(ShardClaim(part).held());
}

}  // namespace
}  // namespace simwright::scene
