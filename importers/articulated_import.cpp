#include "importers/articulated_import.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "assets/joint_poses.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "core/finding_text.h"
#include "core/log.h"
#include "geometry/mass_properties.h"
#include "importers/collision_trimming.h"
#include "importers/import_category.h"
#include "importers/joint_friction.h"
#include "importers/link_folding.h"
#include "importers/link_shapes.h"
#include "importers/link_weight.h"
#include "importers/range_limits.h"
#include "importers/static_stability.h"
#include "physics_params/knowledge_base.h"

namespace simwright::importers {
namespace fs = std::filesystem;
namespace {

using assets::ArticulatedAsset;
using assets::ArticulatedLink;
using assets::SemanticModel;
using assets::UrdfModel;

constexpr int kMaxJoints = 128;          // moving ones; each is swept in two engines
constexpr double kTrimShare = 0.02;      // of the diagonal: trimming limit of small assets
constexpr double kTippingMargin = 0.01;  // of the diagonal: with less, a jerk topples it
constexpr int kRobotChain = 3;           // consecutive moving joints
constexpr int kArmChain = 5;
constexpr int kRobotWheels = 4;
constexpr double kMaxDensity = 11000.0;  // kg/m^3, above all household metals

bool IsNormalised(const fs::path& urdf) {
  const fs::path folder = fs::absolute(urdf).parent_path();
  return urdf.filename() == "mobility.urdf" || urdf.filename() == assets::kGapartnetUrdf ||
         fs::exists(folder / "meta.json") || fs::exists(folder / "bounding_box.json");
}

int MovingJoints(const UrdfModel& model) {
  return static_cast<int>(std::count_if(model.joints.begin(), model.joints.end(),
                                        [](const auto& joint) { return joint.Moves(); }));
}

void RequireJoints(const UrdfModel& model, const std::string& where) {
  const int moving = MovingJoints(model);
  if (moving == 0) throw core::Error("no joint moves", where, "import it as a rigid object");
  if (moving > kMaxJoints) {
    throw core::Error("has " + std::to_string(moving) + " moving joints", where,
                      "at most " + std::to_string(kMaxJoints) + " can be simulated");
  }
}

// Returns the size in the knowledge base's convention: length >= width.
Eigen::Vector3d SizeOf(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d s = box.sizes();
  return {std::max(s.x(), s.y()), std::min(s.x(), s.y()), s.z()};
}

double ScaleOf(const ArticulatedImportOptions& options, bool normalised, const std::string& where,
               const physics_params::PhysicalParameters& p,
               const physics_params::Category& category, const Eigen::Vector3d& size) {
  if (!(size.minCoeff() > 0.0)) {
    throw core::Error("the asset is flat or has no extent", where, "repair its meshes");
  }
  double scale = options.unit;
  if (options.size.size() > 1) {
    throw core::Error("joints do not allow a change of proportions", where,
                      "give one side with --size, or the height with --height");
  }
  if (!options.size.empty()) {
    scale = options.size[0] / size.maxCoeff();
  } else if (options.height > 0.0) {
    scale = options.height / size.z();
  } else if (normalised) {
    scale = std::cbrt(p.length.sample * p.width.sample * p.height.sample / size.prod());
  }
  const bool stated = options.unit_stated || options.height > 0.0 || !options.size.empty();
  if (!stated && !normalised) {
    asset_build::RequirePlausibleSize(category, scale * size, options.unit, where,
                                      asset_build::kAbsurdUrdf);
  }
  const double extent = scale * size.maxCoeff();
  if (!(extent > 1e-3 && extent < 100.0)) {
    char text[80];
    std::snprintf(text, sizeof(text), "the asset would be %.3g m across", extent);
    throw core::Error(text, where, "give its height with --height");
  }
  return scale;
}

// Returns the last word of a qualified label of GAPartNet or PartNet-Mobility ("line_fixed_handle",
// "rotation_door", "furniture_body") if it is one of our labels, else the label unchanged.
std::string PlainLabel(const std::string& label) {
  static const std::set<std::string_view> kLabels{
      "body", "button", "door",  "drawer", "handle", "key",    "knob",  "lever",
      "lid",  "screen", "spout", "switch", "wheel",  "window", "frame", "seat"};
  const size_t last = label.rfind('_');
  if (last == std::string::npos) return label;
  const std::string noun = label.substr(last + 1);
  return kLabels.contains(noun) ? noun : label;
}

std::string LabelOf(const SemanticModel& source, const std::string& link, bool root) {
  const auto found = source.semantics.find(link);
  if (found != source.semantics.end()) return PlainLabel(found->second.label);
  return root ? "body" : "part";
}

// Returns true for built-in assets: doors, faucets and windows, and all that PartNet-Mobility calls
// static.
bool IsBuiltIn(const SemanticModel& source, const std::string& category) {
  static const std::set<std::string_view> kBuiltIn{"door", "faucet", "window"};
  if (kBuiltIn.contains(category)) return true;
  const auto found = source.semantics.find(source.model.links.front().name);
  return found != source.semantics.end() && found->second.joint == "static";
}

// Returns the largest number of moving joints on a path from the root to a link.
int LongestChain(const UrdfModel& model) {
  const std::vector<int> parents = assets::ParentLinks(model);
  std::vector<int> depth(model.links.size(), 0);
  for (size_t i = 0; i < model.joints.size(); ++i) {
    depth[i + 1] = depth[static_cast<size_t>(parents[i])] + (model.joints[i].Moves() ? 1 : 0);
  }
  return *std::max_element(depth.begin(), depth.end());
}

// Returns true for an asset with the joint chain of an arm, and for one of unknown category with a
// shorter chain, such as legs, or with several continuous joints. A desk lamp also has such a chain
// but is a known category; no household object has the whole chain of an arm.
bool IsRobot(const UrdfModel& model, const physics_params::Category& category) {
  if (LongestChain(model) >= kArmChain) return true;
  if (category.name != "object") return false;
  const auto wheels =
      std::count_if(model.joints.begin(), model.joints.end(),
                    [](const auto& joint) { return joint.type == assets::JointType::kContinuous; });
  return LongestChain(model) >= kRobotChain || wheels >= kRobotWheels;
}

// Makes the names of links and joints usable as file names and as names in programs.
void MakeNamesSafe(SemanticModel* source) {
  std::map<std::string, std::string> renamed;
  std::set<std::string> taken;
  const auto safe = [&taken](const std::string& name) {
    // MuJoCo reserves "world".
    const std::string base = name == "world" ? "world_link" : assets::FileSafeName(name);
    std::string unique = base;
    for (int i = 2; !taken.insert(unique).second; ++i) unique = base + "_" + std::to_string(i);
    return unique;
  };
  for (assets::UrdfLink& link : source->model.links) {
    const std::string before = link.name;
    link.name = renamed[before] = safe(before);
    if (const auto found = source->semantics.find(before);
        found != source->semantics.end() && link.name != before) {
      source->semantics[link.name] = found->second;
    }
  }
  taken.clear();
  for (assets::Joint& joint : source->model.joints) {
    joint.name = safe(joint.name);
    joint.parent = renamed.at(joint.parent);
    joint.child = renamed.at(joint.child);
  }
}

void Add(const core::Findings& some, UrdfModel* model) {
  model->findings.insert(model->findings.end(), some.begin(), some.end());
}

// Replaces the links' collisions by convex parts.
void MakeParts(bool robot, const asset_build::PartBudget& budget, core::Progress* progress,
               UrdfModel* model) {
  const double whole = BoundsAtZero(*model).diagonal().norm();
  progress->Stage("collision parts", 1);
  std::vector<std::vector<core::TriangleMesh>> parts =
      ConvexPartsOf(model->links, whole, robot, budget, &model->findings);
  for (size_t i = 0; i < parts.size(); ++i) {
    assets::UrdfLink& link = model->links[i];
    if (link.visuals.empty()) link.visuals = link.collisions;
    link.collisions.clear();
    for (core::TriangleMesh& part : parts[i]) link.collisions.push_back({std::move(part), ""});
  }
  progress->Advance();
  progress->Finish();
}

// Summarises findings about a robot, whose links overlap at the joints and collide with each other
// by design: one finding per code, with the worst figure, instead of one per pair.
core::Findings Summarised(const core::Findings& findings, const std::string& name) {
  core::Findings kept;
  std::map<std::string, core::Findings> by_code;
  for (const core::Finding& one : findings) by_code[one.code].push_back(one);
  for (auto& [code, some] : by_code) {
    const auto worst = std::max_element(
        some.begin(), some.end(), [](const auto& a, const auto& b) { return a.figure < b.figure; });
    core::Finding line = *worst;
    line.severity = core::Severity::kInfo;
    line.sentence = "'" + line.place + "': " + line.sentence;
    if (some.size() > 1) {
      line.sentence += "; also " + std::to_string(some.size() - 1) + " more pairs, by less";
    }
    line.place = name;
    line.remedy.clear();
    kept.push_back(std::move(line));
  }
  return kept;
}

// Makes the asset statically stable and its joints free to move: obstructing geometry is trimmed,
// limits the joint's range, or is excluded from contact. An asset whose joints reach below the
// floor it would stand on is fixed in place instead.
void MakeJointsFree(bool robot, bool* fixed, UrdfModel* model) {
  const double whole = BoundsAtZero(*model).diagonal().norm();
  CollisionTrimmingOptions clearing;
  clearing.most = std::min(clearing.most, kTrimShare * whole);
  clearing.gap = std::min(clearing.gap, 0.6 * clearing.most);
  if (!*fixed) Add(MakeStaticallyStable(model), model);
  RangeResult ranges = LimitRangesAtObstacles({clearing.most, !*fixed, !robot}, model);
  Add(ranges.findings, model);
  if (ranges.floor_in_the_way) {
    *fixed = true;
    Add({{"held", core::Severity::kWarning, model->name,
          "a joint would penetrate the floor right from its zero position: the asset is fixed in "
          "place, like one that hangs on a wall or lies on the edge of a table",
          0.0, "set `fixed` to false to let it stand freely"}},
        model);
  }
  clearing.on_floor = !*fixed;
  const core::Findings cleared = TrimMovingParts(clearing, model);
  Add(robot ? Summarised(cleared, model->name) : cleared, model);
}

// Applies a stated mass or density to the whole asset.
void ReweighLinks(const physics_params::StatedPhysics& stated, ArticulatedAsset* asset) {
  double before = 0.0;
  for (const ArticulatedLink& link : asset->links) before += link.inertial.mass;
  for (ArticulatedLink& link : asset->links) {
    for (double& density : link.densities) {
      density = stated.mass ? density * *stated.mass / before : *stated.density;
    }
    const geometry::MassProperties total = LinkMassProperties(link);
    link.inertial = {total.mass, total.center_of_mass, total.inertia};
  }
}

// Reports links whose centre of mass in the file is farther than 5 % of the link's diagonal from
// the integral over its parts, which is the one that is used.
void ReportReplacedInertials(const UrdfModel& model, ArticulatedAsset* asset) {
  constexpr double kFar = 0.05;  // of the link's diagonal
  double farthest = 0.0;
  std::string worst;
  int count = 0;
  for (size_t i = 0; i < asset->links.size(); ++i) {
    const auto& file = model.links[i].inertial;
    if (!file) continue;
    Eigen::AlignedBox3d box;
    for (const core::TriangleMesh& part : asset->links[i].parts) box.extend(core::Bounds(part));
    const double off = (file->center_of_mass - asset->links[i].inertial.center_of_mass).norm();
    if (off <= kFar * box.diagonal().norm()) continue;
    ++count;
    if (off <= farthest) continue;
    farthest = off;
    worst = asset->links[i].name;
  }
  if (count == 0) return;
  asset->findings.push_back(
      {"inertial-replaced", core::Severity::kWarning, worst,
       "its centre of mass lies " + core::Millimetres(farthest) +
           " from the file's: inertials are computed from parts of uniform density; it affects " +
           std::to_string(count) + " of " + std::to_string(asset->links.size()) + " links",
       1e3 * farthest, "model an internal weight as a separate shape"});
}

// Assigns masses. The file's masses apply if its lengths are also in metres; a link without a mass
// gets the mean density of the others. Otherwise the category's mass is split by volume. Stated
// values take precedence. Returns true if the file's masses apply.
bool GiveMass(const UrdfModel& model, bool metric, const physics_params::Category& category,
              const physics_params::StatedPhysics& stated, ArticulatedAsset* asset) {
  double volume = 0.0;
  for (ArticulatedLink& link : asset->links) {
    link.densities.assign(link.parts.size(), 1.0);
    link.volume = LinkMassProperties(link).volume;
    volume += link.volume;
  }
  physics_params::PhysicalParameters& p = asset->parameters;
  const std::string unusual =
      physics_params::ScaleMassToSize(category, SizeOf(BoundsAtZero(model)), volume, &p);
  double known = 0.0, known_volume = 0.0;
  std::string guessed;
  for (size_t i = 0; i < model.links.size(); ++i) {
    if (model.links[i].inertial) {
      known += model.links[i].inertial->mass;
      known_volume += asset->links[i].volume;
    } else {
      guessed += (guessed.empty() ? "'" : "', '") + model.links[i].name;
    }
  }
  const bool given = metric && known > 0.0;
  if (given && !guessed.empty()) {
    asset->findings.push_back(
        {"urdf-mass-guessed", core::Severity::kWarning, asset->name,
         "the file gives no mass for " + guessed + "': the mean density of the other links is used",
         known / known_volume, "give each link an <inertial>"});
  }
  if (!unusual.empty() && !given) {
    asset->findings.push_back(
        {"unusual-size", core::Severity::kWarning, asset->name, unusual, 0.0});
  }
  // The catch-all "object" has no typical mass: the material's density is sampled.
  const double common = category.name == "object" ? p.density.sample : p.mass.sample / volume;
  double mass = 0.0, densest = 0.0;
  for (size_t i = 0; i < asset->links.size(); ++i) {
    ArticulatedLink& link = asset->links[i];
    const double density = !given                    ? common
                           : model.links[i].inertial ? model.links[i].inertial->mass / link.volume
                                                     : known / known_volume;
    link.densities.assign(link.parts.size(), density);
    const geometry::MassProperties total = LinkMassProperties(link);
    link.inertial = {total.mass, total.center_of_mass, total.inertia};
    mass += total.mass;
    densest = std::max(densest, density);
  }
  if (stated.mass || stated.density) {
    ReweighLinks(stated, asset);
    mass = densest = 0.0;
    for (const ArticulatedLink& link : asset->links) {
      mass += link.inertial.mass;
      for (const double density : link.densities) densest = std::max(densest, density);
    }
  }
  if (given) ReportReplacedInertials(model, asset);
  if (densest > kMaxDensity) {
    asset->findings.push_back({"implausible-density", core::Severity::kWarning, asset->name,
                               "its geometry is too thin for its mass: the densest link has " +
                                   std::to_string(std::lround(densest)) + " kg/m3",
                               densest});
  }
  p.mass.sample = mass;
  p.mass.min = std::min(p.mass.min, mass);
  p.mass.max = std::max(p.mass.max, mass);
  return given;
}

// Fixes an asset that would tip over: large appliances are screwed to the wall, or their file omits
// the weight in their base.
void FixIfItTips(ArticulatedAsset* asset) {
  const UrdfModel model = assets::ModelOf(*asset);
  const TippingMargin least = LeastTippingMargin(model);
  if (least.margin > kTippingMargin * assets::BoundsAtZero(*asset).diagonal().norm()) return;
  asset->fixed = true;
  asset->findings.push_back(
      {"held", core::Severity::kWarning, asset->name,
       "free on the floor it would tip over when '" + least.joint +
           "' opens: it is fixed in place; its centre of mass is within its support polygon by " +
           core::Millimetres(least.margin),
       1e3 * least.margin, "set `fixed` to false to let it stand freely"});
}

ArticulatedAsset AssetFrom(const SemanticModel& source) {
  ArticulatedAsset asset;
  asset.joints = source.model.joints;
  asset.excluded_pairs = source.model.excluded_pairs;
  for (size_t i = 0; i < source.model.links.size(); ++i) {
    const assets::UrdfLink& from = source.model.links[i];
    ArticulatedLink& link = asset.links.emplace_back();
    link.name = from.name;
    link.label = LabelOf(source, from.name, i == 0);
    link.visual = ColoredVisual(from);
    for (const assets::UrdfShape& shape : from.collisions) link.parts.push_back(shape.mesh);
  }
  std::set<std::pair<std::string, std::string>> seen;  // findings repeat for visuals and collisions
  for (core::Finding finding : source.model.findings) {
    // All inertials are recomputed, and mimic joints are reported where they are changed.
    if (finding.code == "urdf-no-inertial" || finding.code == "urdf-mimic") continue;
    if (finding.place == source.urdf.string()) finding.place = source.urdf.filename().string();
    if (seen.emplace(finding.place, finding.sentence).second) asset.findings.push_back(finding);
  }
  return asset;
}

// Implements ImportArticulated.
ArticulatedAsset ConvertedModel(SemanticModel source, const ArticulatedImportOptions& options,
                                core::Progress* progress) {
  const fs::path urdf = source.urdf;
  const std::string where = urdf.string();
  RequireJoints(source.model, where);
  FoldEmptyLinks(&source.model);
  const bool known = !options.category.empty() || !source.category.empty();
  physics_params::Resolution category =
      ImportCategory(options.category, source.category.empty() ? source.name : source.category);
  const bool robot =
      IsRobot(source.model, *category.category) && !(known && category.category->name != "object");
  // The file name of a robot ("model", "hand") does not determine its category.
  if (robot) category = ImportCategory("object", "");
  NormaliseJoints(&source.model, robot);
  RequireJoints(source.model, where);
  MakeNamesSafe(&source);

  const auto& base = physics_params::KnowledgeBase::Shipped();
  physics_params::PhysicalParameters parameters =
      physics_params::SampleParameters(*category.category, base, options.seed);
  parameters.resolution = category.sentence;
  const bool normalised = IsNormalised(urdf);
  const double scale = ScaleOf(options, normalised, where, parameters, *category.category,
                               SizeOf(BoundsAtZero(source.model)));
  CenterAboveOrigin(scale, &source.model);
  bool fixed = robot || source.model.root_is_world || IsBuiltIn(source, category.category->name);
  MakeParts(robot, options.budget, progress, &source.model);
  MakeJointsFree(robot, &fixed, &source.model);

  ArticulatedAsset asset = AssetFrom(source);
  asset.name = assets::FileSafeName(options.name);
  asset.source = urdf.filename().string();
  asset.seed = options.seed;
  asset.fixed = fixed;
  asset.parameters = parameters;
  const core::Findings understood = physics_params::ResolutionFindings(category, asset.name);
  asset.findings.insert(asset.findings.end(), understood.begin(), understood.end());
  const bool given = GiveMass(source.model, !normalised && scale == options.unit,
                              *category.category, options.stated, &asset);
  Apply(options.stated, &asset.parameters);
  const physics_params::Material& material = *base.FindMaterial(parameters.material);
  for (ArticulatedLink& link : asset.links) {
    link.material = material.name;
    link.friction = asset.parameters.friction.sample;
    link.restitution = parameters.restitution.sample;
  }
  if (robot) {
    asset.features[assets::kKindFeature] = assets::kRobotKind;
    asset.findings.push_back(
        {"robot", core::Severity::kInfo, asset.name,
         "it is classified as a robot: its root is fixed, its collision meshes are convex hulls, "
         "and its motors hold its joints, whose friction and damping are the file's",
         static_cast<double>(MovingJoints(source.model)), "give --category if it is not a robot"});
    return asset;
  }
  if (!given) LightenHeavyHinges(&asset);
  if (!fixed) FixIfItTips(&asset);
  core::Rng rng = core::StreamRng(options.seed, 1);
  AssignJointFriction(rng, &asset);
  return asset;
}

}  // namespace

fs::path ArticulatedUrdfIn(const fs::path& folder) {
  if (fs::is_regular_file(folder / assets::kGapartnetUrdf)) return folder / assets::kGapartnetUrdf;
  try {
    return assets::UrdfIn(folder);
  } catch (const core::Error&) {
    return {};
  }
}

bool HasMovingJoint(const SemanticModel& source) {
  UrdfModel model = source.model;
  FoldEmptyLinks(&model);
  NormaliseJoints(&model);
  return MovingJoints(model) > 0;
}

ArticulatedAsset ImportArticulated(const fs::path& urdf, const ArticulatedImportOptions& options,
                                   core::Progress* progress) {
  return ImportArticulated(assets::ReadSemanticModel(urdf, {options.root, true}), options,
                           progress);
}

ArticulatedAsset ImportArticulated(SemanticModel source, const ArticulatedImportOptions& options,
                                   core::Progress* progress) {
  core::Log(core::LogLevel::kInfo, "importers", "importing ", source.urdf, ": ",
            source.model.links.size(), " links, ", MovingJoints(source.model), " moving joints");
  ArticulatedAsset asset = ConvertedModel(std::move(source), options, progress);
  core::Log(core::LogLevel::kInfo, "importers", asset.name, ": ", asset.links.size(), " links, ",
            asset.fixed ? "fixed" : "free", ", ", asset.findings.size(), " findings");
  return asset;
}

}  // namespace simwright::importers
