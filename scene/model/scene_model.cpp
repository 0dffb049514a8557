#include "scene/model/scene_model.h"

#include <algorithm>
#include <optional>

#include "core/error.h"
#include "core/random.h"
#include "nn/compute.h"
#include "nn/noise.h"
#include "scene/model/inpainting.h"
#include "scene/model/limited_classes.h"
#include "scene/model/prompt_encoder.h"
#include "scene/model/scene_diffusion.h"
#include "scene/model/token_tensors.h"
#include "scene/model/weights_file.h"
#include "scene/prompt/scene_type_words.h"

namespace simwright::scene {

struct SceneModel::Network {
  SceneModelMetadata metadata;
  std::shared_ptr<Denoiser> denoiser;
  torch::Device device;
  std::unique_ptr<ExternalTextEncoder> text_encoder;  // null: the denoiser's own

  // Returns prompts in the form that the denoiser attends to.
  EncodedText Encode(std::vector<std::string> prompts) const {
    if (!metadata.types.empty()) {
      for (std::string& one : prompts) one = PromptOfSceneType(one, metadata.vocabulary.type);
    }
    const WordPieces pieces(metadata.text_pieces);
    return denoiser->EncodeText(
        TextInputOf(prompts, pieces, metadata.options.text_length, text_encoder.get()).To(device));
  }
  // Returns the prompts of scenes first .. first + count - 1.
  EncodedText EncodePrompts(const SampleOptions& sampling, int first, int count) const {
    std::vector<std::string> prompts(static_cast<size_t>(count));
    for (size_t i = 0; i < prompts.size() && !sampling.prompts.empty(); ++i) {
      prompts[i] = sampling.prompts[(static_cast<size_t>(first) + i) % sampling.prompts.size()];
    }
    return Encode(prompts);
  }

  // Returns the limits of scenes first .. first + count - 1; nothing if there are none.
  std::optional<LimitedClasses> LimitsOf(const SampleOptions& sampling, int first,
                                         int count) const {
    if (sampling.limits.empty()) return std::nullopt;
    std::vector<std::vector<ClassLimit>> limits;
    for (int i = first; i < first + count; ++i) {
      limits.push_back(sampling.limits[static_cast<size_t>(i) % sampling.limits.size()]);
    }
    return LimitedClasses(std::move(limits), metadata.vocabulary.ClassCount());
  }

  // Inpaints scenes first .. first + some - 1 as one batch.
  std::vector<float> InpaintBatch(const std::vector<float>& given, const InpaintingMask& mask,
                                  const SampleOptions& options, int first, int some) const;
  std::vector<float> InpaintOneByOne(const std::vector<float>& given, const InpaintingMask& mask,
                                     const SampleOptions& options, int count,
                                     core::Progress* progress) const;
};

std::vector<float> SceneModel::Network::InpaintBatch(const std::vector<float>& given,
                                                     const InpaintingMask& mask,
                                                     const SampleOptions& options, int first,
                                                     int some) const {
  StepOptions step;
  step.eta = options.eta;
  if (!options.prompts.empty() && options.guidance > 0.0) {
    step.guidance = {options.guidance, Encode({""})};
  }
  const SceneDiffusion diffusion(metadata.options, metadata.vocabulary.ClassCount());
  std::vector<int> times =
      diffusion.Times(options.steps == 0 ? metadata.options.diffusion_steps : options.steps);
  times.push_back(-1);
  // Each batch samples from its own stream: sampling more scenes does not change the first ones.
  core::Rng rng = core::StreamRng(options.seed, static_cast<std::uint64_t>(first));
  const bool on_device = options.noise_on_device;
  const at::Generator generator = nn::SeededGenerator(rng(), device, on_device);
  const at::Generator clamp_generator = nn::SeededGenerator(rng(), device, on_device);
  const KeptTokens kept(given, mask, first, some, metadata.vocabulary, metadata.range, device);
  NoisyScenes scenes = diffusion.Noise(some, metadata.vocabulary.entries, generator);
  scenes.poses = scenes.poses.to(device);
  scenes.classes = scenes.classes.to(device);
  if (metadata.options.text) scenes.text = EncodePrompts(options, first, some);
  step.forbidden = kept.forbidden();
  const std::optional<LimitedClasses> limits = LimitsOf(options, first, some);
  step.limits = limits ? &*limits : nullptr;
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    core::CheckCancelled();
    kept.Clamp(diffusion, options.clamping, times[i], clamp_generator, &scenes);
    diffusion.Step(denoiser.get(), times[i], times[i + 1], step, generator, &scenes);
  }
  std::vector<float> tokens =
      TokensOf(diffusion.Clean(scenes, kept.forbidden()), metadata.vocabulary, metadata.range);
  kept.Restore(&tokens);
  return tokens;
}

std::vector<float> SceneModel::Network::InpaintOneByOne(const std::vector<float>& given,
                                                        const InpaintingMask& mask,
                                                        const SampleOptions& options, int count,
                                                        core::Progress* progress) const {
  std::vector<std::vector<float>> parts(static_cast<size_t>(count));
  // A single share would use all threads, and another order of summation.
  nn::ForEachShare(std::max(2, count), [&](int i) {
    if (i >= count) return;
    parts[static_cast<size_t>(i)] = InpaintBatch(given, mask, options, i, 1);
    progress->Advance();
  });
  std::vector<float> tokens;
  for (const std::vector<float>& part : parts) {
    tokens.insert(tokens.end(), part.begin(), part.end());
  }
  return tokens;
}

namespace {

// Loads the external text encoder that a model was trained with; null if it needs none.
std::unique_ptr<ExternalTextEncoder> EncoderOf(const SceneModelMetadata& metadata,
                                               const std::filesystem::path& file) {
  if (metadata.text_encoder.empty()) {
    if (file.empty()) return nullptr;
    throw core::Error("the model reads prompts by itself or not at all", file.string(),
                      "leave the text encoder out");
  }
  if (file.empty()) {
    throw core::Error("the model was trained with an external text encoder", "",
                      "give it: --text-encoder FILE");
  }
  auto encoder = std::make_unique<ExternalTextEncoder>(file);
  if (encoder->hash() != metadata.text_encoder) {
    throw core::Error("the model was trained with another text encoder", file.string());
  }
  return encoder;
}

}  // namespace

SceneModelMetadata ReadSceneModelMetadata(const std::filesystem::path& weights) {
  return ReadWeights(weights).metadata;
}

std::vector<std::string> SceneModelMetadata::TypeNames() const {
  if (types.empty()) return {vocabulary.type};
  std::vector<std::string> names;
  for (const SceneModelType& one : types) names.push_back(one.name);
  return names;
}

SceneModelMetadata SceneModelMetadata::OfType(const std::string& type) const {
  if (types.empty() && type == vocabulary.type) return *this;
  for (const SceneModelType& one : types) {
    if (one.name != type) continue;
    SceneModelMetadata metadata = *this;
    metadata.vocabulary.type = one.name;
    metadata.vocabulary.entries = one.entries;
    metadata.range = one.range;
    metadata.training_scenes = one.training_scenes;
    metadata.data_seed = one.data_seed;
    return metadata;
  }
  std::string names;
  for (const std::string& name : TypeNames()) names += (names.empty() ? "" : ", ") + name;
  throw core::Error("the model does not have this scene type", type, "it has " + names);
}

bool SampleOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (steps < 0) return fails("steps must be at least 1, or 0 for all");
  if (!(eta >= 0.0 && eta <= 1.0)) return fails("eta must be 0 to 1");
  if (batch < 1) return fails("batch must be at least 1");
  if (!(guidance >= 0.0 && guidance <= 100.0)) return fails("guidance must be 0 to 100");
  return true;
}

SceneModel::SceneModel(std::unique_ptr<Network> network) : network_(std::move(network)) {}
SceneModel::~SceneModel() = default;
SceneModel::SceneModel(SceneModel&&) noexcept = default;
SceneModel& SceneModel::operator=(SceneModel&&) noexcept = default;

SceneModel SceneModel::Load(const std::filesystem::path& weights,
                            const std::filesystem::path& text_encoder, const std::string& type) {
  ReadModel model = ReadWeights(weights);
  if (!type.empty()) {
    model.metadata = model.metadata.OfType(type);
  } else if (!model.metadata.types.empty()) {
    throw core::Error("the model has several scene types", weights.string(), "choose one: --type");
  }
  const torch::Device device = nn::BestDevice();
  model.denoiser->to(device);
  std::unique_ptr<ExternalTextEncoder> encoder = EncoderOf(model.metadata, text_encoder);
  return SceneModel(std::make_unique<Network>(
      Network{std::move(model.metadata), std::move(model.denoiser), device, std::move(encoder)}));
}

const SceneModelMetadata& SceneModel::metadata() const {
  return network_->metadata;
}

void SceneModel::AddAsset(const std::string& category,
                          const std::vector<Eigen::Vector3d>& surface) {
  SceneModelMetadata metadata = network_->metadata;
  Vocabulary& vocabulary = metadata.vocabulary;
  AssetShapes shapes = network_->denoiser->Shapes();
  if (vocabulary.ClassOf(category) >= 0)
    throw core::Error("the model has this category already", category);
  const auto at =
      std::lower_bound(vocabulary.categories.begin(), vocabulary.categories.end(), category) -
      vocabulary.categories.begin();
  vocabulary.categories.insert(vocabulary.categories.begin() + at, category);
  vocabulary.welded.insert(vocabulary.welded.begin() + at, false);
  shapes.surfaces.insert(shapes.surfaces.begin() + at, surface);
  std::string error;
  if (!vocabulary.IsValid(&error) ||
      !shapes.IsValid(vocabulary, metadata.options.shape_points, &error)) {
    throw core::Error("an asset for a model of scenes: " + error);
  }
  // No parameter depends on the number of classes.
  std::shared_ptr<Denoiser> wider = MakeDenoiser(metadata.options, vocabulary.ClassCount());
  const torch::NoGradGuard no_gradient;
  const auto learned = network_->denoiser->named_parameters();
  for (auto& one : wider->named_parameters()) one.value().copy_(learned[one.key()]);
  wider->SetShapes(shapes);
  wider->to(network_->device);
  wider->eval();
  network_->denoiser = std::move(wider);
  network_->metadata = std::move(metadata);
}

std::vector<float> SceneModel::Sample(int count, const SampleOptions& options,
                                      core::Progress* progress) const {
  if (count < 0) throw core::Error("cannot sample this number of scenes", std::to_string(count));
  const Vocabulary& vocabulary = network_->metadata.vocabulary;
  const auto width = static_cast<size_t>(vocabulary.TokenWidth());
  InpaintingMask mask = InpaintingMask::All(count, vocabulary.entries);
  std::vector<float> padding(mask.pose.size() * width, 0.0f);
  for (size_t i = width; i <= padding.size(); i += width) padding[i - 1] = 1.0f;  // empty: the last
  return Inpaint(padding, mask, options, progress);
}

std::vector<float> SceneModel::Inpaint(const std::vector<float>& given, const InpaintingMask& mask,
                                       const SampleOptions& options,
                                       core::Progress* progress) const {
  const SceneModelMetadata& metadata = network_->metadata;
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("sampling: " + error);
  if (!mask.IsValid(given, metadata.vocabulary, &error)) throw core::Error("inpainting: " + error);
  if (!options.prompts.empty() && !metadata.options.text) {
    throw core::Error("the model reads no prompts", "", "train one with --text");
  }
  if (!options.limits.empty() && metadata.options.continuous) {
    throw core::Error("a model of continuous classes has no limits of their numbers");
  }
  nn::PrepareForWork();
  const torch::NoGradGuard no_gradient;
  const int count = static_cast<int>(mask.pose.size()) / metadata.vocabulary.entries;
  if (options.one_by_one) return network_->InpaintOneByOne(given, mask, options, count, progress);
  std::vector<float> tokens;
  for (int first = 0; first < count; first += options.batch) {
    const int some = std::min(options.batch, count - first);
    const std::vector<float> part = network_->InpaintBatch(given, mask, options, first, some);
    tokens.insert(tokens.end(), part.begin(), part.end());
    for (int i = 0; i < some; ++i) progress->Advance();
  }
  return tokens;
}

}  // namespace simwright::scene
