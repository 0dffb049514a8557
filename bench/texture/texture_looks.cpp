// Measures the textures of `simwright texture` on assets: whether borders of charts show, whether a
// texel is left without a texture, how far variants differ, and whether the library's classifier
// still knows the objects.
//   bench_texture_looks OUT [--exemplar PICTURE] [--size N] [--variants N] [--keep] ASSET...
// Each asset is textured by rule, by a prompt (from a list, in turn) and, with --exemplar, from the
// picture. Seams: the mean colour step across borders of charts over that beside them, at all edges
// and at those where the surface turns by less than 40 degrees. Gaps: samples of the surface whose
// texel belongs to no chart. Distances: of views of the variants to the first one. Recognised: the
// true kind is the most probable of the kinds of the library prior (models/library_prior.pt), or
// among its five most probable, by the mean over 8 views as its training draws them; the kind is
// any of the category of the folder's name (mug_1) or of the asset. Assets without a kind do not
// count. With --keep textures that are in OUT already are measured and not made again: their
// seconds and distances are 0, and assets without any are left out. Smooth edges count where there
// are 50 places to compare.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "core/elapsed_time.h"
#include "core/error.h"
#include "core/files.h"
#include "core/random.h"
#include "library_fit/fit_kinds.h"
#include "library_fit/library_prior.h"
#include "library_fit/prior_example.h"
#include "render/forward.h"
#include "texture/painting/seam_step.h"
#include "texture/painting/texel_map.h"
#include "workflows/priors/models_folder.h"
#include "workflows/texture/texturing.h"

namespace simwright::bench {
namespace {
namespace fs = std::filesystem;

constexpr int kViews = 8;
constexpr const char* kPrompts[] = {"blue with a white inside",
                                    "walnut",
                                    "worn dark green painted",
                                    "speckled stoneware",
                                    "glossy red",
                                    "brushed steel",
                                    "light grey",
                                    "terracotta",
                                    "cream with brown stripes",
                                    "polished copper",
                                    "oak",
                                    "matte black"};

struct Settings {
  fs::path output, exemplar;
  int size = 1024, variants = 3;
  bool keep = false;  // measures what is there
  std::vector<fs::path> assets;
};

// The visual meshes of an asset, each with its textures.
std::vector<core::TexturedMesh> VisualsOf(const fs::path& folder) {
  if (!assets::IsArticulatedAssetFolder(folder)) return {assets::ReadAsset(folder).visual};
  std::vector<core::TexturedMesh> visuals;
  for (const assets::ArticulatedLink& link : assets::ReadArticulatedAsset(folder).links) {
    visuals.push_back(link.visual);
  }
  return visuals;
}

core::TexturedMesh WholeOf(const fs::path& folder) {
  return assets::IsArticulatedAssetFolder(folder)
             ? assets::VisualAtPositions(assets::ReadArticulatedAsset(folder))
             : assets::ReadAsset(folder).visual;
}

struct Surface {
  double seam = 0.0, inside = 0.0, smooth_seam = 0.0, smooth_inside = 0.0;  // sums of steps
  double samples = 0.0, smooth_samples = 0.0;
  int gaps = 0, points = 0;
};

void AddSteps(const texture::SeamSteps& steps, double* seam, double* inside, double* samples) {
  *seam += steps.seam_mean * steps.seam_samples;
  *inside += steps.inside_mean * steps.seam_samples;
  *samples += steps.seam_samples;
}

// Counts points of the surface whose texel belongs to no chart.
void CountGaps(const core::TexturedMesh& mesh, Surface* surface) {
  const texture::TexelMap map =
      texture::MakeTexelMap(mesh.mesh, mesh.corner_uvs, mesh.textures.front().width);
  core::Rng rng = core::StreamRng(7, 0);
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    for (int s = 0; s < 4; ++s) {
      const float u = static_cast<float>(core::Uniform(rng));
      const float v = static_cast<float>(core::Uniform(rng)) * (1.0f - u);
      const Eigen::Vector2f uv = (1.0f - u - v) * mesh.corner_uvs[3 * t] +
                                 u * mesh.corner_uvs[3 * t + 1] + v * mesh.corner_uvs[3 * t + 2];
      const float side = static_cast<float>(map.size);
      const int x = std::clamp(static_cast<int>(uv.x() * side), 0, map.size - 1);
      const int y = std::clamp(static_cast<int>((1.0f - uv.y()) * side), 0, map.size - 1);
      ++surface->points;
      surface->gaps += map.triangle[map.Index(x, y)] < 0;
    }
  }
}

Surface MeasureSurface(const fs::path& folder) {
  Surface surface;
  for (const core::TexturedMesh& mesh : VisualsOf(folder)) {
    if (mesh.mesh.empty() || mesh.textures.empty()) continue;
    AddSteps(texture::MeasureSeamSteps(mesh, M_PI), &surface.seam, &surface.inside,
             &surface.samples);
    AddSteps(texture::MeasureSeamSteps(mesh, 0.7), &surface.smooth_seam, &surface.smooth_inside,
             &surface.smooth_samples);
    CountGaps(mesh, &surface);
  }
  return surface;
}

double Ratio(double seam, double inside, double samples) {
  return samples > 0.0 ? seam / std::max(inside, samples / 255.0) : 0.0;
}

// Returns the kinds that share a category with one of `kinds`.
std::vector<int> OfTheirCategories(const std::vector<int>& kinds) {
  std::set<int> all;
  for (const int kind : kinds) {
    for (const std::string& row :
         library_fit::FitKinds()[static_cast<std::size_t>(kind)].categories) {
      const std::vector<int> same = library_fit::KindsOfCategory(row);
      all.insert(same.begin(), same.end());
    }
    all.insert(kind);
  }
  return {all.begin(), all.end()};
}

// The kinds that an asset may be taken for: those of its category.
std::vector<int> TrueKinds(const fs::path& folder) {
  std::string name = folder.filename().string();
  const std::size_t number = name.rfind('_');
  if (number != std::string::npos) name = name.substr(0, number);
  if (const int kind = library_fit::FindFitKind(name); kind >= 0) return OfTheirCategories({kind});
  const std::string category = assets::IsArticulatedAssetFolder(folder)
                                   ? assets::ReadArticulatedAsset(folder).parameters.category
                                   : assets::ReadAsset(folder).parameters.category;
  return category == "object" ? std::vector<int>{}
                              : OfTheirCategories(library_fit::KindsOfCategory(category));
}

// Returns the rank of the best of the true kinds, 0 for the most probable.
int RankOf(const library_fit::LibraryPrior& prior, const core::TexturedMesh& mesh,
           const std::vector<int>& kinds) {
  render::Scene scene;
  scene.Add(&mesh);
  scene.Commit();
  core::Rng rng = core::StreamRng(20, 0);
  const bool frontal =
      library_fit::FitKinds()[static_cast<std::size_t>(kinds.front())].articulated != nullptr;
  std::vector<double> sum(library_fit::FitKinds().size(), 0.0);
  for (int view = 0; view < kViews; ++view) {
    const library_fit::FitView from = library_fit::RandomView(frontal, &rng);
    const double half = 0.5 * library_fit::kPriorSide / library_fit::kPriorMargin;
    const core::Camera camera = library_fit::CropCameraOf(
        from, mesh.mesh, Eigen::Vector2d::Constant(0.5 * library_fit::kPriorSide), half,
        library_fit::kPriorSide);
    render::ForwardOptions options;
    options.samples_per_side = 3;
    options.shaded = true;
    const core::Image crop = render::RenderForward(scene, camera, options).color;
    const std::vector<double> probabilities = prior.KindProbabilities(crop);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += probabilities[k];
  }
  double best = 0.0;
  for (const int kind : kinds) best = std::max(best, sum[static_cast<std::size_t>(kind)]);
  return static_cast<int>(
      std::count_if(sum.begin(), sum.end(), [&](double one) { return one > best; }));
}

struct Totals {
  int count = 0, known_before = 0, known_after = 0, five_before = 0, five_after = 0, judged = 0;
  int gaps = 0, visible = 0;
  double worst_ratio = 0.0, structure = 0.0, color = 0.0, least_color = 1e9;
  double worst_preparation = 0.0, worst_seconds = 0.0;
  int pairs = 0;
};

class Bench {
 public:
  explicit Bench(const Settings& settings)
      : settings_(settings), prior_(workflows::ModelsFolder() / "library_prior.pt") {}

  void Run() {
    std::printf("%-22s %-9s %6s %6s %6s %5s %6s %6s %6s %5s %5s\n", "asset", "by", "prep s",
                "var s", "seams", "smooth", "gaps", "struct", "colour", "before", "after");
    for (std::size_t i = 0; i < settings_.assets.size(); ++i) {
      const fs::path& asset = settings_.assets[i];
      Measure(asset, "rule", {}, {});
      Measure(asset, "prompt", kPrompts[i % std::size(kPrompts)], {});
      if (!settings_.exemplar.empty()) Measure(asset, "exemplar", {}, settings_.exemplar);
    }
    for (const std::string by : {"rule", "prompt", "exemplar"}) PrintTotals(by);
  }

 private:
  void Measure(const fs::path& asset, const std::string& by, const std::string& prompt,
               const fs::path& exemplar) {
    workflows::TextureRequest request;
    request.asset = asset;
    request.prompt = prompt;
    request.exemplar = exemplar;
    request.variants = settings_.variants;
    request.size = settings_.size;
    request.output = settings_.output / by;
    request.force = true;
    core::Progress silent;
    const workflows::TextureReport report =
        settings_.keep ? Kept(request) : workflows::TextureAsset(request, &silent);
    if (report.variants.empty()) return;
    Totals& totals = by == "rule" ? by_rule_ : by == "prompt" ? by_prompt_ : by_exemplar_;
    ++totals.count;
    Row row{asset.filename().string(), by, report.preparation};
    for (const workflows::TextureVariant& variant : report.variants) {
      AddVariant(asset, variant, &totals, &row);
    }
    totals.worst_preparation =
        std::max(totals.worst_preparation, report.preparation + report.variants[0].seconds);
    const double pairs = std::max<double>(1.0, static_cast<double>(report.variants.size()) - 1.0);
    std::printf("%-22.22s %-9s %6.1f %6.1f %6.2f %5.2f %6d %6.3f %6.1f %5d %5d\n",
                row.asset.c_str(), by.c_str(), row.preparation, row.seconds, row.ratio, row.smooth,
                row.gaps, row.structure / pairs, row.color / pairs, row.before, row.after);
    std::fflush(stdout);
  }

  // Returns the variants that are in the output already.
  static workflows::TextureReport Kept(const workflows::TextureRequest& request) {
    workflows::TextureReport report;
    for (int v = 0; v < request.variants; ++v) {
      workflows::TextureVariant variant;
      char number[16];
      std::snprintf(number, sizeof number, "_%03d", v);
      const std::string name = core::ReadFile(request.asset / "asset.json");
      const std::size_t at = name.find("\"name\": \"") + 9;
      variant.folder = request.output / (name.substr(at, name.find('"', at) - at) + number);
      if (fs::exists(variant.folder)) report.variants.push_back(variant);
    }
    return report;
  }

  struct Row {
    std::string asset, by;
    double preparation = 0.0, seconds = 0.0, ratio = 0.0, smooth = 0.0;
    int gaps = 0;
    double structure = 0.0, color = 0.0;
    int before = -1, after = -1;  // the worst rank of the kind, from 0; -1: no kind
  };

  void AddVariant(const fs::path& asset, const workflows::TextureVariant& variant, Totals* totals,
                  Row* row) {
    const Surface surface = MeasureSurface(variant.folder);
    const double ratio = Ratio(surface.seam, surface.inside, surface.samples);
    row->ratio = std::max(row->ratio, ratio);
    if (surface.smooth_samples >= 50.0) {
      row->smooth = std::max(
          row->smooth, Ratio(surface.smooth_seam, surface.smooth_inside, surface.smooth_samples));
    }
    row->gaps += surface.gaps;
    row->seconds = std::max(row->seconds, variant.seconds);
    totals->worst_ratio = std::max(totals->worst_ratio, row->smooth);
    totals->visible += row->smooth > 1.1;
    totals->gaps += surface.gaps;
    if (variant.from_first.color > 0.0) {
      row->structure += variant.from_first.structure;
      row->color += variant.from_first.color;
      totals->structure += variant.from_first.structure;
      totals->color += variant.from_first.color;
      totals->least_color = std::min(totals->least_color, variant.from_first.color);
      totals->worst_seconds = std::max(totals->worst_seconds, variant.seconds);
      ++totals->pairs;
    }
    const std::vector<int> kinds = TrueKinds(asset);
    if (kinds.empty()) return;
    if (asset != ranked_asset_) rank_before_ = RankOf(prior_, WholeOf(asset), kinds);
    ranked_asset_ = asset;
    const int before = rank_before_;
    const int after = RankOf(prior_, WholeOf(variant.folder), kinds);
    row->before = std::max(row->before, before);
    row->after = std::max(row->after, after);
    ++totals->judged;
    totals->known_before += before == 0;
    totals->known_after += after == 0;
    totals->five_before += before < 5;
    totals->five_after += after < 5;
  }

  void PrintTotals(const std::string& by) const {
    const Totals& t = by == "rule" ? by_rule_ : by == "prompt" ? by_prompt_ : by_exemplar_;
    if (t.count == 0) return;
    std::printf("\n%s: %d assets; first texture at most %.1f s, a further variant at most %.1f s\n",
                by.c_str(), t.count, t.worst_preparation, t.worst_seconds);
    std::printf(
        "  borders of charts: step over the texture's own at most %.2f (%d above 1.1); "
        "points without a texture: %d\n",
        t.worst_ratio, t.visible, t.gaps);
    std::printf("  variants: structure %.3f and colour %.1f on average, at least %.1f\n",
                t.structure / std::max(1, t.pairs), t.color / std::max(1, t.pairs), t.least_color);
    std::printf("  kind known: %d of %d before, %d after; among five: %d before, %d after\n",
                t.known_before, t.judged, t.known_after, t.five_before, t.five_after);
  }

  const Settings& settings_;
  library_fit::LibraryPrior prior_;
  fs::path ranked_asset_;  // the asset of the rank below
  int rank_before_ = 0;
  Totals by_rule_, by_prompt_, by_exemplar_;
};

Settings SettingsOf(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    const bool takes = flag == "--exemplar" || flag == "--size" || flag == "--variants";
    if (takes && i + 1 >= argc) throw core::Error("needs a value", flag);
    if (flag == "--keep") {
      settings.keep = true;
    } else if (flag == "--exemplar") {
      settings.exemplar = argv[++i];
    } else if (flag == "--size") {
      settings.size = std::atoi(argv[++i]);
    } else if (flag == "--variants") {
      settings.variants = std::atoi(argv[++i]);
    } else if (settings.output.empty()) {
      settings.output = flag;
    } else {
      settings.assets.emplace_back(flag);
    }
  }
  if (settings.assets.empty()) throw core::Error("give a folder for the output, and assets");
  return settings;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    const auto settings = simwright::bench::SettingsOf(argc, argv);
    simwright::bench::Bench(settings).Run();
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
