#include "twin/joint_refinement.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "core/error.h"
#include "core/float_image.h"
#include "render/differentiable.h"

namespace simwright::twin {
namespace {

constexpr int kObjectNumbers = 4;         // x, y, yaw, logarithm of the scale
constexpr int kCameraVariables = 3;       // elevation, roll, logarithm of the focal length
constexpr double kLaplaceToNormal = 1.3;  // standard deviation over mean absolute error
constexpr double kLeastError = 1e-4;      // of a camera's number; a smaller one is known
constexpr double kLargestScale = 1.5;     // of the logarithm of a scale

// Returns colours far apart from each other and from black.
Eigen::Vector3f ObjectColor(size_t index) {
  // Corners of the cube of colours, then shades between them.
  constexpr float kShades[] = {1.0f, 0.55f};
  const size_t corner = 1 + index % 7;
  const float shade = kShades[(index / 7) % 2];
  return shade * Eigen::Vector3f(static_cast<float>(corner & 1),
                                 static_cast<float>((corner >> 1) & 1),
                                 static_cast<float>((corner >> 2) & 1));
}

// Returns the picture of the detections in the objects' colours over black.
core::FloatImage TargetPicture(const std::vector<Detection>& detections, int width, int height) {
  core::FloatImage target(width, height, 3);
  for (size_t k = 0; k < detections.size(); ++k) {
    const core::Image alpha = core::Resize(detections[k].alpha, width, height);
    const Eigen::Vector3f color = ObjectColor(k);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float share = *alpha.At(x, y) / 255.0f;
        for (int c = 0; c < 3; ++c) target.At(x, y)[c] += share * color[c];
      }
    }
  }
  return target;
}

double Squared(double value) {
  return value * value;
}

// The loss of all variables, and its gradient. Variables are in units of their steps: about 1 is a
// usual correction.
class JointLoss : public ceres::FirstOrderFunction {
 public:
  JointLoss(const std::vector<RefinedObject>& objects, const std::vector<Detection>& detections,
            const TableCameraGuess& guess, const JointRefinementOptions& options)
      : objects_(objects), guess_(guess), options_(options) {
    const core::Image& alpha = detections.front().alpha;
    width_ = options.width;
    height_ = std::max(16, static_cast<int>(std::lround(static_cast<double>(width_) * alpha.height /
                                                        alpha.width)));
    target_ = TargetPicture(detections, width_, height_);
    std::vector<render::DifferentiableObject> rendered;
    for (size_t k = 0; k < objects.size(); ++k) {
      render::DifferentiableObject object;
      object.mesh = objects[k].mesh;
      object.base_color = ObjectColor(k);
      rendered.push_back(std::move(object));
    }
    render::DifferentiableOptions render_options;
    render_options.edge_samples = 3000;
    render_options.samples_per_side = 3;

    renderer_ =
        std::make_unique<render::DifferentiableRenderer>(std::move(rendered), render_options);
  }

  int NumParameters() const override {
    return kCameraVariables + kObjectNumbers * static_cast<int>(objects_.size());
  }

  TableCamera CameraOf(const double* x) const {
    TableCamera camera = guess_.camera;
    camera.elevation = std::clamp(camera.elevation + ElevationStep() * x[0], 0.06, 1.5);
    camera.roll += RollStep() * x[1];
    camera.focal = std::clamp(camera.focal * std::exp(FocalStep() * x[2]), 0.31, 9.9);
    return camera;
  }

  ScaledPose PoseOf(const double* x, size_t k) const {
    const double* of = x + kCameraVariables + kObjectNumbers * static_cast<int>(k);
    ScaledPose pose = objects_[k].pose;
    const double step = MoveStep(k);
    pose.pose.x += step * of[0];
    pose.pose.y += step * of[1];
    pose.pose.yaw += kYawUnit * of[2];
    pose.scale *= std::exp(std::clamp(kScaleUnit * of[3], -kLargestScale, kLargestScale));
    return pose;
  }

  bool Evaluate(const double* x, double* cost, double* gradient) const override {
    ++evaluations_;
    const TableCamera numbers = CameraOf(x);
    const core::Camera camera = numbers.At(width_, height_);
    for (size_t k = 0; k < objects_.size(); ++k) {
      const ScaledPose pose = PoseOf(x, k);
      std::vector<Eigen::Vector3d> vertices = objects_[k].mesh.vertices;
      for (Eigen::Vector3d& vertex : vertices) vertex *= pose.scale;
      renderer_->SetVertices(static_cast<int>(k), vertices);
      renderer_->SetPose(static_cast<int>(k), pose.pose.WorldFromObject());
    }
    const render::DifferentiableBuffers& seen = renderer_->Render(camera, 1);
    const double weight = 1.0 / Squared(options_.pixel_error);
    render::DifferentiableBuffers slope;
    slope.color = core::FloatImage(width_, height_, 3);
    double squares = 0.0;
    for (size_t i = 0; i < target_.values.size(); ++i) {
      const float off = seen.color.values[i] - target_.values[i];
      squares += Squared(off);
      slope.color.values[i] = static_cast<float>(weight * off);
    }
    error_ = squares / (static_cast<double>(width_) * height_);
    *cost = 0.5 * weight * squares + PriorCost(x, gradient);
    if (gradient == nullptr) return true;
    gradients_.SetZero();
    renderer_->Backward(slope, &gradients_);
    AddImageGradient(x, numbers, camera, gradient);
    return true;
  }

  double error() const { return error_; }
  int evaluations() const { return evaluations_; }

 private:
  static constexpr double kYawUnit = 0.1, kScaleUnit = 0.05;

  // Steps of the camera's numbers; 0: known.
  static double StepOf(double error) { return error > kLeastError ? 0.5 * error : 0.0; }
  double ElevationStep() const { return StepOf(guess_.elevation_error); }
  double RollStep() const { return StepOf(guess_.roll_error); }
  double FocalStep() const { return StepOf(guess_.log_focal_error); }
  double MoveStep(size_t k) const {
    return 0.1 * objects_[k].pose.scale * core::Bounds(objects_[k].mesh).diagonal().norm();
  }

  // Returns the cost of what is expected, and writes its gradient (all of it).
  double PriorCost(const double* x, double* gradient) const {
    double cost = 0.0;
    const double steps[] = {ElevationStep(), RollStep(), FocalStep()};
    const double errors[] = {guess_.elevation_error, guess_.roll_error, guess_.log_focal_error};
    for (int i = 0; i < kCameraVariables; ++i) {
      // A known number stays: its variable has no effect but this cost.
      const double slope = steps[i] > 0.0 ? steps[i] / (kLaplaceToNormal * errors[i]) : 1.0;
      cost += 0.5 * Squared(slope * x[i]);
      if (gradient != nullptr) gradient[i] = Squared(slope) * x[i];
    }
    for (size_t k = 0; k < objects_.size(); ++k) {
      const int at = kCameraVariables + kObjectNumbers * static_cast<int>(k);
      const double deviation = kLaplaceToNormal * std::max(0.02, objects_[k].log_size_error);
      const double off = (kScaleUnit * x[at + 3] - objects_[k].log_size_wanted) / deviation;
      cost += 0.5 * Squared(off);
      if (gradient == nullptr) continue;
      for (int i = 0; i < 3; ++i) gradient[at + i] = 0.0;
      gradient[at + 3] = off * kScaleUnit / deviation;
    }
    return cost;
  }

  void AddImageGradient(const double* x, const TableCamera& numbers, const core::Camera& camera,
                        double* gradient) const {
    const render::CameraGradients& of = gradients_.camera;
    const Eigen::Vector3d axis = camera.world_from_camera.linear().col(2);
    gradient[0] -= ElevationStep() * of.pose.rotation.x();
    gradient[1] += RollStep() * of.pose.rotation.dot(axis);
    gradient[2] += FocalStep() * numbers.focal * width_ * (of.fx + of.fy);
    for (size_t k = 0; k < objects_.size(); ++k) {
      const int at = kCameraVariables + kObjectNumbers * static_cast<int>(k);
      const render::ObjectGradients& object = gradients_.objects[k];
      gradient[at] += MoveStep(k) * object.pose.translation.x();
      gradient[at + 1] += MoveStep(k) * object.pose.translation.y();
      gradient[at + 2] += kYawUnit * object.pose.rotation.z();
      const double scale = PoseOf(x, k).scale;
      double sum = 0.0;
      for (size_t i = 0; i < object.vertices.size(); ++i) {
        sum += object.vertices[i].dot(scale * objects_[k].mesh.vertices[i]);
      }
      gradient[at + 3] += kScaleUnit * sum;
    }
  }

  const std::vector<RefinedObject>& objects_;
  const TableCameraGuess& guess_;
  const JointRefinementOptions& options_;
  int width_ = 0, height_ = 0;
  core::FloatImage target_;
  std::unique_ptr<render::DifferentiableRenderer> renderer_;
  mutable render::SceneGradients gradients_;
  mutable double error_ = 0.0;
  mutable int evaluations_ = 0;
};

}  // namespace

bool JointRefinementOptions::IsValid(std::string* error) const {
  const auto fail = [error](const char* reason) {
    if (error) *error = reason;
    return false;
  };
  if (width < 32 || width > 2048)
    return fail("the compared picture must be 32 to 2048 pixels wide");
  if (steps < 0) return fail("the number of steps is negative");
  if (!(pixel_error > 0.0)) return fail("the error of a pixel must be positive");
  return true;
}

JointRefinement RefineJointly(const std::vector<RefinedObject>& objects,
                              const std::vector<Detection>& detections,
                              const TableCameraGuess& guess,
                              const JointRefinementOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "joint refinement");
  if (objects.empty() || objects.size() != detections.size()) {
    throw core::Error("a joint refinement needs as many detections as objects");
  }
  auto* loss = new JointLoss(objects, detections, guess, options);
  ceres::GradientProblem problem(loss);  // owns the loss
  ceres::GradientProblemSolver::Options solver;
  solver.max_num_iterations = options.steps;
  solver.function_tolerance = 1e-6;
  solver.logging_type = ceres::SILENT;
  std::vector<double> x(static_cast<size_t>(loss->NumParameters()), 0.0);
  JointRefinement refined;
  double cost = 0.0;
  loss->Evaluate(x.data(), &cost, nullptr);
  refined.first_error = loss->error();
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(solver, problem, x.data(), &summary);
  loss->Evaluate(x.data(), &cost, nullptr);
  refined.last_error = loss->error();
  refined.evaluations = loss->evaluations();
  refined.camera = loss->CameraOf(x.data());
  for (size_t k = 0; k < objects.size(); ++k) refined.poses.push_back(loss->PoseOf(x.data(), k));
  return refined;
}

}  // namespace simwright::twin
