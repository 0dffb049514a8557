// Compares both ways of clamping: of each held-out scene half of the free objects are removed and
// completed, or half are rearranged. Reports the share of objects that physics drops, penetration
// before physics, and the distance of the results to the data.
//   simwright scene generate --type dimsum --count 60 --seed 1000000007 -o out/held_out
//   bench_scene_inpainting --data out/held_out
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/parallel.h"
#include "core/random.h"
#include "scene/asset_set/asset_set_folder.h"
#include "scene/dataset/scene_dataset.h"
#include "scene/dataset/tokens.h"
#include "scene/feasibility/constrained_scene.h"
#include "scene/metrics/asset_frequency.h"
#include "scene/metrics/frechet.h"
#include "scene/metrics/label_render.h"
#include "scene/metrics/penetration.h"
#include "scene/metrics/scene_features.h"
#include "scene/model/scene_model.h"
#include "workflows/scenes/scene_sampling.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;
using Objects = std::vector<scene::SceneObject>;

constexpr double kLargestDepth = 0.001;  // m, of objects that touch after physics

struct Arguments {
  fs::path data, models = "models";
  int steps = 50, repeats = 1;
  double share = 0.5;
  bool default_clamping = false;  // only the default way of clamping
};

// A held-out scene with its kept objects first, then the others.
struct Halved {
  Objects objects;
  int kept = 0;
};

// The results of one task and one way of clamping.
struct Figures {
  int asked = 0, dropped = 0, stable = 0, unstable_kept = 0;
  int colliding = 0;                      // scenes with interpenetrations after physics
  double kept_displacement = 0.0;         // m
  std::vector<double> penetrations;       // m, of scenes before physics
  std::vector<Objects> sampled, settled;  // before and after physics
  double sampling = 0.0, physics = 0.0;   // s
};

double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Returns true if one of the first `kept` objects may stand on `object`: it is above, by its
// origin, and no farther to the side than the radius of a steamer.
bool MayCarry(const scene::SceneObject& object, const Objects& objects, size_t kept) {
  constexpr double kRadius = 0.12;  // m
  return std::any_of(objects.begin(), objects.begin() + static_cast<std::ptrdiff_t>(kept),
                     [&](const scene::SceneObject& other) {
                       const Eigen::Vector3d up = other.world_from_object.translation() -
                                                  object.world_from_object.translation();
                       return !other.welded && up.z() > 0.005 && up.z() < 0.12 &&
                              up.head<2>().norm() < kRadius;
                     });
}

// Returns each scene `repeats` times, each time with others of its free objects removed, at random
// but the upper ones of a stack first.
std::vector<Halved> HalvedScenes(const std::vector<Objects>& scenes, double share, int repeats) {
  std::vector<Halved> halved;
  for (size_t i = 0; i < scenes.size() * static_cast<size_t>(repeats); ++i) {
    core::Rng rng = core::StreamRng(91, i);
    Halved one{scenes[i % scenes.size()], 0};
    Objects& objects = one.objects;
    std::shuffle(objects.begin(), objects.end(), rng);
    std::stable_partition(objects.begin(), objects.end(),
                          [](const scene::SceneObject& object) { return object.welded; });
    const auto welded = std::count_if(objects.begin(), objects.end(),
                                      [](const scene::SceneObject& o) { return o.welded; });
    const double free = static_cast<double>(objects.size()) - static_cast<double>(welded);
    const auto removed = static_cast<size_t>(std::lround(free * share));
    size_t kept = objects.size();
    while (objects.size() - kept < removed) {
      size_t next = kept - 1;
      while (next > static_cast<size_t>(welded) && MayCarry(objects[next], objects, kept)) --next;
      if (next == static_cast<size_t>(welded)) next = kept - 1;
      --kept;
      std::rotate(objects.begin() + static_cast<std::ptrdiff_t>(next),
                  objects.begin() + static_cast<std::ptrdiff_t>(next) + 1,
                  objects.begin() + static_cast<std::ptrdiff_t>(kept) + 1);
    }
    one.kept = static_cast<int>(kept);
    halved.push_back(std::move(one));
  }
  return halved;
}

void AppendMask(const Halved& scene, const scene::Vocabulary& vocabulary, bool rearrange,
                std::vector<float>* tokens, scene::InpaintingMask* mask) {
  const auto size = static_cast<size_t>(vocabulary.entries * vocabulary.TokenWidth());
  Objects given = scene.objects;
  if (!rearrange) given.resize(static_cast<size_t>(scene.kept));
  tokens->resize(tokens->size() + size);
  EncodeScene(given, vocabulary, &(*tokens)[tokens->size() - size]);
  const auto first = static_cast<int>(mask->pose.size());
  for (int i = 0; i < vocabulary.entries; ++i) {
    const bool open = i >= scene.kept && i < static_cast<int>(scene.objects.size());
    mask->pose.push_back(open);
    mask->classes.push_back(open && !rearrange);
  }
  for (int i = scene.kept; !rearrange && i < static_cast<int>(scene.objects.size()); ++i) {
    mask->Forbid(vocabulary, first + i, vocabulary.EmptyClass());
    for (int c = 0; c < vocabulary.EmptyClass(); ++c) {
      if (vocabulary.welded[static_cast<size_t>(c)]) mask->Forbid(vocabulary, first + i, c);
    }
  }
}

void RunPhysics(const std::vector<Halved>& scenes, const scene::AssetSet& asset_set,
                Figures* figures) {
  const auto start = std::chrono::steady_clock::now();
  scene::ConstrainedOptions options;
  options.feasibility.lowering = workflows::kSampleLowering;
  std::vector<scene::ConstrainedScene> placed(scenes.size());
  figures->penetrations.resize(scenes.size());
  core::ParallelFor(static_cast<int>(scenes.size()), [&](int index) {
    const auto i = static_cast<size_t>(index);
    const Objects& objects = figures->sampled[i];
    std::vector<char> kept(objects.size(), 0);
    std::fill(kept.begin(), kept.begin() + scenes[i].kept, 1);
    figures->penetrations[i] =
        scene::TotalPenetration(objects, asset_set, scene::BodyShape::kParts);
    placed[i] = PlaceAmong(objects, kept, asset_set, options);
    CheckFree(kept, asset_set, options, &placed[i]);
  });
  for (size_t i = 0; i < scenes.size(); ++i) {
    figures->asked += static_cast<int>(scenes[i].objects.size()) - scenes[i].kept;
    figures->dropped += placed[i].dropped;
    figures->stable += placed[i].stable;
    figures->colliding +=
        !scene::PenetratingPairs(placed[i].objects, asset_set, kLargestDepth).empty();
    figures->unstable_kept += static_cast<int>(placed[i].unstable.size());
    figures->kept_displacement = std::max(figures->kept_displacement, placed[i].kept_displacement);
    figures->settled.push_back(placed[i].objects);
  }
  figures->physics = SecondsSince(start);
}

Figures Measure(const scene::SceneModel& model, const std::vector<Halved>& scenes,
                const scene::AssetSet& asset_set, bool rearrange, scene::Clamping clamping,
                int steps) {
  const scene::Vocabulary& vocabulary = model.metadata().vocabulary;
  std::vector<float> tokens;
  scene::InpaintingMask mask;
  for (const Halved& one : scenes) AppendMask(one, vocabulary, rearrange, &tokens, &mask);
  if (!mask.forbidden.empty()) {
    mask.forbidden.resize(mask.pose.size() * static_cast<size_t>(vocabulary.ClassCount()), 0);
  }
  scene::SampleOptions options;
  options.steps = steps;
  options.clamping = clamping;
  core::Progress progress;
  Figures figures;
  const auto start = std::chrono::steady_clock::now();
  tokens = model.Inpaint(tokens, mask, options, &progress);
  figures.sampling = SecondsSince(start);
  figures.sampled = DecodeScenes(tokens, vocabulary);
  RunPhysics(scenes, asset_set, &figures);
  return figures;
}

// Compares sets of scenes with the data.
class Comparison {
 public:
  Comparison(const std::vector<Objects>& data, const scene::Vocabulary& vocabulary,
             const scene::AssetSet& asset_set, const fs::path& weights)
      : vocabulary_(vocabulary),
        asset_set_(asset_set),
        features_(scene::SceneFeatures::Load(weights)),
        counts_(AssetCounts(data, vocabulary)),
        data_(GaussianFor(data)) {}

  double Frechet(const std::vector<Objects>& scenes) const {
    return scene::FrechetDistance(data_, GaussianFor(scenes));
  }
  double Divergence(const std::vector<Objects>& scenes) const {
    return scene::FrequencyDivergence(counts_, AssetCounts(scenes, vocabulary_));
  }

 private:
  scene::Gaussian GaussianFor(const std::vector<Objects>& scenes) const {
    std::vector<core::Image> pictures(scenes.size());
    const core::Camera camera = scene::LabelCamera(vocabulary_.type);
    core::ParallelFor(static_cast<int>(scenes.size()), [&](int i) {
      const auto index = static_cast<size_t>(i);
      pictures[index] =
          features_.Resized(LabelRender(scenes[index], vocabulary_, asset_set_, camera));
    });
    return scene::GaussianOf(features_.Of(pictures));
  }

  const scene::Vocabulary& vocabulary_;
  const scene::AssetSet& asset_set_;
  scene::SceneFeatures features_;
  std::vector<std::int64_t> counts_;
  scene::Gaussian data_;
};

void PrintRow(const char* task, const char* clamping, const Figures& figures,
              const Comparison& comparison) {
  std::vector<double> depths = figures.penetrations;
  std::nth_element(depths.begin(), depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2),
                   depths.end());
  const double n = static_cast<double>(figures.sampled.size());
  std::printf("%-10s %-7s %6d %8.1f %8.1f %8.3f %8.3f %8.1f %8d %8.1f %8.3f %8d %8.1f %8.1f\n",
              task, clamping, figures.asked, 100.0 * figures.dropped / std::max(1, figures.asked),
              100.0 * depths[depths.size() / 2], comparison.Frechet(figures.sampled),
              comparison.Frechet(figures.settled), 1e4 * comparison.Divergence(figures.sampled),
              figures.colliding, 100.0 * figures.stable / n, 1e3 * figures.kept_displacement,
              figures.unstable_kept, figures.sampling, figures.physics);
  std::fflush(stdout);
}

void Run(const Arguments& arguments) {
  const scene::SceneDataset dataset(arguments.data);
  const scene::Vocabulary& vocabulary = dataset.vocabulary();
  const int count = dataset.SceneCount();
  const std::vector<Objects> data = DecodeScenes(dataset.Read(0, count), vocabulary);
  const scene::AssetSet asset_set = scene::ReadAssetSet(
      scene::FoldersForCategories(arguments.data / "assets", vocabulary.categories));
  const scene::SceneModel model =
      scene::SceneModel::Load(arguments.models / "scenes" / (vocabulary.type + ".pt"));
  const std::vector<Halved> halved = HalvedScenes(data, arguments.share, arguments.repeats);
  std::vector<Halved> emptied = halved;  // unconditional: only the furniture is kept
  for (Halved& one : emptied) {
    one.kept = static_cast<int>(std::count_if(one.objects.begin(), one.objects.end(),
                                              [](const auto& o) { return o.welded; }));
  }
  const Comparison comparison(data, vocabulary, asset_set, arguments.models / "scene_features.pt");
  std::printf("%s, %d scenes %d times, %d steps\n", vocabulary.type.c_str(), count,
              arguments.repeats, arguments.steps);
  std::printf("%-10s %-7s %6s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "task", "clamped",
              "asked", "drop %", "MTP cm", "Frechet", "settled", "KL 1e4", "collide", "stable %",
              "kept mm", "unstable", "sample s", "physics s");
  for (const bool rearrange : {false, true}) {
    for (const bool noised : {false, true}) {
      if (noised && arguments.default_clamping) continue;
      const scene::Clamping clamping =
          noised ? scene::Clamping::kForwardNoised : scene::Clamping::kCleanValues;
      PrintRow(rearrange ? "rearrange" : "complete", noised ? "noised" : "clean",
               Measure(model, halved, asset_set, rearrange, clamping, arguments.steps), comparison);
    }
  }
  const scene::Clamping clamping =
      arguments.default_clamping ? scene::Clamping::kCleanValues : scene::Clamping::kForwardNoised;
  PrintRow("furniture", arguments.default_clamping ? "clean" : "noised",
           Measure(model, emptied, asset_set, false, clamping, arguments.steps), comparison);
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Completion and rearrangement of scenes: both ways of clamping");
  simwright::Arguments arguments;
  app.add_option("--data", arguments.data, "Dataset of held-out scenes with its assets")
      ->required();
  app.add_option("--models", arguments.models, "Folder of the shipped weights")
      ->capture_default_str();
  app.add_option("--steps", arguments.steps, "Diffusion steps")->capture_default_str();
  app.add_option("--share", arguments.share, "Share of the free objects that are replaced")
      ->capture_default_str();
  app.add_option("--repeats", arguments.repeats, "Times that each scene is completed")
      ->capture_default_str();
  app.add_flag("--default-clamping", arguments.default_clamping,
               "Measure the default way of clamping only");
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::core::InstallCancelHandler();
    simwright::core::SetThreadCount(0);
    simwright::Run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
