// Rebuilds rendered tables of library objects that no training used, and compares kinds, poses and
// sizes with the truth.
//   bench_twin_table [--count N] [--first N] [--camera known|unknown] [--detector FILE]
//                    [--photos FOLDER] [--tuning] [--threads N]
// --count: tables (60), from number --first (0) on. --camera unknown: elevation, focal length, roll
// and height are guessed, by the detector or, without one, with errors of 4.6 degrees, 12 %, 1.1
// degrees and 20 %; positions and yaws are then compared after a rigid alignment in the plane.
// --detector: weights; without them the true masks are given. --tuning: instances of training
// seeds, for choosing settings. --photos: what is behind and below the objects.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "library_fit/library_prior.h"
#include "rl/wilson_interval.h"
#include "twin/scene_sources.h"
#include "twin_judgement.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"

namespace simwright::bench {
namespace {

constexpr std::uint64_t kHeldOut = 1'000'000'000;
constexpr double kPosition = 0.02, kYaw = 10.0 * M_PI / 180.0,
                 kSize = 0.0953;  // 2 cm, 10 deg, 10 %

struct Options {
  int count = 60, first = 0;
  bool unknown = false, tuning = false;
  std::string detector;
  std::vector<std::filesystem::path> photos;
};

Options Parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string flag = argv[i];
    if (flag == "--tuning") {
      options.tuning = true;
      continue;
    }
    if (i + 1 >= argc) throw core::Error("the option needs a value", flag);
    const std::string value = argv[++i];
    if (flag == "--count") {
      options.count = std::atoi(value.c_str());
    } else if (flag == "--first") {
      options.first = std::atoi(value.c_str());
    } else if (flag == "--camera") {
      options.unknown = value == "unknown";
    } else if (flag == "--detector") {
      options.detector = value;
    } else if (flag == "--photos") {
      options.photos.emplace_back(value);
    } else if (flag == "--threads") {
      core::SetThreadCount(std::atoi(value.c_str()));
    } else {
      throw core::Error("no such option", flag);
    }
  }
  return options;
}

struct Sums {
  int truths = 0, found = 0, wrong = 0;
  int kinds = 0, positions = 0, yaws = 0, poses = 0, sizes = 0;
  std::vector<double> position_sigmas, size_sigmas, elevation, focal, height;
  double seconds = 0.0;
};

// The guess of a camera with known errors, for tables without a detector.
twin::TableCameraGuess GuessNear(const twin::TableCamera& truth, bool unknown, core::Rng* rng) {
  twin::TableCameraGuess guess;
  guess.camera = truth;
  guess.elevation_error = unknown ? 0.08 : 0.0;
  guess.roll_error = unknown ? 0.02 : 0.0;
  guess.log_focal_error = unknown ? 0.12 : 0.0;
  guess.log_height_error = unknown ? 0.2 : 0.0;
  guess.camera.elevation += guess.elevation_error * core::Normal(*rng);
  guess.camera.roll += guess.roll_error * core::Normal(*rng);
  guess.camera.focal *= std::exp(guess.log_focal_error * core::Normal(*rng));
  guess.camera.height *= std::exp(guess.log_height_error * core::Normal(*rng));
  return guess;
}

void AddErrors(const std::vector<ObjectErrors>& errors, const twin::TableScene& scene, int number,
               Sums* sums) {
  for (const ObjectErrors& error : errors) {
    const bool position = error.position < kPosition, yaw = error.yaw < kYaw;
    sums->kinds += error.kind;
    sums->positions += position;
    sums->yaws += yaw;
    sums->poses += position && yaw;
    sums->sizes += std::abs(error.size) < kSize;
    sums->position_sigmas.push_back(error.position_sigmas);
    sums->size_sigmas.push_back(error.size_sigmas);
    const auto name = [](int kind) {
      return library_fit::FitKinds()[static_cast<size_t>(kind)].name;
    };
    const twin::TableObject& truth = scene.objects[static_cast<size_t>(error.truth)];
    std::printf("%d %-16s %5.1f cm %4.0f deg %+4.0f %%%s\n", number,
                name(truth.instance.kind).c_str(), 100.0 * error.position, error.yaw * 180.0 / M_PI,
                100.0 * std::expm1(error.size), error.kind ? "" : "  another kind");
  }
}

void PrintShare(const char* name, int count, int all) {
  if (all == 0) return;
  const rl::Interval interval = rl::WilsonInterval(count, all);
  std::printf("%-40s %5.1f %% (%.1f to %.1f)\n", name, 100.0 * count / all, 100.0 * interval.low,
              100.0 * interval.high);
}

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<size_t>(share * static_cast<double>(values.size())))];
}

void Print(const Sums& sums, int tables) {
  const double precision = sums.found / std::max(1.0, static_cast<double>(sums.found + sums.wrong));
  const double recall = sums.found / std::max(1.0, static_cast<double>(sums.truths));
  std::printf("objects: %d, found %d, wrong detections %d; F1 %.3f\n", sums.truths, sums.found,
              sums.wrong, 2.0 * precision * recall / std::max(1e-9, precision + recall));
  PrintShare("kind right, of those found", sums.kinds, sums.found);
  PrintShare("position within 2 cm", sums.positions, sums.found);
  PrintShare("yaw within 10 degrees", sums.yaws, sums.found);
  PrintShare("both", sums.poses, sums.found);
  PrintShare("size within 10 %", sums.sizes, sums.found);
  std::printf("position error over its deviation: median %.2f, 95 %% %.2f; size: %.2f, %.2f\n",
              Quantile(sums.position_sigmas, 0.5), Quantile(sums.position_sigmas, 0.95),
              Quantile(sums.size_sigmas, 0.5), Quantile(sums.size_sigmas, 0.95));
  std::printf(
      "camera: median error of elevation %.1f degrees, focal length %.1f %%, height %.1f %%\n",
      Quantile(sums.elevation, 0.5) * 180.0 / M_PI, 100.0 * Quantile(sums.focal, 0.5),
      100.0 * Quantile(sums.height, 0.5));
  std::printf("seconds a table: %.1f\n", sums.seconds / std::max(1, tables));
}

void Run(const Options& options) {
  twin::TableSceneSources sources;
  sources.photos = twin::ReadScenePhotos(options.photos);
  const library_fit::LibraryPrior prior(workflows::LibraryWeights(workflows::ModelsFolder()));
  std::unique_ptr<twin::ObjectDetector> detector;
  if (!options.detector.empty()) {
    detector = std::make_unique<twin::ObjectDetector>(options.detector);
  }
  twin::TableSceneOptions scene_options;
  scene_options.width = 640;
  scene_options.height = 480;
  scene_options.first_seed = options.tuning ? 1 : kHeldOut;
  if (options.tuning) scene_options.seeds = kHeldOut - 1;
  Sums sums;
  core::Progress silent;
  for (int number = options.first; number < options.first + options.count; ++number) {
    core::Rng rng = core::StreamRng(options.tuning ? 78 : 77, static_cast<std::uint64_t>(number));
    const twin::TableScene scene = twin::SampleTableScene(sources, scene_options, &rng);
    const twin::TablePicture picture =
        twin::RenderTable(scene, sources, {}, static_cast<std::uint64_t>(number));
    std::vector<int> indices;
    const std::vector<twin::Detection> truth =
        TrueDetections(picture, static_cast<int>(scene.objects.size()), &indices);
    const twin::TableCamera camera = twin::TableCameraOf(scene.camera);
    const auto start = std::chrono::steady_clock::now();
    twin::Detections found;
    if (detector) found = detector->Detect(picture.color);
    if (!detector) found.objects = truth;
    if (!detector || !options.unknown) found.camera = GuessNear(camera, options.unknown, &rng);
    const std::vector<int> matched = MatchedDetections(found.objects, truth);
    sums.truths += static_cast<int>(truth.size());
    for (const int match : matched) (match >= 0 ? sums.found : sums.wrong) += 1;
    if (found.objects.empty()) continue;
    const twin::TableReconstruction table =
        twin::ReconstructTable(picture.color, found, prior, {}, &silent);
    sums.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::vector<int> objects;
    for (const twin::ReconstructedObject& object : table.objects) {
      const int match = matched[static_cast<size_t>(object.detection)];
      objects.push_back(match < 0 ? -1 : indices[static_cast<size_t>(match)]);
    }
    AddErrors(JudgeTable(table, objects, scene, options.unknown), scene, number, &sums);
    sums.elevation.push_back(std::abs(table.camera.elevation - camera.elevation));
    sums.focal.push_back(std::abs(std::log(table.camera.focal / camera.focal)));
    sums.height.push_back(std::abs(std::log(table.camera.height / camera.height)));
    std::fflush(stdout);
  }
  Print(sums, options.count);
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    simwright::bench::Run(simwright::bench::Parse(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
