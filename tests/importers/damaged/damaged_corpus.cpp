#include "tests/importers/damaged/damaged_corpus.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/progress.h"
#include "geometry/mass_properties.h"
#include "library/rigid/rigid_kinds.h"
#include "physics_params/size_plausibility.h"
#include "tests/importers/damaged/column_volume.h"
#include "tests/importers/damaged/specimen_file.h"
#include "workflows/import/import.h"

namespace simwright::damaged {
namespace {

constexpr std::array<const char*, 30> kCorpusKinds = {
    "mug",      "bowl",         "cereal_box",   "bottle", "apple",       "plate",
    "spoon",    "vase",         "brick",        "can",    "frying_pan",  "milk_carton",
    "pear",     "tray",         "jar",          "die",    "candle",      "hammer",
    "saucepan", "soap",         "toilet_paper", "goblet", "lemon",       "speaker",
    "bucket",   "wooden_spoon", "egg",          "box",    "pepper_mill", "cutting_board"};
constexpr std::array<const char*, 4> kFormats = {"glb", "obj", "ply", "stl"};
constexpr std::uint64_t kCorpusSeed = 2024;
constexpr int kSoundColumns = 600;
constexpr double kSideTolerance = 0.02, kVolumeTolerance = 0.05;

const Damage& DamageNamed(const std::string& name) {
  const auto& all = Damages();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Damage& d) { return d.name == name; });
  if (found == all.end()) throw core::Error("no such damage", name);
  return *found;
}

// Chooses `count` damages, the first of which is given, none twice and one of a group.
std::vector<std::string> ChooseDamages(std::size_t first, int count, core::Rng* rng) {
  const auto& all = Damages();
  std::set<std::size_t> chosen{first};
  while (static_cast<int>(chosen.size()) < count) {
    const auto next = static_cast<std::size_t>(core::UniformIndex(*rng, std::ssize(all)));
    const bool excluded = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t other) {
      return all[next].group != 0 && all[other].group == all[next].group;
    });
    if (!excluded) chosen.insert(next);
  }
  std::vector<std::string> names;
  for (const std::size_t index : chosen) names.push_back(all[index].name);
  return names;
}

// Findings that tell the user to look at the size or the shape.
bool Warns(const core::Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const core::Finding& finding) {
    return finding.severity != core::Severity::kInfo &&
           (finding.code.starts_with("size-") || finding.code.starts_with("unit-") ||
            finding.code.starts_with("mesh-") || finding.code.starts_with("solid-") ||
            finding.code == "unusual-size" || finding.code == "surface-distance");
  });
}

void Compare(const Specimen& specimen, const assets::Asset& asset, Trial* trial) {
  core::TriangleMesh solid = asset.solid;
  core::Transform(Eigen::Affine3d(asset.link_from_input.inverse()), &solid);
  Eigen::Vector3d sides = core::Bounds(solid).sizes();
  std::sort(sides.data(), sides.data() + 3);
  const double volume = geometry::SolidMassProperties(solid, 1.0).volume;
  double scale = 1.0;
  if (!specimen.scale_known) scale = std::cbrt(sides.prod() / specimen.sides.prod());
  const Eigen::Vector3d ratios = sides.cwiseQuotient(scale * specimen.sides);
  trial->side_error = (ratios - Eigen::Vector3d::Ones()).cwiseAbs().maxCoeff();
  trial->volume_error = volume / (std::pow(scale, 3) * specimen.volume) - 1.0;
  const bool right = trial->side_error <= kSideTolerance &&
                     std::abs(trial->volume_error) <= kVolumeTolerance &&
                     (specimen.scale_known || Warns(trial->findings));
  trial->verdict = right                    ? Verdict::kRight
                   : Warns(trial->findings) ? Verdict::kWrongAndSaid
                                            : Verdict::kWrongInSilence;
}

}  // namespace

const char* Name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kRight:
      return "right";
    case Verdict::kRefused:
      return "refused";
    case Verdict::kWrongAndSaid:
      return "wrong, said";
    case Verdict::kWrongInSilence:
      return "WRONG IN SILENCE";
  }
  return "";
}

std::vector<Recipe> CorpusRecipes() {
  std::vector<Recipe> recipes;
  const std::size_t damages = Damages().size();
  for (std::size_t i = 0; i < kCorpusFiles; ++i) {
    core::Rng rng = core::StreamRng(kCorpusSeed, i);
    Recipe recipe;
    // 7 has no factor in common with 30: each round of 30 files has each kind once.
    recipe.kind = kCorpusKinds[(7 * i + i / 30) % kCorpusKinds.size()];
    recipe.damages = ChooseDamages(i % damages, 1 + static_cast<int>(i / damages) % 4, &rng);
    recipe.format = kFormats[static_cast<std::size_t>(core::UniformIndex(rng, kFormats.size()))];
    recipe.seed = 1 + i;
    char number[8];
    std::snprintf(number, sizeof number, "%03zu", i);
    recipe.name = std::string(number) + "-" + recipe.kind;
    for (const std::string& damage : recipe.damages) recipe.name += "-" + damage;
    recipes.push_back(recipe);
  }
  return recipes;
}

Specimen SoundSpecimen(const std::string& kind, std::uint64_t seed) {
  const library::RigidKind* const found = library::FindRigidKind(kind);
  if (found == nullptr) throw core::Error("no such kind", kind);
  Specimen specimen;
  specimen.kind = kind;
  specimen.category = found->category;
  specimen.mesh = library::MakeRigidObject(*found, seed).visual.mesh;
  specimen.volume = ColumnVolume(specimen.mesh, kSoundColumns).Volume();
  specimen.sides = core::Bounds(specimen.mesh).sizes();
  specimen.true_height = specimen.sides.z();
  std::sort(specimen.sides.data(), specimen.sides.data() + 3);
  return specimen;
}

Specimen DamagedSpecimen(const Recipe& recipe) {
  Specimen specimen = SoundSpecimen(recipe.kind, recipe.seed);
  specimen.format = recipe.format;
  if (specimen.format == "obj") specimen.up = 'z';
  core::Rng rng = core::StreamRng(kCorpusSeed, 1000 + recipe.seed);
  for (const std::string& name : recipe.damages) DamageNamed(name).apply(&specimen, &rng);
  return specimen;
}

Trial ImportSpecimen(const Specimen& specimen, const std::string& name,
                     const std::filesystem::path& folder) {
  const std::filesystem::path file = WriteSpecimen(specimen, name, folder);
  workflows::ImportOptions options;
  options.category = specimen.category;
  options.up = specimen.format == "glb" ? 0 : specimen.up;
  options.height = specimen.height;
  options.force = true;
  if (!specimen.unit.empty()) {
    options.unit = physics_params::MetresOfUnit(specimen.unit);
    options.unit_stated = true;
  }
  core::Progress progress;
  const std::vector<workflows::ImportOutcome> outcomes = workflows::ImportAll(
      workflows::ListImports({file}, options), folder / "out", options, &progress);
  const workflows::ImportOutcome& outcome = outcomes.at(0);
  Trial trial;
  trial.findings = outcome.findings;
  trial.seconds = outcome.seconds.at("total");
  trial.reason = outcome.refusal;
  if (outcome.refusal.empty()) Compare(specimen, assets::ReadAsset(outcome.folder), &trial);
  return trial;
}

}  // namespace simwright::damaged
