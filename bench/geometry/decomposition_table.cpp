// Compares this project's convex decomposition with Bullet's HACD and, if a Python with coacd is
// given, CoACD, at the same number of parts, all measured by geometry/concavity.h on the same
// solids.
//   bench_decomposition_table [--coacd PYTHON] [--iterations N] [--folder DIR] [--only NAME]
//                            [--hacd no] [--rounding yes]
// CoACD runs with its threshold of 0.05; its number of parts is the limit for the other two.
// Without it the limit is the number of parts that ours needs at 0.05. Solids and CoACD's parts
// stay in DIR, and existing parts are read instead of computed again.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include <hacdHACD.h>

#include "bench/geometry/decomposition_shapes.h"
#include "core/error.h"
#include "core/random.h"
#include "geometry/concavity.h"
#include "geometry/convex_decomposition.h"
#include "geometry/convex_hull.h"
#include "geometry/mesh_validity.h"

namespace simwright::bench {
namespace {

namespace fs = std::filesystem;
using Parts = std::vector<core::TriangleMesh>;

struct Row {
  Parts parts;
  double seconds = 0.0;
  double processor_seconds = 0.0;  // of all threads; of ours alone
  geometry::DecompositionQuality quality;
};

double Seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

Row Ours(const core::TriangleMesh& mesh, int parts) {
  geometry::DecompositionOptions options;
  options.max_parts = parts;
  if (parts > 0) options.threshold = 0.001;
  Row row;
  const double start = Seconds();
  const std::clock_t used = std::clock();
  row.parts = geometry::Hulls(geometry::Decompose(mesh, options));
  row.processor_seconds = static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC;
  row.seconds = Seconds() - start;
  return row;
}

Row Hacd(const core::TriangleMesh& mesh, int parts) {
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const auto& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  // The settings of Bullet's own example, except for an unbounded concavity: it merges clusters
  // down to the requested number.
  hacd.SetCompacityWeight(0.1);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNClusters(parts);
  hacd.SetNVerticesPerCH(64);  // as ours
  hacd.SetConcavity(1e9);
  hacd.SetAddExtraDistPoints(false);
  hacd.SetAddNeighboursDistPoints(false);
  hacd.SetAddFacesPoints(false);
  Row row;
  const double start = Seconds();
  hacd.Compute();
  row.seconds = Seconds() - start;
  const double size = core::Bounds(mesh).diagonal().norm();
  for (std::size_t c = 0; c < hacd.GetNClusters(); ++c) {
    std::vector<HACD::Vec3<HACD::Real>> corner(hacd.GetNPointsCH(c));
    std::vector<HACD::Vec3<long>> face(hacd.GetNTrianglesCH(c));
    if (corner.empty()) continue;
    hacd.GetCH(c, corner.data(), face.data());
    std::vector<Eigen::Vector3d> vertices;
    for (const auto& p : corner) vertices.emplace_back(p.X(), p.Y(), p.Z());
    row.parts.push_back(geometry::ThickenedConvexHull(vertices, 1e-5 * size));
  }
  return row;
}

// Returns the mesh as a file with 6 significant digits gives it.
core::TriangleMesh Rewritten(core::TriangleMesh mesh) {
  for (auto& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) {
      char digits[32];
      std::snprintf(digits, sizeof(digits), "%.6g", v[k]);
      v[k] = std::atof(digits);
    }
  }
  return mesh;
}

// Returns the mesh with each coordinate moved by at most 1e-7 of the diagonal.
core::TriangleMesh Jittered(core::TriangleMesh mesh) {
  core::Rng rng(7);
  const double reach = 1e-7 * core::Bounds(mesh).diagonal().norm();
  for (auto& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) v[k] += core::Uniform(rng, -reach, reach);
  }
  return mesh;
}

void WriteObj(const core::TriangleMesh& mesh, const fs::path& path) {
  std::ofstream out(path);
  out.precision(12);
  for (const auto& v : mesh.vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& t : mesh.triangles) {
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
}

Row ReadParts(const fs::path& path, double size) {
  Row row;
  std::ifstream in(path);
  std::vector<std::vector<Eigen::Vector3d>> parts;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "#") words >> kind >> row.seconds;
    if (kind == "o") parts.emplace_back();
    Eigen::Vector3d p;
    if (kind == "v" && words >> p.x() >> p.y() >> p.z()) parts.back().push_back(p);
  }
  for (const auto& points : parts) {
    row.parts.push_back(geometry::ThickenedConvexHull(points, 1e-5 * size));
  }
  return row;
}

Row Coacd(const NamedSolid& solid, const fs::path& folder, const std::string& python,
          int iterations) {
  std::string stem = solid.name;
  std::replace(stem.begin(), stem.end(), ' ', '_');
  const fs::path in = folder / (stem + ".obj");
  const fs::path out = folder / (stem + "_coacd_" + std::to_string(iterations) + ".obj");
  if (!fs::exists(out)) {
    WriteObj(solid.mesh, in);
    const std::string command =
        python + " " SIMWRIGHT_SOURCE_DIR "/bench/geometry/coacd_parts.py " + in.string() + " " +
        out.string() + " " + std::to_string(iterations) + " > /dev/null";
    if (std::system(command.c_str()) != 0) throw core::Error("CoACD failed", solid.name);
  }
  return ReadParts(out, core::Bounds(solid.mesh).diagonal().norm());
}

void Print(const std::string& solid, const char* method, const Row& row) {
  const auto& q = row.quality;
  std::printf("%-11s %-6s %4zu  %8.4f %8.4f %8.4f  %8.3f %8.3f  %6.4f  %8.2f\n", solid.c_str(),
              method, row.parts.size(), q.concavity, q.parts_to_solid, q.solid_to_parts,
              q.volume_error, q.missing_volume, q.coverage, row.seconds);
  std::fflush(stdout);
}

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

// Compares ours with a rival over all solids.
struct Duel {
  std::vector<double> ours, theirs, ratio;
  int better = 0, worse = 0;

  void Add(double mine, double other) {
    ours.push_back(mine);
    theirs.push_back(other);
    // Below a ten-thousandth of the diagonal both are exact.
    constexpr double kExact = 1e-4;
    ratio.push_back((mine + kExact) / (other + kExact));
    better += mine < other - kExact;
    worse += mine > other + kExact;
  }

  void Print(const char* name, const char* figure) const {
    std::printf(
        "%-6s %-13s ours better on %d, worse on %d of %zu; medians %.4f and %.4f; median "
        "ratio %.3f\n",
        name, figure, better, worse, ours.size(), Median(ours), Median(theirs), Median(ratio));
  }
};

int Main(int argc, char** argv) {
  std::string python, only;
  fs::path folder = fs::temp_directory_path() / "simwright_decomposition";
  int iterations = 150;
  bool with_hacd = true, with_rounding = false;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string flag = argv[i];
    if (flag == "--coacd") python = argv[i + 1];
    if (flag == "--iterations") iterations = std::atoi(argv[i + 1]);
    if (flag == "--folder") folder = argv[i + 1];
    if (flag == "--only") only = argv[i + 1];
    if (flag == "--rounding") with_rounding = std::string(argv[i + 1]) == "yes";
    if (flag == "--hacd") with_hacd = std::string(argv[i + 1]) != "no";
  }
  fs::create_directories(folder);
  std::printf("CoACD: %s, %d MCTS iterations (its default is 150)\n",
              python.empty() ? "not run" : "run", iterations);
  std::printf("%-11s %-6s %4s  %8s %8s %8s  %8s %8s  %6s  %8s\n", "solid", "method", "part",
              "concav.", "to solid", "to part", "vol.err", "missing", "cover", "seconds");
  Duel hacd_concavity, hacd_volume, coacd_concavity, coacd_volume;
  double our_seconds = 0.0, our_processor_seconds = 0.0, slowest = 0.0, coacd_seconds = 0.0;
  std::vector<double> times_faster, rounding;
  int beyond = 0;
  for (const NamedSolid& solid : AllSolids()) {
    if (!only.empty() && solid.name != only) continue;
    const auto judge = [&](Row* row) {
      geometry::ConcavityOptions fine;
      fine.surface_samples = 100000;
      row->quality = geometry::MeasureDecomposition(solid.mesh, row->parts, fine);
    };
    Row coacd;
    if (!python.empty()) {
      coacd = Coacd(solid, folder, python, iterations);
      judge(&coacd);
    }
    Row ours = Ours(solid.mesh, static_cast<int>(coacd.parts.size()));
    judge(&ours);
    Print(solid.name, "ours", ours);
    our_seconds += ours.seconds;
    our_processor_seconds += ours.processor_seconds;
    for (const bool noise : {false, true}) {
      if (!with_rounding) break;
      Row again = Ours(noise ? Jittered(solid.mesh) : Rewritten(solid.mesh),
                       static_cast<int>(coacd.parts.size()));
      judge(&again);
      Print(solid.name, noise ? "jitter" : "6 dig.", again);
      const double change = again.quality.concavity - ours.quality.concavity;
      rounding.push_back(std::abs(change));
      const double slack = std::max(1e-3, 0.1 * ours.quality.concavity);
      beyond += rounding.back() > slack;
    }
    slowest = std::max(slowest, ours.seconds);
    if (with_hacd) {
      const std::size_t parts = std::max(ours.parts.size(), coacd.parts.size());
      Row hacd = Hacd(solid.mesh, static_cast<int>(parts));
      judge(&hacd);
      Print(solid.name, "HACD", hacd);
      hacd_concavity.Add(ours.quality.concavity, hacd.quality.concavity);
      hacd_volume.Add(ours.quality.volume_error, hacd.quality.volume_error);
    }
    if (python.empty()) continue;
    coacd_seconds += coacd.seconds;
    times_faster.push_back(coacd.seconds / ours.seconds);
    Print(solid.name, "CoACD", coacd);
    coacd_concavity.Add(ours.quality.concavity, coacd.quality.concavity);
    coacd_volume.Add(ours.quality.volume_error, coacd.quality.volume_error);
  }
  if (with_hacd) {
    hacd_concavity.Print("HACD", "concavity");
    hacd_volume.Print("HACD", "volume error");
  }
  if (!python.empty()) {
    coacd_concavity.Print("CoACD", "concavity");
    coacd_volume.Print("CoACD", "volume error");
  }
  if (with_rounding) {
    std::printf(
        "rounding: concavity changes by %.4f in the median, %.4f at most; %d of %zu by "
        "more than a tenth and a thousandth of the diagonal\n",
        Median(rounding), *std::max_element(rounding.begin(), rounding.end()), beyond,
        rounding.size());
  }
  std::printf("ours: %.1f s in all (%.1f s of processors), %.1f s the slowest\n", our_seconds,
              our_processor_seconds, slowest);
  if (!python.empty()) {
    std::printf("CoACD: %.1f s in all, ours %.2f times faster; median ratio %.2f, least %.2f\n",
                coacd_seconds, coacd_seconds / our_seconds, Median(times_faster),
                *std::min_element(times_faster.begin(), times_faster.end()));
  }
  return 0;
}

}  // namespace
}  // namespace simwright::bench

int main(int argc, char** argv) {
  try {
    return simwright::bench::Main(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
