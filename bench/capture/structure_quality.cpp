// Measures the cameras of photos without a mat: textured objects that no training used stand on a
// textured table and are rendered from an orbit, with lens distortion, noise and JPEG compression.
//   bench_structure_quality [--objects N] [--photos N] [--width N] [--only NAME] [--cameras]
//   [--hull]
//                           [--pycolmap PYTHON] [--photos-folder DIR] [--dump DIR]
// Objects: pieces of the list held_out.txt that have a texture, thinned uniformly, at most 13 cm
// wide and 17 cm high. --cameras stops after the cameras, --hull after the hull. --pycolmap also
// runs structure from motion of COLMAP (pip install pycolmap, that Python's path) on the same
// photos.
// --photos-folder keeps the rendered photos; --dump writes masks and meshes. Columns: photos that
// were placed; camera positions after a similarity alignment with the true ones (median and worst,
// percent of the orbit's radius); the focal length's error, percent; the reprojection error,
// pixels; seconds for the cameras; then the Chamfer distance (mean of both mean distances between
// the outer surfaces, percent of the truth's diagonal) of hull and fitted mesh, in the truth's
// frame by the alignment of the cameras alone; masks' IoU (mean, least); seconds in all.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "assets/obj_file.h"
#include "bench/asset_lift/held_out.h"
#include "capture/capture_lift.h"
#include "capture/object_masks.h"
#include "capture/structure_from_motion.h"
#include "capture/table_capture.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "geometry/surface_distance.h"
#include "tests/capture/camera_alignment.h"
#include "tests/capture/mat_photos.h"

namespace simwright::bench {
namespace {
namespace fs = std::filesystem;

constexpr double kRadian = std::numbers::pi / 180.0;
constexpr double kLargestSide = 0.13, kLargestHeight = 0.17;  // m

struct Settings {
  int objects = 6, photos = 24, width = 1600;
  std::string only, python;
  bool cameras_only = false, hull_only = false;
  fs::path dump, photos_folder;
};

struct TexturedObject {
  std::string name;
  core::TexturedMesh mesh;  // stands on z = 0 at the origin, m
};

std::vector<TexturedObject> TexturedObjects(int count) {
  const fs::path list = fs::path(SIMWRIGHT_SOURCE_DIR) / "bench/asset_lift/held_out.txt";
  std::vector<TexturedObject> all;
  for (const HeldOutPiece& piece : ReadHeldOut(list)) {
    try {
      CatalogueObject object = LoadHeldOut({piece}, "/usr/share/sweethome3d/furniture")[0];
      if (!object.visual.textures.empty()) all.push_back({object.name, std::move(object.visual)});
    } catch (const core::Error& error) {
      std::fprintf(stderr, "left out: %s\n", error.what());
    }
  }
  std::vector<TexturedObject> objects;
  const std::size_t wanted = std::min(all.size(), static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < wanted; ++i) objects.push_back(all[i * all.size() / wanted]);
  for (TexturedObject& object : objects) {
    const Eigen::AlignedBox3d box = core::Bounds(object.mesh.mesh);
    const Eigen::Vector3d sides = box.sizes();
    const double scale =
        std::min({1.0, kLargestSide / std::max(sides.x(), sides.y()), kLargestHeight / sides.z()});
    const Eigen::Vector3d base(box.center().x(), box.center().y(), box.min().z());
    core::Transform(Eigen::Scaling(scale) * Eigen::Translation3d(-base), &object.mesh.mesh);
  }
  return objects;
}

struct OrbitPhotos {
  std::vector<core::Image> photos;
  std::vector<Eigen::Isometry3d> poses;
  capture::Lens lens;
};

OrbitPhotos Photograph(const TexturedObject& object, const Settings& settings) {
  capture::MatPhotoOptions options;
  options.mat = false;
  options.fine_table = true;
  options.lens = capture::PhoneLens(settings.width, settings.width * 3 / 4, 65 * kRadian);
  const double radius = std::max(0.1, 0.75 * core::Bounds(object.mesh.mesh).diagonal().norm());
  OrbitPhotos orbit;
  orbit.lens = options.lens;
  orbit.poses = capture::OrbitPoses(settings.photos, {15 * kRadian, 38 * kRadian, 62 * kRadian},
                                    radius, options.lens, 7);
  const auto file = [&](std::size_t i) {
    return settings.photos_folder / object.name / (std::to_string(i) + ".jpg");
  };
  if (!settings.photos_folder.empty() && fs::exists(file(orbit.poses.size() - 1))) {
    for (std::size_t i = 0; i < orbit.poses.size(); ++i) {
      orbit.photos.push_back(core::ReadImage(file(i)));
    }
    return orbit;
  }
  for (capture::MatPhoto& photo : capture::RenderMatPhotos(object.mesh, orbit.poses, options)) {
    orbit.photos.push_back(std::move(photo.photo));
  }
  if (settings.photos_folder.empty()) return orbit;
  fs::create_directories(settings.photos_folder / object.name);
  for (std::size_t i = 0; i < orbit.photos.size(); ++i) {
    core::WriteFile(file(i), core::EncodeJpeg(orbit.photos[i], 97));
  }
  return orbit;
}

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void PrintCameras(const std::string& name, const capture::Structure& structure,
                  const OrbitPhotos& orbit, double seconds) {
  const capture::CameraAlignment alignment = capture::AlignCameras(structure, orbit.poses);
  const double focal =
      structure.lenses.empty() ? 0.0 : 100.0 * (structure.lenses[0].fx / orbit.lens.fx - 1.0);
  std::printf("%-28s %3d/%zu %7.3f %7.3f %7.3f %6.2f %7.1f\n", name.c_str(), alignment.registered,
              orbit.photos.size(), alignment.median_percent, alignment.worst_percent, focal,
              structure.error, seconds);
  std::fflush(stdout);
}

// Runs COLMAP on the same photos and prints its figures.
void MeasureColmap(const OrbitPhotos& orbit, const Settings& settings) {
  const fs::path folder = fs::temp_directory_path() / "simwright_structure_quality";
  fs::remove_all(folder);
  fs::create_directories(folder / "photos");
  for (std::size_t i = 0; i < orbit.photos.size(); ++i) {
    core::WriteFile(folder / "photos" / (std::to_string(i) + ".jpg"),
                    core::EncodeJpeg(orbit.photos[i], 97));
  }
  const fs::path script = fs::path(SIMWRIGHT_SOURCE_DIR) / "bench/capture/run_pycolmap.py";
  const std::string command = settings.python + " " + script.string() + " " + folder.string() +
                              " > " + (folder / "log.txt").string() + " 2>&1";
  if (std::system(command.c_str()) != 0) {
    throw core::Error("failed, see its log.txt", folder.string());
  }
  const core::Json json = core::ParseJson(core::ReadFile(folder / "cameras.json"), "cameras.json");
  capture::Structure structure;
  structure.views.resize(orbit.photos.size());
  structure.lenses.resize(1);
  structure.lenses[0].fx = json.at("focal").get<double>();
  structure.error = json.at("error").get<double>();
  for (const core::Json& photo : json.at("photos")) {
    capture::Structure::View& view = structure.views[photo.at("index").get<std::size_t>()];
    view.registered = true;
    for (int k = 0; k < 3; ++k) {
      view.world_from_camera.translation()[k] =
          photo.at("position").at(static_cast<std::size_t>(k)).get<double>();
    }
  }
  PrintCameras("  pycolmap", structure, orbit, json.at("seconds").get<double>());
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

core::TriangleMesh Aligned(core::TriangleMesh mesh, const capture::CameraAlignment& alignment) {
  core::Transform(alignment.truth_from_found, &mesh);
  return mesh;
}

// Returns the mean and the least IoU of a capture's masks.
std::pair<double, double> MaskIou(const capture::Capture& capture, const core::TriangleMesh& truth,
                                  const capture::CameraAlignment& alignment) {
  core::TriangleMesh moved = truth;
  core::Transform(alignment.truth_from_found.inverse(), &moved);
  double mean = 0.0, least = 1.0;
  for (const capture::CaptureView& view : capture.views) {
    const core::FloatImage expected = capture::SilhouetteOf(moved, view.camera);
    double both = 0.0, either = 0.0;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
      const bool a = expected.values[i] >= 0.5f, b = view.opacity.values[i] >= 0.5f;
      both += a && b;
      either += a || b;
    }
    mean += both / either / static_cast<double>(capture.views.size());
    least = std::min(least, both / either);
  }
  return {mean, least};
}

void Dump(const fs::path& folder, const TexturedObject& object, const capture::Capture& capture) {
  fs::create_directories(folder);
  std::vector<core::Image> pictures;
  for (const capture::CaptureView& view : capture.views) {
    core::Image cut = view.photo;
    for (int y = 0; y < cut.height; ++y) {
      for (int x = 0; x < cut.width; ++x) {
        if (*view.opacity.At(x, y) < 0.5f) cut.At(x, y)[1] = 255;
      }
    }
    pictures.push_back(core::Resize(cut, cut.width / 2, cut.height / 2));
  }
  core::WritePng(folder / (object.name + "_masks.png"), core::ContactSheet(pictures, 6));
  core::WriteFile(folder / (object.name + "_hull.obj"), assets::ObjText(capture.hull));
}

void MeasureShape(const TexturedObject& object, const OrbitPhotos& orbit,
                  const Settings& settings) {
  capture::CaptureSource source;
  for (std::size_t i = 0; i < orbit.photos.size(); ++i) {
    source.photos.push_back({std::to_string(i), 0.0});
  }
  source.read = [&](int i) { return orbit.photos[static_cast<std::size_t>(i)]; };
  const Stopwatch watch;
  core::Progress progress;
  const capture::Capture capture = capture::CaptureOnTable(source, {}, &progress);
  for (const core::Finding& finding : capture.findings) {
    std::fprintf(stderr, "%s: %s %s\n", object.name.c_str(), finding.code.c_str(),
                 finding.place.c_str());
  }
  if (!settings.dump.empty()) Dump(settings.dump, object, capture);
  const capture::CameraAlignment alignment = capture::AlignCameras(capture, orbit.poses);
  const core::TriangleMesh& truth = object.mesh.mesh;
  const double hull = ChamferPercent(truth, Aligned(capture.hull, alignment));
  const auto [mean, least] = MaskIou(capture, truth, alignment);
  double fitted = hull;
  if (!settings.hull_only) {
    const asset_lift::LiftedMesh lifted = capture::LiftCapture(capture, {}, &progress);
    fitted = ChamferPercent(truth, Aligned(lifted.mesh.mesh, alignment));
    if (!settings.dump.empty()) {
      core::WriteFile(settings.dump / (object.name + "_fit.obj"),
                      assets::ObjText(Aligned(lifted.mesh.mesh, alignment)));
    }
  }
  std::printf("  %-26s %3d/%zu hull %.3f fit %.3f iou %.3f least %.3f %7.1f s\n", "shape",
              static_cast<int>(capture.views.size()), orbit.photos.size(), hull, fitted, mean,
              least, watch.Seconds());
  std::fflush(stdout);
}

void MeasureCameras(const TexturedObject& object, const OrbitPhotos& orbit) {
  const Stopwatch watch;
  core::Progress progress;
  capture::StructureInput input;
  for (std::size_t i = 0; i < orbit.photos.size(); ++i) {
    input.photos.push_back({orbit.lens.width, orbit.lens.height, 0.0, std::to_string(i)});
  }
  input.tracks =
      capture::FindFeatureTracks(
          static_cast<int>(orbit.photos.size()),
          [&](int i) { return orbit.photos[static_cast<std::size_t>(i)]; }, {}, &progress)
          .tracks;
  std::fprintf(stderr, "%s: %zu tracks, %.1f s\n", object.name.c_str(), input.tracks.size(),
               watch.Seconds());
  const capture::Structure structure =
      capture::ReconstructStructure(std::move(input), {}, &progress);
  PrintCameras(object.name, structure, orbit, watch.Seconds());
}

void Measure(const TexturedObject& object, const Settings& settings) {
  const OrbitPhotos orbit = Photograph(object, settings);
  MeasureCameras(object, orbit);
  if (!settings.python.empty()) MeasureColmap(orbit, settings);
  if (!settings.cameras_only) MeasureShape(object, orbit, settings);
}

Settings ParseArguments(int count, char** arguments) {
  Settings settings;
  for (int i = 1; i < count; ++i) {
    const std::string flag = arguments[i];
    if (flag == "--cameras") {
      settings.cameras_only = true;
      continue;
    }
    if (flag == "--hull") {
      settings.hull_only = true;
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
    else if (flag == "--pycolmap")
      settings.python = value;
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
  std::printf("%-28s %6s %7s %7s %7s %6s %7s\n", "object", "placed", "median", "worst", "focal",
              "pixels", "s");
  std::string names;
  bool measured = false;
  for (const TexturedObject& object : TexturedObjects(settings.objects)) {
    names += (names.empty() ? "" : ", ") + object.name;
    if (!settings.only.empty() && object.name != settings.only) continue;
    measured = true;
    try {
      Measure(object, settings);
    } catch (const core::Error& error) {
      std::printf("%-28s failed: %s\n", object.name.c_str(), error.what());
    }
  }
  if (!measured) {
    throw core::Error("there is no such object; there are: " + names, settings.only);
  }
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
