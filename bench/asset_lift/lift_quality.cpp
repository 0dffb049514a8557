// Measures the reconstruction of objects that were not used in training, beside an ellipsoid, the
// inflated silhouette, and the pipeline without its parts. The objects are held_out.txt's; one
// photo each, from a random azimuth and 5 to 45 degrees above, with its mask and field of view
// given.
//   bench_lift_quality [--list FILE] [--count N] [--only NAME] [--variants a,b,c] [--seed S]
//                      [--true-elevation] [--out FILE.tsv] [--resume]
//                      [--sheet FILE.png] [--sheet-variant V] [--threads N]
//   bench_lift_quality --choose [--list FILE] [--limit N]   writes the list again
//   bench_lift_quality --self-test                          of alignment and scores
//   bench_lift_quality --summary --out FILE.tsv             of a finished table
// The learned weights are searched in the program's own places: $SIMWRIGHT_MODELS, or beside it.
//
// The scores follow SF3D's protocol (Boss et al. 2024) where it is published: both shapes are
// normalized so that their bounding box is centered at the origin and its longest side spans [-1,
// 1]; rotations are searched by brute force, then refined by iterated closest points with scale;
// then Chamfer distance, F at 0.1 and volume IoU. Points are those that a ray from outside hits,
// distances go to the other shape's triangles, so that two samples of one surface have no distance:
// a Chamfer distance here is the mean of both directions.
// For novel views, the reconstructed texture contains the light of the photo, so it is rendered
// unlit, and the ground truth in the photo's light, on white. There the pose is the photo's own,
// refined: a rotation that reduces the shape distance may swap front and back.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/finding.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "held_out.h"
#include "lift_quality_measures.h"
#include "lift_quality_sheet.h"
#include "lift_quality_table.h"
#include "lift_quality_variants.h"
#include "workflows/priors/prior_weights.h"

namespace simwright::bench {
namespace fs = std::filesystem;
namespace {

constexpr double kDegree = M_PI / 180.0;
// The largest distance of a ground truth to its rotated self for a solid of revolution: a hundredth
// of the box's longest side, as of faceted glasses and plates. A mug's handle exceeds it.
constexpr double kRevolvedDefect = 0.02;

struct Settings {
  fs::path furniture = "/usr/share/sweethome3d/furniture";
  fs::path list = fs::path(SIMWRIGHT_SOURCE_DIR) / "bench" / "asset_lift" / "held_out.txt";
  fs::path out, sheet;
  std::string only, sheet_variant = "both";
  std::vector<std::string> variants = LiftVariants();
  int count = 1000, limit = 46;
  std::uint64_t seed = 1;
  bool choose = false, self_test = false, summary = false, resume = false, true_elevation = false;
};

// The ground truth of one object.
struct Truth {
  const CatalogueObject* object = nullptr;
  std::string key;  // name in the table
  size_t index = 0;
  MadePhoto made;
  double azimuth = 0.0;  // of the photo's camera, rad
  double turning_defect = 0.0;
  std::optional<ComparableShape> shape;
  std::vector<core::Image> views;
};

// Renders the photo on plain grey: segmentation is not measured here.
MadePhoto PhotoOf(const CatalogueObject& object, std::uint64_t seed, size_t index) {
  core::Rng rng = core::StreamRng(seed, index);
  return MakePhoto(object, {core::Image(64, 64, 3, 128)}, &rng);
}

Truth Prepared(const CatalogueObject& object, const std::string& key, size_t index,
               std::uint64_t seed) {
  Truth truth;
  truth.object = &object;
  truth.key = key;
  truth.index = index;
  truth.made = PhotoOf(object, seed, index);
  const Eigen::Vector3d eye =
      truth.made.camera.position() - core::Bounds(object.visual.mesh).center();
  truth.azimuth = std::atan2(eye.y(), eye.x());
  truth.shape.emplace(object.visual.mesh, seed);
  truth.turning_defect = TurningDefect(*truth.shape);
  truth.views =
      NovelViews(Moved(object.visual, truth.shape->normal_from_mesh()), truth.azimuth, true);
  return truth;
}

// Renders the reconstruction, placed by the photo's camera and refined.
std::vector<core::Image> LiftedViews(const Truth& truth, const VariantResult& lifted,
                                     const ComparableShape& shape) {
  const Eigen::Matrix3d truth_from_lift = truth.made.camera.world_from_camera.linear() *
                                          lifted.camera.world_from_camera.linear().transpose();
  const Eigen::Affine3d placed =
      AlignFrom(*truth.shape, shape, truth_from_lift) * shape.normal_from_mesh();
  return NovelViews(Moved(lifted.mesh, placed), truth.azimuth, false);
}

QualityRow Measured(const Truth& truth, const std::string& variant, const VariantSettings& settings,
                    const QualitySheet& sheet, const std::string& sheet_variant) {
  QualityRow row;
  try {
    const VariantResult lifted = LiftVariant(variant, *truth.object, truth.made, settings);
    // Another sample than the ground truth's, so that no point meets its own twin.
    const ComparableShape shape(lifted.mesh.mesh, settings.seed + 1);
    row.scores = CompareShapes(*truth.shape, shape, Align(*truth.shape, shape));
    const std::vector<core::Image> views = LiftedViews(truth, lifted, shape);
    for (size_t i = 0; i < views.size(); ++i) {
      row.psnr += PeakSignalToNoise(views[i], truth.views[i]) / static_cast<double>(views.size());
    }
    row.elevation_used = lifted.elevation / kDegree;
    row.seconds = lifted.seconds;
    row.start = lifted.start;
    if (sheet.wanted() && variant == sheet_variant) {
      sheet.Add(truth.index, truth.made.photo, views, truth.views);
    }
  } catch (const core::Cancelled&) {
    throw;
  } catch (const std::exception& error) {  // libtorch's too: one object does not end the table
    row = QualityRow::Failed(error.what());
  }
  row.object = truth.key;
  row.variant = variant;
  row.elevation = truth.made.elevation / kDegree;
  row.turning_defect = truth.turning_defect;
  row.revolved = truth.turning_defect < kRevolvedDefect;
  return row;
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto& known = LiftVariants();
    if (std::find(known.begin(), known.end(), part) == known.end()) {
      throw core::Error("there is no such variant", part);
    }
    parts.push_back(part);
  }
  return parts;
}

bool SetSwitch(const std::string& flag, Settings* settings) {
  const std::pair<const char*, bool*> switches[] = {
      {"--choose", &settings->choose},
      {"--self-test", &settings->self_test},
      {"--summary", &settings->summary},
      {"--resume", &settings->resume},
      {"--true-elevation", &settings->true_elevation}};
  for (const auto& [name, value] : switches) {
    if (flag == name) return *value = true;
  }
  return false;
}

void SetValue(const std::string& flag, const std::string& value, Settings* settings) {
  if (flag == "--list")
    settings->list = value;
  else if (flag == "--out")
    settings->out = value;
  else if (flag == "--sheet")
    settings->sheet = value;
  else if (flag == "--sheet-variant")
    settings->sheet_variant = value;
  else if (flag == "--only")
    settings->only = value;
  else if (flag == "--variants")
    settings->variants = Split(value);
  else if (flag == "--count")
    settings->count = std::atoi(value.c_str());
  else if (flag == "--limit")
    settings->limit = std::atoi(value.c_str());
  else if (flag == "--seed")
    settings->seed = std::strtoull(value.c_str(), nullptr, 10);
  else if (flag == "--threads")
    core::SetThreadCount(std::atoi(value.c_str()));
  else
    throw core::Error("unknown flag", flag);
}

Settings ParseSettings(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (SetSwitch(flag, &settings)) continue;
    if (i + 1 >= argc) throw core::Error("unknown flag, or one that needs a value", flag);
    SetValue(flag, argv[++i], &settings);
  }
  return settings;
}

int Choose(const Settings& settings) {
  const std::vector<HeldOutPiece> pieces = ChooseHeldOut(settings.furniture, settings.limit);
  WriteHeldOut(pieces, settings.list);
  std::printf("%zu objects written to %s\n", pieces.size(), settings.list.c_str());
  return 0;
}

// Returns the list indices of the chosen objects.
std::vector<size_t> Wanted(const std::vector<HeldOutPiece>& pieces, const Settings& settings) {
  std::vector<size_t> named, wanted;
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i].name.find(settings.only) != std::string::npos) named.push_back(i);
  }
  const size_t count = std::min(named.size(), static_cast<size_t>(std::max(settings.count, 0)));
  for (size_t i = 0; i < count; ++i) wanted.push_back(named[i * named.size() / count]);
  return wanted;
}

VariantSettings LoadPriors(const Settings& settings) {
  VariantSettings variants;
  core::Findings findings;
  variants.priors = workflows::LoadLiftPriors({}, &findings);
  for (const core::Finding& finding : findings) {
    std::fprintf(stderr, "%s\n", finding.sentence.c_str());
  }
  variants.true_elevation = settings.true_elevation;
  variants.seed = settings.seed;
  return variants;
}

void MeasureObject(const HeldOutPiece& piece, size_t index, const Settings& settings,
                   const VariantSettings& variants, const QualitySheet& sheet,
                   QualityTable* table) {
  const std::string key = fs::path(piece.catalogue).stem().string() + "/" + piece.name;
  std::vector<std::string> left;
  for (const std::string& variant : settings.variants) {
    const bool drawn = !sheet.wanted() || variant != settings.sheet_variant || sheet.Has(index);
    if (!table->Has(key, variant) || !drawn) left.push_back(variant);
  }
  if (left.empty()) return;
  const std::vector<CatalogueObject> object = LoadHeldOut({piece}, settings.furniture);
  const Truth truth = Prepared(object.front(), key, index, settings.seed);
  for (const std::string& variant : left) {
    core::CheckCancelled();
    const QualityRow row = Measured(truth, variant, variants, sheet, settings.sheet_variant);
    if (!table->Has(key, variant)) table->Add(row);
    PrintRow(row);
  }
}

int Run(const Settings& settings) {
  if (settings.choose) return Choose(settings);
  if (settings.summary) {
    if (!fs::exists(settings.out)) throw core::Error("--summary needs a table", settings.out);
    PrintSummary(QualityTable(settings.out, true).rows());
    return 0;
  }
  const std::vector<HeldOutPiece> pieces = ReadHeldOut(settings.list);
  if (settings.self_test) {
    const auto sample = LoadHeldOut({pieces.back()}, settings.furniture);
    return MeasuresHold(sample.front().visual.mesh) ? 0 : 1;
  }
  core::InstallCancelHandler();
  const VariantSettings variants = LoadPriors(settings);
  const QualitySheet sheet(settings.sheet, settings.resume);
  QualityTable table(settings.out, settings.resume);
  const std::vector<size_t> wanted = Wanted(pieces, settings);
  std::printf("%zu of %zu held-out objects, seed %llu, elevation %s, %d threads\n", wanted.size(),
              pieces.size(), static_cast<unsigned long long>(settings.seed),
              settings.true_elevation ? "given" : "estimated", core::ThreadCount());
  PrintRowNames();
  for (const size_t index : wanted) {
    try {
      MeasureObject(pieces[index], index, settings, variants, sheet, &table);
    } catch (const core::Error& error) {
      std::fprintf(stderr, "skipped: %s: %s\n", pieces[index].name.c_str(), error.what());
    }
  }
  PrintSummary(table.rows());
  sheet.Write();
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Run(simwright::bench::ParseSettings(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
