#include "steering/post_training/post_training.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "core/shuffle.h"
#include "nn/compute.h"
#include "nn/trainer.h"
#include "scene/dataset/scene_stream.h"
#include "scene/dataset/tokens.h"
#include "scene/model/prompt_encoder.h"
#include "scene/model/token_tensors.h"
#include "scene/model/training.h"
#include "scene/model/weights_file.h"
#include "scene/prompt/prompt_drawing.h"
#include "steering/post_training/advantages.h"
#include "steering/post_training/post_training_records.h"
#include "steering/post_training/rollout.h"

namespace simwright::steering {
namespace fs = std::filesystem;
namespace {

constexpr int kBadUpdatesInARow = 5;    // most consecutive losses that are not finite
constexpr int kBuffer = 16384;          // scenes of the data held in memory
constexpr double kPromptDropout = 0.1;  // of the data's scenes
constexpr std::uint64_t kScoringStream = 0x7363'6f72'65;

class PostTraining {
 public:
  PostTraining(const fs::path& weights, const scene::SceneDataset& data,
               const PostTrainingGoal& goal, const PostTrainingOptions& options,
               const fs::path& output)
      : data_(data),
        goal_(goal),
        options_(options),
        output_(output),
        device_(nn::BestDevice()),
        model_(scene::ReadWeights(weights)),
        drawing_(data.vocabulary(), goal.sizes),
        average_(scene::MakeDenoiser(model_.metadata.options, vocabulary().ClassCount())),
        diffusion_(model_.metadata.options, vocabulary().ClassCount()) {
    CheckInput(weights);
    if (model_.metadata.options.text) pieces_.emplace(model_.metadata.text_pieces);
    model_.metadata.vocabulary.entries += options_.more_entries;
    model_.denoiser->to(device_);
    model_.denoiser->train();
    average_->to(device_);
    if (model_.metadata.options.shape_points > 0) average_->SetShapes(model_.denoiser->Shapes());
    options_.trainer.steps = options_.rounds * options_.updates;
    trainer_ = std::make_unique<nn::Trainer>(model_.denoiser.get(), options_.trainer,
                                             output_ / scene::kStateFile);
  }

  PostTrainingReport Run(core::Progress* progress) {
    const int first = trainer_->first_step() / options_.updates;
    if (first > options_.rounds) {
      throw core::Error("the post-training has more rounds already: " + std::to_string(first),
                        output_.string(), "ask for at least as many");
    }
    report_.rounds = ReadRounds(output_ / kRoundsFile, first);
    report_.checkpoints = ReadCheckpoints(output_ / kCheckpointsFile, first);
    scene::SceneStream stream(data_, {0, TrainingScenes(), kBuffer}, options_.seed);
    stream_ = &stream;
    for (int i = 0; i < trainer_->first_step(); ++i) DataTokens();  // those of the earlier run
    progress->Stage("post-training", options_.rounds - first);
    if (report_.checkpoints.empty()) Score(0);
    for (int round = first + 1; round <= options_.rounds; ++round) {
      Round(round);
      const bool last = round == options_.rounds;
      if (round % options_.score_every == 0 || last) Score(round);
      char detail[64];
      std::snprintf(detail, sizeof detail, "reward %.2f", report_.rounds.back().reward);
      progress->Say(detail);
      progress->Advance();
    }
    progress->Finish();
    report_.chosen = ChosenCheckpoint(report_.checkpoints, goal_.largest_accuracy);
    const auto chosen = static_cast<size_t>(report_.chosen);
    core::WriteFile(output_ / scene::kWeightsFile,
                    core::ReadFile(report_.checkpoints[chosen].weights));
    return report_;  // the state stays: more rounds may follow
  }

 private:
  const scene::Vocabulary& vocabulary() const { return model_.metadata.vocabulary; }

  int TrainingScenes() const {
    const int scenes = model_.metadata.training_scenes;
    return scenes > 0 ? std::min(scenes, data_.SceneCount()) : data_.SceneCount();
  }

  void CheckInput(const fs::path& weights) const {
    const scene::Vocabulary &ours = vocabulary(), &theirs = data_.vocabulary();
    if (ours.categories != theirs.categories || ours.welded != theirs.welded) {
      throw core::Error("the data has other categories than the model", weights.string(),
                        "give the dataset that the model was trained on");
    }
    if (theirs.entries > ours.entries) {
      throw core::Error("the data's scenes have more entries than the model's", weights.string());
    }
    if (!goal_.prompts.empty() && !model_.metadata.options.text) {
      throw core::Error("the model reads no prompts", weights.string(), "train one with --text");
    }
    if (!model_.metadata.text_encoder.empty()) {
      throw core::Error("post-training needs a model that reads prompts by itself",
                        weights.string(), "train one with --text, without --text-encoder");
    }
  }

  // Returns the prompts of `count` scenes as pieces; undefined if the model reads none.
  scene::TextInput PromptInput(int count) const {
    if (!model_.metadata.options.text) return {};
    std::vector<std::string> prompts(static_cast<size_t>(count));
    for (size_t i = 0; i < prompts.size() && !goal_.prompts.empty(); ++i) {
      prompts[i] = goal_.prompts[i % goal_.prompts.size()];
    }
    return TextOf(prompts);
  }

  scene::TextInput TextOf(const std::vector<std::string>& prompts) const {
    return scene::PiecesOf(prompts, *pieces_, model_.metadata.options.text_length).To(device_);
  }

  Rollout Sample(scene::Denoiser* denoiser, int count, core::Rng* rng) const {
    const torch::NoGradGuard no_gradient;
    scene::EncodedText text;
    if (model_.metadata.options.text) text = denoiser->EncodeText(PromptInput(count));
    const at::Generator generator = at::detail::createCPUGenerator((*rng)());
    return RollOut(diffusion_, denoiser, count, vocabulary().entries, options_.steps, text, device_,
                   generator);
  }

  SampledScenes Decoded(const Rollout& rollout) const {
    const std::vector<float> tokens = scene::TokensOf(diffusion_.Clean(rollout.states.back()),
                                                      vocabulary(), model_.metadata.range);
    const size_t size =
        static_cast<size_t>(vocabulary().entries) * static_cast<size_t>(vocabulary().TokenWidth());
    SampledScenes scenes;
    for (size_t i = 0; i < tokens.size(); i += size) {
      for (size_t k = i; k < i + size; ++k) {
        if (!std::isfinite(tokens[k]))
          throw core::Error(
              "the model has sampled a number that is "
              "not finite",
              output_.string(), "use an earlier checkpoint");
      }
      scenes.push_back(scene::DecodeScene(&tokens[i], vocabulary()));
    }
    return scenes;
  }

  std::vector<double> RewardsOf(const SampledScenes& scenes) {
    const core::ScopedTimer watch(&report_.reward_seconds);
    std::vector<double> rewards = goal_.rewards(scenes);
    if (rewards.size() != scenes.size()) throw core::Error("there must be a reward for each scene");
    return rewards;
  }

  void Round(int round) {
    core::CheckCancelled();
    core::Rng rng = core::StreamRng(options_.seed, static_cast<std::uint64_t>(round));
    Rollout rollout;
    SampledScenes scenes;
    {
      const core::ScopedTimer watch(&report_.sampling_seconds);
      rollout = Sample(model_.denoiser.get(), options_.scenes, &rng);
      scenes = Decoded(rollout);
    }
    const std::vector<double> rewards = RewardsOf(scenes);
    RoundRecord record = RecordOf(round, scenes, rewards);
    const int groups = std::max(1, static_cast<int>(goal_.prompts.size()));
    const core::ScopedTimer watch(&report_.update_seconds);
    Update(rollout, Advantages(rewards, groups), &rng, &record);
    report_.rounds.push_back(record);
  }

  static RoundRecord RecordOf(int round, const SampledScenes& scenes,
                              const std::vector<double>& rewards) {
    RoundRecord record;
    record.round = round;
    const auto count = static_cast<double>(scenes.size());
    record.reward = std::accumulate(rewards.begin(), rewards.end(), 0.0) / count;
    record.least = *std::min_element(rewards.begin(), rewards.end());
    record.largest = *std::max_element(rewards.begin(), rewards.end());
    for (const auto& one : scenes) {
      record.objects += static_cast<double>(one.size()) / count;
      record.most_objects = std::max(record.most_objects, static_cast<int>(one.size()));
    }
    return record;
  }

  // Returns the next scenes of the data, padded to the model's entries.
  std::vector<float> DataTokens() {
    const auto from = static_cast<size_t>(data_.vocabulary().entries);
    const auto to = static_cast<size_t>(vocabulary().entries);
    const auto width = static_cast<size_t>(vocabulary().TokenWidth());
    const auto count = static_cast<size_t>(options_.data_batch);
    std::vector<float> tokens(count * from * width), padded(count * to * width, 0.0f);
    stream_->Next(options_.data_batch, tokens.data());
    for (size_t i = 0; i < count; ++i) {
      const auto begin = tokens.begin() + static_cast<std::ptrdiff_t>(i * from * width);
      std::copy(begin, begin + static_cast<std::ptrdiff_t>(from * width),
                padded.begin() + static_cast<std::ptrdiff_t>(i * to * width));
      for (size_t k = from; k < to; ++k) padded[(i * to + k + 1) * width - 1] = 1.0f;
    }
    return padded;
  }

  scene::DenoisingBatch DataBatch(core::Rng* rng) {
    const std::vector<float> tokens = DataTokens();
    scene::CleanScenes clean = scene::TensorsOf(tokens, vocabulary(), model_.metadata.range);
    clean.poses = clean.poses.to(device_);
    clean.classes = clean.classes.to(device_);
    const at::Generator generator = at::detail::createCPUGenerator((*rng)());
    scene::DenoisingBatch batch = diffusion_.AddNoise(clean, generator);
    if (!model_.metadata.options.text) return batch;
    std::vector<std::string> prompts(static_cast<size_t>(options_.data_batch));
    const size_t size = tokens.size() / prompts.size();
    for (size_t i = 0; i < prompts.size(); ++i) {
      if (core::Uniform(*rng) < kPromptDropout) continue;
      prompts[i] = drawing_.Draw(&tokens[i * size], *rng).Text();
    }
    batch.text = TextOf(prompts);
    return batch;
  }

  // Takes the updates of a round, each along the gradient of other steps of the rollout.
  void Update(const Rollout& rollout, const std::vector<double>& advantages, core::Rng* rng,
              RoundRecord* record) {
    std::vector<float> single(advantages.begin(), advantages.end());
    const torch::Tensor advantage = torch::tensor(single).to(device_);
    // The last step of a continuous model is certain.
    const int uncertain = rollout.Steps() - (model_.metadata.options.continuous ? 1 : 0);
    std::vector<int> order(static_cast<size_t>(uncertain));
    std::iota(order.begin(), order.end(), 0);
    for (int i = 0; i < options_.updates; ++i) {
      core::Shuffle(&order, *rng);
      const std::vector<int> steps(order.begin(), order.begin() + options_.gradient_steps);
      const scene::DenoisingBatch data = DataBatch(rng);
      const scene::TextInput text = PromptInput(options_.scenes);
      const int shares = nn::ShareCount(device_, options_.scenes);
      std::vector<double> ratios(static_cast<size_t>(shares)), losses(ratios.size());
      const int step = (record->round - 1) * options_.updates + i;
      const double total = trainer_->Step(step, shares, [&](int share) {
        const auto at = static_cast<size_t>(share);
        return DataTerm(data, nn::ShareOf(options_.data_batch, shares, share), &losses[at]) +
               PolicyTerm(rollout, steps, advantage, text,
                          nn::ShareOf(options_.scenes, shares, share), &ratios[at]);
      });
      record->ratio = std::accumulate(ratios.begin(), ratios.end(), 0.0);
      record->data_loss += std::accumulate(losses.begin(), losses.end(), 0.0) / options_.updates;
      CountBad(total, record->round);
    }
  }

  void CountBad(double total, int round) {
    bad_ = std::isfinite(total) ? 0 : bad_ + 1;
    if (bad_ < kBadUpdatesInARow) return;
    throw core::Error(
        "post-training has diverged: the loss is not a number in round " + std::to_string(round),
        output_.string(), "the checkpoints so far are kept; resume with --resume and a lower rate");
  }

  // Returns a share's part of the loss on data.
  torch::Tensor DataTerm(const scene::DenoisingBatch& data, const nn::Share& share, double* loss) {
    if (share.count == 0 || options_.data_weight == 0.0) return torch::zeros({}, device_);
    const torch::Tensor all =
        diffusion_.Loss(model_.denoiser.get(), data.Part(share.first, share.count)).total *
        (static_cast<double>(share.count) / options_.data_batch);
    *loss = all.item<double>();
    return options_.data_weight * all;
  }

  // Returns a share's part of the policy's loss.
  torch::Tensor PolicyTerm(const Rollout& rollout, const std::vector<int>& steps,
                           const torch::Tensor& advantage, const scene::TextInput& text,
                           const nn::Share& share, double* ratio_sum) {
    torch::Tensor sum = torch::zeros({}, device_);
    if (share.count == 0) return sum;
    scene::EncodedText encoded;
    if (text.IsDefined()) {
      encoded = model_.denoiser->EncodeText(text.Part(share.first, share.count));
    }
    const torch::Tensor a = advantage.narrow(0, share.first, share.count);
    for (const int step : steps) {
      const torch::Tensor log_probability = StepLogProbability(
          diffusion_, model_.denoiser.get(), rollout, step, share.first, share.count, encoded);
      const torch::Tensor before =
          rollout.log_probabilities[static_cast<size_t>(step)].narrow(0, share.first, share.count);
      const torch::Tensor ratio =
          torch::exp((log_probability - before) / static_cast<double>(vocabulary().entries));
      const torch::Tensor gain =
          torch::minimum(a * ratio, a * ratio.clamp(1.0 - options_.clip, 1.0 + options_.clip));
      sum = sum - gain.sum();
      *ratio_sum += (ratio.detach() - 1.0).abs().sum().item<double>();
    }
    const double count = static_cast<double>(options_.scenes) * static_cast<double>(steps.size());
    *ratio_sum /= count;
    return sum / count;
  }

  // Scores the averaged weights, and writes them with all records.
  void Score(int round) {
    const core::ScopedTimer watch(&report_.scoring_seconds);
    trainer_->CopyAverageTo(average_.get());
    if (round == 0) CopyParameters(*model_.denoiser, average_.get());
    average_->eval();
    core::Rng rng = core::StreamRng(options_.seed, kScoringStream);
    SampledScenes scenes;
    for (int done = 0; done < options_.scored_scenes; done += options_.scenes) {
      core::CheckCancelled();
      for (auto& one : Decoded(Sample(average_.get(), options_.scenes, &rng))) {
        scenes.push_back(std::move(one));
      }
    }
    Checkpoint checkpoint;
    checkpoint.round = round;
    const std::vector<double> rewards = goal_.rewards(scenes);
    checkpoint.score.reward =
        std::accumulate(rewards.begin(), rewards.end(), 0.0) / static_cast<double>(rewards.size());
    checkpoint.score.accuracy = goal_.accuracy(scenes);
    checkpoint.weights = output_ / CheckpointName(round);
    scene::WriteWeights(*average_, model_.metadata, checkpoint.weights);
    report_.checkpoints.push_back(checkpoint);
    core::WriteFile(output_ / kRoundsFile, RoundsText(report_.rounds));
    core::WriteFile(output_ / kCheckpointsFile, CheckpointsText(report_.checkpoints));
    if (round > 0) trainer_->SaveState(round * options_.updates);
  }

  static void CopyParameters(const scene::Denoiser& from, scene::Denoiser* to) {
    const torch::NoGradGuard no_gradient;
    const auto source = from.named_parameters();
    for (auto& one : to->named_parameters()) one.value().copy_(source[one.key()]);
  }

  const scene::SceneDataset& data_;
  const PostTrainingGoal& goal_;
  PostTrainingOptions options_;
  fs::path output_;
  torch::Device device_;
  scene::ReadModel model_;
  std::optional<scene::WordPieces> pieces_;  // of a model that reads prompts
  scene::PromptDrawing drawing_;
  std::shared_ptr<scene::Denoiser> average_;
  scene::SceneDiffusion diffusion_;
  std::unique_ptr<nn::Trainer> trainer_;
  scene::SceneStream* stream_ = nullptr;
  PostTrainingReport report_;
  int bad_ = 0;
};

}  // namespace

int ChosenCheckpoint(const std::vector<Checkpoint>& checkpoints, double largest_accuracy) {
  if (checkpoints.empty()) throw core::Error("there is no checkpoint to choose");
  const auto better = [&](const Checkpoint& a, const Checkpoint& b) {
    const bool good_a = a.score.accuracy <= largest_accuracy;
    const bool good_b = b.score.accuracy <= largest_accuracy;
    if (good_a != good_b) return good_a;
    return good_a ? a.score.reward > b.score.reward : a.score.accuracy < b.score.accuracy;
  };
  size_t best = 0;
  for (size_t i = 1; i < checkpoints.size(); ++i) {
    if (better(checkpoints[i], checkpoints[best])) best = i;
  }
  return static_cast<int>(best);
}

PostTrainingReport PostTrain(const fs::path& weights, const scene::SceneDataset& data,
                             const PostTrainingGoal& goal, const PostTrainingOptions& options,
                             const fs::path& output, core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("post-training: " + error);
  if (!goal.rewards || !goal.accuracy) throw core::Error("post-training needs a goal");
  nn::PrepareForWork();
  fs::create_directories(output);
  return PostTraining(weights, data, goal, options, output).Run(progress);
}

}  // namespace simwright::steering
