// The house of docs/architecture.md: a module includes only from floors below its own, and each
// large library has one door. Read from the include lines, so that the rule needs no compiler.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/include_lines.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr double kLargestShare = 0.12;  // of the production lines, in one module

// Include pattern -> where it may stand: a module, or a file's stem below one.
struct Door {
  std::regex pattern;
  std::set<std::string> places;
};
const std::vector<Door> kDoors = {
    {std::regex("^embree3?/"), {"render"}},
    {std::regex("^CGAL/"), {"geometry"}},
    {std::regex("^assimp/"), {"assets"}},
    {std::regex("^draco/"), {"assets/gltf_draco"}},
    {std::regex("^(urdf_parser|urdf_model|console_bridge)/"), {"assets"}},
    {std::regex("^bt[A-Z]|^Bullet"), {"sim"}},
    {std::regex("^mujoco/"),
     {"sim/mujoco", "sim/mujoco_scene", "sim/mujoco_rig", "sim/mujoco_bodies",
      "sim/mujoco_stability", "sim/mujoco_grasp_rig", "sim/mujoco_body_rig"}},
    {std::regex("^curl/"), {"llm"}},
    {std::regex("^opencv2/"),
     {"core/image", "core/depth_image", "asset_lift", "capture", "texture"}},
    {std::regex("^ceres/"), {"capture", "scene", "twin"}},
    {std::regex("^(torch|ATen)/"), {"nn"}},
    {std::regex("^mpi\\.h$"), {"rl/mpi_communicator"}},
    {std::regex("^CLI/"), {"cli"}},
    {std::regex("^nanobind/"), {"python"}},
    {std::regex("^zip\\.h"), {"assets"}},
    {std::regex("^(hdf5|H5[A-Za-z]*)(_hl)?\\.h"), {"core/hdf5"}},
    {std::regex("^tinyxml2\\.h"), {"assets"}},
    {std::regex("^(spdlog|fmt)/"), {"core/log"}},
    {std::regex("^nlohmann/"), {"core/json"}},
    {std::regex("^httplib"), {"viewer/view_server"}},
    {std::regex("^third_party/xatlas/"), {"texture/uv_atlas"}},
};

TEST(Architecture, ModulesIncludeOnlyFromFloorsBelow) {
  int checked = 0;
  for (const Include& include : AllIncludes()) {
    const std::string other = include.target.substr(0, include.target.find('/'));
    const auto floor = kFloor.find(other);
    if (floor == kFloor.end() || include.target.find('/') == std::string::npos) continue;
    ++checked;
    if (other == include.module) continue;
    EXPECT_LT(floor->second, kFloor.at(include.module))
        << include.file << ":" << include.line << " includes " << include.target;
  }
  EXPECT_GT(checked, 100);  // the reading works at all
}

TEST(Architecture, EachLibraryHasOneDoor) {
  int checked = 0;
  for (const Include& include : AllIncludes()) {
    for (const Door& door : kDoors) {
      if (!std::regex_search(include.target, door.pattern)) continue;
      ++checked;
      EXPECT_TRUE(door.places.contains(include.module) || door.places.contains(include.stem))
          << include.file << ":" << include.line << " includes " << include.target;
    }
  }
  EXPECT_GT(checked, 10);
}

// The headers that `file` includes from this repository, by path.
std::map<std::string, std::set<std::string>> HeaderGraph() {
  const fs::path root(SIMWRIGHT_SOURCE_DIR);
  std::map<std::string, std::set<std::string>> graph;
  for (const Include& include : AllIncludes()) {
    const std::string file = fs::path(include.file).lexically_relative(root).generic_string();
    if (!file.ends_with(".h") || !fs::exists(root / include.target)) continue;
    graph[file].insert(include.target);
  }
  return graph;
}

// True where `header` leads back to itself; `path` then ends with the circle.
bool FindsCircle(const std::map<std::string, std::set<std::string>>& graph,
                 const std::string& header, std::set<std::string>* done,
                 std::vector<std::string>* path) {
  if (std::find(path->begin(), path->end(), header) != path->end()) {
    path->push_back(header);
    return true;
  }
  if (done->contains(header)) return false;
  path->push_back(header);
  const auto found = graph.find(header);
  if (found != graph.end()) {
    for (const std::string& next : found->second) {
      if (FindsCircle(graph, next, done, path)) return true;
    }
  }
  path->pop_back();
  done->insert(header);
  return false;
}

TEST(Architecture, NoCircleBetweenHeaders) {
  const auto graph = HeaderGraph();
  EXPECT_GT(graph.size(), 100u);
  std::set<std::string> done;
  for (const auto& [header, includes] : graph) {
    std::vector<std::string> path;
    if (!FindsCircle(graph, header, &done, &path)) continue;
    std::string circle;
    for (const std::string& step : path) circle += step + " -> ";
    ADD_FAILURE() << circle;
  }
}

// The same for whole files: a header and its source are one node, without their endings.
std::map<std::string, std::set<std::string>> FileGraph(const std::string& module) {
  const fs::path root(SIMWRIGHT_SOURCE_DIR);
  std::map<std::string, std::set<std::string>> graph;
  for (const Include& include : AllIncludes()) {
    if (include.module != module || !fs::exists(root / include.target)) continue;
    const fs::path file = fs::path(include.file).lexically_relative(root).replace_extension();
    const std::string target = fs::path(include.target).replace_extension().generic_string();
    if (file.generic_string() != target) graph[file.generic_string()].insert(target);
  }
  return graph;
}

TEST(Architecture, NoCircleBetweenFilesOfAModule) {
  for (const std::string module : {"validation", "manipulation", "importers", "sim", "robot"}) {
    const auto graph = FileGraph(module);
    EXPECT_FALSE(graph.empty()) << module;
    std::set<std::string> done;
    for (const auto& [file, includes] : graph) {
      std::vector<std::string> path;
      EXPECT_FALSE(FindsCircle(graph, file, &done, &path)) << file;
    }
  }
}

TEST(Architecture, NoModuleIsTooLarge) {
  std::map<std::string, int> lines;
  int total = 0;
  for (const auto& [module, floor] : kFloor) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(SIMWRIGHT_SOURCE_DIR) / module)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line); ++total) ++lines[module];
    }
  }
  EXPECT_GT(total, 50000);
  for (const auto& [module, count] : lines) {
    EXPECT_LE(count, kLargestShare * total) << module;
  }
}

TEST(Architecture, LargeLibrariesStayOutOfHeaders) {
  for (const Include& include : AllIncludes()) {
    // The headers of cli and python declare types of CLI11 and nanobind.
    const bool top = include.module == "cli" || include.module == "python";
    if (!include.file.ends_with(".h") || top) continue;
    // OpenCV's matrices are asset_lift's own currency between its files.
    if (include.module == "asset_lift" && include.target.starts_with("opencv2/core")) continue;
    // libtorch's one header, and those of nn/ that declare network modules through it.
    if (include.stem == "nn/torch" || include.stem == "nn/torch_script") continue;
    // A JSON value is a type of its readers and writers, under core's names.
    if (include.stem == "core/json") continue;
    // CGAL's types are geometry's, in headers named as such.
    if (include.module == "geometry" && include.stem.find("cgal") != std::string::npos) continue;
    for (const Door& door : kDoors) {
      EXPECT_FALSE(std::regex_search(include.target, door.pattern))
          << include.file << ":" << include.line << " includes " << include.target;
    }
  }
}

}  // namespace
}  // namespace simwright
