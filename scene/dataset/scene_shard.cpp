#include "scene/dataset/scene_shard.h"

#include <algorithm>

#include "core/error.h"
#include "core/file_seal.h"
#include "core/hdf5.h"
#include "scene/dataset/tokens.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

constexpr char kFormat[] = "simwright scenes";
constexpr std::int64_t kVersion = 1;
constexpr char kNoPrompt[] = " ";  // the empty prompt in a file, whose texts are not empty
constexpr std::size_t kScenesPerChunk = 16;
constexpr int kGzip = 4;
constexpr std::size_t kCounts = 5, kFigures = 3;  // numbers per attempt

void WriteAttempts(const std::vector<SceneAttempt>& attempts, core::Hdf5Group* root) {
  std::vector<std::int64_t> counts;
  std::vector<double> figures;
  for (const SceneAttempt& one : attempts) {
    counts.insert(counts.end(), {one.sampled, one.kept, one.dropped, one.projected, one.valid});
    figures.insert(figures.end(), {one.moved, one.penetration, one.drift});
  }
  const core::Hdf5Storage storage{.rows_per_chunk = 1024, .gzip = kGzip};
  root->Write("attempt_counts", {attempts.size(), kCounts}, counts.data(), storage);
  root->Write("attempt_figures", {attempts.size(), kFigures}, figures.data(), storage);
}

}  // namespace

SceneAttempt AttemptOf(const FeasibleScene& scene, int drawn) {
  return {drawn,
          static_cast<int>(scene.objects.size()),
          scene.dropped,
          scene.projected,
          scene.valid,
          scene.moved,
          scene.penetration,
          scene.drift};
}

int SceneShard::SceneCount() const {
  return static_cast<int>(std::count_if(attempts.begin(), attempts.end(),
                                        [](const SceneAttempt& one) { return one.valid; }));
}

void WriteShard(const SceneShard& part, const fs::path& path) {
  const Vocabulary& vocabulary = part.vocabulary;
  if (!part.prompts.empty() && part.prompts.size() != static_cast<std::size_t>(part.SceneCount())) {
    throw core::Error("it has " + std::to_string(part.prompts.size()) + " prompts for " +
                          std::to_string(part.SceneCount()) + " scenes",
                      path.string());
  }
  core::Hdf5Writer writer(path);
  core::Hdf5Group& root = writer.root();
  root.SetAttribute("format", kFormat);
  root.SetAttribute("version", kVersion);
  root.SetAttribute("type", vocabulary.type);
  root.SetAttribute("seed", static_cast<std::int64_t>(part.origin.seed));
  root.SetAttribute("part", static_cast<std::int64_t>(part.origin.part));
  root.SetAttribute("assets", part.origin.assets);
  root.SetAttribute("settings", part.origin.settings);
  root.SetAttribute("program", part.origin.program);
  root.WriteTexts("slots", vocabulary.categories);
  const std::vector<std::uint8_t> welded(vocabulary.welded.begin(), vocabulary.welded.end());
  root.Write("welded", {welded.size()}, welded.data());
  root.Write(
      "scenes",
      {static_cast<std::size_t>(part.SceneCount()), static_cast<std::size_t>(vocabulary.entries),
       static_cast<std::size_t>(vocabulary.TokenWidth())},
      part.tokens.data(), {.rows_per_chunk = kScenesPerChunk, .gzip = kGzip});
  WriteAttempts(part.attempts, &root);
  if (!part.prompts.empty()) {
    std::vector<std::string> prompts = part.prompts;
    std::replace(prompts.begin(), prompts.end(), std::string(), std::string(kNoPrompt));
    root.WriteTexts("prompts", prompts);
  }
  writer.CommitSealed();
}

int SceneCountIn(const fs::path& path) {
  const core::Hdf5Reader reader(path);
  const std::vector<std::size_t> shape = reader.root().Shape("scenes");
  return shape.empty() ? 0 : static_cast<int>(std::min<std::size_t>(shape[0], 1 << 30));
}

SceneShardFile::SceneShardFile(const fs::path& path) : path_(path) {
  if (fs::is_regular_file(path) && core::CheckSeal(path) == core::FileSeal::kBroken) {
    throw core::Error("it is damaged: its checksum does not match", path.string(),
                      "delete the file and generate again: only this shard is recomputed");
  }
  const core::Hdf5Reader reader(path);
  const core::Hdf5Group& root = reader.root();
  ReadOrigin(root);
  ReadAttempts(root);
  const std::vector<std::size_t> shape = root.Shape("scenes");
  if (shape.size() != 3 || shape[2] != static_cast<std::size_t>(vocabulary_.TokenWidth()) ||
      shape[0] > static_cast<std::size_t>(1 << 30)) {
    throw core::Error("the shape of the scenes does not match the categories", path.string());
  }
  vocabulary_.entries = static_cast<int>(std::min<std::size_t>(shape[1], 1 << 20));
  scenes_ = static_cast<int>(shape[0]);
  std::string error;
  if (!vocabulary_.IsValid(&error)) throw core::Error(error, path.string());
  const auto valid = std::count_if(attempts_.begin(), attempts_.end(),
                                   [](const SceneAttempt& one) { return one.valid; });
  if (valid != scenes_) {
    throw core::Error(
        "it lists " + std::to_string(valid) + " valid scenes but holds " + std::to_string(scenes_),
        path.string());
  }
}

void SceneShardFile::ReadOrigin(const core::Hdf5Group& root) {
  std::string format;
  try {
    format = root.TextAttribute("format");
  } catch (const core::Error&) {
  }
  if (format != kFormat) throw core::Error("this file is not a scene dataset", path_.string());
  const std::int64_t version = root.IntegerAttribute("version");
  if (version != kVersion) {
    throw core::Error("its format is version " + std::to_string(version) +
                          ", the known version is " + std::to_string(kVersion),
                      path_.string(),
                      "generate the dataset again, or use the version that wrote it");
  }
  vocabulary_.type = root.TextAttribute("type");
  vocabulary_.categories = root.ReadTexts("slots");
  const std::vector<std::uint8_t> welded = root.Read<std::uint8_t>("welded").values;
  vocabulary_.welded.assign(welded.begin(), welded.end());
  origin_.seed = static_cast<std::uint64_t>(root.IntegerAttribute("seed"));
  origin_.part = static_cast<int>(root.IntegerAttribute("part"));
  origin_.assets = root.TextAttribute("assets");
  origin_.settings = root.TextAttribute("settings");
  origin_.program = root.TextAttribute("program");
}

void SceneShardFile::ReadAttempts(const core::Hdf5Group& root) {
  const auto counts = root.Read<std::int64_t>("attempt_counts");
  const auto figures = root.Read<double>("attempt_figures");
  if (counts.shape.size() != 2 || figures.shape.size() != 2 || counts.shape[1] != kCounts ||
      figures.shape[1] != kFigures || counts.shape[0] != figures.shape[0]) {
    throw core::Error("its attempt records have a wrong shape", path_.string());
  }
  for (std::size_t i = 0; i < counts.shape[0]; ++i) {
    const std::int64_t* const count = &counts.values[i * kCounts];
    const double* const figure = &figures.values[i * kFigures];
    attempts_.push_back({static_cast<int>(count[0]), static_cast<int>(count[1]),
                         static_cast<int>(count[2]), count[3] != 0, count[4] != 0, figure[0],
                         figure[1], figure[2]});
  }
}

std::vector<float> SceneShardFile::Read(int first, int count) const {
  const core::Hdf5Reader reader(path_);
  const std::vector<float> tokens = reader.root()
                                        .ReadRows<float>("scenes", static_cast<std::size_t>(first),
                                                         static_cast<std::size_t>(count))
                                        .values;
  const std::size_t size = static_cast<std::size_t>(vocabulary_.entries) *
                           static_cast<std::size_t>(vocabulary_.TokenWidth());
  for (int i = 0; i < count; ++i) {
    const std::string fault =
        ValidateTokens(&tokens[static_cast<std::size_t>(i) * size], vocabulary_);
    if (!fault.empty()) {
      throw core::Error(fault, path_.string() + ", scene " + std::to_string(first + i),
                        "delete the file and generate again: only this shard is recomputed");
    }
  }
  return tokens;
}

std::vector<std::string> SceneShardFile::Prompts(int first, int count) const {
  if (first < 0 || count < 0 || first > scenes_ - count) {
    throw core::Error("it has " + std::to_string(scenes_) + " scenes, not scene " +
                          std::to_string(first + count - 1),
                      path_.string());
  }
  const core::Hdf5Reader reader(path_);
  if (!reader.root().Has("prompts")) return {};
  std::vector<std::string> prompts = reader.root().ReadTexts("prompts");
  std::replace(prompts.begin(), prompts.end(), std::string(kNoPrompt), std::string());
  if (prompts.size() != static_cast<std::size_t>(scenes_)) {
    throw core::Error("it has " + std::to_string(prompts.size()) + " prompts for " +
                          std::to_string(scenes_) + " scenes",
                      path_.string(),
                      "delete the file and generate again: only this shard is recomputed");
  }
  return {prompts.begin() + first, prompts.begin() + first + count};
}

SceneShard SceneShardFile::ReadAll() const {
  return {vocabulary_, origin_, Read(0, scenes_), attempts_, Prompts(0, scenes_)};
}

}  // namespace simwright::scene
