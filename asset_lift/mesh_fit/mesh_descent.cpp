#include "asset_lift/mesh_fit/mesh_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "asset_lift/mesh_fit/area_penalty.h"
#include "asset_lift/mesh_fit/floor_contact.h"

namespace simwright::asset_lift {
namespace {

constexpr double kFloorBand = 0.005;  // of the diagonal, above the floor, in which a base is held
constexpr double kNotFinite = std::numeric_limits<double>::quiet_NaN();

std::vector<render::DifferentiableObject> Objects(const core::TriangleMesh& mesh,
                                                  const std::vector<Eigen::Vector3f>& colors) {
  std::vector<render::DifferentiableObject> objects(1);
  objects[0].mesh = mesh;
  objects[0].vertex_colors = colors;
  return objects;
}

render::DifferentiableOptions RenderOptions(const MeshFitOptions& options) {
  render::DifferentiableOptions render_options;
  render_options.samples_per_side = options.samples_per_side;
  render_options.edge_samples = options.edge_samples;
  return render_options;
}

Eigen::MatrixX3d VertexRows(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::MatrixX3d rows(static_cast<Eigen::Index>(vectors.size()), 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) rows.row(i) = vectors[i];
  return rows;
}

// Decreases from the first weight to the last one in a geometric sequence.
double AreaWeight(const MeshFitOptions& options, double progress) {
  if (!(options.last_area_weight > 0.0)) return 0.0;
  return options.first_area_weight *
         std::pow(options.last_area_weight / options.first_area_weight, progress);
}

void Scale(float factor, core::FloatImage* image) {
  for (float& v : image->values) v *= factor;
}

bool AllFinite(const core::FloatImage& image) {
  return std::all_of(image.values.begin(), image.values.end(),
                     [](float v) { return std::isfinite(v); });
}

bool AllFinite(const std::vector<Eigen::Vector3f>& vectors) {
  for (const Eigen::Vector3f& v : vectors) {
    if (!v.allFinite()) return false;
  }
  return true;
}

}  // namespace

MeshDescent::MeshDescent(const core::TriangleMesh& mesh, const std::vector<Eigen::Vector3f>& colors,
                         double diagonal, const MeshFitOptions& options)
    : options_(options),
      weights_{options.mask_weight, options.color_weight, options.depth_weight, diagonal,
               options.depth_tolerance * diagonal},
      mesh_(mesh),
      colors_(colors),
      steps_(mesh, options.smoothing),
      penalty_(mesh, options.crease_angle_deg * std::numbers::pi / 180.0),
      renderer_(Objects(mesh, colors), RenderOptions(options)),
      smooth_(steps_.Apply(VertexRows(mesh.vertices))),
      adam_(smooth_.rows()),
      color_mean_(colors.size(), Eigen::Vector3f::Zero()),
      color_square_(colors.size(), Eigen::Vector3f::Zero()) {
  SaveState();
}

void MeshDescent::SaveState() {
  kept_smooth_ = smooth_;
  kept_colors_ = colors_;
}

void MeshDescent::RestoreState() {
  smooth_ = kept_smooth_;
  colors_ = kept_colors_;
  adam_ = AdamUniform(smooth_.rows());
  color_mean_.assign(colors_.size(), Eigen::Vector3f::Zero());
  color_square_.assign(colors_.size(), Eigen::Vector3f::Zero());
  color_steps_ = 0;
  Show();
}

void MeshDescent::Show() {
  const Eigen::MatrixX3d v = steps_.Solve(smooth_);
  for (std::size_t i = 0; i < mesh_.vertices.size(); ++i) mesh_.vertices[i] = v.row(i);
  if (options_.stands_on_floor && StandOnFloor(kFloorBand * weights_.length, &mesh_)) {
    smooth_ = steps_.Apply(VertexRows(mesh_.vertices));
  }
  renderer_.SetVertices(0, mesh_.vertices);
  if (!colors_.empty()) renderer_.SetVertexColors(0, colors_);
}

double MeshDescent::AddView(const ViewTarget& target, double weight, std::uint64_t seed) {
  const render::DifferentiableBuffers& picture = renderer_.Render(target.camera, seed);
  const double loss = ViewLoss(target, picture, weights_, &pixel_gradient_);
  for (core::FloatImage* image :
       {&pixel_gradient_.mask, &pixel_gradient_.color, &pixel_gradient_.depth}) {
    Scale(static_cast<float>(weight), image);
  }
  renderer_.Backward(pixel_gradient_, &gradients_);
  return weight * loss;
}

double MeshDescent::AddObjective(ImageObjective* objective, double progress, core::Rng* rng) {
  const core::Camera camera = objective->NextCamera(progress, rng);
  const render::DifferentiableBuffers& picture = renderer_.Render(camera, (*rng)());
  const ObjectImage shown{picture.color, picture.mask};
  ObjectImage gradient;
  const double loss = objective->Evaluate(camera, shown, progress, rng, &gradient);
  // A mask without an edge passes no gradient to the vertices, so a non-finite one would go
  // unnoticed.
  if (!AllFinite(gradient.color) || !AllFinite(gradient.opacity)) return kNotFinite;
  const auto weight = static_cast<float>(options_.objective_weight);
  Scale(weight, &gradient.color);
  Scale(weight, &gradient.opacity);
  render::DifferentiableBuffers images;
  images.color = std::move(gradient.color);
  images.mask = std::move(gradient.opacity);
  renderer_.Backward(images, &gradients_);
  return options_.objective_weight * loss;
}

double MeshDescent::Step(const std::vector<const ViewTarget*>& views, ImageObjective* objective,
                         double progress, double rate, core::Rng* rng) {
  gradients_.SetZero();
  double loss = 0.0;
  for (const ViewTarget* view : views) {
    loss += AddView(*view, 1.0 / static_cast<double>(views.size()), (*rng)());
  }
  if (objective != nullptr) loss += AddObjective(objective, progress, rng);
  render::ObjectGradients& of = gradients_.objects[0];
  loss +=
      options_.normal_weight * penalty_.Add(mesh_.vertices, options_.normal_weight, &of.vertices);
  if (const double weight = AreaWeight(options_, progress); weight > 0.0) {
    loss += weight * AddAreaPenalty(mesh_, weights_.length, weight, &of.vertices);
  }
  const Eigen::MatrixX3d gradient = VertexRows(of.vertices);
  if (!std::isfinite(loss) || !gradient.allFinite() || !AllFinite(of.vertex_colors)) {
    return kNotFinite;
  }
  Move(gradient, rate);
  Recolor();
  if (!smooth_.allFinite()) return kNotFinite;
  Show();
  return loss;
}

void MeshDescent::Move(const Eigen::MatrixX3d& gradient, double rate) {
  smooth_ += adam_.Step(steps_.Solve(gradient), rate);
}

void MeshDescent::Recolor() {
  constexpr float kBeta1 = 0.9f, kBeta2 = 0.99f;
  ++color_steps_;
  const auto steps = static_cast<float>(color_steps_);
  const float mean_share = 1.0f - std::pow(kBeta1, steps);
  const float square_share = 1.0f - std::pow(kBeta2, steps);
  const auto rate = static_cast<float>(options_.color_rate);
  for (std::size_t i = 0; i < colors_.size(); ++i) {
    const Eigen::Vector3f& g = gradients_.objects[0].vertex_colors[i];
    Eigen::Vector3f& mean = color_mean_[i];
    Eigen::Vector3f& square = color_square_[i];
    mean = kBeta1 * mean + (1.0f - kBeta1) * g;
    square = kBeta2 * square + (1.0f - kBeta2) * g.cwiseProduct(g);
    for (int c = 0; c < 3; ++c) {
      const float size = std::sqrt(square[c] / square_share);
      if (!(size > 1e-12f)) continue;  // not visible yet
      colors_[i][c] = std::clamp(colors_[i][c] - rate * mean[c] / mean_share / size, 0.0f, 1.0f);
    }
  }
}

}  // namespace simwright::asset_lift
