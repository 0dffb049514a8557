#include "scene/model/training.h"

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "nn/compute.h"
#include "nn/mixed_precision.h"
#include "nn/trainer.h"
#include "scene/dataset/scene_stream.h"
#include "scene/model/token_tensors.h"
#include "scene/model/training_prompts.h"
#include "scene/model/weights_file.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

constexpr int kBadInARow = 20;     // most consecutive losses that are not finite
constexpr int kHeldOutBatch = 64;  // scenes, in one batch

int HeldOut(int scenes, const SceneTrainingOptions& options) {
  const int share = static_cast<int>(options.held_out * scenes);
  return std::min(share, options.held_out_most);
}

// The sums of the losses since the last line.
class LossMeans {
 public:
  // Adds the losses of the shares of a batch.
  void Add(const std::vector<SceneLoss>& losses, const std::vector<double>& shares) {
    for (size_t i = 0; i < losses.size(); ++i) {
      sums_.total += shares[i] * losses[i].total.item<double>();
      sums_.translation += shares[i] * losses[i].translation.item<double>();
      sums_.rotation += shares[i] * losses[i].rotation.item<double>();
      sums_.classes += shares[i] * losses[i].divergence.item<double>();
      sums_.cross_entropy += shares[i] * losses[i].cross_entropy.item<double>();
    }
    ++count_;
  }
  LossRecord Take(int step) {
    LossRecord mean = sums_;
    mean.step = step;
    for (double* const one :
         {&mean.total, &mean.translation, &mean.rotation, &mean.classes, &mean.cross_entropy}) {
      *one = count_ > 0 ? *one / count_ : NAN;
    }
    sums_ = {};
    count_ = 0;
    return mean;
  }

 private:
  LossRecord sums_;
  int count_ = 0;
};

class Training {
 public:
  Training(const SceneDataset& dataset, const SceneModelOptions& model,
           const SceneTrainingOptions& options, const fs::path& output)
      : dataset_(dataset),
        options_(options),
        output_(output),
        device_(nn::BestDevice()),
        held_out_(HeldOut(dataset.SceneCount(), options)),
        training_(dataset.SceneCount() - held_out_),
        metadata_{dataset.vocabulary(), model, PoseRange::Of(dataset, 0, training_)},
        diffusion_(model, dataset.vocabulary().ClassCount()) {
    metadata_.training_scenes = training_;
    metadata_.data_seed = dataset.parts().front().origin().seed;
    if (model.text) ReadPrompts();
    torch::manual_seed(options.seed);  // for the initial weights
    denoiser_ = MakeDenoiser(metadata_.options, dataset.vocabulary().ClassCount());
    metadata_.parameters = ParameterCount(*denoiser_);
    denoiser_->to(device_);
    average_ = MakeDenoiser(metadata_.options, dataset.vocabulary().ClassCount());
    average_->to(device_);
    if (model.shape_points > 0) {
      denoiser_->SetShapes(options.shapes);
      average_->SetShapes(options.shapes);
    }
    trainer_ = std::make_unique<nn::Trainer>(denoiser_.get(), options.trainer, output / kStateFile);
  }

  SceneTrainingReport Run(core::Progress* progress) {
    const auto start = std::chrono::steady_clock::now();
    const int first = trainer_->first_step();
    losses_ = ReadLosses(output_ / kLossesFile, first);
    SceneStream stream(dataset_, {0, training_, options_.buffer}, options_.seed + first);
    core::Rng rng = core::StreamRng(options_.seed, static_cast<std::uint64_t>(first) + 1);
    const at::Generator generator = at::detail::createCPUGenerator(rng());
    std::vector<float> tokens(static_cast<size_t>(options_.batch) *
                              static_cast<size_t>(dataset_.vocabulary().entries) *
                              static_cast<size_t>(dataset_.vocabulary().TokenWidth()));
    progress->Stage("training", options_.trainer.steps - first);
    for (int step = first; step < options_.trainer.steps; ++step) {
      stream.Next(options_.batch, tokens.data());
      TextInput text;
      if (prompts_) text = prompts_->Draw(tokens, metadata_.options.text_length, rng);
      Step(step, OnDevice(TensorsOf(tokens, dataset_.vocabulary(), metadata_.range)),
           text.To(device_), generator);
      const bool last = step + 1 == options_.trainer.steps;
      if ((step + 1) % options_.report_every == 0 || last) Record(step + 1);
      if (trainer_->SaveDue(step)) Save(step + 1);
      progress->Advance();
    }
    progress->Finish();
    SceneTrainingReport report;
    report.weights = output_ / kWeightsFile;
    report.parameters = metadata_.parameters;
    report.training_scenes = training_;
    report.held_out_scenes = held_out_;
    report.losses = losses_;
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
  }

 private:
  CleanScenes OnDevice(const CleanScenes& scenes) const {
    return {scenes.poses.to(device_), scenes.classes.to(device_)};
  }

  void ReadPrompts() {
    prompts_ = std::make_unique<TrainingPrompts>(dataset_, training_, options_);
    prompts_->Complete(&metadata_.options);
    metadata_.text_pieces = prompts_->pieces().pieces();
    if (prompts_->encoder() != nullptr) metadata_.text_encoder = prompts_->encoder()->hash();
  }

  void Step(int step, const CleanScenes& scenes, const TextInput& text,
            const at::Generator& generator) {
    DenoisingBatch batch = diffusion_.AddNoise(scenes, generator);
    batch.text = text;
    const std::int64_t count = scenes.poses.size(0);
    const int share_count = nn::ShareCount(device_, count);
    // The padding of prompts takes as long as prompts. On a CPU each share is therefore a part of
    // short prompts and one of long ones.
    const bool sorts = text.IsDefined() && !device_.is_cuda() && count >= 2 * share_count;
    if (sorts) batch = batch.SortedByPromptLength();
    const int parts = sorts ? 2 * share_count : share_count;
    std::vector<SceneLoss> losses(static_cast<size_t>(parts));
    std::vector<double> shares(losses.size());
    const auto loss_of = [&](int part) {
      const size_t at = static_cast<size_t>(part);
      const nn::Share share = nn::ShareOf(count, parts, part);
      shares[at] = static_cast<double>(share.count) / static_cast<double>(count);
      // On a GPU only; half-precision products speed up an update on a CPU with AMX by a tenth
      // only.
      const nn::MixedPrecision half(device_, options_.bfloat16_on_gpu && device_.is_cuda());
      losses[at] = diffusion_.Loss(denoiser_.get(), batch.Part(share.first, share.count));
      return shares[at] * losses[at].total;
    };
    const double total = trainer_->Step(step, share_count, [&](int i) {
      return sorts ? loss_of(i) + loss_of(parts - 1 - i) : loss_of(i);
    });
    if (std::isfinite(total)) {
      means_.Add(losses, shares);
      bad_ = 0;
      return;
    }
    if (++bad_ < kBadInARow) return;
    throw core::Error(
        "the training has diverged: the loss is not a number at step " + std::to_string(step),
        output_.string(),
        "the last good state is kept; resume from it with --resume and a lower rate");
  }

  // Returns the loss of the averaged weights on held-out scenes, at the same times and noise in
  // every call.
  double HeldOutLoss() {
    if (held_out_ == 0) return NAN;
    const torch::NoGradGuard no_gradient;
    trainer_->CopyAverageTo(average_.get());
    const std::vector<float> tokens = dataset_.Read(training_, std::min(held_out_, kHeldOutBatch));
    core::Rng rng = core::StreamRng(options_.seed, 0);
    const at::Generator generator = at::detail::createCPUGenerator(rng());
    DenoisingBatch batch = diffusion_.AddNoise(
        OnDevice(TensorsOf(tokens, dataset_.vocabulary(), metadata_.range)), generator);
    if (prompts_) {
      batch.text = prompts_->Draw(tokens, metadata_.options.text_length, rng).To(device_);
    }
    return diffusion_.Loss(average_.get(), batch).total.item<double>();
  }

  void Record(int step) {
    LossRecord record = means_.Take(step);
    record.held_out = HeldOutLoss();
    losses_.push_back(record);
  }

  void Save(int step) {
    trainer_->SaveState(step);
    trainer_->CopyAverageTo(average_.get());
    metadata_.steps = step;
    WriteWeights(*average_, metadata_, output_ / kWeightsFile);
    core::WriteFile(output_ / kLossesFile, LossesText(losses_));
    core::WriteFile(output_ / kLossCurvesFile, LossCurves(metadata_.vocabulary.type, losses_));
  }

  const SceneDataset& dataset_;
  SceneTrainingOptions options_;
  fs::path output_;
  torch::Device device_;
  int held_out_, training_;
  SceneModelMetadata metadata_;
  SceneDiffusion diffusion_;
  std::unique_ptr<TrainingPrompts> prompts_;  // null: the model reads none
  std::shared_ptr<Denoiser> denoiser_, average_;
  std::unique_ptr<nn::Trainer> trainer_;
  LossMeans means_;
  std::vector<LossRecord> losses_;
  int bad_ = 0;
};

}  // namespace

SceneTrainingOptions::SceneTrainingOptions() {
  trainer.steps = 10000;
  trainer.learning_rate = 1e-3;
  trainer.weight_decay = 1e-3;
  trainer.ema_decay = 0.999;
  trainer.warm_share = 0.02;
  trainer.save_every = 500;
}

bool SceneTrainingOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (!trainer.IsValid(error)) return false;
  if (batch < 1) return fails("batch must be at least 1");
  if (!(held_out >= 0.0 && held_out < 1.0)) return fails("held_out must be a share below 1");
  if (held_out_most < 0) return fails("held_out_most must be at least 0");
  if (!(prompt_dropout >= 0.0 && prompt_dropout <= 1.0)) {
    return fails("prompt_dropout must be 0 to 1");
  }
  if (text_pieces < 64) return fails("text_pieces must be at least 64");
  if (buffer < 1) return fails("buffer must be at least 1");
  if (report_every < 1) return fails("report_every must be at least 1");
  return true;
}

SceneTrainingReport TrainSceneModel(const SceneDataset& dataset, const SceneModelOptions& model,
                                    const SceneTrainingOptions& options, const fs::path& output,
                                    core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("training: " + error);
  if (dataset.SceneCount() < 2) {
    throw core::Error("a model needs at least 2 training scenes",
                      std::to_string(dataset.SceneCount()) + " are there");
  }
  if (model.shape_points > 0 &&
      !options.shapes.IsValid(dataset.vocabulary(), model.shape_points, &error)) {
    throw core::Error("training by shape: " + error);
  }
  nn::PrepareForWork();
  fs::create_directories(output);
  return Training(dataset, model, options, output).Run(progress);
}

}  // namespace simwright::scene
