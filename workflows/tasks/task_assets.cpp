#include "workflows/tasks/task_assets.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/error.h"
#include "robot/panda_model.h"
#include "tasks/task_names.h"
#include "workflows/grasps/asset_grasps.h"

namespace simwright::workflows {
namespace {

namespace fs = std::filesystem;

struct Located {
  std::string name;  // the given name; empty: the asset's own
  fs::path path;
};

bool HoldsUrdf(const fs::path& folder) {
  const fs::directory_iterator entries(folder);
  return std::any_of(begin(entries), end(entries), [](const fs::directory_entry& entry) {
    return entry.is_regular_file() && entry.path().extension() == ".urdf";
  });
}

Located SplitArgument(const std::string& argument) {
  // An existing path may itself contain an equals sign.
  const std::size_t equals = argument.find('=');
  if (equals == std::string::npos || fs::exists(argument)) return {"", argument};
  return {argument.substr(0, equals), argument.substr(equals + 1)};
}

// Returns the argument itself, or the assets in the folder that it names.
std::vector<Located> Expanded(const std::string& argument) {
  const Located one = SplitArgument(argument);
  if (!fs::exists(one.path)) {
    throw core::Error("no such asset", one.path.string(), "give a folder or a .urdf");
  }
  if (!fs::is_directory(one.path) || HoldsUrdf(one.path)) return {one};
  std::vector<Located> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(one.path)) {
    if (entry.is_directory() && HoldsUrdf(entry.path())) found.push_back({"", entry.path()});
  }
  if (found.empty()) return {one};  // reading it reports the fault
  if (!one.name.empty()) {
    throw core::Error(
        "there is one name for a folder of " + std::to_string(found.size()) + " assets", argument,
        "name each asset, or give the folder without a name");
  }
  std::sort(found.begin(), found.end(),
            [](const Located& a, const Located& b) { return a.path < b.path; });
  return found;
}

}  // namespace

TaskAssets ReadTaskAssets(const std::vector<std::string>& arguments) {
  TaskAssets result;
  std::set<std::string> names;
  for (const std::string& argument : arguments) {
    for (const Located& located : Expanded(argument)) {
      assets::SemanticModel model = assets::ReadSemanticModel(located.path);
      model.graspable = HasGraspOnSupport(located.path, robot::Panda(false), &result.findings);
      if (!located.name.empty()) model.name = located.name;
      if (!tasks::IsAssetName(model.name)) {
        throw core::Error("programs cannot use the asset name '" + model.name + "'",
                          located.path.string(),
                          "give it a name of letters, digits, '_' and '-': NAME=PATH");
      }
      if (!names.insert(model.name).second) {
        throw core::Error("two assets have the name '" + model.name + "'", located.path.string(),
                          "rename one: NAME=PATH");
      }
      for (core::Finding finding : model.model.findings) {
        const std::string file = model.urdf.string();
        const bool named = finding.place.find(file) != std::string::npos;
        if (!named) finding.place = file + (finding.place.empty() ? "" : ", " + finding.place);
        result.findings.push_back(finding);
      }
      result.listed.push_back({model.name, located.path.string(), model.category});
      result.models.push_back(std::move(model));
    }
  }
  return result;
}

}  // namespace simwright::workflows
