#include "factory/factory_plan.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "assets/asset.h"
#include "core/error.h"
#include "core/json.h"
#include "library/articulated/articulated_kinds.h"
#include "library/rigid/rigid_kinds.h"
#include "library_fit/fit_kinds.h"
#include "proposals/category_proposals.h"
#include "tasks/task_names.h"
#include "workflows/import/import.h"

namespace simwright::factory {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMostPlanBytes = 64u << 20;
constexpr int kMostAssets = 100000, kMostTasks = 10000, kMostVariants = 1000;
constexpr int kArticulatedEvery = 10;  // one articulated asset among so many
constexpr int kAssetsOfPart = 12;
constexpr const char* kFurniture[] = {"drawer_unit", "microwave", "cabinet", "box_with_lid"};
constexpr int kPlanFormat = 1;
constexpr size_t kLongestName = 40;
constexpr double kLargestTheme = 1.5;  // times as many categories as kinds are asked for

const std::map<std::string, FactorySource> kSources = {{"library", FactorySource::kLibrary},
                                                       {"photo", FactorySource::kPhoto},
                                                       {"file", FactorySource::kFile}};

std::string SourceName(FactorySource source) {
  for (const auto& [name, value] : kSources) {
    if (value == source) return name;
  }
  return "";
}

bool IsKind(const std::string& kind) {
  if (library::FindRigidKind(kind) != nullptr) return true;
  return std::any_of(library::Kinds().begin(), library::Kinds().end(),
                     [&](const library::Kind& one) { return one.name == kind; });
}

bool IsArticulatedKind(const std::string& kind) {
  return std::any_of(library::Kinds().begin(), library::Kinds().end(),
                     [&](const library::Kind& one) { return one.name == kind; });
}

bool IsPhoto(const fs::path& path) {
  static const std::set<std::string> kEndings{".png", ".jpg", ".jpeg", ".webp"};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kEndings.contains(ending);
}

// Adds `count` assets of kinds in turn; the seeds of each kind count up.
void AddLibraryItems(const std::vector<std::string>& kinds, int count, const FactoryItem& like,
                     FactoryPlan* plan) {
  std::map<std::string, std::uint64_t> next;
  for (int i = 0; i < count; ++i) {
    FactoryItem item = like;
    item.kind = kinds[static_cast<size_t>(i) % kinds.size()];
    item.seed = plan->seed + next[item.kind]++;
    item.name = item.kind + "_" + std::to_string(item.seed);
    plan->items.push_back(std::move(item));
  }
}

// Adds the pictures of a folder: mug/1.jpg or mug_1.jpg are mugs.
void AddPhotoItems(const fs::path& folder, const FactoryItem& like, FactoryPlan* plan) {
  std::vector<fs::path> photos;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && IsPhoto(entry.path())) photos.push_back(entry.path());
  }
  std::sort(photos.begin(), photos.end());
  for (const fs::path& photo : photos) {
    FactoryItem item = like;
    item.source = FactorySource::kPhoto;
    item.file = photo;
    std::string category = photo.parent_path() == folder ? photo.stem().string()
                                                         : photo.parent_path().filename().string();
    while (!category.empty() && (std::isdigit(static_cast<unsigned char>(category.back())) ||
                                 category.back() == '_' || category.back() == '-')) {
      category.pop_back();
    }
    item.kind = category.empty() ? "object" : category;
    item.name = assets::FileSafeName(item.kind + "_" + photo.stem().string());
    plan->items.push_back(std::move(item));
  }
}

void AddFileItems(const fs::path& path, const FactoryItem& like, FactoryPlan* plan) {
  for (const workflows::ImportItem& listed : workflows::ListImports({path}, {})) {
    if (listed.piece >= 0) continue;
    FactoryItem item = like;
    item.source = FactorySource::kFile;
    item.kind.clear();
    item.file = listed.mesh;
    item.name = assets::FileSafeName(listed.name);
    plan->items.push_back(std::move(item));
  }
}

// Returns `name` as a name that tasks can give an asset: a letter first, at most 40 characters.
std::string TaskAssetName(const std::string& name) {
  std::string safe;
  for (const char c : name.substr(0, kLongestName)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
    safe += plain ? c : '_';
  }
  return tasks::IsAssetName(safe) ? safe : "asset_" + safe;
}

// Returns the name of the asset whose texture variant has this name, NAME_NNN; "" if it is none's.
std::string VariantOf(const std::string& name) {
  const size_t end = name.rfind('_');
  const bool numbered = end != std::string::npos && name.size() >= end + 4 &&
                        name.find_first_not_of("0123456789", end + 1) == std::string::npos;
  return numbered ? name.substr(0, end) : "";
}

// Returns true if an asset has the name, or a variant of one of both assets would have the other's.
bool Clashes(const std::string& name, const std::set<std::string>& taken) {
  if (taken.contains(name) || taken.contains(VariantOf(name))) return true;
  for (auto other = taken.lower_bound(name + "_");
       other != taken.end() && other->rfind(name + "_", 0) == 0; ++other) {
    if (VariantOf(*other) == name) return true;
  }
  return false;
}

// Gives items valid and distinct names; none is that of another's texture variant, NAME_NNN.
void MakeNamesDistinct(FactoryPlan* plan) {
  std::map<std::string, int> count;
  std::set<std::string> taken;
  for (FactoryItem& item : plan->items) {
    const std::string base = TaskAssetName(item.name);
    std::string name = base;
    while (Clashes(name, taken)) name = base + "-" + std::to_string(++count[base]);
    taken.insert(name);
    item.name = name;
  }
}

void RequireSize(const FactoryPlan& plan, const std::string& where) {
  if (plan.items.empty()) throw core::Error("the plan has no asset", where);
  if (plan.items.size() > static_cast<size_t>(kMostAssets)) {
    throw core::Error("the plan has more than 100000 assets", where);
  }
}

void AddSource(const core::JsonField& source, const fs::path& folder, FactoryPlan* plan) {
  source.RequireMembers({}, {"library", "photos", "files", "count", "variants", "prompt"});
  FactoryItem like;
  like.seed = plan->seed;
  like.prompt = source.TextOr("prompt", "");
  like.variants = source.Has("variants") ? source["variants"].Int(0, kMostVariants) : 0;
  const int named = static_cast<int>(source.Has("library")) +
                    static_cast<int>(source.Has("photos")) + static_cast<int>(source.Has("files"));
  if (named != 1) source.Fail("must have one of library, photos and files");
  if (source.Has("count") && !source.Has("library")) {
    source["count"].Fail("belongs to library; all photos and files are taken");
  }
  if (source.Has("library")) {
    const std::vector<std::string> kinds = source["library"].Texts();
    if (kinds.empty()) source["library"].Fail("names no kind");
    for (const std::string& kind : kinds) {
      if (!IsKind(kind)) {
        source["library"].Fail("there is no kind '" + kind + "'",
                               "simwright library --list prints the kinds");
      }
    }
    const int count =
        source.Has("count") ? source["count"].Int(1, kMostAssets) : static_cast<int>(kinds.size());
    AddLibraryItems(kinds, count, like, plan);
    return;
  }
  const char* member = source.Has("photos") ? "photos" : "files";
  const fs::path path = folder / source[member].Text();
  if (!fs::exists(path)) source[member].Fail("there is no " + path.string());
  if (source.Has("photos")) {
    if (!fs::is_directory(path)) source[member].Fail("must be a folder");
    AddPhotoItems(path, like, plan);
  } else {
    AddFileItems(path, like, plan);
  }
}

}  // namespace

FactoryPlan PlanOfTheme(const FactoryThemeRequest& request, core::Findings* findings) {
  if (request.assets < 1 || request.assets > kMostAssets || request.tasks < 0 ||
      request.tasks > kMostTasks || request.variants < 0 || request.variants > kMostVariants) {
    throw core::Error("a factory makes 1 to 100000 assets, up to 10000 tasks and 1000 variants",
                      request.theme);
  }
  const int asked =
      static_cast<int>(kLargestTheme * static_cast<double>(library_fit::FitKinds().size()));
  std::vector<std::string> rigid, articulated;
  int without = 0;
  std::set<int> seen;
  for (const proposals::CategoryProposal& proposal :
       proposals::OfflineCategories(request.theme, asked, findings)) {
    const std::vector<int> kinds =
        library_fit::KindsOfCategory(proposal.row.empty() ? proposal.category : proposal.row);
    without += kinds.empty() ? 1 : 0;
    for (const int kind : kinds) {
      if (kinds.size() == library_fit::FitKinds().size() || !seen.insert(kind).second) continue;
      const library_fit::FitKind& of = library_fit::FitKinds()[static_cast<size_t>(kind)];
      (of.articulated != nullptr ? articulated : rigid).push_back(of.name);
    }
  }
  std::erase_if(*findings, [](const core::Finding& f) { return f.code == "proposals-fewer"; });
  if (without > 0) {
    findings->push_back(
        {"factory-no-kind", core::Severity::kInfo, request.theme,
         std::to_string(without) + " proposed categories have no kind in the library",
         static_cast<double>(without),
         "give photos of them: simwright propose, and a plan with photos"});
  }
  if (rigid.empty() && articulated.empty()) {
    throw core::Error("the library has no kind for the theme", request.theme,
                      "see simwright propose --theme");
  }
  // Proposals are objects that a hand moves; tasks also open and fill furniture.
  for (const char* furniture : kFurniture) {
    if (std::find(articulated.begin(), articulated.end(), furniture) == articulated.end()) {
      articulated.emplace_back(furniture);
    }
  }
  FactoryPlan plan;
  plan.theme = request.theme;
  plan.tasks = request.tasks;
  plan.seed = request.seed;
  FactoryItem like;
  like.variants = request.variants;
  const int jointed =
      rigid.empty() ? request.assets : (request.assets + kArticulatedEvery - 1) / kArticulatedEvery;
  FactoryPlan with_joints = plan, without_joints = plan;
  AddLibraryItems(articulated, jointed, like, &with_joints);
  if (!rigid.empty()) AddLibraryItems(rigid, request.assets - jointed, like, &without_joints);
  size_t next = 0;
  for (size_t i = 0; i < with_joints.items.size(); ++i) {
    plan.items.push_back(with_joints.items[i]);
    for (int k = 1; k < kArticulatedEvery && next < without_joints.items.size(); ++k) {
      plan.items.push_back(without_joints.items[next++]);
    }
  }
  MakeNamesDistinct(&plan);
  return plan;
}

FactoryPlan ReadFactoryPlan(const fs::path& file, core::Findings* findings) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMostPlanBytes);
  const core::JsonField root = document.root();
  root.RequireMembers({}, {"theme", "assets", "tasks", "variants", "seed", "sources"});
  const auto number = [&](const char* name, int most, int otherwise) {
    return root.Has(name) ? root[name].Int(0, most) : otherwise;
  };
  const std::uint64_t seed = root.Has("seed") ? root["seed"].Unsigned() : 1;
  if (root.Has("theme") == root.Has("sources")) {
    root.Fail("must have either a theme or sources");
  }
  if (root.Has("theme")) {
    FactoryThemeRequest request;
    request.theme = root["theme"].Name();
    request.assets = number("assets", kMostAssets, request.assets);
    request.tasks = number("tasks", kMostTasks, request.tasks);
    request.variants = number("variants", kMostVariants, 0);
    request.seed = seed;
    return PlanOfTheme(request, findings);
  }
  for (const char* of_themes : {"assets", "variants"}) {
    if (root.Has(of_themes)) root[of_themes].Fail("belongs to a theme; sources have their own");
  }
  FactoryPlan plan;
  plan.seed = seed;
  plan.tasks = number("tasks", kMostTasks, 0);
  for (const core::JsonField& source : root["sources"].Elements()) {
    AddSource(source, file.parent_path(), &plan);
  }
  RequireSize(plan, file.string());
  MakeNamesDistinct(&plan);
  return plan;
}

std::string PlanText(const FactoryPlan& plan) {
  core::OrderedJson json;
  json["format"] = kPlanFormat;
  json["theme"] = plan.theme;
  json["tasks"] = plan.tasks;
  json["tasks_per_part"] = plan.tasks_per_part;
  json["seed"] = plan.seed;
  json["items"] = core::OrderedJson::array();
  for (const FactoryItem& item : plan.items) {
    core::OrderedJson entry;
    entry["name"] = item.name;
    entry["source"] = SourceName(item.source);
    entry["kind"] = item.kind;
    if (!item.file.empty()) entry["file"] = fs::absolute(item.file).string();
    entry["seed"] = item.seed;
    if (!item.prompt.empty()) entry["prompt"] = item.prompt;
    if (item.variants > 0) entry["variants"] = item.variants;
    json["items"].push_back(std::move(entry));
  }
  return core::JsonText(json, core::InvalidUtf8::kReplace);
}

FactoryPlan ReadPlanText(const fs::path& file) {
  const core::JsonDocument document = core::JsonDocument::Read(file, kMostPlanBytes);
  const core::JsonField root = document.root();
  if (root["format"].Int() != kPlanFormat) root["format"].FailAs("1");
  FactoryPlan plan;
  plan.theme = root["theme"].Text();
  plan.tasks = root["tasks"].Int(0, kMostTasks);
  plan.tasks_per_part = root["tasks_per_part"].Int(1, kMostTasks);
  plan.seed = root["seed"].Unsigned();
  for (const core::JsonField& field : root["items"].Elements()) {
    FactoryItem item;
    item.name = field["name"].Name();
    if (item.name != assets::FileSafeName(item.name)) field["name"].Fail("is no name of a folder");
    const auto source = kSources.find(field["source"].Text());
    if (source == kSources.end()) field["source"].FailAs("library, photo or file");
    item.source = source->second;
    item.kind = field["kind"].Text();
    item.file = field.TextOr("file", "");
    item.seed = field["seed"].Unsigned();
    item.prompt = field.TextOr("prompt", "");
    item.variants = field.IntOr("variants", 0);
    plan.items.push_back(std::move(item));
  }
  RequireSize(plan, file.string());
  return plan;
}

int PartCount(const FactoryPlan& plan) {
  return (plan.tasks + plan.tasks_per_part - 1) / plan.tasks_per_part;
}

std::vector<int> ItemsOfPart(const FactoryPlan& plan, int part) {
  std::vector<int> jointed, others;
  for (int i = 0; i < static_cast<int>(plan.items.size()); ++i) {
    const FactoryItem& item = plan.items[static_cast<size_t>(i)];
    const bool articulated = item.source == FactorySource::kLibrary && IsArticulatedKind(item.kind);
    (articulated ? jointed : others).push_back(i);
  }
  // Every part has articulated assets of its own, as far as they go round, and the others in turn.
  std::vector<int> items;
  const auto take = [&](const std::vector<int>& from, int count) {
    const int size = static_cast<int>(from.size());
    for (int k = 0; k < std::min(count, size); ++k) {
      items.push_back(from[static_cast<size_t>((part * count + k) % size)]);
    }
  };
  take(jointed, others.empty() ? kAssetsOfPart : 2);
  take(others, kAssetsOfPart - static_cast<int>(items.size()));
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
  return items;
}

}  // namespace simwright::factory
