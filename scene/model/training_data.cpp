#include "scene/model/training_data.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/error.h"
#include "scene/model/token_tensors.h"

namespace simwright::scene {
namespace {

constexpr char kSeveralTypes[] = "combined";

int HeldOut(int scenes, const SceneTrainingOptions& options) {
  const int share = static_cast<int>(options.held_out * scenes);
  return std::min(share, options.held_out_most);
}

// Returns the union of vocabularies.
Vocabulary UnionOf(const std::vector<const SceneDataset*>& datasets) {
  if (datasets.size() == 1) return datasets.front()->vocabulary();
  std::map<std::string, bool> welded;
  Vocabulary all;
  all.type = kSeveralTypes;
  for (const SceneDataset* const dataset : datasets) {
    const Vocabulary& one = dataset->vocabulary();
    all.entries = std::max(all.entries, one.entries);
    for (size_t c = 0; c < one.categories.size(); ++c) {
      const auto [found, is_new] = welded.emplace(one.categories[c], one.welded[c]);
      if (!is_new && found->second != one.welded[c]) {
        throw core::Error("a category is furniture in one dataset and free in another",
                          one.categories[c]);
      }
    }
  }
  for (const auto& [category, is_welded] : welded) {
    all.categories.push_back(category);
    all.welded.push_back(is_welded);
  }
  return all;
}

void RequireDifferentTypes(const std::vector<const SceneDataset*>& datasets) {
  std::map<std::string, int> seen;
  for (const SceneDataset* const dataset : datasets) {
    const std::string& type = dataset->vocabulary().type;
    if (++seen[type] > 1) {
      throw core::Error("two datasets have the same scene type", type,
                        "train on one dataset for each type");
    }
  }
}

// Returns the classes of a vocabulary in another one that has all its categories.
torch::Tensor ClassesIn(const Vocabulary& from, const Vocabulary& to) {
  std::vector<std::int64_t> classes;
  for (const std::string& category : from.categories) classes.push_back(to.ClassOf(category));
  classes.push_back(to.EmptyClass());
  return torch::tensor(classes, torch::kLong);
}

}  // namespace

TrainingData::TrainingData(const std::vector<const SceneDataset*>& datasets,
                           const SceneTrainingOptions& options) {
  if (datasets.empty()) throw core::Error("a training needs a dataset");
  RequireDifferentTypes(datasets);
  vocabulary_ = UnionOf(datasets);
  for (const SceneDataset* const dataset : datasets) {
    const int held_out = HeldOut(dataset->SceneCount(), options);
    const int training = dataset->SceneCount() - held_out;
    types_.push_back({dataset, training, held_out, PoseRange::Of(*dataset, 0, training),
                      ClassesIn(dataset->vocabulary(), vocabulary_),
                      dataset->vocabulary().categories});
  }
}

void TrainingData::Describe(SceneModelMetadata* metadata) const {
  metadata->vocabulary = vocabulary_;
  metadata->range = types_.front().range;
  metadata->training_scenes = training();
  metadata->data_seed = types_.front().dataset->parts().front().origin().seed;
  metadata->types.clear();
  if (types_.size() == 1) return;
  for (const TrainingType& one : types_) {
    metadata->types.push_back({one.vocabulary().type, one.vocabulary().entries, one.range,
                               one.training, one.dataset->parts().front().origin().seed,
                               one.present});
  }
}

int TrainingData::training() const {
  return std::accumulate(types_.begin(), types_.end(), 0,
                         [](int sum, const TrainingType& one) { return sum + one.training; });
}

int TrainingData::held_out() const {
  return std::accumulate(types_.begin(), types_.end(), 0,
                         [](int sum, const TrainingType& one) { return sum + one.held_out; });
}

void TrainingData::Start(std::uint64_t seed, int buffer) {
  streams_.clear();
  for (const TrainingType& one : types_) {
    streams_.emplace_back(*one.dataset, StreamOptions{0, one.training, buffer}, seed);
  }
}

std::vector<float> TrainingData::Next(int type, int count) {
  const Vocabulary& vocabulary = types_[static_cast<size_t>(type)].vocabulary();
  std::vector<float> tokens(static_cast<size_t>(count) * static_cast<size_t>(vocabulary.entries) *
                            static_cast<size_t>(vocabulary.TokenWidth()));
  streams_[static_cast<size_t>(type)].Next(count, tokens.data());
  return tokens;
}

CleanScenes TrainingData::Tensors(int type, const std::vector<float>& tokens) const {
  const TrainingType& one = types_[static_cast<size_t>(type)];
  CleanScenes scenes = TensorsOf(tokens, one.vocabulary(), one.range);
  if (types_.size() > 1) {
    scenes.classes =
        one.class_of.index_select(0, scenes.classes.flatten()).reshape(scenes.classes.sizes());
  }
  return scenes;
}

}  // namespace simwright::scene
