#include "asset_build/asset_builder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "asset_build/rest_pose.h"
#include "asset_build/support_polygon.h"
#include "asset_build/true_size.h"
#include "core/error.h"
#include "core/log.h"
#include "geometry/concavity.h"
#include "geometry/mass_properties.h"
#include "physics_params/volume_mass.h"

namespace simwright::asset_build {
namespace {

constexpr int kSupportCorners = 12;
constexpr int kRestPasses = 3;

class StageClock {
 public:
  StageClock(core::Progress* progress, StageSeconds* seconds)
      : progress_(progress), seconds_(seconds) {}
  ~StageClock() { End(); }
  void Begin(const std::string& stage) {
    End();
    stage_ = stage;
    start_ = std::chrono::steady_clock::now();
    progress_->Stage(stage);
  }
  void End() {
    if (stage_.empty()) return;
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    (*seconds_)[stage_] += seconds;
    core::Log(core::LogLevel::kDebug, "asset_build", stage_, " took ", seconds, " s");
    progress_->Finish();
    stage_.clear();
  }

 private:
  core::Progress* progress_;
  StageSeconds* seconds_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

void MakeSolidPart(const BuildRequest& request, assets::Asset* asset) {
  geometry::Solid solid = geometry::MakeSolid(asset->visual.mesh, request.solid);
  asset->solid = std::move(solid.mesh);
  asset->solid_method = geometry::Name(solid.method);
  asset->sheet_thickness = solid.sheet_thickness;
  asset->findings.insert(asset->findings.end(), solid.findings.begin(), solid.findings.end());
}

// Reports a density above that of osmium, the densest element: the stated mass or the scale is
// wrong.
void ReportDensity(double density, assets::Asset* asset) {
  constexpr double kOsmium = 22590.0;  // kg/m^3
  if (density <= kOsmium) return;
  char text[120];
  std::snprintf(text, sizeof(text), "its density would be %.3g kg/m3, above osmium's", density);
  asset->findings.push_back({"implausible-density", core::Severity::kWarning, asset->name, text,
                             density, "correct --mass, --density or the size"});
}

// Lets the mass follow from the measured volume: states its interval, and moves the sample into it.
void UseMeasuredVolume(const BuildRequest& request, const physics_params::Category& category,
                       double volume, double area, assets::Asset* asset) {
  const bool weighed = request.stated.mass || request.stated.density;
  if (!request.volume_error || weighed || category.name == "object") return;
  const physics_params::MeasuredMass measured = physics_params::MassOfMeasured(
      category, physics_params::KnowledgeBase::Shipped(), volume, area, *request.volume_error);
  asset->parameters.intervals.mass = measured.mass;
  asset->parameters.intervals.basis += "; " + measured.sentence;
  physics_params::Estimate& mass = asset->parameters.mass;
  mass.sample = std::clamp(mass.sample, measured.mass.min, measured.mass.max);
  mass.min = std::min(mass.min, mass.sample);
  mass.max = std::max(mass.max, mass.sample);
}

void GiveMass(const BuildRequest& request, assets::Asset* asset) {
  const auto& base = physics_params::KnowledgeBase::Shipped();
  const physics_params::Category category =
      physics_params::ChosenRow(request.category, request.stated.variant, base);
  const core::Findings understood =
      physics_params::ResolutionFindings(request.category, asset->name);
  asset->findings.insert(asset->findings.end(), understood.begin(), understood.end());
  asset->parameters = physics_params::SampleParameters(category, base, request.seed);
  asset->parameters.resolution = request.category.sentence;
  const geometry::MassProperties unit = geometry::SolidMassProperties(asset->solid, 1.0);
  asset->volume = unit.volume;
  const std::string unusual = physics_params::ScaleMassToSize(
      category, GroundBoxOf(asset->visual.mesh).sides, unit.volume, &asset->parameters);
  if (!unusual.empty()) {
    const bool weighed = request.stated.mass || request.stated.density;
    asset->findings.push_back(
        {"unusual-size", core::Severity::kWarning, asset->name,
         weighed ? unusual : unusual + "; the category's mass is scaled accordingly", 0.0,
         weighed ? "give the true size with --height or --size"
                 : "give the true size with --height or --size, and the mass with --mass"});
  }
  const double area = core::SurfaceArea(asset->solid);
  UseMeasuredVolume(request, category, unit.volume, area, asset);
  Apply(request.stated, &asset->parameters);
  const physics_params::MassModel model =
      ReconcileMass(request.stated, asset->parameters, category, base, unit.volume, area);
  ReportDensity(model.density, asset);
  const geometry::MassProperties mass =
      model.wall_thickness > 0.0
          ? geometry::HollowMassProperties(asset->solid, model.wall_thickness, model.density)
          : geometry::SolidMassProperties(asset->solid, model.density);
  asset->inertial = {mass.mass, mass.center_of_mass, mass.inertia};
  asset->density = model.density;
  asset->wall_thickness = model.wall_thickness;
  asset->mass_sentence = model.sentence;
  asset->parameters.material = model.material;
  asset->parameters.mass.sample = mass.mass;
  asset->friction = asset->parameters.friction.sample;
  asset->restitution = asset->parameters.restitution.sample;
  constexpr double kRollingResistance = 0.01;
  asset->rolling_friction = kRollingResistance * 0.5 * core::Bounds(asset->solid).sizes().mean();
}

void UseGivenParts(const BuildRequest& request, assets::Asset* asset) {
  asset->parts = request.parts;
  geometry::ConcavityOptions options;
  options.surface_samples = 6000;
  options.volume_samples = 1000;
  const geometry::DecompositionQuality quality =
      geometry::MeasureDecomposition(asset->solid, asset->parts, options);
  const Eigen::AlignedBox3d box = core::Bounds(asset->solid);
  // In CoACD's units, as for a decomposition.
  asset->concavity = quality.concavity * 2.0 * box.diagonal().norm() / box.sizes().maxCoeff();
  asset->coverage = quality.coverage;
}

void DecomposeIntoParts(const BuildRequest& request, assets::Asset* asset) {
  geometry::DecompositionOptions options = Limited(request.decomposition, request.budget);
  options.max_hull_vertices -= kSupportCorners;
  const geometry::ConvexDecomposition decomposition = geometry::Decompose(asset->solid, options);
  asset->parts = geometry::Hulls(decomposition);
  asset->concavity = decomposition.concavity;
  asset->coverage = decomposition.coverage;
  ReportBinding(asset->solid, options, request.budget, decomposition, asset->name,
                &asset->findings);
}

// Rotates the asset and moves it so that it stands centred on z = 0.
void PlaceInLinkFrame(const Eigen::Isometry3d& turn, assets::Asset* asset) {
  Eigen::Isometry3d link_from_body = turn;
  core::TriangleMesh turned = asset->solid;
  core::Transform(Eigen::Affine3d(link_from_body), &turned);
  const Eigen::AlignedBox3d box = core::Bounds(turned);
  link_from_body.pretranslate(
      Eigen::Vector3d(-box.center().x(), -box.center().y(), -box.min().z()));
  const Eigen::Affine3d map(link_from_body);
  core::Transform(map, &asset->visual.mesh);
  core::Transform(map, &asset->solid);
  for (core::TriangleMesh& part : asset->parts) core::Transform(map, &part);
  asset->link_from_input = link_from_body * asset->link_from_input;
  const Eigen::Matrix3d R = link_from_body.linear();
  asset->inertial.center_of_mass = link_from_body * asset->inertial.center_of_mass;
  asset->inertial.inertia = R * asset->inertial.inertia * R.transpose();
  // Rounding may leave the two triangles slightly different; readers expect a symmetric matrix.
  asset->inertial.inertia =
      (0.5 * (asset->inertial.inertia + asset->inertial.inertia.transpose())).eval();
}

// Finds the rest pose and places the asset in it. A pose other than the given one has another
// support face, and the rest pose may change once the parts preserve that face.
void PlaceInRestPose(const BuildRequest& request, assets::Asset* asset) {
  RestPose rest;
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  for (int pass = 0; pass < kRestPasses; ++pass) {
    if (request.parts.empty()) {
      PreserveSupportFace(
          FindSupportPolygon(asset->solid, asset->inertial.center_of_mass, kSupportCorners),
          Limited(request.decomposition, request.budget).max_hull_vertices, &asset->parts);
    }
    rest = FindRestPose(sim::BodyFromAsset(*asset), asset->solid);
    PlaceInLinkFrame(rest.turn, asset);
    turn = rest.turn * turn;
    if (rest.turn.linear().isIdentity()) break;
  }
  asset->rolls = rest.rolls;
  const Eigen::Vector3d size = GroundBoxOf(asset->visual.mesh).sides;
  asset->parameters.length.sample = std::max(size.x(), size.y());
  asset->parameters.width.sample = std::min(size.x(), size.y());
  asset->parameters.height.sample = size.z();
  const bool as_given = IsUprightAsGiven(turn);
  asset->findings.push_back({"rest-pose",
                             as_given ? core::Severity::kInfo : core::Severity::kWarning,
                             asset->name, RestSentence(turn, rest.rolls), 0.0});
}

}  // namespace

BuiltAsset BuildAsset(const core::TexturedMesh& visual, const BuildRequest& request,
                      core::Progress* progress) {
  if (request.category.category == nullptr) throw core::Error("an asset needs a category");
  core::RequireValid(visual, request.source);
  BuiltAsset built;
  assets::Asset& asset = built.asset;
  asset.name = assets::FileSafeName(request.name);
  asset.source = request.source;
  asset.seed = request.seed;
  asset.visual = visual;
  StageClock clock(progress, &built.seconds);
  clock.Begin("solid");
  MakeSolidPart(request, &asset);
  clock.Begin("mass");
  GiveMass(request, &asset);
  clock.Begin("collision parts");
  request.parts.empty() ? DecomposeIntoParts(request, &asset) : UseGivenParts(request, &asset);
  clock.Begin("rest pose");
  PlaceInRestPose(request, &asset);
  clock.End();
  core::Log(core::LogLevel::kInfo, "asset_build", asset.name, ": solid ", asset.solid_method, ", ",
            asset.parts.size(), " collision parts, ", asset.inertial.mass, " kg, ",
            asset.findings.size(), " findings");
  return built;
}

}  // namespace simwright::asset_build
