#include "scene/model/denoiser.h"

#include "core/error.h"
#include "nn/compute.h"
#include "scene/model/flux_denoiser.h"
#include "scene/model/transformer_denoiser.h"
#include "scene/model/unet_denoiser.h"

namespace simwright::scene {

namespace {

void RequireShapes(const ClassShapes& shapes) {
  if (shapes) return;
  throw core::Error("the model uses a table of classes and cannot take assets by shape", "",
                    "train one with --by-shape");
}

}  // namespace

Denoised Denoiser::PredictParallel(const NoisyScenes& scenes) {
  const std::int64_t count = scenes.poses.size(0);
  const int shares = nn::ShareCount(scenes.poses.device(), count);
  std::vector<torch::Tensor> noise(static_cast<size_t>(shares)), classes(noise.size());
  nn::ForEachShare(shares, [&](int i) {
    const nn::Share share = nn::ShareOf(count, shares, i);
    const auto part = [&](const torch::Tensor& all) {
      return all.narrow(0, share.first, share.count);
    };
    const Denoised one = Predict({part(scenes.poses), part(scenes.classes), part(scenes.time),
                                  scenes.text.Part(share.first, share.count)});
    noise[static_cast<size_t>(i)] = one.pose_noise;
    classes[static_cast<size_t>(i)] = one.classes;
  });
  return {torch::cat(noise), torch::cat(classes)};
}

EncodedText Denoiser::EncodeText(const TextInput& text) {
  if (!text_) {
    throw core::Error("the model reads no prompts", "", "train one with --text");
  }
  return text_->forward(text);
}

void Denoiser::RegisterText(const SceneModelOptions& options) {
  if (options.text) text_ = register_module("text", TextEncoder(options));
}

void Denoiser::SetShapes(const AssetShapes& shapes) {
  RequireShapes(shapes_);
  shapes_->Set(shapes);
}

AssetShapes Denoiser::Shapes() const {
  RequireShapes(shapes_);
  return shapes_->Shapes();
}

ClassShapes Denoiser::RegisterShapes(const SceneModelOptions& options, int classes,
                                     std::int64_t entry, std::int64_t exit) {
  if (options.shape_points == 0) return nullptr;
  shapes_ = register_module("shapes", ClassShapes(classes, options.shape_points, entry, exit));
  return shapes_;
}

std::shared_ptr<Denoiser> MakeDenoiser(const SceneModelOptions& options, int classes) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("model of scenes: " + error);
  if (classes < 2) throw core::Error("a model of scenes needs a class besides the empty one");
  switch (options.kind) {
    case DenoiserKind::kFlux:
      return std::make_shared<FluxDenoiser>(options, classes);
    case DenoiserKind::kTransformer:
      return std::make_shared<TransformerDenoiser>(options, classes);
    case DenoiserKind::kUnet:
      return std::make_shared<UnetDenoiser>(options, classes);
  }
  throw core::Error("unknown kind of denoiser");
}

std::int64_t ParameterCount(const torch::nn::Module& module) {
  std::int64_t count = 0;
  for (const torch::Tensor& one : module.parameters()) count += one.numel();
  return count;
}

}  // namespace simwright::scene
