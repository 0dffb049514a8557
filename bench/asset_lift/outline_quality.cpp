// Measures reconstructions of photos with ground truth: catalogue objects, rendered on photographed
// surfaces. Prints one row per object and the medians.
//   bench_outline_quality [--count N] [--seed S] [--sheet FILE.png] [--photos FOLDER]
//                         [--only NAME] [CATALOGUE.sh3f...]
// --photos: scikit-image's data folder (Debian: python3-skimage).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "asset_lift/outline/inflation.h"
#include "core/error.h"
#include "core/image.h"
#include "core/parallel.h"
#include "geometry/solid.h"
#include "made_photos.h"
#include "render/forward.h"
#include "volume_overlap.h"

namespace simwright::bench {
namespace {

constexpr double kDegree = M_PI / 180.0;

struct Settings {
  int count = 60;
  std::uint64_t seed = 1;
  std::string sheet, only;
  std::string photos = "/usr/lib/python3/dist-packages/skimage/data";
  std::vector<std::filesystem::path> catalogues;
};

struct Row {
  bool made = false;
  std::string refusal;       // of the segmentation
  double mask_iou = 0.0;     // 0 if refused
  double elevation = 0.0;    // degrees, true
  double error_found = NAN;  // degrees, from the segmented mask
  double error_true = NAN;   // degrees, from the true mask
  double silhouette = NAN;   // of the mesh with its own matte
  const char* form = "-";
  VolumeOverlaps volume;
  std::vector<core::Image> pictures;  // photo, cut-out, mesh
  double seconds = 0.0;
};

double MaskIou(const core::Image& a, const core::Image& b) {
  double both = 0.0, either = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    both += a.pixels[i] > 127 && b.pixels[i] > 127 ? 1 : 0;
    either += a.pixels[i] > 127 || b.pixels[i] > 127 ? 1 : 0;
  }
  return either > 0.0 ? both / either : 0.0;
}

// Estimates the elevation as LiftPhoto does.
double EstimatedElevation(const asset_lift::Matte& matte, const MadePhoto& made,
                          const asset_lift::CategoryPrior& prior) {
  asset_lift::ElevationEstimate estimate = asset_lift::EstimateElevation(matte, prior);
  if (prior.revolved && !prior.round) {
    estimate = asset_lift::RefineElevation(matte, made.focal, estimate);
  }
  return std::clamp(estimate.elevation, 0.03, 1.5);
}

// Returns the photo's camera in the reconstruction's world, tilted like the true camera.
core::Camera TrueLiftCamera(const MadePhoto& made) {
  const double middle = 0.5 * (made.matte.top + made.matte.bottom) - made.camera.cy;
  return asset_lift::PhotoCamera(made.matte, made.focal,
                                 made.elevation + std::atan(middle / made.focal));
}

core::Image CutOut(const core::Image& photo, const core::Image& alpha) {
  core::Image cut = photo;
  for (int y = 0; y < photo.height; ++y) {
    for (int x = 0; x < photo.width; ++x) {
      if (alpha.At(x, y)[0] > 127) continue;
      for (int c = 0; c < 3; ++c) cut.At(x, y)[c] = c == 1 ? 0 : 255;
    }
  }
  return cut;
}

core::Image Drawn(const core::TriangleMesh& mesh, const core::Camera& camera) {
  core::TexturedMesh grey;
  grey.mesh = mesh;
  render::Scene scene;
  scene.Add(&grey);
  scene.Commit();
  render::ForwardOptions options;
  options.shaded = true;
  options.samples_per_side = 2;
  const core::Image color = render::RenderForward(scene, camera, options).color;
  core::Image opaque(color.width, color.height, 3, 255);
  for (int y = 0; y < color.height; ++y) {
    for (int x = 0; x < color.width; ++x) {
      const std::uint8_t* p = color.At(x, y);
      for (int c = 0; c < 3; ++c) {
        opaque.At(x, y)[c] = static_cast<std::uint8_t>((p[3] * p[c] + (255 - p[3]) * 255) / 255);
      }
    }
  }
  return opaque;
}

// Runs the pipeline's own steps on both masks.
void Lift(const CatalogueObject& object, const MadePhoto& made, Row* row) {
  core::Image alpha(made.photo.width, made.photo.height, 1);
  try {
    asset_lift::SegmentationOptions options;
    options.round_object = object.prior.round;
    const asset_lift::Matte found = asset_lift::SegmentObject(made.photo, std::nullopt, options);
    alpha = found.alpha;
    row->mask_iou = MaskIou(found.alpha, made.matte.alpha);
    const double elevation = EstimatedElevation(found, made, object.prior);
    row->error_found = std::abs(elevation - made.elevation) / kDegree;
    row->silhouette =
        asset_lift::InflateOutline(found, asset_lift::PhotoCamera(found, made.focal, elevation),
                                   object.prior)
            .silhouette_iou;
  } catch (const core::Error& error) {
    row->refusal = error.what();
  }
  row->error_true =
      std::abs(EstimatedElevation(made.matte, made, object.prior) - made.elevation) / kDegree;
  row->pictures = {made.photo, CutOut(made.photo, alpha)};
}

void Compare(const CatalogueObject& object, const MadePhoto& made, std::uint64_t seed, Row* row) {
  const core::Camera camera = TrueLiftCamera(made);
  const asset_lift::InflatedShape shape =
      asset_lift::InflateOutline(made.matte, camera, object.prior);
  row->form = asset_lift::Name(shape.form);
  // A coarse grid suffices for volumes to a few percent.
  geometry::SolidOptions coarse;
  coarse.cell_ratio = 0.006;
  coarse.tolerance_ratio = 0.012;
  coarse.sheet_thickness_ratio = 0.0108;
  core::TriangleMesh truth = geometry::MakeSolid(object.visual.mesh, coarse).mesh;
  core::Transform(
      Eigen::Affine3d(camera.world_from_camera * made.camera.world_from_camera.inverse()), &truth);
  const double depth = camera.Project(Eigen::Vector3d::Zero()).z();
  row->volume = CompareVolumes(truth, shape.mesh, camera, made.matte, depth, 60000, seed);
  row->pictures.push_back(Drawn(shape.mesh, camera));
}

Row Measure(const CatalogueObject& object, const std::vector<core::Image>& backgrounds,
            std::uint64_t seed, int index) {
  const auto start = std::chrono::steady_clock::now();
  Row row;
  try {
    core::Rng rng = core::StreamRng(seed, static_cast<std::uint64_t>(index));
    const MadePhoto made = MakePhoto(object, backgrounds, &rng);
    row.elevation = made.elevation / kDegree;
    Lift(object, made, &row);
    Compare(object, made, seed, &row);
    row.made = true;
  } catch (const core::Error& error) {
    std::fprintf(stderr, "skipped: %s: %s\n", object.name.c_str(), error.what());
  }
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::fprintf(stderr, "%3d %s: mask %.3f, elevation error %.1f, volume %.3f %.3f %.3f\n", index,
               object.name.c_str(), row.mask_iou, row.error_found, row.volume.ours,
               row.volume.ellipsoid, row.volume.extrusion);
  return row;
}

double Median(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  if (values.empty()) return NAN;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void PrintRow(const CatalogueObject& object, const Row& row) {
  std::printf("%-26.26s %-16.16s %5.1f %6.3f %6.1f %6.1f %6.3f %-14s %6.3f %6.3f %6.3f %5.1f %s\n",
              object.name.c_str(), object.category.c_str(), row.elevation, row.mask_iou,
              row.error_found, row.error_true, row.silhouette, row.form, row.volume.ours,
              row.volume.ellipsoid, row.volume.extrusion, row.seconds, row.refusal.c_str());
}

void PrintMedians(const std::vector<Row>& rows) {
  const auto median = [&](auto value) {
    std::vector<double> values;
    for (const Row& row : rows) {
      if (row.made) values.push_back(value(row));
    }
    return Median(values);
  };
  int made = 0, refused = 0;
  for (const Row& row : rows) {
    made += row.made ? 1 : 0;
    refused += row.made && !row.refusal.empty() ? 1 : 0;
  }
  std::printf("\nmedians of %d objects (%d not cut out, counted with a mask IoU of 0)\n", made,
              refused);
  std::printf("mask IoU                            %.3f\n",
              median([](const Row& r) { return r.mask_iou; }));
  std::printf("elevation error, mask found         %.1f degrees\n",
              median([](const Row& r) { return r.error_found; }));
  std::printf("elevation error, true mask          %.1f degrees\n",
              median([](const Row& r) { return r.error_true; }));
  std::printf("silhouette IoU, mesh with its mask  %.3f\n",
              median([](const Row& r) { return r.silhouette; }));
  std::printf("volume IoU, inflated                %.3f\n",
              median([](const Row& r) { return r.volume.ours; }));
  std::printf("volume IoU, ellipsoid               %.3f\n",
              median([](const Row& r) { return r.volume.ellipsoid; }));
  std::printf("volume IoU, extrusion               %.3f\n",
              median([](const Row& r) { return r.volume.extrusion; }));
}

// Writes ten rows, spread over the objects: photo, cut-out, mesh from the true mask.
void WriteSheet(const std::vector<Row>& rows, const std::string& file) {
  std::vector<const Row*> made;
  for (const Row& row : rows) {
    if (row.made) made.push_back(&row);
  }
  std::vector<core::Image> pictures;
  const size_t count = std::min<size_t>(10, made.size());
  for (size_t i = 0; i < count; ++i) {
    for (const core::Image& picture : made[i * made.size() / count]->pictures) {
      pictures.push_back(core::Resize(picture, 200, 200));
    }
  }
  core::WritePng(file, core::ContactSheet(pictures, 6));
}

Settings ParseSettings(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag.rfind("--", 0) != 0) {
      settings.catalogues.emplace_back(flag);
      continue;
    }
    if (i + 1 >= argc) throw core::Error("needs a value", flag);
    const std::string value = argv[++i];
    if (flag == "--count")
      settings.count = std::atoi(value.c_str());
    else if (flag == "--seed")
      settings.seed = std::strtoull(value.c_str(), nullptr, 10);
    else if (flag == "--sheet")
      settings.sheet = value;
    else if (flag == "--photos")
      settings.photos = value;
    else if (flag == "--only")
      settings.only = value;
    else
      throw core::Error("unknown flag", flag);
  }
  if (settings.catalogues.empty()) {
    const std::filesystem::path folder = "/usr/share/sweethome3d/furniture";
    settings.catalogues = {folder / "BlendSwap-CC-0.sh3f", folder / "KatorLegaz.sh3f"};
  }
  return settings;
}

int Run(const Settings& settings) {
  std::vector<CatalogueObject> objects = HouseholdObjects(settings.catalogues, settings.count);
  const std::vector<core::Image> backgrounds = Backgrounds(settings.photos);
  std::printf("%zu objects, %zu backgrounds, seed %llu\n", objects.size(), backgrounds.size(),
              static_cast<unsigned long long>(settings.seed));
  std::vector<Row> rows(objects.size());
  core::ParallelFor(static_cast<int>(objects.size()), [&](int i) {
    const size_t at = static_cast<size_t>(i);
    if (objects[at].name.find(settings.only) == std::string::npos) return;
    rows[at] = Measure(objects[at], backgrounds, settings.seed, i);
  });
  std::printf("%-26s %-16s %5s %6s %6s %6s %6s %-14s %6s %6s %6s %5s\n", "object", "category",
              "elev", "mask", "e.fnd", "e.true", "silh", "form", "v.ours", "v.ell", "v.ext", "s");
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].made) PrintRow(objects[i], rows[i]);
  }
  PrintMedians(rows);
  if (!settings.sheet.empty()) WriteSheet(rows, settings.sheet);
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
