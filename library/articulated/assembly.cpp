#include "library/articulated/assembly.h"

#include <algorithm>
#include <map>

#include "assets/joint_gravity_load.h"
#include "assets/kinematic_model.h"
#include "core/error.h"
#include "geometry/mass_properties.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

constexpr double kHoldFactor = 1.3;  // of the maximum gravity load on a joint
constexpr int kLoadSamples = 32;     // samples over a joint's range

// Returns a random stream per kind, so that a seed gives independent samples for each: FNV-1a, the
// same on every standard library.
std::uint64_t StreamOf(const std::string& kind) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : kind) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return hash;
}

physics_params::PhysicalParameters Sampled(const std::string& category, std::uint64_t seed) {
  const auto& base = physics_params::KnowledgeBase::Shipped();
  const physics_params::Category* row = base.FindCategory(category);
  if (row == nullptr) throw core::Error("no such category in the knowledge base", category);
  return physics_params::SampleParameters(*row, base, seed);
}

void AddColored(const core::TriangleMesh& mesh, const Matter& matter, core::TexturedMesh* visual) {
  core::Append(mesh, &visual->mesh);
  size_t index = 0;
  while (index < visual->materials.size() && visual->materials[index].name != matter.look) ++index;
  if (index == visual->materials.size()) {
    visual->materials.push_back({matter.look, matter.color, -1});
  }
  visual->triangle_material.resize(visual->mesh.triangles.size(), static_cast<int>(index));
}

}  // namespace

JointResistance SampleJointResistance(core::Rng& rng, double lever) {
  JointResistance feel;
  feel.friction = core::Uniform(rng, 1.5, 8.0) * lever;
  feel.damping = feel.friction / core::Uniform(rng, 1.0, 4.0);
  return feel;
}

Assembly::Assembly(const std::string& kind, const physics_params::PhysicalParameters& parameters,
                   const Options& options)
    : options_(options), draws_(core::StreamRng(options.seed, StreamOf(kind)), options.draws) {
  asset_.parameters = parameters;
  if (options.size) {
    asset_.parameters.length.sample = options.size->x();
    asset_.parameters.width.sample = options.size->y();
    asset_.parameters.height.sample = options.size->z();
  }
  asset_.parameters.resolution = "the library's " + kind;
  asset_.name = options.name.empty() ? kind : options.name;
  asset_.source = "library/" + kind;
  asset_.seed = options.seed;
}

Assembly::Assembly(const std::string& kind, const std::string& category, const Options& options)
    : Assembly(kind, Sampled(category, options.seed ^ StreamOf(kind)), options) {}

void Assembly::RecordFeature(const std::string& feature, const std::string& value) {
  asset_.features[feature] = value;
}

int Assembly::AddRoot(const std::string& name, const std::string& label) {
  asset_.links.emplace_back().name = name;
  asset_.links.back().label = label;
  pieces_.emplace_back();
  origins_.push_back(Eigen::Vector3d::Zero());
  return 0;
}

int Assembly::AddLink(const std::string& name, const std::string& label, int parent,
                      const JointPlan& plan) {
  asset_.links.emplace_back().name = name;
  asset_.links.back().label = label;
  pieces_.emplace_back();
  origins_.push_back(plan.origin);
  assets::Joint joint;
  joint.name = name + "_joint";
  joint.parent = asset_.links[static_cast<size_t>(parent)].name;
  joint.child = name;
  joint.type = plan.type;
  joint.parent_from_joint.translation() = plan.origin - origins_[static_cast<size_t>(parent)];
  joint.axis = plan.axis;
  joint.lower = plan.lower;
  joint.upper = plan.upper;
  joint.friction = plan.joint_resistance.friction;
  joint.damping = plan.joint_resistance.damping;
  asset_.joints.push_back(joint);
  return static_cast<int>(asset_.links.size()) - 1;
}

void Assembly::Add(int link, const Matter& matter, const core::TriangleMesh& piece) {
  pieces_.at(static_cast<size_t>(link)).push_back({matter, piece, true});
}

void Assembly::Add(int link, const Matter& matter, const std::vector<core::TriangleMesh>& pieces) {
  for (const core::TriangleMesh& piece : pieces) Add(link, matter, piece);
}

void Assembly::Paint(int link, const Matter& matter, const core::TriangleMesh& piece) {
  pieces_.at(static_cast<size_t>(link)).push_back({matter, piece, false});
}

int Assembly::AddHandle(const std::string& name, int parent, HandleKind kind,
                        const HandlePlacement& place, const Matter& matter) {
  JointPlan plan;
  plan.origin = GripPoint(place);
  const int link = AddLink(name, "handle", parent, plan);
  Add(link, matter, HandleMeshes(kind, place));
  return link;
}

void Assembly::FitDensity(const std::string& material) {
  double fitted = 0.0, rest = 0.0, density = 0.0;
  for (const std::vector<Piece>& link : pieces_) {
    for (const Piece& piece : link) {
      if (!piece.solid) continue;
      const bool fits = piece.matter.material == material;
      (fits ? fitted : rest) +=
          geometry::SolidMassProperties(piece.mesh, piece.matter.density).mass;
      if (fits) density = piece.matter.density;
    }
  }
  if (!(fitted > 0.0)) return;
  const physics_params::Interval range =
      physics_params::KnowledgeBase::Shipped().FindMaterial(material)->density;
  const double wanted = density * (asset_.parameters.mass.sample - rest) / fitted;
  const double scale = std::clamp(wanted, range.min, range.max) / density;
  for (std::vector<Piece>& link : pieces_) {
    for (Piece& piece : link) {
      if (piece.matter.material == material) piece.matter.density *= scale;
    }
  }
}

void Assembly::FillAppearance(size_t index) {
  const Eigen::Affine3d link_from_root(Eigen::Translation3d(-origins_[index]));
  for (Piece& piece : pieces_[index]) {
    core::Transform(link_from_root, &piece.mesh);
    AddColored(piece.mesh, piece.matter, &asset_.links[index].visual);
  }
}

void Assembly::FillLink(size_t index) {
  assets::ArticulatedLink& link = asset_.links[index];
  const Eigen::Affine3d link_from_root(Eigen::Translation3d(-origins_[index]));
  std::map<std::string, double> mass_of;
  geometry::MassProperties total;
  for (const Piece& piece : pieces_[index]) {
    core::TriangleMesh mesh = piece.mesh;
    core::Transform(link_from_root, &mesh);
    AddColored(mesh, piece.matter, &link.visual);
    if (!piece.solid) continue;
    const geometry::MassProperties one = geometry::SolidMassProperties(mesh, piece.matter.density);
    total = total.mass > 0.0 ? geometry::Combined(total, one) : one;
    mass_of[piece.matter.material] += one.mass;
    link.parts.push_back(std::move(mesh));
    link.densities.push_back(piece.matter.density);
  }
  if (link.parts.empty()) throw core::Error("a link has no pieces", link.name);
  link.inertial = {total.mass, total.center_of_mass, total.inertia};
  link.volume = total.volume;
  link.material =
      std::max_element(mass_of.begin(), mass_of.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      })->first;
  const physics_params::Material& material =
      *physics_params::KnowledgeBase::Shipped().FindMaterial(link.material);
  link.friction = 0.5 * (material.friction.min + material.friction.max);
  link.restitution = 0.5 * (material.restitution.min + material.restitution.max);
}

void Assembly::SetJointFriction() {
  const auto model = assets::MakeKinematicModel(asset_);
  for (size_t i = 0; i < asset_.joints.size(); ++i) {
    assets::Joint& joint = asset_.joints[i];
    if (!joint.Moves()) continue;
    double load = 0.0;
    for (int k = 0; k <= kLoadSamples; ++k) {
      const double position = joint.lower + (joint.upper - joint.lower) * k / kLoadSamples;
      load =
          std::max(load, std::abs(assets::LoadOn(*model, static_cast<int>(i), position).gravity));
    }
    joint.friction = std::max(joint.friction, kHoldFactor * load);
    joint.effort = 4.0 * (joint.friction + load);
    joint.velocity = 5.0 * (joint.upper - joint.lower);
  }
}

assets::ArticulatedAsset Assembly::Finish(const std::string& fitted) {
  if (options_.record != nullptr) *options_.record = draws_.record();
  if (options_.appearance_only) {
    for (size_t i = 0; i < asset_.links.size(); ++i) FillAppearance(i);
    return std::move(asset_);
  }
  if (!fitted.empty()) FitDensity(fitted);
  double mass = 0.0;
  for (size_t i = 0; i < asset_.links.size(); ++i) {
    FillLink(i);
    mass += asset_.links[i].inertial.mass;
  }
  SetJointFriction();
  physics_params::Estimate& range = asset_.parameters.mass;
  if (mass < range.min || mass > range.max) {
    asset_.findings.push_back({"library-mass", core::Severity::kInfo, asset_.name,
                               "the mass of its pieces is outside the category's range", mass});
  }
  range.sample = mass;
  range.min = std::min(range.min, mass);
  range.max = std::max(range.max, mass);
  return std::move(asset_);
}

}  // namespace simwright::library
