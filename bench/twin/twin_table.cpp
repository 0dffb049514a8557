// Rebuilds rendered tables of library objects that no training used, and compares kinds, poses and
// sizes with the truth.
// --camera unknown: elevation, focal length, roll and height are unknown, or, without a detector,
// guessed with errors of 4.6 degrees, 12 %, 1.1 degrees and 20 %; positions and yaws are then
// compared after a rigid alignment in the plane.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/parallel.h"
#include "library_fit/library_prior.h"
#include "rl/wilson_interval.h"
#include "settled_twin.h"
#include "twin/camera_guess.h"
#include "twin/observed_object.h"
#include "twin/scene_sources.h"
#include "twin_judgement.h"
#include "workflows/priors/models_folder.h"
#include "workflows/priors/prior_training.h"

namespace simwright::bench {
namespace {

constexpr std::uint64_t kHeldOut = 1'000'000'000;
constexpr double kPosition = 0.02, kYaw = 10.0 * M_PI / 180.0,
                 kSize = 0.0953;    // 2 cm, 10 deg, 10 %
constexpr double kTouching = 1e-3;  // m: a deeper interpenetration counts

struct Options {
  int count = 60, first = 0;
  bool unknown = false, tuning = false, detections_only = false, settle = false, guess_only = false;
  std::filesystem::path detector, pictures;
  std::vector<std::filesystem::path> photos;
};

void AddOptions(CLI::App* app, Options* options) {
  app->add_option("--count", options->count, "Number of tables")->capture_default_str();
  app->add_option("--first", options->first, "Number of the first table")->capture_default_str();
  app->add_option_function<std::string>(
         "--camera", [options](const std::string& name) { options->unknown = name == "unknown"; },
         "The camera is known or unknown")
      ->check(CLI::IsMember({"known", "unknown"}))
      ->default_str("known");
  app->add_option("--detector", options->detector,
                  "Weights; without them the true masks are given");
  app->add_option("--photos", options->photos, "Pictures behind and below the objects");
  app->add_flag("--tuning", options->tuning, "Training seeds, for choosing settings");
  app->add_flag("--detections-only", options->detections_only, "Rebuild nothing");
  CLI::Option* guess =
      app->add_flag("--guess-only", options->guess_only,
                    "Judge the prior's first kinds and its guess of an unknown camera alone");
  app->add_flag("--settle", options->settle,
                "Compare poses after physics, and count the twins that stand without "
                "interpenetration")
      ->excludes(guess);
  app->add_option("--pictures", options->pictures,
                  "Folder for a picture of each table, the photo beside the detections");
  app->add_option_function<int>("--threads", core::SetThreadCount, "Number of threads");
}

struct Sums {
  int truths = 0, found = 0, wrong = 0;
  int kinds = 0, positions = 0, yaws = 0, poses = 0, sizes = 0;
  std::vector<double> position_sigmas, size_sigmas, elevation, focal, height;
  int settled = 0, standing = 0, touching = 0;  // twins
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

void PrintDetections(const Sums& sums) {
  const double precision = sums.found / std::max(1.0, static_cast<double>(sums.found + sums.wrong));
  const double recall = sums.found / std::max(1.0, static_cast<double>(sums.truths));
  std::printf("objects: %d, found %d, wrong detections %d; F1 %.3f\n", sums.truths, sums.found,
              sums.wrong, 2.0 * precision * recall / std::max(1e-9, precision + recall));
}

void PrintPoses(const Sums& sums) {
  PrintShare("position within 2 cm", sums.positions, sums.found);
  PrintShare("yaw within 10 degrees", sums.yaws, sums.found);
  PrintShare("both", sums.poses, sums.found);
  PrintShare("size within 10 %", sums.sizes, sums.found);
  PrintShare("twins that stand still", sums.standing, sums.settled);
  if (sums.settled > 0) std::printf("twins with interpenetrations: %d\n", sums.touching);
  std::printf("position error over its deviation: median %.2f, 95 %% %.2f; size: %.2f, %.2f\n",
              Quantile(sums.position_sigmas, 0.5), Quantile(sums.position_sigmas, 0.95),
              Quantile(sums.size_sigmas, 0.5), Quantile(sums.size_sigmas, 0.95));
}

void PrintCamera(const Sums& sums) {
  std::printf(
      "camera: median error of elevation %.1f degrees, focal length %.1f %%, height %.1f %%\n",
      Quantile(sums.elevation, 0.5) * 180.0 / M_PI, 100.0 * Quantile(sums.focal, 0.5),
      100.0 * Quantile(sums.height, 0.5));
}

// Rebuilds the tables of the options.
class TableBench {
 public:
  explicit TableBench(const Options& options)
      : options_(options), prior_(workflows::LibraryWeights(workflows::ModelsFolder())) {
    sources_.photos = twin::ReadScenePhotos(options.photos);
    if (!options.detector.empty()) {
      detector_ = std::make_unique<twin::ObjectDetector>(options.detector);
    }
    scene_options_.width = 640;
    scene_options_.height = 480;
    scene_options_.first_seed = options.tuning ? 1 : kHeldOut;
    if (options.tuning) scene_options_.seeds = kHeldOut - 1;
    if (!options.pictures.empty()) std::filesystem::create_directories(options.pictures);
  }

  void Run() {
    for (int number = options_.first; number < options_.first + options_.count; ++number) {
      Rebuild(number);
      std::fflush(stdout);
    }
    PrintDetections(sums_);
    if (options_.detections_only) return;
    PrintShare("kind right, of those found", sums_.kinds, sums_.found);
    if (!options_.guess_only) PrintPoses(sums_);
    PrintCamera(sums_);
    if (options_.guess_only) return;
    std::printf("seconds a table: %.1f\n", sums_.seconds / std::max(1, options_.count));
  }

 private:
  void Rebuild(int number) {
    core::Rng rng = core::StreamRng(options_.tuning ? 78 : 77, static_cast<std::uint64_t>(number));
    const twin::TableScene scene = twin::SampleTableScene(sources_, scene_options_, &rng);
    const twin::TablePicture picture =
        twin::RenderTable(scene, sources_, {}, static_cast<std::uint64_t>(number));
    std::vector<int> indices;
    const std::vector<twin::Detection> truth =
        TrueDetections(picture, static_cast<int>(scene.objects.size()), &indices);
    const twin::TableCamera camera = twin::TableCameraOf(scene.camera);
    const auto start = std::chrono::steady_clock::now();
    twin::Detections found;
    if (detector_) found = detector_->Detect(picture.color);
    if (!detector_) found.objects = truth;
    if (!detector_ || !options_.unknown) found.camera = GuessNear(camera, options_.unknown, &rng);
    const std::vector<int> matched = MatchedDetections(found.objects, truth);
    sums_.truths += static_cast<int>(truth.size());
    for (const int match : matched) (match >= 0 ? sums_.found : sums_.wrong) += 1;
    if (options_.detections_only) PrintMatches(number, scene, found, matched, truth, indices);
    if (found.objects.empty() || options_.detections_only) {
      Keep(number, SideBySide(picture.color, DetectionsPicture(picture.color, found)));
      return;
    }
    if (options_.guess_only) {
      Guess(picture.color, found, scene, matched, indices);
      return;
    }
    twin::TableReconstruction table =
        twin::ReconstructTable(picture.color, found, prior_, {}, &silent_);
    if (options_.settle) Settle(number, picture.color, found, &table);
    sums_.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::vector<int> objects;
    for (const twin::ReconstructedObject& object : table.objects) {
      const int match = matched[static_cast<size_t>(object.detection)];
      objects.push_back(match < 0 ? -1 : indices[static_cast<size_t>(match)]);
    }
    AddErrors(JudgeTable(table, objects, scene, options_.unknown), scene, number, &sums_);
    AddCameraErrors(table.camera, camera);
  }

  void AddCameraErrors(const twin::TableCamera& found, const twin::TableCamera& truth) {
    sums_.elevation.push_back(std::abs(found.elevation - truth.elevation));
    sums_.focal.push_back(std::abs(std::log(found.focal / truth.focal)));
    sums_.height.push_back(std::abs(std::log(found.height / truth.height)));
  }

  // Judges the prior's first kinds and its guess of the camera.
  void Guess(const core::Image& photo, const twin::Detections& found, const twin::TableScene& scene,
             const std::vector<int>& matched, const std::vector<int>& indices) {
    const std::vector<twin::ObservedObject> observed =
        twin::ObserveObjects(photo, found.objects, 80);
    const std::vector<int>& kinds = twin::TableKinds();
    for (size_t k = 0; k < observed.size(); ++k) {
      if (matched[k] < 0) continue;
      const std::vector<double> odds = prior_.KindProbabilities(observed[k].prior_crop);
      const int best = *std::max_element(kinds.begin(), kinds.end(), [&](int a, int b) {
        return odds[static_cast<size_t>(a)] < odds[static_cast<size_t>(b)];
      });
      const auto object = static_cast<size_t>(indices[static_cast<size_t>(matched[k])]);
      sums_.kinds += best == scene.objects[object].instance.kind;
    }
    const twin::TableCamera truth = twin::TableCameraOf(scene.camera);
    const twin::TableCameraGuess guess =
        twin::GuessByObjects(observed, {}, prior_, photo.width, photo.height, {});
    AddCameraErrors(guess.camera, truth);
  }

  static void PrintMatches(int number, const twin::TableScene& scene, const twin::Detections& found,
                           const std::vector<int>& matched,
                           const std::vector<twin::Detection>& truth,
                           const std::vector<int>& indices) {
    for (size_t k = 0; k < matched.size(); ++k) {
      std::printf("%d detection of confidence %.2f: %s\n", number, found.objects[k].confidence,
                  matched[k] < 0 ? "wrong" : "right");
    }
    for (size_t k = 0; k < truth.size(); ++k) {
      if (std::count(matched.begin(), matched.end(), static_cast<int>(k)) > 0) continue;
      const std::vector<std::uint8_t>& alpha = truth[k].alpha.pixels;
      const auto pixels = std::count_if(alpha.begin(), alpha.end(), [](int a) { return a > 127; });
      const twin::TableObject& object = scene.objects[static_cast<size_t>(indices[k])];
      std::printf("%d missed %s, %td pixels\n", number,
                  library_fit::FitKinds()[static_cast<size_t>(object.instance.kind)].name.c_str(),
                  pixels);
    }
  }

  void Settle(int number, const core::Image& photo, const twin::Detections& found,
              twin::TableReconstruction* table) {
    const SettledTwin settled = SettleReconstruction(photo, found, 1, table);
    ++sums_.settled;
    sums_.standing += settled.complete && settled.stands;
    sums_.touching += settled.penetration > kTouching;
    if (!settled.complete || !settled.stands || settled.penetration > kTouching) {
      std::printf("%d does not stand; deepest interpenetration %.2f mm\n", number,
                  1e3 * settled.penetration);
    }
    if (settled.picture.width > 0) {
      Keep(number, SideBySide(DetectionsPicture(photo, found), settled.picture));
    }
  }

  void Keep(int number, const core::Image& picture) const {
    if (options_.pictures.empty()) return;
    core::WritePng(options_.pictures / (std::to_string(number) + ".png"), picture);
  }

  const Options& options_;
  twin::TableSceneSources sources_;
  library_fit::LibraryPrior prior_;
  std::unique_ptr<twin::ObjectDetector> detector_;
  twin::TableSceneOptions scene_options_;
  Sums sums_;
  core::Progress silent_;
};

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  CLI::App app("Rebuilt tables: kinds, poses and sizes against the truth");
  simwright::bench::Options options;
  simwright::bench::AddOptions(&app, &options);
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::bench::TableBench(options).Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
  return 0;
}
