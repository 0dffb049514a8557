#include "scene/model/training.h"

#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "nn/captured_work.h"
#include "nn/compute.h"
#include "nn/mixed_precision.h"
#include "nn/noise.h"
#include "nn/prefetcher.h"
#include "nn/trainer.h"
#include "scene/model/loss_means.h"
#include "scene/model/training_data.h"
#include "scene/model/training_prompts.h"
#include "scene/model/weights_file.h"

namespace simwright::scene {
namespace fs = std::filesystem;
namespace {

constexpr int kBadInARow = 20;     // most consecutive losses that are not finite
constexpr int kHeldOutBatch = 64;  // scenes, in one batch
constexpr int kTypesPerUpdate = 2;

class Training {
 public:
  Training(const std::vector<const SceneDataset*>& datasets, const SceneModelOptions& model,
           const SceneTrainingOptions& options, const fs::path& output)
      : data_(datasets, options),
        options_(options),
        output_(output),
        device_(nn::BestDevice()),
        metadata_{{}, model, data_.types().front().range},
        diffusion_(model, ClassCount()),
        losses_stay_(options.losses_on_device.value_or(device_.is_cuda())) {
    data_.Describe(&metadata_);
    if (!metadata_.types.empty() && !model.text) {
      throw core::Error("a model of several scene types reads the type in its prompts", "",
                        "train with --text");
    }
    if (model.text) ReadPrompts();
    torch::manual_seed(options.seed);  // for the initial weights
    denoiser_ = MakeDenoiser(metadata_.options, ClassCount());
    metadata_.parameters = ParameterCount(*denoiser_);
    denoiser_->to(device_);
    average_ = MakeDenoiser(metadata_.options, ClassCount());
    average_->to(device_);
    if (model.shape_points > 0) {
      denoiser_->SetShapes(options.shapes);
      average_->SetShapes(options.shapes);
    }
    trainer_ = std::make_unique<nn::Trainer>(denoiser_.get(), options.trainer, output / kStateFile);
    if (options.cuda_graph) CaptureUpdates();
  }

  SceneTrainingReport Run(core::Progress* progress) {
    const auto start = std::chrono::steady_clock::now();
    const int first = trainer_->first_step();
    losses_ = ReadLosses(output_ / kLossesFile, first);
    data_.Start(options_.seed + first, options_.buffer);
    core::Rng rng = core::StreamRng(options_.seed, static_cast<std::uint64_t>(first) + 1);
    const at::Generator generator = nn::SeededGenerator(rng(), device_, options_.noise_on_device);
    MakeHeldOutBatches();
    progress->Stage("training", options_.trainer.steps - first);
    // From here on only the thread of the batches touches `data_`'s streams, `rng` and `generator`.
    nn::Prefetcher<std::vector<DenoisingBatch>> batches(
        options_.prefetch.value_or(device_.is_cuda()), first, options_.trainer.steps,
        [&](int step) { return Batches(step, &rng, generator); });
    for (int step = first; step < options_.trainer.steps; ++step) {
      if (captured_) {
        StepCaptured(step, batches.Next());
      } else if (losses_stay_) {
        StepOnDevice(step, batches.Next());
      } else {
        Step(step, batches.Next());
      }
      const bool last = step + 1 == options_.trainer.steps;
      if ((step + 1) % options_.report_every == 0 || last) Record(step + 1);
      if (trainer_->SaveDue(step)) Save(step + 1);
      progress->Advance();
    }
    // Errors of kernels that are still running are reported here, not while the program ends.
    if (device_.is_cuda()) torch::cuda::synchronize();
    progress->Finish();
    SceneTrainingReport report;
    report.weights = output_ / kWeightsFile;
    report.parameters = metadata_.parameters;
    report.training_scenes = data_.training();
    report.held_out_scenes = data_.held_out();
    report.losses = losses_;
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return report;
  }

 private:
  CleanScenes OnDevice(const CleanScenes& scenes) const {
    return {scenes.poses.to(device_), scenes.classes.to(device_)};
  }

  int ClassCount() const { return data_.ClassCount(); }

  void ReadPrompts() {
    prompts_ = std::make_unique<TrainingPrompts>(data_, options_);
    prompts_->Complete(&metadata_.options);
    metadata_.text_pieces = prompts_->pieces().pieces();
    if (prompts_->encoder() != nullptr) metadata_.text_encoder = prompts_->encoder()->hash();
  }

  DenoisingBatch BatchOf(int type, const std::vector<float>& tokens, core::Rng* rng,
                         const at::Generator& generator) const {
    TextInput text;
    if (prompts_) text = prompts_->Draw(type, tokens, metadata_.options.text_length, *rng);
    DenoisingBatch batch = diffusion_.AddNoise(OnDevice(data_.Tensors(type, tokens)), generator);
    batch.text = text.To(device_);
    return batch;
  }

  // Returns the batches of an update: one, or one of each of several types, which take turns.
  std::vector<DenoisingBatch> Batches(int step, core::Rng* rng, const at::Generator& generator) {
    const int types = static_cast<int>(data_.types().size());
    const int some = std::min({types, kTypesPerUpdate, options_.batch});
    std::vector<DenoisingBatch> batches;
    for (int i = 0; i < some; ++i) {
      const int type = static_cast<int>((static_cast<std::int64_t>(step) * some + i) % types);
      const auto count = static_cast<int>(nn::ShareOf(options_.batch, some, i).count);
      batches.push_back(BatchOf(type, data_.Next(type, count), rng, generator));
    }
    return batches;
  }

  // The padding of prompts takes as long as prompts. On a CPU each share is therefore a part of
  // short prompts and one of long ones.
  void Step(int step, std::vector<DenoisingBatch> batches) {
    const int shares = nn::ShareCount(device_, batches.front().clean.poses.size(0));
    const bool sorts = prompts_ != nullptr && !device_.is_cuda();
    const int parts = sorts ? 2 * shares : shares;
    if (sorts) {
      for (DenoisingBatch& one : batches) one = one.SortedByPromptLength();
    }
    std::vector<SceneLoss> losses(batches.size() * static_cast<size_t>(parts));
    std::vector<double> weights(losses.size(), 0.0);
    const auto loss_of = [&](size_t batch, int part) {
      const size_t at = batch * static_cast<size_t>(parts) + static_cast<size_t>(part);
      const nn::Share share = nn::ShareOf(batches[batch].clean.poses.size(0), parts, part);
      if (share.count == 0) return torch::zeros({}, device_);
      weights[at] = static_cast<double>(share.count) / options_.batch;
      // On a GPU only; half-precision products speed up an update on a CPU with AMX by a tenth
      // only.
      const nn::MixedPrecision half(device_, options_.bfloat16_on_gpu && device_.is_cuda());
      losses[at] = diffusion_.Loss(denoiser_.get(), batches[batch].Part(share.first, share.count));
      return weights[at] * losses[at].total;
    };
    const double total = trainer_->Step(step, shares, [&](int i) {
      torch::Tensor sum;
      for (size_t batch = 0; batch < batches.size(); ++batch) {
        const torch::Tensor one = loss_of(batch, i);
        sum = sum.defined() ? sum + one : one;
        if (sorts) sum = sum + loss_of(batch, parts - 1 - i);
      }
      return sum;
    });
    if (std::isfinite(total)) means_.Add(losses, weights);
    RequireConvergence(step);
  }

  SceneLoss WholeLoss(const DenoisingBatch& batch) const {
    const nn::MixedPrecision half(device_, options_.bfloat16_on_gpu && device_.is_cuda());
    return diffusion_.Loss(denoiser_.get(), batch);
  }

  // Makes the update of the batch `captured_batch_`, whose terms it puts into `captured_terms_`.
  void CaptureUpdates() {
    if (prompts_ || data_.types().size() > 1) {
      throw core::Error("a CUDA graph needs batches of one shape", "--cuda-graph",
                        "leave it out for models that read prompts");
    }
    const bool can = nn::CapturedWork::IsAvailable(device_) && trainer_->IsFused();
    if (!can && !losses_stay_) return;  // on a CPU updates remain as they are
    losses_stay_ = true;
    captured_ = std::make_unique<nn::CapturedWork>(can ? device_ : torch::kCPU, [this] {
      const SceneLoss loss = WholeLoss(captured_batch_);
      trainer_->Update(loss.total);
      captured_terms_ = TermsOf(loss);
    });
  }

  // Returns true if the losses of the last updates are read from the device after `step`.
  bool IsTimeToLook(int step) const {
    return (step + 1) % kBadInARow == 0 || step + 1 == options_.trainer.steps;
  }

  void StepCaptured(int step, const std::vector<DenoisingBatch>& batches) {
    captured_batch_.CopyFrom(batches.front());
    trainer_->SetStep(step);
    captured_->Run();
    means_.AddOnDevice(captured_terms_);
    if (IsTimeToLook(step)) RequireConvergence(step);
  }

  // The same as Step with each batch as a whole and without reading its losses back.
  void StepOnDevice(int step, const std::vector<DenoisingBatch>& batches) {
    torch::Tensor total, terms;
    for (const DenoisingBatch& batch : batches) {
      const double share = static_cast<double>(batch.clean.poses.size(0)) / options_.batch;
      const SceneLoss loss = WholeLoss(batch);
      total = total.defined() ? total + share * loss.total : share * loss.total;
      terms = terms.defined() ? terms + share * TermsOf(loss) : share * TermsOf(loss);
    }
    trainer_->Step(step, total);
    means_.AddOnDevice(terms);
    if (IsTimeToLook(step)) RequireConvergence(step);
  }

  void RequireConvergence(int step) const {
    if (trainer_->SkippedInARow() < kBadInARow) return;
    throw core::Error(
        "the training has diverged: the loss is not a number at step " + std::to_string(step),
        output_.string(),
        "the last good state is kept; resume from it with --resume and a lower rate");
  }

  // Makes the batches of held-out scenes, one for each type, whose times and noise stay the same.
  // None where a type has no held-out scenes.
  void MakeHeldOutBatches() {
    held_out_.clear();
    const torch::NoGradGuard no_gradient;
    core::Rng rng = core::StreamRng(options_.seed, 0);
    const at::Generator generator = nn::SeededGenerator(rng(), device_, /*on_device=*/false);
    const int types = static_cast<int>(data_.types().size());
    for (int i = 0; i < types; ++i) {
      const TrainingType& type = data_.types()[static_cast<size_t>(i)];
      const int count = std::min(type.held_out, std::max(1, kHeldOutBatch / types));
      if (count == 0) return held_out_.clear();
      const std::vector<float> tokens = type.dataset->Read(type.training, count);
      held_out_.push_back(BatchOf(i, tokens, &rng, generator));
    }
  }

  // Returns the loss of the averaged weights on held-out scenes; the mean over the types.
  double HeldOutLoss() {
    if (held_out_.empty()) return NAN;
    const torch::NoGradGuard no_gradient;
    trainer_->CopyAverageTo(average_.get());
    double sum = 0.0;
    for (const DenoisingBatch& batch : held_out_) {
      sum += diffusion_.Loss(average_.get(), batch).total.item<double>();
    }
    return sum / static_cast<double>(held_out_.size());
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

  TrainingData data_;
  SceneTrainingOptions options_;
  fs::path output_;
  torch::Device device_;
  SceneModelMetadata metadata_;
  SceneDiffusion diffusion_;
  std::unique_ptr<TrainingPrompts> prompts_;  // null: the model reads none
  std::shared_ptr<Denoiser> denoiser_, average_;
  std::unique_ptr<nn::Trainer> trainer_;
  std::vector<DenoisingBatch> held_out_;
  LossMeans means_;
  std::vector<LossRecord> losses_;
  bool losses_stay_;  // on the device until a line of the log
  DenoisingBatch captured_batch_;
  torch::Tensor captured_terms_;
  std::unique_ptr<nn::CapturedWork> captured_;  // null: updates are not captured
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

SceneTrainingReport TrainSceneModel(const std::vector<const SceneDataset*>& datasets,
                                    const SceneModelOptions& model,
                                    const SceneTrainingOptions& options, const fs::path& output,
                                    core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("training: " + error);
  for (const SceneDataset* const dataset : datasets) {
    if (dataset->SceneCount() < 2) {
      throw core::Error("a model needs at least 2 training scenes",
                        std::to_string(dataset->SceneCount()) + " are there");
    }
    if (model.shape_points > 0 &&
        !options.shapes.IsValid(dataset->vocabulary(), model.shape_points, &error)) {
      throw core::Error("training by shape: " + error);
    }
  }
  if (model.shape_points > 0 && datasets.size() > 1) {
    throw core::Error("training by shape takes one dataset");
  }
  nn::PrepareForWork();
  fs::create_directories(output);
  return Training(datasets, model, options, output).Run(progress);
}

SceneTrainingReport TrainSceneModel(const SceneDataset& dataset, const SceneModelOptions& model,
                                    const SceneTrainingOptions& options, const fs::path& output,
                                    core::Progress* progress) {
  return TrainSceneModel(std::vector<const SceneDataset*>{&dataset}, model, options, output,
                         progress);
}

}  // namespace simwright::scene
