#include "asset_lift/mesh_fit/mesh_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "asset_lift/mesh_fit/mesh_descent.h"
#include "asset_lift/multi_view/view_consistency.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"
#include "geometry/remesh.h"
#include "geometry/self_intersection_smoothing.h"
#include "geometry/solid.h"
#include "geometry/triangle_tree.h"
#include "geometry/weld.h"

namespace simwright::asset_lift {
namespace {

constexpr int kMeshFitMaxRollbacks = 5;
constexpr int kSaveInterval = 10;  // steps

// Returns a mesh's colours at the vertices of another mesh, from the nearest point of its surface.
std::vector<Eigen::Vector3f> ColorsAt(const std::vector<Eigen::Vector3d>& points,
                                      const core::TriangleMesh& mesh,
                                      const std::vector<Eigen::Vector3f>& colors) {
  if (colors.empty()) return {};
  const geometry::TriangleTree tree(mesh);
  std::vector<Eigen::Vector3f> found;
  found.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const geometry::SurfacePoint at = tree.Closest(p);
    const Eigen::Vector3i& t = mesh.triangles[at.triangle];
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]],
                          &c = mesh.vertices[t[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    const auto weight = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      const double w = area > 0.0 ? normal.dot((to - from).cross(at.point - from)) / area : 1.0 / 3;
      return static_cast<float>(std::clamp(w, 0.0, 1.0));
    };
    const float wa = weight(b, c), wb = weight(c, a), wc = weight(a, b);
    found.push_back((wa * colors[t[0]] + wb * colors[t[1]] + wc * colors[t[2]]) / (wa + wb + wc));
  }
  return found;
}

// Returns the mean colour of the views' object pixels.
Eigen::Vector3f MeanColor(const std::vector<ViewTarget>& targets) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (const ViewTarget& target : targets) {
    if (target.color.empty()) continue;
    area += target.area;
    for (std::size_t i = 0; i < target.color.values.size(); i += 3) {
      sum += Eigen::Map<const Eigen::Vector3f>(&target.color.values[i]).cast<double>();
    }
  }
  return area > 0.0 ? Eigen::Vector3f((sum / area).cast<float>()) : Eigen::Vector3f(0.5, 0.5, 0.5);
}

class Fit {
 public:
  Fit(const core::TriangleMesh& start, const std::vector<ObservedView>& views,
      ImageObjective* objective, const MeshFitOptions& options, core::Progress* progress)
      : options_(options),
        objective_(options.objective_weight > 0.0 ? objective : nullptr),
        progress_(progress),
        rng_(core::StreamRng(options.seed, 0)) {
    bool colored = objective_ != nullptr;
    for (const ObservedView& view : views) {
      targets_.push_back(MakeTarget(view, options.max_side));
      colored = colored || !view.color.empty();
    }
    mesh_ = geometry::Weld(start, 0.0);
    geometry::OrientConsistently(&mesh_);
    diagonal_ = core::Bounds(mesh_).diagonal().norm();
    if (!(diagonal_ > 0.0)) throw core::Error("the initial mesh has no extent", "mesh fit");
    if (colored) colors_.assign(mesh_.vertices.size(), MeanColor(targets_));
  }

  MeshFitResult Run() {
    if (progress_ != nullptr) {
      progress_->Stage("fitting the mesh", options_.rounds * options_.steps_per_round);
    }
    for (int round = 0; round < options_.rounds && result_.complete; ++round) {
      Remesh(round);
      Step(round);
    }
    MakeValid();
    Measure();
    result_.mesh = mesh_;
    result_.vertex_colors = colors_;
    return result_;
  }

 private:
  void Report(const char* code, core::Severity severity, const std::string& sentence,
              double figure = 0.0) {
    result_.findings.push_back({code, severity, "mesh fit", sentence, figure});
  }

  void Remesh(int round) {
    const double t = options_.rounds > 1 ? static_cast<double>(round) / (options_.rounds - 1) : 1.0;
    geometry::RemeshOptions remesh;
    remesh.edge_length = diagonal_ * options_.first_edge_ratio *
                         std::pow(options_.last_edge_ratio / options_.first_edge_ratio, t);
    remesh.feature_angle_deg = options_.feature_angle_deg;
    try {
      geometry::SmoothSelfIntersections(&mesh_, {.rounds = 6});
      const core::TriangleMesh even = geometry::RemeshIsotropic(mesh_, remesh);
      if (even.empty()) throw core::Error("the result is empty");
      colors_ = ColorsAt(even.vertices, mesh_, colors_);
      mesh_ = even;
    } catch (const core::Error& error) {
      Report("remesh-left-out", core::Severity::kWarning,
             std::string("a round continued without remeshing: ") + error.what());
    }
  }

  // Returns the views of the next step, in rotation, in an order that is reshuffled after each
  // pass.
  std::vector<const ViewTarget*> NextViews() {
    std::vector<const ViewTarget*> views;
    const int count = std::min<int>(options_.views_per_step, static_cast<int>(targets_.size()));
    while (static_cast<int>(views.size()) < count) {
      if (queue_.empty()) {
        queue_.resize(targets_.size());
        std::iota(queue_.begin(), queue_.end(), 0);
        for (std::size_t i = queue_.size(); i > 1; --i) {
          std::swap(queue_[i - 1], queue_[core::UniformIndex(rng_, static_cast<int>(i))]);
        }
      }
      views.push_back(&targets_[queue_.back()]);
      queue_.pop_back();
    }
    return views;
  }

  void Step(int round) {
    MeshDescent descent(mesh_, colors_, diagonal_, options_);
    const int total = options_.rounds * options_.steps_per_round;
    for (int step = 0; step < options_.steps_per_round && result_.complete; ++step) {
      const double through = static_cast<double>(step) / options_.steps_per_round;
      const double rate =
          options_.step_ratio * diagonal_ * damping_ * std::pow(0.7, round) * (1.0 - 0.8 * through);
      const double done = static_cast<double>(round * options_.steps_per_round + step) / total;
      const double loss = descent.Step(NextViews(), objective_, done, rate, &rng_);
      if (progress_ != nullptr) progress_->Advance();
      core::CheckCancelled();
      if (std::isfinite(loss)) {
        ++result_.steps;
        if (step % kSaveInterval == 0) descent.SaveState();
        continue;
      }
      RollBack(&descent);
    }
    mesh_ = descent.mesh();
    colors_ = descent.colors();
  }

  void RollBack(MeshDescent* descent) {
    descent->RestoreState();
    damping_ *= 0.5;
    if (++rollbacks_ < kMeshFitMaxRollbacks) {
      Report("stepped-back", core::Severity::kWarning,
             "a loss or gradient was not finite: restored the last state and halved the step",
             damping_);
      return;
    }
    result_.complete = false;
    Report("stopped-early", core::Severity::kError,
           "losses or gradients were repeatedly not finite: stopped with the last finite mesh",
           result_.steps);
  }

  // Makes the mesh closed, oriented and free of self-intersections: by local smoothing, otherwise
  // by remeshing on a grid.
  void MakeValid() {
    if (geometry::Examine(mesh_, 1).IsSolid()) return;
    core::TriangleMesh smoothed = mesh_;
    geometry::SmoothSelfIntersections(&smoothed, {.rounds = 15});
    if (geometry::Examine(smoothed, 1).IsSolid()) {
      Report("crossings-smoothed", core::Severity::kInfo,
             "the surface intersected itself: smoothed locally");
      mesh_ = smoothed;
      return;
    }
    // The fit's own error exceeds the detail of a fine wrap, which takes ten times as long.
    geometry::SolidOptions coarse;
    coarse.cell_ratio = 0.006;
    coarse.tolerance_ratio = 0.012;
    coarse.sheet_thickness_ratio = 0.0108;
    geometry::Solid solid = geometry::MakeSolid(mesh_, coarse);
    Report("made-solid", core::Severity::kInfo,
           std::string("the surface was not a solid: ") + geometry::Name(solid.method));
    colors_ = ColorsAt(solid.mesh.vertices, mesh_, colors_);
    mesh_ = std::move(solid.mesh);
  }

  void Measure() {
    if (targets_.empty()) return;
    std::vector<render::DifferentiableObject> objects(1);
    objects[0].mesh = mesh_;
    objects[0].vertex_colors = colors_;
    render::DifferentiableOptions render_options;
    render_options.samples_per_side = 4;
    render::DifferentiableRenderer renderer(std::move(objects), render_options);
    for (const ViewTarget& target : targets_) {
      const render::DifferentiableBuffers& picture = renderer.Render(target.camera, options_.seed);
      result_.mask_iou.push_back(MaskIou(target, picture));
      result_.color_error.push_back(ColorError(target, picture));
    }
  }

  const MeshFitOptions& options_;
  ImageObjective* objective_;
  core::Progress* progress_;
  core::Rng rng_;
  std::vector<ViewTarget> targets_;
  std::vector<int> queue_;
  core::TriangleMesh mesh_;
  std::vector<Eigen::Vector3f> colors_;
  double diagonal_ = 0.0;
  double damping_ = 1.0;
  int rollbacks_ = 0;
  MeshFitResult result_;
};

}  // namespace

bool MeshFitOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (rounds < 1 || steps_per_round < 1) {
    return fail("rounds and steps_per_round must be at least 1");
  }
  if (!(first_edge_ratio > 0.0) || !(last_edge_ratio > 0.0) || first_edge_ratio > 1.0 ||
      last_edge_ratio > 1.0) {
    return fail("edge ratios must be in (0, 1]");
  }
  if (!(feature_angle_deg > 0.0)) return fail("feature_angle_deg must be positive");
  if (!(crease_angle_deg >= 0.0 && crease_angle_deg < 180.0)) {
    return fail("crease_angle_deg must be in [0, 180)");
  }
  if (max_side < 8) return fail("max_side must be at least 8");
  if (views_per_step < 1 || samples_per_side < 1 || edge_samples < 0) {
    return fail("views_per_step and samples_per_side must be at least 1");
  }
  for (const double weight :
       {mask_weight, color_weight, depth_weight, depth_tolerance, normal_weight, first_area_weight,
        last_area_weight, objective_weight, smoothing}) {
    if (!(weight >= 0.0) || !std::isfinite(weight)) {
      return fail("weights must be finite and not negative");
    }
  }
  if ((first_area_weight > 0.0) != (last_area_weight > 0.0)) {
    return fail("give both weights of the area, or none");
  }
  if (!(step_ratio > 0.0) || !(color_rate >= 0.0) || !std::isfinite(step_ratio) ||
      !std::isfinite(color_rate)) {
    return fail("rates must be positive");
  }
  return true;
}

MeshFitResult FitMesh(const core::TriangleMesh& start, const std::vector<ObservedView>& views,
                      ImageObjective* objective, const MeshFitOptions& options,
                      core::Progress* progress) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "mesh fit");
  core::RequireValid(start, "mesh fit");
  if (start.empty()) throw core::Error("the initial mesh has no faces", "mesh fit");
  RequireValid(views);
  if (views.empty() && objective == nullptr) {
    throw core::Error("a fit needs a view or an objective", "mesh fit");
  }
  MeshFitResult result = Fit(start, views, objective, options, progress).Run();
  if (views.size() >= 2) {
    const core::Findings disagreements = CheckViewConsistency(views).findings;
    result.findings.insert(result.findings.end(), disagreements.begin(), disagreements.end());
  }
  return result;
}

}  // namespace simwright::asset_lift
