// Profiles `lift`, `import` and `check`: seconds and share of each stage, on two photos of
// examples/ and on a bumpy ball and a cup of about 10,000 faces.
//   bench_stage_shares [--runs N]      the median of N runs (3)
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "assets/obj_file.h"
#include "core/error.h"
#include "core/files.h"
#include "validation/check.h"
#include "workflows/import/import.h"
#include "workflows/lift/lift.h"

namespace simwright::bench {
namespace {

namespace fs = std::filesystem;
using asset_build::StageSeconds;

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double PeakMebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Reports a profile. `run` returns the seconds of its stages; the remaining time is "other".
void Report(const std::string& name, int runs, const std::function<StageSeconds()>& run) {
  std::map<std::string, std::vector<double>> seconds;
  for (int i = 0; i < runs; ++i) {
    const double start = Now();
    StageSeconds stages = run();
    const double whole = Now() - start;
    stages.erase("total");
    double known = 0.0;
    for (const auto& [stage, s] : stages) known += s;
    stages["other"] = whole - known;
    stages["whole"] = whole;
    for (const auto& [stage, s] : stages) seconds[stage].push_back(s);
  }
  const auto median = [](std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  const double whole = median(seconds["whole"]);
  std::printf("%s: %.2f s, at most %.0f MiB so far\n", name.c_str(), whole, PeakMebibytes());
  for (auto& [stage, values] : seconds) {
    if (stage == "whole") continue;
    const double s = median(values);
    std::printf("  %-16s %6.2f s  %3.0f%%\n", stage.c_str(), s, 100.0 * s / whole);
  }
  std::fflush(stdout);
}

// Returns a surface of revolution: rings of a latitude-longitude grid; `radius` and `height` by
// ring (0..1).
core::TriangleMesh Lathe(int rings, int sectors, const std::function<double(double)>& radius,
                         const std::function<double(double)>& height) {
  core::TriangleMesh mesh;
  mesh.vertices.emplace_back(0.0, 0.0, height(0.0));
  for (int i = 1; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double t = static_cast<double>(i) / rings, turn = 2.0 * M_PI * j / sectors;
      mesh.vertices.emplace_back(radius(t) * std::cos(turn), radius(t) * std::sin(turn), height(t));
    }
  }
  mesh.vertices.emplace_back(0.0, 0.0, height(1.0));
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int i, int j) { return 1 + (i - 1) * sectors + j % sectors; };
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.emplace_back(0, at(1, j + 1), at(1, j));
    mesh.triangles.emplace_back(last, at(rings - 1, j), at(rings - 1, j + 1));
    for (int i = 1; i + 1 < rings; ++i) {
      mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j));
      mesh.triangles.emplace_back(at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
    }
  }
  return mesh;
}

// Returns a cup: from the bottom's middle up the outside, over the rim, down the inside.
core::TriangleMesh Cup() {
  const auto radius = [](double t) {
    if (t < 0.15) return 0.035 * t / 0.15;
    if (t < 0.5) return 0.035 + 0.008 * (t - 0.15) / 0.35;
    if (t < 0.85) return 0.040 - 0.008 * (t - 0.5) / 0.35;
    return 0.032 * (1.0 - t) / 0.15;
  };
  const auto height = [](double t) {
    if (t < 0.15) return 0.0;
    if (t < 0.5) return 0.1 * (t - 0.15) / 0.35;
    if (t < 0.85) return 0.1 - 0.095 * (t - 0.5) / 0.35;
    return 0.005;
  };
  return Lathe(71, 72, radius, height);
}

core::TriangleMesh BumpyBall() {
  return Lathe(
      71, 72, [](double t) { return (0.1 + 0.006 * std::sin(25.0 * t)) * std::sin(M_PI * t); },
      [](double t) { return -0.1 * std::cos(M_PI * t); });
}

void BenchLift(const std::string& photo, const std::string& mask, const std::string& category,
               int runs, const fs::path& folder) {
  const fs::path examples = fs::path(SIMWRIGHT_SOURCE_DIR) / "examples";
  Report("lift " + photo, runs, [&] {
    workflows::LiftRequest request;
    request.photo = examples / photo;
    request.category = category;
    if (!mask.empty()) request.mask = examples / mask;
    request.output = folder / photo;
    request.force = true;
    core::Progress progress;
    return workflows::LiftToFolder(request, &progress).seconds;
  });
  Report("check " + photo, runs, [&] {
    const double start = Now();
    validation::CheckAsset(folder / photo);
    return StageSeconds{{"check", Now() - start}};
  });
}

void BenchImport(const std::string& name, const core::TriangleMesh& mesh,
                 const std::string& category, int runs, const fs::path& folder) {
  const fs::path file = folder / (name + ".obj");
  core::WriteFile(file, assets::ObjText(mesh));
  Report("import " + name + ", " + std::to_string(mesh.triangles.size()) + " faces", runs, [&] {
    workflows::ImportOptions options;
    options.category = category;
    options.up = 'z';
    options.force = true;
    options.check = false;
    core::Progress progress;
    const auto outcomes = workflows::ImportAll(workflows::ListImports({file}, options),
                                               folder / "imports", options, &progress);
    if (!outcomes[0].refusal.empty()) throw core::Error(outcomes[0].refusal);
    return outcomes[0].seconds;
  });
  Report("check " + name, runs, [&] {
    const double start = Now();
    validation::CheckAsset(folder / "imports" / name);
    return StageSeconds{{"check", Now() - start}};
  });
}

int Run(int argc, char** argv) {
  const int runs =
      argc > 2 && std::string(argv[1]) == "--runs" ? std::max(1, std::atoi(argv[2])) : 3;
  const fs::path folder =
      fs::temp_directory_path() / ("simwright_stage_shares_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  BenchLift("apple.jpg", "", "apple", runs, folder);
  BenchLift("coffee.png", "coffee_mask.png", "coffee cup", runs, folder);
  BenchImport("ball", BumpyBall(), "ball", runs, folder);
  BenchImport("cup", Cup(), "cup", runs, folder);
  fs::remove_all(folder);
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
