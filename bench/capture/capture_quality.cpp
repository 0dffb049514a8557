// Measures the reconstruction from photos on a mat: objects that no training used are rendered on a
// mat from an orbit, with lens distortion, noise and JPEG compression, and reconstructed.
//   bench_capture_quality [--objects N] [--photos N] [--width N] [--only NAME] [--hull] [--develop]
//                         [--photos-folder DIR [--render]] [--dump DIR] [--no-stereo]
// Objects: pieces of the list held_out.txt and library kinds of seeds from 9101 on, alternating,
// scaled down where they do not fit on A4. --develop takes pieces of other catalogues and other
// seeds (7001 on): settings are chosen on these. --photos-folder keeps the rendered photos,
// --render stops there; --dump writes masks and meshes; --hull stops after the fit's start,
// --no-stereo leaves out its stereo. Columns: the Chamfer
// distance (mean of both mean distances between the outer surfaces, in percent of the truth's
// diagonal, without any alignment: the mat's frame is the truth's) of the hull, of the start
// without stereo, of the start and of the fitted mesh; the errors of its diagonal (percent) and of
// its sides (the largest, percent of the longest); the cameras' position error (percent of the
// distance); the reprojection error (pixels); masks' IoU (mean, least) and the mean distance of
// their outlines outside the true ones (pixels); the share of the object's pixels whose depth
// stereo found (percent), the median and the ninth decile of its error (percent of the diagonal);
// seconds to the hull, for the start, all.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "assets/mesh_import.h"
#include "assets/obj_file.h"
#include "bench/asset_lift/held_out.h"
#include "capture/capture.h"
#include "capture/capture_lift.h"
#include "capture/object_masks.h"
#include "capture/start_shape.h"
#include "core/error.h"
#include "core/files.h"
#include "geometry/surface_distance.h"
#include "library/rigid/rigid_kinds.h"
#include "render/forward.h"
#include "tests/capture/mat_photos.h"

namespace simwright::bench {
namespace {
namespace fs = std::filesystem;

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr const char* kFurniture = "/usr/share/sweethome3d/furniture";
constexpr double kLargestSide = 0.13, kLargestHeight = 0.17;  // m, of objects on A4

struct Settings {
  int objects = 20, photos = 24, width = 1600;
  std::string only;
  bool hull_only = false, develop = false, render_only = false, no_stereo = false;
  fs::path photos_folder, dump;
};

struct CapturedObject {
  std::string name;
  core::TexturedMesh mesh;  // stands on z = 0 at the origin, m
};

// Places the object on the mat, scaled down where it does not fit.
void PlaceOnMat(core::TexturedMesh* object) {
  const Eigen::AlignedBox3d box = core::Bounds(object->mesh);
  const Eigen::Vector3d sides = box.sizes();
  const double scale =
      std::min({1.0, kLargestSide / std::max(sides.x(), sides.y()), kLargestHeight / sides.z()});
  const Eigen::Vector3d base(box.center().x(), box.center().y(), box.min().z());
  core::Transform(Eigen::Scaling(scale) * Eigen::Translation3d(-base), &object->mesh);
}

std::vector<CatalogueObject> HeldOutPieces() {
  const fs::path list = fs::path(SIMWRIGHT_SOURCE_DIR) / "bench/asset_lift/held_out.txt";
  std::vector<CatalogueObject> pieces;
  for (const HeldOutPiece& piece : ReadHeldOut(list)) {
    try {
      pieces.push_back(LoadHeldOut({piece}, kFurniture)[0]);
    } catch (const core::Error& error) {
      std::fprintf(stderr, "left out: %s\n", error.what());
    }
  }
  return pieces;
}

std::vector<CatalogueObject> DevelopmentPieces() {
  std::vector<CatalogueObject> pieces;
  for (const char* catalogue : {"BlendSwap-CC-0.sh3f", "Scopia.sh3f"}) {
    constexpr int kMost = 10;
    for (CatalogueObject& piece : HouseholdObjects({fs::path(kFurniture) / catalogue}, kMost)) {
      pieces.push_back(std::move(piece));
    }
  }
  return pieces;
}

std::vector<CapturedObject> Objects(const Settings& settings) {
  const int count = settings.objects;
  std::vector<CapturedObject> objects;
  const std::vector<CatalogueObject> pieces =
      settings.develop ? DevelopmentPieces() : HeldOutPieces();
  for (int i = 0; i < count / 2 && !pieces.empty(); ++i) {
    const CatalogueObject& piece =
        pieces[static_cast<std::size_t>(i) * pieces.size() / static_cast<std::size_t>(count / 2)];
    objects.push_back({piece.name, piece.visual});
  }
  const std::vector<library::RigidKind>& kinds = library::RigidKinds();
  const int library = count - static_cast<int>(objects.size());
  const std::uint64_t seed = settings.develop ? 7001 : 9101;
  for (int i = 0; i < library; ++i) {
    const library::RigidKind& kind =
        kinds[static_cast<std::size_t>(i) * kinds.size() / static_cast<std::size_t>(library)];
    objects.push_back(
        {kind.name, library::MakeRigidObject(kind, seed + static_cast<std::uint64_t>(i)).visual});
  }
  for (CapturedObject& object : objects) PlaceOnMat(&object.mesh);
  return objects;
}

// Renders the photos, or reads those of an earlier run.
std::vector<core::Image> PhotosOf(const CapturedObject& object, const Settings& settings,
                                  const capture::MatPhotoOptions& options,
                                  const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<core::Image> photos;
  const auto file = [&](std::size_t i) {
    return settings.photos_folder / object.name / (std::to_string(i) + ".jpg");
  };
  if (!settings.photos_folder.empty() && fs::exists(file(poses.size() - 1))) {
    for (std::size_t i = 0; i < poses.size(); ++i) photos.push_back(core::ReadImage(file(i)));
    return photos;
  }
  for (capture::MatPhoto& photo : capture::RenderMatPhotos(object.mesh, poses, options)) {
    photos.push_back(std::move(photo.photo));
  }
  if (settings.photos_folder.empty()) return photos;
  fs::create_directories(settings.photos_folder / object.name);
  for (std::size_t i = 0; i < photos.size(); ++i) {
    core::WriteFile(file(i), core::EncodeJpeg(photos[i], 97));
  }
  return photos;
}

// Returns the Chamfer distance in percent of the truth's diagonal.
double ChamferPercent(const core::TriangleMesh& truth, const core::TriangleMesh& mesh) {
  const auto mean = [](const core::TriangleMesh& from, const core::TriangleMesh& to) {
    double sum = 0.0;
    const std::vector<double> distances =
        geometry::DistancesToSurface(geometry::SampleOuterSurface(from, 20000, 1), to);
    for (const double d : distances) sum += d;
    return sum / static_cast<double>(distances.size());
  };
  return 100.0 * 0.5 * (mean(truth, mesh) + mean(mesh, truth)) /
         core::Bounds(truth).diagonal().norm();
}

struct MaskScore {
  double mean = 0.0, least = 1.0;
  double bias = 0.0;  // mean distance of the masks' outlines outside the true ones, pixels
};

MaskScore MaskIou(const capture::Capture& capture, const core::TriangleMesh& truth) {
  MaskScore score;
  for (const capture::CaptureView& view : capture.views) {
    const core::FloatImage expected = capture::SilhouetteOf(truth, view.camera);
    double both = 0.0, either = 0.0, outline = 0.0, excess = 0.0;
    const int width = expected.width;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      excess += view.opacity.values[i] - expected.values[i];
      if (i >= static_cast<std::size_t>(width)) {
        outline += std::hypot(expected.values[i] - expected.values[i - 1],
                              expected.values[i] - expected.values[i - width]);
      }
      const bool a = expected.values[i] >= 0.5f, b = view.opacity.values[i] >= 0.5f;
      both += a && b;
      either += a || b;
    }
    score.bias += excess / outline / static_cast<double>(capture.views.size());
    score.mean += both / either / static_cast<double>(capture.views.size());
    score.least = std::min(score.least, both / either);
  }
  return score;
}

double PositionError(const capture::Capture& capture, const std::vector<Eigen::Isometry3d>& poses) {
  double worst = 0.0;
  for (const capture::CaptureView& view : capture.views) {
    const Eigen::Vector3d truth = poses[static_cast<std::size_t>(view.index)].translation();
    worst = std::max(worst, (view.camera.position() - truth).norm() / truth.norm());
  }
  return 100.0 * worst;
}

void Dump(const fs::path& folder, const CapturedObject& object, const capture::Capture& capture) {
  fs::create_directories(folder);
  std::vector<core::Image> pictures;
  for (const capture::CaptureView& view : capture.views) {
    core::Image cut = view.photo;
    const core::FloatImage truth = capture::SilhouetteOf(object.mesh.mesh, view.camera);
    for (int y = 0; y < cut.height; ++y) {
      for (int x = 0; x < cut.width; ++x) {
        std::uint8_t* pixel = cut.At(x, y);
        if ((*view.opacity.At(x, y) >= 0.5f) != (*truth.At(x, y) >= 0.5f)) {
          pixel[0] = *truth.At(x, y) >= 0.5f ? 0 : 255;
          pixel[1] = 0;
          pixel[2] = *truth.At(x, y) >= 0.5f ? 255 : 0;
          continue;
        }
        if (*view.opacity.At(x, y) >= 0.5f) continue;
        pixel[0] = static_cast<std::uint8_t>(pixel[0] / 4);
        pixel[1] = static_cast<std::uint8_t>(128 + pixel[1] / 4);
        pixel[2] = static_cast<std::uint8_t>(pixel[2] / 4);
      }
    }
    pictures.push_back(cut);
  }
  core::WritePng(folder / (object.name + "_masks.png"), core::ContactSheet(pictures, 6));
  core::WriteFile(folder / (object.name + "_hull.obj"), assets::ObjText(capture.hull));
  core::WriteFile(folder / (object.name + "_truth.obj"), assets::ObjText(object.mesh.mesh));
}

struct SizeErrors {
  double scale = 0.0;  // of the diagonal, percent
  double side = 0.0;   // the largest of a side, percent of the longest side
};

SizeErrors SizeErrorsOf(const core::TriangleMesh& truth, const core::TriangleMesh& mesh) {
  const Eigen::Vector3d a = core::Bounds(truth).sizes(), b = core::Bounds(mesh).sizes();
  return {100.0 * (b.norm() / a.norm() - 1.0),
          100.0 * (b - a).cwiseAbs().maxCoeff() / a.maxCoeff()};
}

struct DepthScore {
  double median = 0.0, ninth_decile = 0.0;  // of the errors, percent of the truth's diagonal
};

// Compares the depths that stereo found with the truth's.
DepthScore DepthErrors(const core::TexturedMesh& truth, const capture::StartShape& start) {
  render::Scene scene;
  scene.Add(&truth);
  scene.Commit();
  std::vector<double> errors;
  for (const asset_lift::ObservedView& view : start.views) {
    if (view.depth.empty()) continue;
    const render::ForwardBuffers expected = render::RenderForward(scene, view.camera);
    for (std::size_t i = 0; i < expected.depth.size(); ++i) {
      if (!(view.depth.values[i] > 0.0f && expected.depth[i] > 0.0f)) continue;
      errors.push_back(std::abs(view.depth.values[i] - expected.depth[i]));
    }
  }
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const double percent = 100.0 / core::Bounds(truth.mesh).diagonal().norm();
  return {percent * errors[errors.size() / 2], percent * errors[errors.size() * 9 / 10]};
}

// Returns the Chamfer distance of the final mesh, percent.
double Measure(const CapturedObject& object, const Settings& settings) {
  capture::MatPhotoOptions options;
  options.lens = capture::PhoneLens(settings.width, settings.width * 3 / 4, 65 * kRadian);
  const double radius = std::max(0.12, 0.75 * core::Bounds(object.mesh.mesh).diagonal().norm());
  const auto poses = capture::OrbitPoses(
      settings.photos, {15 * kRadian, 38 * kRadian, 62 * kRadian}, radius, options.lens, 7);
  const std::vector<core::Image> photos = PhotosOf(object, settings, options, poses);
  if (settings.render_only) return 0.0;
  capture::CaptureSource source;
  for (std::size_t i = 0; i < photos.size(); ++i) source.photos.push_back({std::to_string(i), 0.0});
  source.read = [&](int i) { return photos[static_cast<std::size_t>(i)]; };
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  core::Progress progress;
  const capture::Capture capture = capture::CaptureOnMat(source, {}, &progress);
  const double hull_seconds = seconds();
  const MaskScore masks = MaskIou(capture, object.mesh.mesh);
  const double hull = ChamferPercent(object.mesh.mesh, capture.hull);
  if (!settings.dump.empty()) Dump(settings.dump, object, capture);
  capture::CaptureLiftOptions lift;
  lift.start.use_stereo = !settings.no_stereo;
  const double before_start = seconds();
  const capture::StartShape first =
      capture::MakeStartShape(capture, lift.fit_side, lift.start, &progress);
  const double start_seconds = seconds() - before_start;
  const DepthScore depths = DepthErrors(object.mesh, first);
  const double started = ChamferPercent(object.mesh.mesh, first.mesh);
  if (!settings.dump.empty()) {
    core::WriteFile(settings.dump / (object.name + "_start.obj"), assets::ObjText(first.mesh));
  }
  double fitted = started;
  SizeErrors size = SizeErrorsOf(object.mesh.mesh, first.mesh);
  double all_seconds = hull_seconds + start_seconds;
  if (!settings.hull_only) {
    const auto begin = std::chrono::steady_clock::now();
    const asset_lift::LiftedMesh lifted = capture::LiftCapture(capture, first, lift, &progress);
    all_seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fitted = ChamferPercent(object.mesh.mesh, lifted.mesh.mesh);
    size = SizeErrorsOf(object.mesh.mesh, lifted.mesh.mesh);
    if (!settings.dump.empty()) {
      core::WriteFile(settings.dump / (object.name + "_fit.obj"),
                      assets::ObjText(lifted.mesh.mesh));
    }
  }
  std::printf(
      "%-22s %6.2f %6.2f %6.2f %+6.2f %6.2f %6.2f %6.2f %6.3f %6.3f %6.2f %6.1f %6.2f %6.2f %6.1f "
      "%6.1f %6.1f\n",
      object.name.c_str(), hull, started, fitted, size.scale, size.side,
      PositionError(capture, poses), capture.calibration.error, masks.mean, masks.least, masks.bias,
      100.0 * first.depth_share, depths.median, depths.ninth_decile, hull_seconds, start_seconds,
      all_seconds);
  std::fflush(stdout);
  return fitted;
}

Settings ParseArguments(int count, char** arguments) {
  Settings settings;
  for (int i = 1; i < count; ++i) {
    const std::string flag = arguments[i];
    bool* given = flag == "--hull"        ? &settings.hull_only
                  : flag == "--develop"   ? &settings.develop
                  : flag == "--render"    ? &settings.render_only
                  : flag == "--no-stereo" ? &settings.no_stereo
                                          : nullptr;
    if (given != nullptr) {
      *given = true;
      continue;
    }
    if (i + 1 >= count) throw core::Error("needs a value", flag);
    const std::string value = arguments[++i];
    if (flag == "--objects")
      settings.objects = std::stoi(value);
    else if (flag == "--photos")
      settings.photos = std::stoi(value);
    else if (flag == "--width")
      settings.width = std::stoi(value);
    else if (flag == "--only")
      settings.only = value;
    else if (flag == "--photos-folder")
      settings.photos_folder = value;
    else if (flag == "--dump")
      settings.dump = value;
    else
      throw core::Error("is no option", flag);
  }
  return settings;
}

int Main(int count, char** arguments) {
  const Settings settings = ParseArguments(count, arguments);
  std::printf("%-22s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s %6s\n", "object",
              "hull", "start", "fit", "scale", "side", "camera", "pixels", "iou", "least", "bias",
              "stereo", "error", "90 %", "s", "start s", "all s");
  std::vector<double> all;
  std::string names;
  for (const CapturedObject& object : Objects(settings)) {
    names += (names.empty() ? "" : ", ") + object.name;
    if (!settings.only.empty() && object.name != settings.only) continue;
    try {
      all.push_back(Measure(object, settings));
    } catch (const core::Error& error) {
      std::printf("%-22s failed: %s\n", object.name.c_str(), error.what());
      std::fflush(stdout);
      all.push_back(100.0);
    }
  }
  if (all.empty()) throw core::Error("there is no such object; there are: " + names, settings.only);
  std::sort(all.begin(), all.end());
  std::printf("median %.3f %% of the diagonal, worst %.3f %%, %zu objects\n", all[all.size() / 2],
              all.back(), all.size());
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int count, char** arguments) {
  try {
    return simwright::bench::Main(count, arguments);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
