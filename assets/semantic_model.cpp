#include "assets/semantic_model.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <sstream>
#include <vector>

#include "assets/articulated_writer.h"
#include "assets/urdf_meshes.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"

namespace simwright::assets {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostBytes = 4 << 20;
constexpr size_t kMostNamed = 8;  // URDFs in a message
constexpr int kMostDepth = 8;     // maximum folder depth of the search

// Returns the link's name without a trailing number as the label: "handle_0" and "drawer2" have
// one, "switch_off" has not.
std::string LabelFromName(const std::string& link) {
  std::string label = link;
  while (!label.empty() && std::isdigit(static_cast<unsigned char>(label.back()))) label.pop_back();
  while (!label.empty() && (label.back() == '_' || label.back() == '-')) label.pop_back();
  return label == "link" ? "" : label;
}

// Returns the first existing one of `files`; empty if there is none.
fs::path FirstExisting(const fs::path& folder, std::initializer_list<const char*> files) {
  for (const char* file : files) {
    if (fs::is_regular_file(folder / file)) return folder / file;
  }
  return {};
}

std::string CategoryIn(const fs::path& folder, core::Findings* findings) {
  for (const auto& [file, key] :
       {std::pair{"asset.json", "category"}, {"meta.json", "model_cat"}}) {
    const fs::path path = FirstExisting(folder, {file});
    if (path.empty()) continue;
    const auto json = core::TryParseJson(core::ReadFile(path, kMostBytes));
    const core::Json* found = json ? core::FindMember(*json, key) : nullptr;
    if (found != nullptr && found->is_string()) {
      std::string category = found->get<std::string>();
      std::transform(category.begin(), category.end(), category.begin(), ::tolower);
      return category;
    }
    findings->push_back({"semantics-category", core::Severity::kWarning, path.string(),
                         std::string("names no category under '") + key + "'", 0.0});
  }
  return "";
}

void ReadSemantics(const fs::path& file, SemanticModel* model) {
  static const std::set<std::string> kKinds{"hinge", "slider", "slider+", "free",
                                            "heavy", "static", "fixed"};
  std::set<std::string> links;
  for (const UrdfLink& link : model->model.links) links.insert(link.name);
  std::istringstream lines(core::ReadFile(file, kMostBytes));
  int number = 0;
  const auto warn = [&](const std::string& sentence) {
    model->model.findings.push_back({"semantics-line", core::Severity::kWarning,
                                     file.string() + ":" + std::to_string(number), sentence,
                                     static_cast<double>(number)});
  };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    const std::vector<std::string> word{std::istream_iterator<std::string>(words), {}};
    if (word.empty()) continue;
    if (word.size() != 3) {
      warn("has " + std::to_string(word.size()) + " words instead of three: LINK JOINT LABEL");
    } else if (!links.contains(word[0])) {
      warn("names the link '" + word[0] + "', which is not in the URDF");
    } else if (!kKinds.contains(word[1])) {
      warn("'" + word[1] + "' is not a joint kind");
    } else if (!model->semantics.emplace(word[0], LinkSemantics{word[1], word[2]}).second) {
      warn("describes the link '" + word[0] + "' again");
    }
  }
}

// Fills missing semantics: the kind from the joint, the label from the link's name.
void FillFromNames(SemanticModel* model) {
  for (size_t i = 0; i < model->model.links.size(); ++i) {
    const std::string& name = model->model.links[i].name;
    if (model->semantics.contains(name)) continue;
    const std::string label = LabelFromName(name);
    if (label.empty()) continue;
    model->semantics[name] = {i == 0 ? "" : SemanticsKind(model->model.joints[i - 1].type), label};
  }
}

}  // namespace

fs::path UrdfIn(const fs::path& folder) {
  const fs::path own = folder / (fs::weakly_canonical(folder).filename().string() + ".urdf");
  if (fs::is_regular_file(own)) return own;
  const fs::path known = FirstExisting(folder, {"mobility.urdf", kGapartnetUrdf});
  if (!known.empty()) return known;
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".urdf") found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  const bool package = IsPackage(folder) ||
                       std::any_of(fs::directory_iterator(folder), fs::directory_iterator(),
                                   [](const fs::directory_entry& entry) {
                                     return entry.is_directory() && HasUrdfFolderName(entry.path());
                                   });
  if (found.empty() && package) found = FilesBelow(folder, ".urdf");
  if (found.size() == 1) return found.front();
  if (!found.empty()) {
    std::string names;
    for (size_t i = 0; i < std::min<size_t>(found.size(), kMostNamed); ++i) {
      names += (i > 0 ? ", " : "") + found[i].lexically_relative(folder).string();
    }
    if (found.size() > kMostNamed) names += " ...";
    throw core::Error("holds " + std::to_string(found.size()) + " URDFs: " + names, folder.string(),
                      "name the .urdf file itself");
  }
  if (const auto xacros = FilesBelow(folder, ".xacro"); !xacros.empty()) {
    throw core::Error(
        "holds no URDF, but the xacro " + xacros.front().lexically_relative(folder).string(),
        folder.string(), "expand it first: xacro FILE.xacro > FILE.urdf");
  }
  throw core::Error("holds no URDF", folder.string(), "name the .urdf file itself");
}

std::vector<fs::path> FilesBelow(const fs::path& folder, const std::string& ending) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (auto at = fs::recursive_directory_iterator(
           folder, fs::directory_options::skip_permission_denied, failed);
       !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
    if (at->path().filename().string().starts_with(".")) {
      if (at->is_directory()) at.disable_recursion_pending();
      continue;
    }
    if (at->path().extension() == ending && !at->is_symlink() && at->is_regular_file())
      found.push_back(at->path());
    if (at.depth() >= kMostDepth) at.disable_recursion_pending();
  }
  std::sort(found.begin(), found.end());
  return found;
}

SemanticModel ReadSemanticModel(const fs::path& path, const UrdfReadOptions& options) {
  if (!fs::exists(path)) throw core::Error("no such file or folder", path.string());
  SemanticModel model;
  const bool is_folder = fs::is_directory(path);
  model.urdf = is_folder ? UrdfIn(path) : path;
  const fs::path folder = is_folder ? path : fs::absolute(path).parent_path();
  const bool asset = !FirstExisting(folder, {"asset.json", "meta.json"}).empty();
  model.name =
      is_folder || asset ? fs::weakly_canonical(folder).filename().string() : path.stem().string();
  model.model = ReadUrdf(model.urdf, options);
  model.category = CategoryIn(folder, &model.model.findings);
  // GAPartNet keeps its own semantics beside PartNet-Mobility's; each describes the links of its
  // own URDF.
  const char* const own = "semantics.txt";
  const char* const gapartnet = "semantics_gapartnet.txt";
  const bool annotated = model.urdf.filename() == kGapartnetUrdf;
  const fs::path semantics =
      annotated ? FirstExisting(folder, {gapartnet, own}) : FirstExisting(folder, {own, gapartnet});
  if (!semantics.empty()) ReadSemantics(semantics, &model);
  FillFromNames(&model);
  return model;
}

}  // namespace simwright::assets
