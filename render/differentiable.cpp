#include "render/differentiable.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/differentiable_pass.h"

namespace simwright::render {
namespace {

// m; products of three such lengths are still finite in single precision.
constexpr double kLargest = 1e12;

template <typename Vectors>
void RequireFinite(const Vectors& vectors, const char* what) {
  for (const auto& v : vectors) {
    if (!v.allFinite()) throw core::Error(std::string("not finite: ") + what, "renderer");
  }
}

void RequireFinite(const core::FloatImage& image, const char* what) {
  for (const float v : image.values) {
    if (!std::isfinite(v)) throw core::Error(std::string("not finite: ") + what, "renderer");
  }
}

void RequireValid(const DifferentiableObject& object) {
  core::RequireValid(object.mesh, "renderer");
  if (object.mesh.triangles.empty()) throw core::Error("a mesh without faces cannot be rendered");
  if (!object.vertex_colors.empty() && object.vertex_colors.size() != object.mesh.vertices.size()) {
    throw core::Error("there must be one colour per vertex, or none", "renderer");
  }
  RequireFinite(object.vertex_colors, "a vertex's colour");
  if (!object.world_from_object.matrix().allFinite()) {
    throw core::Error("not finite: an object's pose", "renderer");
  }
  const core::FloatImage& texture = object.texture;
  if (texture.empty()) return;
  if (texture.channels != 3 ||
      texture.values.size() != static_cast<std::size_t>(texture.width) * texture.height * 3) {
    throw core::Error("a texture must have three channels and width x height texels", "renderer");
  }
  if (object.corner_uvs.size() != 3 * object.mesh.triangles.size()) {
    throw core::Error("a texture needs three texture coordinates per triangle", "renderer");
  }
  RequireFinite(texture, "a texel");
  RequireFinite(object.corner_uvs, "a texture coordinate");
}

void RequireValid(const core::Camera& camera) {
  const bool finite = std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
                      std::isfinite(camera.fx) && std::isfinite(camera.fy) &&
                      camera.world_from_camera.matrix().allFinite();
  if (camera.width < 1 || camera.height < 1 || !finite || !(camera.fx > 0.0) ||
      !(camera.fy > 0.0)) {
    throw core::Error("a camera needs pixels, positive focal lengths and finite values",
                      "renderer");
  }
}

void RequireShape(const core::FloatImage& image, const core::FloatImage& like, const char* what) {
  if (image.empty()) return;
  if (image.width != like.width || image.height != like.height || image.channels != like.channels) {
    throw core::Error(std::string("the gradient and the image differ in size: ") + what, "renderer",
                      "normals need the option draw_normals");
  }
}

}  // namespace

bool DifferentiableOptions::IsValid(std::string* error) const {
  const auto fail = [&](const char* why) {
    if (error != nullptr) *error = why;
    return false;
  };
  if (samples_per_side < 1 || samples_per_side > 1024) {
    return fail("samples_per_side must be 1 to 1024");
  }
  if (edge_samples < 0) return fail("edge_samples must not be negative");
  if (!(near > 0.0) || !std::isfinite(near)) return fail("near must be positive");
  if (!light.radiance.allFinite()) return fail("the light must be finite");
  return true;
}

void SceneGradients::SetZero() {
  for (ObjectGradients& object : objects) {
    std::fill(object.vertices.begin(), object.vertices.end(), Eigen::Vector3d::Zero());
    std::fill(object.vertex_colors.begin(), object.vertex_colors.end(), Eigen::Vector3f::Zero());
    std::fill(object.texture.values.begin(), object.texture.values.end(), 0.0f);
    object.pose = {};
  }
  light.setZero();
  camera = {};
}

class DifferentiableRenderer::Implementation {
 public:
  Implementation(std::vector<DifferentiableObject> objects, const DifferentiableOptions& options)
      : options_(options), pass_(&objects_, &tree_, &options_) {
    std::string error;
    if (!options.IsValid(&error)) throw core::Error(error, "renderer");
    const bool steps = !options.smooth_normals && (options.lit || options.render_normals);
    for (DifferentiableObject& object : objects) {
      RequireValid(object);
      PreparedObject prepared;
      prepared.topology = FindEdges(object, steps);
      prepared.object = std::move(object);
      PlaceInWorld(&prepared);
      tree_.Add(prepared.world, prepared.object.mesh.triangles, true);
      objects_.push_back(std::move(prepared));
    }
    moved_.assign(objects_.size(), false);
    tree_.Commit();
  }

  const PreparedObject& at(int index) const { return objects_.at(static_cast<std::size_t>(index)); }
  int size() const { return static_cast<int>(objects_.size()); }
  const SphericalHarmonicsLight& light() const { return options_.light; }

  DifferentiableObject* Change(int index, bool moves) {
    if (moves) moved_.at(static_cast<std::size_t>(index)) = true;
    return &objects_.at(static_cast<std::size_t>(index)).object;
  }
  void SetLight(const SphericalHarmonicsLight& light) { options_.light = light; }

  const DifferentiableBuffers& Render(const core::Camera& camera, std::uint64_t seed) {
    RequireValid(camera);
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (!moved_[i]) continue;
      PlaceInWorld(&objects_[i]);
      tree_.Move(static_cast<int>(i), objects_[i].world);
      refit_ = true;
      moved_[i] = false;
    }
    if (refit_) tree_.Commit();
    refit_ = false;
    pass_.Draw(camera, seed, &buffers_);
    rendered_ = true;
    return buffers_;
  }

  void Backward(const DifferentiableBuffers& gradient, SceneGradients* gradients) {
    if (!rendered_) throw core::Error("Backward needs a rendered image", "renderer");
    RequireShape(gradient.color, buffers_.color, "color");
    RequireShape(gradient.mask, buffers_.mask, "mask");
    RequireShape(gradient.depth, buffers_.depth, "depth");
    RequireShape(gradient.normal, buffers_.normal, "normal");
    pass_.Backpropagate(gradient, gradients);
  }

 private:
  static void PlaceInWorld(PreparedObject* prepared) {
    const std::vector<Eigen::Vector3d>& vertices = prepared->object.mesh.vertices;
    const Eigen::Isometry3d& pose = prepared->object.world_from_object;
    prepared->world.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Eigen::Vector3d placed = pose * vertices[i];
      if (!(placed.cwiseAbs().maxCoeff() < kLargest)) {
        throw core::Error("a vertex is too far away to be rendered", "renderer");
      }
      prepared->world[i] = placed.cast<float>();
    }
  }

  DifferentiableOptions options_;
  std::vector<PreparedObject> objects_;
  RayTree tree_;
  std::vector<bool> moved_;
  bool refit_ = false, rendered_ = false;
  DifferentiableBuffers buffers_;
  DifferentiablePass pass_;
};

DifferentiableRenderer::DifferentiableRenderer(std::vector<DifferentiableObject> objects,
                                               const DifferentiableOptions& options)
    : implementation_(std::make_unique<Implementation>(std::move(objects), options)) {}

DifferentiableRenderer::~DifferentiableRenderer() = default;

int DifferentiableRenderer::size() const {
  return implementation_->size();
}

const DifferentiableObject& DifferentiableRenderer::object(int index) const {
  return implementation_->at(index).object;
}

const SphericalHarmonicsLight& DifferentiableRenderer::light() const {
  return implementation_->light();
}

const std::vector<int>& DifferentiableRenderer::WeldedVertices(int object) const {
  return implementation_->at(object).topology.welded;
}

void DifferentiableRenderer::SetVertices(int object, const std::vector<Eigen::Vector3d>& vertices) {
  if (vertices.size() != this->object(object).mesh.vertices.size()) {
    throw core::Error("the number of vertices must not change", "renderer");
  }
  RequireFinite(vertices, "a vertex");
  implementation_->Change(object, true)->mesh.vertices = vertices;
}

void DifferentiableRenderer::SetPose(int object, const Eigen::Isometry3d& world_from_object) {
  if (!world_from_object.matrix().allFinite()) {
    throw core::Error("not finite: an object's pose", "renderer");
  }
  implementation_->Change(object, true)->world_from_object = world_from_object;
}

void DifferentiableRenderer::SetVertexColors(int object,
                                             const std::vector<Eigen::Vector3f>& colors) {
  if (colors.size() != this->object(object).vertex_colors.size()) {
    throw core::Error("the number of colours must not change", "renderer");
  }
  RequireFinite(colors, "a vertex's colour");
  implementation_->Change(object, false)->vertex_colors = colors;
}

void DifferentiableRenderer::SetTexture(int object, const core::FloatImage& texture) {
  const core::FloatImage& old = this->object(object).texture;
  if (texture.width != old.width || texture.height != old.height ||
      texture.values.size() != old.values.size()) {
    throw core::Error("the texture's size must not change", "renderer");
  }
  RequireFinite(texture, "a texel");
  implementation_->Change(object, false)->texture = texture;
}

void DifferentiableRenderer::SetLight(const SphericalHarmonicsLight& light) {
  if (!light.radiance.allFinite()) throw core::Error("not finite: the light", "renderer");
  implementation_->SetLight(light);
}

const DifferentiableBuffers& DifferentiableRenderer::Render(const core::Camera& camera,
                                                            std::uint64_t seed) {
  return implementation_->Render(camera, seed);
}

void DifferentiableRenderer::Backward(const DifferentiableBuffers& pixel_gradients,
                                      SceneGradients* gradients) {
  implementation_->Backward(pixel_gradients, gradients);
}

}  // namespace simwright::render
