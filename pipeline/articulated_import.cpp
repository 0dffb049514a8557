#include "pipeline/articulated_import.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "assets/joint_poses.h"
#include "assets/semantic_model.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "physics_params/knowledge_base.h"
#include "pipeline/import_category.h"
#include "pipeline/joint_feel.h"
#include "pipeline/link_folding.h"
#include "pipeline/link_shapes.h"
#include "pipeline/part_clearing.h"

namespace simwright::pipeline {
namespace fs = std::filesystem;
namespace {

using assets::ArticulatedAsset;
using assets::ArticulatedLink;
using assets::SemanticModel;
using assets::UrdfModel;

constexpr int kMostJoints = 128;       // that move: a keyboard's keys; each is swung in two engines
constexpr double kSloppyShare = 0.02;  // of the diagonal: no more is trimmed of small things
constexpr double kHeaviest = 11000.0;  // kg/m^3: household metals are lighter

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
  if (moving == 0) {
    throw core::Error("no joint moves", where, "import its meshes, as a rigid thing");
  }
  if (moving > kMostJoints) {
    throw core::Error("has " + std::to_string(moving) + " joints that move", where,
                      "at most " + std::to_string(kMostJoints) + " can be tried in the engines");
  }
}

// Size as the knowledge base counts it: length >= width.
Eigen::Vector3d SizeOf(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d s = box.sizes();
  return {std::max(s.x(), s.y()), std::min(s.x(), s.y()), s.z()};
}

double ScaleOf(const ArticulatedImportOptions& options, bool normalised, const std::string& where,
               const physics_params::PhysicalParameters& p, const Eigen::Vector3d& size) {
  if (!(size.minCoeff() > 0.0)) {
    throw core::Error("the whole is flat or has no extent", where, "mend its meshes");
  }
  double scale = options.unit;
  if (options.height > 0.0) {
    scale = options.height / size.z();
  } else if (normalised) {
    scale = std::cbrt(p.length.sample * p.width.sample * p.height.sample / size.prod());
  }
  const double extent = scale * size.maxCoeff();
  if (!(extent > 1e-3 && extent < 100.0)) {
    char text[80];
    std::snprintf(text, sizeof(text), "the whole would be %.3g m across", extent);
    throw core::Error(text, where, "say its height with --height");
  }
  return scale;
}

// GAPartNet and PartNet-Mobility qualify what a link is ("line_fixed_handle", "rotation_door",
// "furniture_body"): the thing itself is what we call it too.
std::string PlainLabel(const std::string& label) {
  static const std::set<std::string_view> kThings{
      "body", "button", "door",  "drawer", "handle", "key",    "knob",  "lever",
      "lid",  "screen", "spout", "switch", "wheel",  "window", "frame", "seat"};
  const size_t last = label.rfind('_');
  if (last == std::string::npos) return label;
  const std::string thing = label.substr(last + 1);
  return kThings.contains(thing) ? thing : label;
}

std::string LabelOf(const SemanticModel& source, const std::string& link, bool root) {
  const auto found = source.semantics.find(link);
  if (found != source.semantics.end()) return PlainLabel(found->second.label);
  return root ? "body" : "part";
}

// Doors, faucets and windows are built in; so is what PartNet-Mobility calls static.
bool StandsFixed(const SemanticModel& source, const std::string& category) {
  static const std::set<std::string_view> kBuiltIn{"door", "faucet", "window"};
  if (kBuiltIn.contains(category)) return true;
  const auto found = source.semantics.find(source.model.links.front().name);
  return found != source.semantics.end() && found->second.joint == "static";
}

// Names of links and joints become names of files and of things in programs.
void MakeNamesSafe(SemanticModel* source) {
  std::map<std::string, std::string> renamed;
  std::set<std::string> taken;
  const auto safe = [&taken](const std::string& name) {
    const std::string base = assets::FileSafeName(name);
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
  for (assets::UrdfJoint& joint : source->model.joints) {
    joint.name = safe(joint.name);
    joint.parent = renamed.at(joint.parent);
    joint.child = renamed.at(joint.child);
  }
}

// Replaces the links' collisions by convex parts that clear each other.
void MakeParts(bool fixed, core::Progress* progress, UrdfModel* model) {
  const double whole = BoundsAtZero(*model).diagonal().norm();
  progress->Stage("collision parts", static_cast<int>(model->links.size()));
  std::vector<std::vector<assets::UrdfShape>> parts;
  for (const assets::UrdfLink& link : model->links) {
    core::CheckCancelled();
    parts.emplace_back();
    for (core::TriangleMesh& part : ConvexPartsOf(link, whole, &model->findings)) {
      parts.back().push_back({std::move(part), ""});
    }
    progress->Advance();
  }
  for (size_t i = 0; i < parts.size(); ++i) {
    if (model->links[i].visuals.empty()) model->links[i].visuals = model->links[i].collisions;
    model->links[i].collisions = std::move(parts[i]);
  }
  progress->Finish();
  ClearingOptions clearing;
  clearing.most = std::min(clearing.most, kSloppyShare * whole);
  clearing.gap = std::min(clearing.gap, 0.6 * clearing.most);
  clearing.on_floor = !fixed;
  const core::Findings findings = ClearMovingParts(clearing, model);
  model->findings.insert(model->findings.end(), findings.begin(), findings.end());
}

geometry::MassProperties Weighed(const ArticulatedLink& link) {
  geometry::MassProperties total;
  for (size_t i = 0; i < link.parts.size(); ++i) {
    const auto one = geometry::SolidMassProperties(link.parts[i], link.densities[i]);
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
  }
  return total;
}

// Masses that the file gives for every link count where its lengths are metres too; else the
// category's mass is split by volume.
void GiveMass(const UrdfModel& model, bool metric, const physics_params::Category& category,
              ArticulatedAsset* asset) {
  double volume = 0.0;
  for (ArticulatedLink& link : asset->links) {
    link.densities.assign(link.parts.size(), 1.0);
    link.volume = Weighed(link).volume;
    volume += link.volume;
  }
  physics_params::PhysicalParameters& p = asset->parameters;
  const std::string unusual =
      physics_params::FollowSize(category, SizeOf(BoundsAtZero(model)), volume, &p);
  const bool given = metric && std::all_of(model.links.begin(), model.links.end(),
                                           [](const auto& link) { return link.inertial; });
  if (!unusual.empty() && !given) {
    asset->findings.push_back(
        {"unusual-size", core::Severity::kWarning, asset->name, unusual, 0.0});
  }
  // Of a mere object no mass is known: its material's density is drawn.
  const double common = category.name == "object" ? p.density.sample : p.mass.sample / volume;
  double mass = 0.0, densest = 0.0;
  for (size_t i = 0; i < asset->links.size(); ++i) {
    ArticulatedLink& link = asset->links[i];
    const double density = given ? model.links[i].inertial->mass / link.volume : common;
    link.densities.assign(link.parts.size(), density);
    const geometry::MassProperties total = Weighed(link);
    link.inertial = {total.mass, total.center_of_mass, total.inertia};
    mass += total.mass;
    densest = std::max(densest, density);
  }
  if (densest > kHeaviest) {
    asset->findings.push_back({"implausible-density", core::Severity::kWarning, asset->name,
                               "its walls are thin for its mass: kg/m3 of the densest link",
                               densest});
  }
  p.mass.sample = mass;
  p.mass.min = std::min(p.mass.min, mass);
  p.mass.max = std::max(p.mass.max, mass);
}

ArticulatedAsset AssetFrom(const SemanticModel& source) {
  ArticulatedAsset asset;
  asset.joints = source.model.joints;
  for (size_t i = 0; i < source.model.links.size(); ++i) {
    const assets::UrdfLink& from = source.model.links[i];
    ArticulatedLink& link = asset.links.emplace_back();
    link.name = from.name;
    link.label = LabelOf(source, from.name, i == 0);
    link.visual = ColoredVisual(from);
    for (const assets::UrdfShape& shape : from.collisions) link.parts.push_back(shape.mesh);
  }
  std::set<std::pair<std::string, std::string>> told;  // of visuals, and again of collisions
  for (core::Finding finding : source.model.findings) {
    // Every inertial is made anew, and what mimics is told of where it is changed.
    if (finding.code == "urdf-no-inertial" || finding.code == "urdf-mimic") continue;
    if (finding.place == source.urdf.string()) finding.place = source.urdf.filename().string();
    if (told.emplace(finding.place, finding.sentence).second) asset.findings.push_back(finding);
  }
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

ArticulatedAsset ImportArticulated(const fs::path& urdf, const ArticulatedImportOptions& options,
                                   core::Progress* progress) {
  SemanticModel source = assets::ReadSemanticModel(urdf);
  const std::string where = urdf.string();
  RequireJoints(source.model, where);
  FoldEmptyLinks(&source.model);
  NormaliseJoints(&source.model);
  RequireJoints(source.model, where);
  MakeNamesSafe(&source);

  const physics_params::Resolution category =
      ImportCategory(options.category, source.category.empty() ? source.name : source.category);
  const auto& base = physics_params::KnowledgeBase::Shipped();
  physics_params::PhysicalParameters parameters =
      physics_params::SampleParameters(*category.category, base, options.seed);
  parameters.resolution = category.sentence;
  const bool normalised = IsNormalised(urdf);
  const double scale =
      ScaleOf(options, normalised, where, parameters, SizeOf(BoundsAtZero(source.model)));
  StandOnOrigin(scale, &source.model);
  const bool fixed = StandsFixed(source, category.category->name);
  MakeParts(fixed, progress, &source.model);

  ArticulatedAsset asset = AssetFrom(source);
  asset.name = assets::FileSafeName(options.name);
  asset.source = urdf.filename().string();
  asset.seed = options.seed;
  asset.fixed = fixed;
  asset.parameters = parameters;
  GiveMass(source.model, !normalised && scale == options.unit, *category.category, &asset);
  const physics_params::Material& material = *base.FindMaterial(parameters.material);
  for (ArticulatedLink& link : asset.links) {
    link.material = material.name;
    link.friction = parameters.friction.sample;
    link.restitution = parameters.restitution.sample;
  }
  core::Rng rng = core::StreamRng(options.seed, 1);
  GiveJointsFeel(rng, &asset);
  return asset;
}

}  // namespace simwright::pipeline
