#include "sim/mujoco_stability.h"

#include <algorithm>
#include <cmath>

#include <mujoco/mujoco.h>

#include "core/error.h"
#include "core/progress.h"
#include "sim/max_displacement.h"
#include "sim/mujoco_scene.h"

namespace simwright::sim {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d PoseFrom(const double* place, const double* turn) {
  Isometry3d pose(Eigen::Quaterniond(turn[0], turn[1], turn[2], turn[3]).normalized());
  pose.translation() = Eigen::Map<const Vector3d>(place);
  return pose;
}

// A body with a free joint.
struct FreeBody {
  int body = 0, position = 0;  // position: index of its pose in qpos
  Vector3d center;             // of mass, in the body's frame
  double radius = 0.0;         // m from there to its farthest vertex
};

// Returns the radius (m) of the colliding geoms around `center`.
double RadiusOf(const mjModel& model, int body, const Vector3d& center) {
  double radius = 0.0;
  for (int i = 0; i < model.body_geomnum[body]; ++i) {
    const int geom = model.body_geomadr[body] + i;
    if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) continue;
    const Isometry3d body_from_geom =
        PoseFrom(model.geom_pos + 3 * geom, model.geom_quat + 4 * geom);
    const int mesh = model.geom_dataid[geom];
    if (model.geom_type[geom] != mjGEOM_MESH || mesh < 0) {
      radius = std::max(radius,
                        (body_from_geom.translation() - center).norm() + model.geom_rbound[geom]);
      continue;
    }
    for (int v = 0; v < model.mesh_vertnum[mesh]; ++v) {
      const float* const vertex = model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + v);
      const Vector3d point = Eigen::Map<const Eigen::Vector3f>(vertex).cast<double>();
      radius = std::max(radius, (body_from_geom * point - center).norm());
    }
  }
  return radius;
}

std::vector<FreeBody> FreeBodies(const mjModel& model) {
  std::vector<FreeBody> bodies;
  for (int body = 1; body < model.nbody; ++body) {
    const int joint = model.body_jntadr[body];
    if (joint < 0 || model.jnt_type[joint] != mjJNT_FREE) continue;
    FreeBody one;
    one.body = body;
    one.position = model.jnt_qposadr[joint];
    one.center = Eigen::Map<const Vector3d>(model.body_ipos + 3 * body);
    one.radius = RadiusOf(model, body, one.center);
    bodies.push_back(one);
  }
  return bodies;
}

// Steps the world and measures displacements from marked poses.
class StabilityCheck {
 public:
  explicit StabilityCheck(const std::filesystem::path& mjcf)
      : scene_(mjcf, {}, MujocoScene::Ground::kOwn), bodies_(FreeBodies(*scene_.model())) {
    for (const FreeBody& one : bodies_) {
      const char* const name = mj_id2name(scene_.model(), mjOBJ_BODY, one.body);
      result_.bodies.push_back({name != nullptr ? name : "", 0.0, 0.0});
    }
  }

  MujocoStability Run(const StabilityOptions& options) {
    Mark();
    StepUntil(options.settle, false);
    for (size_t i = 0; i < bodies_.size(); ++i) result_.bodies[i].settled = DisplacementOf(i);
    Mark();
    StepUntil(options.settle + options.watch, true);
    result_.warnings = scene_.warnings();
    return result_;
  }

 private:
  Isometry3d PoseOf(size_t index) const {
    const double* const q = scene_.data()->qpos + bodies_[index].position;
    return PoseFrom(q, q + 3);
  }

  double DisplacementOf(size_t index) const {
    const FreeBody& one = bodies_[index];
    const double displacement =
        MaxDisplacement(one.center, one.radius, marks_[index], PoseOf(index));
    return std::isfinite(displacement) ? displacement : HUGE_VAL;
  }

  void Mark() {
    marks_.clear();
    for (size_t i = 0; i < bodies_.size(); ++i) marks_.push_back(PoseOf(i));
  }

  void StepUntil(double time, bool measure) {
    const mjData& data = *scene_.data();
    const double step = scene_.model()->opt.timestep;
    // Counts steps instead of reading the clock: MuJoCo resets its clock when a world diverges.
    const auto steps = static_cast<int>(std::lround((time - elapsed_) / step));
    elapsed_ = time;
    for (int i = 0; i < steps; ++i) {
      scene_.Step();
      result_.contacts = std::max(result_.contacts, data.ncon);
      result_.rows = std::max(result_.rows, data.nefc);
      if (i % 100 == 0) core::CheckCancelled();
      for (size_t b = 0; measure && b < bodies_.size(); ++b) {
        result_.bodies[b].drift = std::max(result_.bodies[b].drift, DisplacementOf(b));
      }
    }
  }

  MujocoScene scene_;
  std::vector<FreeBody> bodies_;
  std::vector<Isometry3d> marks_;
  double elapsed_ = 0.0;  // s
  MujocoStability result_;
};

}  // namespace

bool StabilityOptions::IsValid(std::string* error) const {
  const auto is_duration = [](double time) { return time >= 0.0 && time <= 3600.0; };
  if (is_duration(settle) && is_duration(watch)) return true;
  *error = "settle and watch must be 0 to 3600 s";
  return false;
}

const BodyMotion* MujocoStability::Farthest() const {
  const auto farthest =
      std::max_element(bodies.begin(), bodies.end(),
                       [](const BodyMotion& a, const BodyMotion& b) { return a.drift < b.drift; });
  return farthest == bodies.end() ? nullptr : &*farthest;
}

MujocoStability CheckStabilityInMujoco(const std::filesystem::path& mjcf,
                                       const StabilityOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("stability check: " + error);
  return StabilityCheck(mjcf).Run(options);
}

}  // namespace simwright::sim
