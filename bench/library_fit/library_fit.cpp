// Measures how well objects of the library are fitted to photos of instances that no training used:
// seeds from kHeldOutSeed + 500 on. Each is rendered from a random view over a background.
//   bench_library_fit [--count N] [--rigid N] [--first N] [--segment] [--free none|fast|full]
//                     [--network] [--only KIND] [--stride N] [--weights FILE] [--partnet FOLDER]
//                     [--tuning]
//                     [--threads N]
// --network: only the accuracy of the network's kinds, no fits; --count: instances per articulated
// kind (default 2); --rigid: per rigid kind (1); --segment: the mask is found by SegmentObject
// instead of given; --free: the free form that shapes are compared with (fast: first guess and
// stage 2); --partnet: the folders KIND/NUMBER of PartNet-Mobility, imported and rendered, in place
// of the library; --stride: every Nth rigid kind; --tuning: seeds below kHeldOutSeed, on which
// settings may be chosen.
//
// "all kinds": nothing is known of the object, and what is measured is the best fit of any kind.
// "kind given": the fit is restricted to the true kind, as a category given by the user does it.
// Chamfer distances follow bench_lift_quality. Joints are compared in the camera's frame.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "asset_lift/lift.h"
#include "asset_lift/priors/shape_example.h"
#include "asset_lift/priors/shape_prior.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "fit_case.h"
#include "importers/articulated_import.h"
#include "library_fit/library_fit.h"
#include "library_fit/library_training.h"
#include "lift_quality_measures.h"
#include "physics_params/knowledge_base.h"
#include "shape_alignment.h"
#include "workflows/lift/lift.h"
#include "workflows/priors/models_folder.h"

namespace simwright::bench {
namespace {

namespace fs = std::filesystem;
using library_fit::FitKinds;
using library_fit::FittedInstance;

constexpr double kLeastPart = 0.1;  // of the diagonal: smaller parts are controls

struct Settings {
  int count = 2, rigid = 1, first = 0, stride = 1;
  bool segment = false, tuning = false, network = false;
  std::string free_form = "fast", only;
  fs::path weights, partnet;
};

// The figures of a group of cases.
struct Totals {
  int cases = 0, network_right = 0, among_five = 0, fit_right = 0, failed = 0;
  std::vector<double> fitted, given, free_form;  // Chamfer distances
  std::vector<double> seconds;
  JointScores all_kinds, kind_given, main_all_kinds, main_kind_given;
};

double Median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double ChamferOf(const ComparableShape& truth, const core::TriangleMesh& mesh) {
  const ComparableShape shape(mesh, 1);
  return CompareShapes(truth, shape, Align(truth, shape)).chamfer;
}

std::optional<double> FreeChamfer(const Settings& settings, const FitCase& fit_case,
                                  const std::string& category, const ComparableShape& truth) {
  if (settings.free_form == "none") return {};
  static const auto kShape =
      std::make_shared<asset_lift::ShapePrior>(workflows::ModelsFolder() / "shape_prior.pt");
  asset_lift::LiftOptions options;
  options.effort =
      settings.free_form == "full" ? asset_lift::LiftEffort::kFull : asset_lift::LiftEffort::kFast;
  if (!settings.segment) options.mask = fit_case.matte.alpha;
  asset_lift::LiftPriors priors;
  priors.shape = kShape;
  asset_lift::CategoryPrior prior;
  const auto* row = physics_params::KnowledgeBase::Shipped().FindCategory(category);
  if (row != nullptr) prior = workflows::PriorOf(*row);
  core::Progress progress(core::Progress::Style::kSilent);
  try {
    const asset_lift::LiftedMesh lifted =
        asset_lift::LiftPhoto(fit_case.photo, prior, priors, options, &progress);
    return ChamferOf(truth, lifted.mesh.mesh);
  } catch (const core::Error& error) {
    std::fprintf(stderr, "free form of %s: %s\n", fit_case.name.c_str(), error.what());
    return {};
  }
}

void AddJoints(const FitCase& fit_case, const assets::ArticulatedAsset& truth,
               const FittedInstance& fit, const library_fit::FitPhoto& photo, JointScores* all,
               JointScores* main) {
  const core::Camera camera = library_fit::PhotoCamera(fit, photo);
  const bool jointed = FitKinds()[static_cast<size_t>(fit.instance.kind)].articulated != nullptr;
  const auto joints = [&](double least) {
    return jointed ? SeenJoints(library_fit::InstanceAsset(fit.instance), camera, least)
                   : std::vector<SeenJoint>{};
  };
  all->Add(CompareJoints(SeenJoints(truth, fit_case.camera, 0.0), joints(0.0)));
  main->Add(CompareJoints(SeenJoints(truth, fit_case.camera, kLeastPart), joints(kLeastPart)));
}

// Counts at which place among the network's kinds the true one is.
void AddNetworkRanks(const library_fit::LibraryPrior& prior, const library_fit::FitPhoto& photo,
                     int kind, const std::string& name, Totals* totals) {
  const std::vector<double> p =
      prior.KindProbabilities(asset_lift::CropImage(photo.photo, photo.alpha, photo.frame));
  const double ours = p[static_cast<size_t>(kind)];
  const auto before = std::count_if(p.begin(), p.end(), [&](double other) { return other > ours; });
  totals->network_right += before == 0;
  totals->among_five += before < 5;
  if (before == 0) return;
  const auto first = std::max_element(p.begin(), p.end()) - p.begin();
  std::printf("%s: the network takes it for %s (%.2f against %.2f)\n", name.c_str(),
              FitKinds()[static_cast<size_t>(first)].name.c_str(), p[static_cast<size_t>(first)],
              ours);
}

// Fits one case, prints its line, and adds its figures.
void Measure(const Settings& settings, const library_fit::LibraryPrior& prior,
             const FitCase& fit_case, const std::optional<assets::ArticulatedAsset>& joints,
             const std::string& category, Totals* totals) {
  ++totals->cases;
  core::Image alpha = fit_case.matte.alpha;
  if (settings.segment) {
    try {
      alpha = asset_lift::SegmentObject(fit_case.photo, {}).alpha;
    } catch (const core::Error& error) {
      std::printf("%s: %s\n", fit_case.name.c_str(), error.what());
      ++totals->failed;
      return;
    }
  }
  const library_fit::FitPhoto photo = library_fit::FitPhotoOf(fit_case.photo, alpha);
  if (settings.network) {
    AddNetworkRanks(prior, photo, fit_case.kind, fit_case.name, totals);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
  const std::vector<FittedInstance> fits = library_fit::FitLibrary(prior, photo);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  totals->seconds.push_back(seconds);
  const FittedInstance& best = fits.front();
  const auto likeliest =
      std::max_element(fits.begin(), fits.end(),
                       [](const auto& a, const auto& b) { return a.probability < b.probability; });
  totals->network_right += likeliest->instance.kind == fit_case.kind;
  totals->fit_right += best.instance.kind == fit_case.kind;
  FittedInstance given = best;
  if (best.instance.kind != fit_case.kind && fit_case.kind >= 0) {
    library_fit::LibraryFitOptions only;
    only.kinds = {fit_case.kind};
    given = library_fit::FitLibrary(prior, photo, only).front();
  }
  const ComparableShape truth(fit_case.visual.mesh, 1);
  const double fitted = ChamferOf(truth, library_fit::InstanceMesh(best.instance).mesh);
  totals->fitted.push_back(fitted);
  totals->given.push_back(given.instance.kind == best.instance.kind
                              ? fitted
                              : ChamferOf(truth, library_fit::InstanceMesh(given.instance).mesh));
  const std::optional<double> free_form = FreeChamfer(settings, fit_case, category, truth);
  if (free_form) totals->free_form.push_back(*free_form);
  if (joints) {
    AddJoints(fit_case, *joints, best, photo, &totals->all_kinds, &totals->main_all_kinds);
    AddJoints(fit_case, *joints, given, photo, &totals->kind_given, &totals->main_kind_given);
  }
  std::printf(
      "%-28s %-14s p %.2f score %.3f iou %.3f unexplained %.2f edges %.2f chamfer %.4f given %.4f "
      "free %.4f  %.1f s\n",
      fit_case.name.c_str(), FitKinds()[static_cast<size_t>(best.instance.kind)].name.c_str(),
      best.probability, best.score, best.iou, best.unexplained, best.edge_error, fitted,
      totals->given.back(), free_form.value_or(0.0), seconds);
  std::fflush(stdout);
}

void PrintJoints(const char* what, const JointScores& s) {
  const auto share = [](int part, int all) { return all > 0 ? 100.0 * part / all : 0.0; };
  std::printf(
      "  %-24s type %.1f %%, axis %.1f %% of %d joints; pivot %.1f %% of %d hinges; parts "
      "%.1f %% of %d objects\n",
      what, share(s.type_right, s.joints), share(s.axis_right, s.joints), s.joints,
      share(s.pivot_right, s.hinges), s.hinges, share(s.parts_right, s.objects), s.objects);
}

void PrintTotals(const char* name, const Totals& t) {
  std::printf("%s: %d photos, %d not segmented\n", name, t.cases, t.failed);
  const double fitted_cases = std::max(1, t.cases - t.failed);
  std::printf("  kind right: network %.1f %%, best fit %.1f %%\n",
              100.0 * t.network_right / fitted_cases, 100.0 * t.fit_right / fitted_cases);
  if (t.among_five > 0) {
    std::printf("  among the network's first five: %.1f %%\n", 100.0 * t.among_five / fitted_cases);
    return;
  }
  const double free_form = Median(t.free_form);
  std::printf("  median Chamfer: all kinds %.4f, kind given %.4f, free form %.4f", Median(t.fitted),
              Median(t.given), free_form);
  if (free_form > 0.0) {
    std::printf("; ratio %.2f, kind given %.2f", Median(t.fitted) / free_form,
                Median(t.given) / free_form);
  }
  std::printf("\n  median seconds of a fit %.1f\n", Median(t.seconds));
  if (t.all_kinds.objects == 0) return;
  PrintJoints("all kinds, main parts", t.main_all_kinds);
  PrintJoints("kind given, main parts", t.main_kind_given);
  PrintJoints("all kinds, all joints", t.all_kinds);
  PrintJoints("kind given, all joints", t.kind_given);
}

void MeasureLibrary(const Settings& settings, const library_fit::LibraryPrior& prior) {
  const std::vector<core::Image> backgrounds = ExampleBackgrounds();
  Totals articulated, rigid;
  int rigid_kinds = 0;
  for (size_t kind = 0; kind < FitKinds().size(); ++kind) {
    const library_fit::FitKind& of = FitKinds()[kind];
    if (!settings.only.empty() && of.name != settings.only) continue;
    if (of.articulated == nullptr && rigid_kinds++ % settings.stride != 0) continue;
    const int count = of.articulated != nullptr ? settings.count : settings.rigid;
    for (int i = 0; i < count; ++i) {
      const std::uint64_t seed = (settings.tuning ? 1'000'000 : library_fit::kHeldOutSeed + 500) +
                                 static_cast<std::uint64_t>(settings.first + i);
      const library_fit::Instance instance =
          library_fit::SampleInstance(static_cast<int>(kind), seed);
      FitCase fit_case;
      fit_case.name = of.name + " " + std::to_string(settings.first + i);
      fit_case.kind = static_cast<int>(kind);
      fit_case.visual = library_fit::InstanceMesh(instance);
      core::Rng rng = core::StreamRng(seed, 1000 + kind);
      Photograph(backgrounds, of.articulated != nullptr, &rng, &fit_case);
      std::optional<assets::ArticulatedAsset> joints;
      if (of.articulated != nullptr) joints = library_fit::InstanceAsset(instance);
      Measure(settings, prior, fit_case, joints, of.categories.front(),
              of.articulated != nullptr ? &articulated : &rigid);
    }
  }
  PrintTotals("articulated kinds", articulated);
  PrintTotals("rigid kinds", rigid);
}

// Our kind for a folder of PartNet-Mobility, or -1.
int KindOfFolder(const std::string& folder) {
  static const std::map<std::string, std::string> kKinds = {
      {"microwave", "microwave"},   {"oven", "oven"},
      {"dishwasher", "dishwasher"}, {"drawer", "drawer_unit"},
      {"laptop_rotate", "laptop"},  {"box_rotate", "box_with_lid"},
      {"switch", "light_switch"},   {"window_push", "window"}};
  const auto found = kKinds.find(folder);
  return found == kKinds.end() ? -1 : library_fit::FindFitKind(found->second);
}

std::vector<fs::path> Sorted(const fs::path& folder) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

void MeasurePartNet(const Settings& settings, const library_fit::LibraryPrior& prior) {
  const std::vector<core::Image> backgrounds = ExampleBackgrounds();
  core::Progress progress(core::Progress::Style::kSilent);
  Totals totals;
  for (const fs::path& folder : Sorted(settings.partnet)) {
    const int kind = KindOfFolder(folder.filename().string());
    if (kind < 0) continue;
    for (const fs::path& model : Sorted(folder)) {
      const fs::path urdf = importers::ArticulatedUrdfIn(model);
      if (urdf.empty()) continue;
      importers::ArticulatedImportOptions options;
      options.name = model.filename().string();
      const assets::ArticulatedAsset asset = importers::ImportArticulated(urdf, options, &progress);
      FitCase fit_case;
      fit_case.name = folder.filename().string() + " " + options.name;
      fit_case.kind = kind;
      fit_case.visual = assets::VisualAtPositions(asset);
      core::Rng rng = core::StreamRng(7, static_cast<std::uint64_t>(totals.cases));
      Photograph(backgrounds, true, &rng, &fit_case);
      Measure(settings, prior, fit_case, asset,
              FitKinds()[static_cast<size_t>(kind)].categories.front(), &totals);
    }
  }
  PrintTotals("PartNet-Mobility", totals);
}

Settings ReadSettings(int argc, char** argv) {
  Settings settings;
  settings.weights = workflows::ModelsFolder() / "library_prior.pt";
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= argc) throw core::Error(flag + " needs a value");
      return argv[++i];
    };
    if (flag == "--count")
      settings.count = std::stoi(value());
    else if (flag == "--rigid")
      settings.rigid = std::stoi(value());
    else if (flag == "--first")
      settings.first = std::stoi(value());
    else if (flag == "--stride")
      settings.stride = std::max(1, std::stoi(value()));
    else if (flag == "--segment")
      settings.segment = true;
    else if (flag == "--network")
      settings.network = true;
    else if (flag == "--tuning")
      settings.tuning = true;
    else if (flag == "--free")
      settings.free_form = value();
    else if (flag == "--only")
      settings.only = value();
    else if (flag == "--weights")
      settings.weights = value();
    else if (flag == "--partnet")
      settings.partnet = value();
    else if (flag == "--threads")
      core::SetThreadCount(std::stoi(value()));
    else
      throw core::Error("unknown option", flag);
  }
  return settings;
}

}  // namespace

int Main(int argc, char** argv) {
  const Settings settings = ReadSettings(argc, argv);
  const library_fit::LibraryPrior prior(settings.weights);
  if (settings.partnet.empty()) {
    MeasureLibrary(settings, prior);
  } else {
    MeasurePartNet(settings, prior);
  }
  return 0;
}

}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
