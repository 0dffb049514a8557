#pragma once

#include <string>

namespace simwright::scene {

enum class DenoiserKind {
  kFlux,         // ours: double- and single-stream blocks (Pfaff et al., after Flux)
  kTransformer,  // MiDiffusion (Hu et al. 2024)
  kUnet,         // DiffuScene (Tang et al. 2024)
};

// A model of scenes, free of libtorch, so that whoever passes it on is too.
struct SceneModelOptions {
  DenoiserKind kind = DenoiserKind::kFlux;
  // Classes as numbers, diffused as poses are; else as classes, by mask and replace.
  bool continuous = false;
  int width = 128;
  int heads = 4;
  int double_blocks = 2;  // of kFlux; attention, then a network a token
  int single_blocks = 4;  // of kFlux: both at once; of kTransformer: all of them
  // The noise of a pose is predicted both as such and by way of the clean pose (PoseBlend); else as
  // such, as in the papers.
  bool blends_clean_poses = true;
  // Times to learn at are drawn as T u^p, u uniform in [0, 1). Heights are decided where the noise
  // is below 0.25, poses being in [-1, 1]: 1, as in the papers, has 8 % of times there, 2 has 28 %.
  // The classes' loss is weighted back to the evidence's bound.
  double time_power = 2.0;
  int diffusion_steps = 1000;
  // Of the classes' loss in the whole, of a mixed model; the papers' is 1. A step's divergence is
  // what a class is worth divided by the steps, a thousandth of what poses' errors are: of 64 drawn
  // after 400 updates 25 scenes had the right things with 1, and 54 with 30 (of 100 steps).
  double class_weight = 100.0;

  // Above 0: classes are known by so many points of their assets' surfaces instead of by their
  // number, so that an asset can be added without training.
  int shape_points = 0;

  // "tiny" (two cores), "base", "full" (the paper's 88 M). Throws core::Error for another.
  static SceneModelOptions OfSize(const std::string& size);
  // The baselines of the paper, as large as `this` to within a tenth.
  SceneModelOptions AsMiDiffusion() const;
  SceneModelOptions AsDiffuScene() const;

  bool IsValid(std::string* error) const;
};

// "flux", "transformer", "unet", and back. Throws core::Error for another.
std::string NameOf(DenoiserKind kind);
DenoiserKind DenoiserNamed(const std::string& name);

}  // namespace simwright::scene
