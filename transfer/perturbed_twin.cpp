#include "transfer/perturbed_twin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "transfer/scaled_model.h"

namespace simwright::transfer {
namespace {

constexpr int kDraws = 20;
constexpr double kSamePlace = 1e-4;  // m and of a rotation's entries
constexpr double kSameSize = 1e-9;   // of the logarithm: no other model is made

double LogUniform(const skills::FactorRange& range, core::Rng& rng) {
  return core::Uniform(rng, std::log(range.low), std::log(range.high));
}

const workflows::TwinObject& ObjectNamed(const workflows::TwinRecord& record,
                                         const TransferObject& object,
                                         const std::filesystem::path& where) {
  for (const workflows::TwinObject& one : record.objects) {
    if (one.name != object.model.name) continue;
    if (one.world_from_object.isApprox(object.world_from_asset, kSamePlace)) return one;
    throw core::Error("has '" + one.name + "' elsewhere than the task", where.string(),
                      "make the tasks again with simwright tasks --twin, or give their twin");
  }
  throw core::Error("has no object '" + object.model.name + "', which the task places",
                    where.string(), "give the twin from which the tasks were made");
}

}  // namespace

// One object of a world.
struct PerturbedTwin::Draw {
  double factor = 1.0;
  Eigen::Isometry3d pose;
};

PerturbedTwin::PerturbedTwin(const workflows::TwinRecord& record, TransferWorld described,
                             const PhysicsRanges& physics, const std::filesystem::path& where)
    : described_(std::move(described)),
      physics_(physics),
      log_scale_error_(record.log_scale_error) {
  for (const TransferObject& object : described_.objects) {
    const workflows::TwinObject& known = ObjectNamed(record, object, where);
    const double own = known.size_error * known.size_error - log_scale_error_ * log_scale_error_;
    // An asset of the user has its own size, whatever the scale of the photo.
    const bool metric = known.source == workflows::TwinSource::kRetrieved;
    uncertainty_.push_back(
        {known.position_error, known.yaw_error, std::sqrt(std::max(0.0, own)), metric});
    shapes_.push_back(PartsOf(object.model));
  }
  for (size_t i = 0; i < shapes_.size(); ++i) {
    touches_.emplace_back();
    const auto here = Placed(shapes_[i], 1.0, described_.objects[i].world_from_asset);
    for (size_t j = 0; j < i; ++j) {
      const auto there = Placed(shapes_[j], 1.0, described_.objects[j].world_from_asset);
      touches_[i].push_back(!AreApart(here, there));
    }
  }
}

bool PerturbedTwin::IsValid(const std::vector<Draw>& draws) const {
  std::vector<std::vector<geometry::ConvexShape>> placed;
  for (size_t i = 0; i < draws.size(); ++i) {
    placed.push_back(Placed(shapes_[i], draws[i].factor, draws[i].pose));
    for (size_t j = 0; j < i; ++j) {
      if (!touches_[i][j] && !AreApart(placed[i], placed[j])) return false;
    }
  }
  return true;
}

std::vector<PerturbedTwin::Draw> PerturbedTwin::Sample(double scale, double common,
                                                       core::Rng& rng) const {
  std::vector<Draw> draws;
  for (size_t i = 0; i < described_.objects.size(); ++i) {
    const Uncertainty& error = uncertainty_[i];
    const double x = scale * error.position * core::Normal(rng);
    const double y = scale * error.position * core::Normal(rng);
    const double yaw = scale * error.yaw * core::Normal(rng);
    const double size = (error.metric ? 0.0 : common) + scale * error.size * core::Normal(rng);
    const Eigen::Isometry3d& pose = described_.objects[i].world_from_asset;
    Eigen::Vector3d middle = BoundsOf(Placed(shapes_[i], 1.0, pose)).center();
    middle.z() = 0.0;  // it stands on the table
    const Eigen::Vector3d moved = std::exp(common) * middle + Eigen::Vector3d(x, y, 0.0);
    Draw& draw = draws.emplace_back();
    draw.factor = std::exp(size);
    const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitZ());
    draw.pose.linear() = (turn * pose.linear()).eval();
    draw.pose.translation() = moved + turn * (draw.factor * (pose.translation() - middle));
    draw.pose.makeAffine();
  }
  return draws;
}

TransferWorld PerturbedTwin::World(double scale, std::uint64_t seed, std::uint64_t index) const {
  core::Rng rng = core::StreamRng(seed, index);
  const double share = std::min(1.0, scale);
  TransferWorld world = described_;
  for (TransferObject& object : world.objects) {
    object.mass = std::exp(share * LogUniform(physics_.mass, rng));
    object.friction = std::exp(share * LogUniform(physics_.friction, rng));
  }
  world.finger_friction = std::exp((1.0 - share) * std::log(physics_.own_finger_friction) +
                                   share * LogUniform(physics_.finger_friction, rng));
  const double common = scale * log_scale_error_ * core::Normal(rng);
  std::vector<Draw> draws = Sample(scale, common, rng);
  for (int attempt = 1; attempt < kDraws && !IsValid(draws); ++attempt) {
    draws = Sample(scale, common, rng);
  }
  for (size_t i = 0; i < draws.size(); ++i) {
    TransferObject& object = world.objects[i];
    object.world_from_asset = draws[i].pose;
    if (std::abs(std::log(draws[i].factor)) < kSameSize) continue;
    object.model = ScaledModel(object.model, draws[i].factor);
    for (manipulation::Grasp& grasp : object.grasps) {
      grasp = ScaledGrasp(grasp, draws[i].factor);
    }
  }
  return world;
}

}  // namespace simwright::transfer
