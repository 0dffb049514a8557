#pragma once

#include <string>

namespace simwright::scene {

enum class DenoiserKind {
  kFlux,         // ours: double- and single-stream blocks (Pfaff et al., after Flux)
  kTransformer,  // MiDiffusion (Hu et al. 2024)
  kUnet,         // DiffuScene (Tang et al. 2024)
};

// The options of a scene model. Independent of libtorch, so that code that passes them on is too.
struct SceneModelOptions {
  DenoiserKind kind = DenoiserKind::kFlux;
  // True: classes are continuous and diffused like poses; false: discrete, by mask and replace.
  bool continuous = false;
  int width = 128;
  int heads = 4;
  int double_blocks = 2;  // of kFlux: attention, then an MLP per token
  int single_blocks = 4;  // of kFlux: both in parallel; of kTransformer: all blocks
  // True: the noise of a pose is predicted directly and from the predicted clean pose (PoseBlend);
  // false: directly only, as in the papers.
  bool blends_clean_poses = true;
  // The training times are sampled as T u^p, u uniform in [0, 1). Heights are decided where the
  // noise is below 0.25, with poses in [-1, 1]: at p = 1, as in the papers, 8 % of the times are
  // there, at p = 2 28 %. The classes' loss is reweighted to the evidence lower bound.
  double time_power = 2.0;
  int diffusion_steps = 1000;
  // The weight of the classes' loss in the total, for a mixed model; 1 in the papers. The
  // divergence of one step is the class information divided by the number of steps, about a
  // thousandth of the pose errors.
  double class_weight = 100.0;

  // If above 0, classes are embedded by this number of surface points of their assets instead of by
  // their index, so that an asset can be added without training.
  int shape_points = 0;

  // True: the model reads prompts. kFlux: by the text streams of its double-stream blocks, joined
  // with the scene's tokens in the single-stream ones; the baselines: by cross-attention.
  bool text = false;
  // With `text`, one of these is above 0 once the vocabulary is known; training sets it: the number
  // of word pieces of the model's own encoder, or the width of an external encoder's features.
  int text_pieces = 0, text_features = 0;
  int text_layers = 2;    // transformer layers of the own encoder
  int text_length = 110;  // most pieces of a prompt, as published; the rest is cut off

  // Returns the options of a size: "tiny" (two cores), "base" or "full" (the paper's 88 M). Throws
  // core::Error for another one.
  static SceneModelOptions OfSize(const std::string& size);
  // Return the paper's baselines with the size of `this` to within a tenth.
  SceneModelOptions AsMiDiffusion() const;
  SceneModelOptions AsDiffuScene() const;

  bool IsValid(std::string* error) const;
};

// Converts to "flux", "transformer", "unet" and back. Throws core::Error for another name.
std::string NameOf(DenoiserKind kind);
DenoiserKind DenoiserNamed(const std::string& name);

}  // namespace simwright::scene
