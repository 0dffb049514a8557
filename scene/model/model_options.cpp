#include "scene/model/model_options.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace simwright::scene {
namespace {

// Returns the number of parameters of the blocks of kFlux divided by width^2: 18 per stream of a
// double-stream block, 15 per single-stream block.
int BlockParameters(const SceneModelOptions& options) {
  return 18 * (options.text ? 2 : 1) * options.double_blocks + 15 * options.single_blocks;
}

}  // namespace

SceneModelOptions SceneModelOptions::OfSize(const std::string& size) {
  SceneModelOptions options;
  if (size == "tiny") return options;
  if (size == "base") {
    options.width = 256;
    options.heads = 8;
    options.double_blocks = 3;
    options.single_blocks = 6;
    return options;
  }
  if (size == "full") {
    options.width = 512;
    options.heads = 16;
    options.double_blocks = 5;
    options.single_blocks = 10;
    return options;
  }
  throw core::Error("there is no such model size", size, "tiny, base or full");
}

SceneModelOptions SceneModelOptions::AsMiDiffusion() const {
  SceneModelOptions options = *this;
  options.kind = DenoiserKind::kTransformer;
  // One of their blocks has 16 width^2 parameters, with cross-attention 20.
  const int theirs = text ? 20 : 16;
  options.single_blocks = (BlockParameters(*this) + theirs / 2) / theirs;
  options.double_blocks = 0;
  options.heads = 4;
  options.blends_clean_poses = false;
  options.time_power = 1.0;
  options.class_weight = 1.0;
  return options;
}

SceneModelOptions SceneModelOptions::AsDiffuScene() const {
  SceneModelOptions options = *this;
  options.kind = DenoiserKind::kUnet;
  options.continuous = true;
  options.heads = 4;
  options.blends_clean_poses = false;
  options.time_power = 1.0;
  // It has 132 width^2 parameters, 4 more with each of its 9 layers of cross-attention. The own
  // text encoder has the width of the model, too, 12 width^2 a layer.
  const double encoder = text ? 12.0 * text_layers : 0.0;
  const double theirs = (text ? 132.0 + 4.0 * 9.0 : 132.0) + encoder;
  const double ours = (BlockParameters(*this) + encoder) * width * width;
  options.width = std::max(8, 4 * static_cast<int>(std::lround(std::sqrt(ours / theirs) / 4)));
  return options;
}

bool SceneModelOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (width < 8 || width > 4096 || width % 4 != 0) {
    return fails("width must be 8 to 4096, a multiple of 4");
  }
  if (heads < 1 || width % heads != 0) return fails("heads must divide the width");
  if (double_blocks < 0 || single_blocks < 0 || double_blocks + single_blocks > 256) {
    return fails("blocks must be 0 to 256");
  }
  if (kind != DenoiserKind::kUnet && double_blocks + single_blocks < 1) {
    return fails("a model needs a block");
  }
  if (!(class_weight > 0.0)) return fails("class_weight must be above 0");
  if (!(time_power >= 1.0 && time_power <= 8.0)) return fails("time_power must be 1 to 8");
  if (shape_points < 0 || shape_points > 65536) return fails("shape_points must be 0 to 65536");
  if (shape_points > 0 && continuous)
    return fails("continuous classes cannot be embedded by shape");
  if (shape_points > 0 && kind == DenoiserKind::kUnet) {
    return fails("a U-Net cannot embed classes by shape");
  }
  if (!text && (text_pieces != 0 || text_features != 0)) {
    return fails("text_pieces and text_features need text");
  }
  if (text_pieces < 0 || text_pieces > 1 << 20) return fails("text_pieces must be 0 to 1048576");
  if (text_features < 0 || text_features > 65536) return fails("text_features must be 0 to 65536");
  if (text_pieces > 0 && text_features > 0) {
    return fails("text is read as pieces or as features, not as both");
  }
  if (text_layers < 0 || text_layers > 64) return fails("text_layers must be 0 to 64");
  if (text_length < 2 || text_length > 4096) return fails("text_length must be 2 to 4096");
  if (text && kind == DenoiserKind::kFlux && double_blocks < 1) {
    return fails("text enters by the double-stream blocks: double_blocks must be at least 1");
  }
  if (diffusion_steps < 2 || diffusion_steps > 100000) {
    return fails("diffusion_steps must be 2 to 100000");
  }
  return true;
}

std::string NameOf(DenoiserKind kind) {
  switch (kind) {
    case DenoiserKind::kFlux:
      return "flux";
    case DenoiserKind::kTransformer:
      return "transformer";
    case DenoiserKind::kUnet:
      return "unet";
  }
  throw core::Error("unknown kind of denoiser");
}

DenoiserKind DenoiserNamed(const std::string& name) {
  for (const DenoiserKind kind :
       {DenoiserKind::kFlux, DenoiserKind::kTransformer, DenoiserKind::kUnet}) {
    if (NameOf(kind) == name) return kind;
  }
  throw core::Error("there is no such denoiser", name, "flux, transformer or unet");
}

}  // namespace simwright::scene
