#include "library_fit/prior_example.h"

#include <algorithm>
#include <cmath>

#include "asset_lift/priors/shape_example.h"
#include "render/forward.h"

namespace simwright::library_fit {
namespace {

constexpr int kArticulatedWeight = 4;  // to 1 of a rigid kind
constexpr double kRecolored = 0.3;     // share of pictures in random colours

// Gives each material another colour; materials of one name keep sharing it.
void Recolor(core::Rng* rng, core::TexturedMesh* mesh) {
  std::vector<std::pair<std::string, Eigen::Vector4f>> changed;
  for (core::Material& material : mesh->materials) {
    auto known = std::find_if(changed.begin(), changed.end(),
                              [&](const auto& entry) { return entry.first == material.name; });
    if (known == changed.end()) {
      const auto share = static_cast<float>(core::Uniform(*rng, 0.2, 0.8));
      Eigen::Vector4f color = material.base_color;
      for (int c = 0; c < 3; ++c) {
        color[c] =
            (1.0f - share) * color[c] + share * static_cast<float>(core::Uniform(*rng, 0.05, 0.95));
      }
      known = changed.insert(changed.end(), {material.name, color});
    }
    material.base_color = known->second;
  }
}

}  // namespace

int PriorExampleKind(core::Rng* rng) {
  const auto articulated = static_cast<std::int64_t>(library::Kinds().size());
  const auto rigid = static_cast<std::int64_t>(FitKinds().size()) - articulated;
  const std::int64_t at = core::UniformIndex(*rng, kArticulatedWeight * articulated + rigid);
  return static_cast<int>(at < kArticulatedWeight * articulated
                              ? at / kArticulatedWeight
                              : at - (kArticulatedWeight - 1) * articulated);
}

PriorExample LabelsOf(const Instance& instance, const FitView& view) {
  PriorExample example;
  example.kind = instance.kind;
  example.view = view;
  for (int i = 0; i < 3; ++i) {
    example.log_size[static_cast<size_t>(i)] = static_cast<float>(std::log(instance.size[i]));
  }
  example.choices.fill(-1.0f);
  for (size_t i = 0; i < std::min(instance.draws.size(), size_t{kPriorDraws}); ++i) {
    example.choices[i] = static_cast<float>(instance.draws[i]);
  }
  if (FitKinds()[static_cast<size_t>(instance.kind)].opening > 0.0) {
    example.choices[kPriorDraws] = static_cast<float>(std::min(instance.opening, 0.9999));
  }
  return example;
}

PriorExample MakePriorExample(int kind, std::uint64_t seed) {
  const Instance instance = SampleInstance(kind, seed);
  core::Rng rng = core::StreamRng(seed, 104729);
  core::TexturedMesh mesh = InstanceMesh(instance);
  if (core::Uniform(rng) < kRecolored) Recolor(&rng, &mesh);
  PriorExample example = LabelsOf(
      instance, RandomView(FitKinds()[static_cast<size_t>(kind)].articulated != nullptr, &rng));

  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  // The object's bounding box in the crop is about as uncertain as a segmentation.
  const double half = 0.5 * kPriorSide / (kPriorMargin * core::Uniform(rng, 0.96, 1.05));
  const Eigen::Vector2d middle =
      Eigen::Vector2d::Constant(0.5 * kPriorSide) +
      0.01 * kPriorSide * Eigen::Vector2d(core::Normal(rng), core::Normal(rng));
  const core::Camera camera = CropCameraOf(example.view, mesh.mesh, middle, half, kPriorSide);
  render::ForwardOptions options;
  options.samples_per_side = 2;
  options.shaded = true;
  options.light = asset_lift::RandomLight(&rng);
  options.occlusion_rays = core::Uniform(rng) < 0.25 ? 4 : 0;
  example.picture = render::RenderForward(scene, camera, options).color.pixels;
  return example;
}

}  // namespace simwright::library_fit
