#include "texture/photo_projection.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "render/scene.h"
#include "texture/bake.h"
#include "texture/uv_atlas.h"

namespace simwright::texture {
namespace {

constexpr int kLargestTexture = 4096;  // pixels per side

struct Sample {
  Eigen::Vector3f color{0, 0, 0};
  float weight = 0.0f;  // 0: not visible
};

// Returns the photo's colours inside the matte, extended beyond its edge so that no lookup meets
// the background. Erodes the matte by `edge` pixels first, unless it would vanish.
core::Image ForegroundColors(const core::Image& photo, const core::Image& alpha, int edge) {
  const int w = photo.width, h = photo.height;
  std::vector<int> known(static_cast<size_t>(w) * h);
  std::vector<int> frontier;
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < w && y < h && alpha.At(x, y)[0] > 200;
  };
  for (int shrink = edge; shrink >= 0 && frontier.empty(); --shrink) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const bool core = inside(x, y) && inside(x - shrink, y) && inside(x + shrink, y) &&
                          inside(x, y - shrink) && inside(x, y + shrink);
        known[static_cast<size_t>(y) * w + x] = core ? 1 : 0;
        if (core) frontier.push_back(y * w + x);
      }
    }
  }
  core::Image colors(w, h, 3);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      for (int c = 0; c < 3; ++c) colors.At(x, y)[c] = photo.At(x, y)[photo.channels < 3 ? 0 : c];
    }
  }
  // Breadth-first: each unknown pixel takes the colour of the neighbour that reached it.
  for (size_t i = 0; i < frontier.size(); ++i) {
    const int x = frontier[i] % w, y = frontier[i] / w;
    constexpr int kDx[] = {1, -1, 0, 0}, kDy[] = {0, 0, 1, -1};
    for (int k = 0; k < 4; ++k) {
      const int nx = x + kDx[k], ny = y + kDy[k];
      if (nx < 0 || ny < 0 || nx >= w || ny >= h) continue;
      int& state = known[static_cast<size_t>(ny) * w + nx];
      if (state != 0) continue;
      state = 2;
      std::copy_n(colors.At(x, y), 3, colors.At(nx, ny));
      frontier.push_back(ny * w + nx);
    }
  }
  return colors;
}

// A photo's foreground colours and its camera.
struct SeenColors {
  core::Camera camera;
  core::Image colors;
};

class PhotoPainter {
 public:
  PhotoPainter(const core::TriangleMesh& mesh, const std::vector<PhotoView>& views,
               const PhotoProjectionOptions& options)
      : mesh_(mesh), options_(options) {
    for (const PhotoView& view : views) {
      seen_.push_back({view.camera, ForegroundColors(view.photo, view.alpha, options.edge_pixels)});
    }
    shape_.mesh = mesh;
    scene_.Add(&shape_);
    scene_.Commit();
    reach_ = static_cast<float>(core::Bounds(mesh).diagonal().norm());
  }

  // Fills unseen surfaces with the mirror image of the front, then with their surroundings.
  void FillHiddenByMirror(const Eigen::Hyperplane<double, 3>& mirror) {
    mirror_ = &mirror;
    vertex_colors_ = SpreadColors();
  }

  // Fills unseen surfaces with these colours.
  void FillHidden(const std::vector<Eigen::Vector3f>& vertex_colors) {
    vertex_colors_ = vertex_colors;
  }

  // Returns true if a camera sees anything of the mesh.
  bool SeesAnything() const {
    const std::vector<Eigen::Vector3d> normals = core::VertexNormals(mesh_);
    for (size_t v = 0; v < normals.size(); ++v) {
      if (Blend(mesh_.vertices[v], normals[v]).weight >= 0.5f) return true;
    }
    return false;
  }

  Eigen::Vector3f Color(const SurfacePoint& point) const {
    const Sample seen = Blend(point.position, point.normal);
    const Eigen::Vector3i& t = mesh_.triangles[static_cast<size_t>(point.triangle)];
    Eigen::Vector3f spread = Eigen::Vector3f::Zero();
    for (int k = 0; k < 3; ++k) spread += point.barycentric[k] * vertex_colors_[t[k]];
    return seen.weight * seen.color + (1.0f - seen.weight) * spread;
  }

 private:
  // Blends the front view with its mirror image where it fades; weight 1 where either is fully
  // visible.
  Sample Blend(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const {
    Sample front = See(position, normal);
    if (front.weight >= 1.0f || mirror_ == nullptr) return front;
    const Eigen::Vector3d mirrored =
        position - 2.0 * mirror_->signedDistance(position) * mirror_->normal();
    const Eigen::Vector3d mirrored_normal =
        normal - 2.0 * normal.dot(mirror_->normal()) * mirror_->normal();
    const Sample back = See(mirrored, mirrored_normal);
    const float rest = (1.0f - front.weight) * back.weight;
    const float total = front.weight + rest;
    if (total <= 0.0f) return {};
    return {(front.weight * front.color + rest * back.color) / total, std::min(1.0f, total)};
  }

  // Combines all cameras' views of a point; the most frontal view counts most.
  Sample See(const Eigen::Vector3d& position, const Eigen::Vector3d& normal) const {
    Sample all;
    float total = 0.0f;
    for (const SeenColors& seen : seen_) {
      const Sample one = SeeFrom(seen, position, normal);
      if (one.weight <= 0.0f) continue;
      const float share = one.weight * one.weight;
      all.color += share * one.color;
      all.weight = std::max(all.weight, one.weight);
      total += share;
    }
    if (total > 0.0f) all.color /= total;
    return all;
  }

  Sample SeeFrom(const SeenColors& seen, const Eigen::Vector3d& position,
                 const Eigen::Vector3d& normal) const {
    const Eigen::Vector3d to_eye = (seen.camera.position() - position).normalized();
    const double cosine = normal.dot(to_eye);
    if (cosine <= options_.fade_to) return {};
    const Eigen::Vector3d pixel = seen.camera.Project(position);
    const core::Image& colors = seen.colors;
    if (pixel.z() <= 0.0 || pixel.x() < 0.0 || pixel.y() < 0.0 || pixel.x() >= colors.width ||
        pixel.y() >= colors.height) {
      return {};
    }
    const Eigen::Vector3f start = (position + 2e-3 * reach_ * normal).cast<float>();
    if (scene_.Occluded(start, to_eye.cast<float>(), 0.0f, 2.0f * static_cast<float>(pixel.z()))) {
      return {};
    }
    const double fade =
        std::clamp((cosine - options_.fade_to) / (options_.fade_from - options_.fade_to), 0.0, 1.0);
    const Eigen::Vector2f uv(
        static_cast<float>(pixel.x()) / static_cast<float>(colors.width),
        1.0f - static_cast<float>(pixel.y()) / static_cast<float>(colors.height));
    return {core::SampleTexture(colors, uv).head<3>(),
            static_cast<float>(fade * fade * (3.0 - 2.0 * fade))};
  }

  // Returns a colour for each vertex: seen vertices keep theirs, the rest relax to the mean of
  // their neighbours (Laplace's equation on the mesh, Gauss-Seidel from a breadth-first start).
  std::vector<Eigen::Vector3f> SpreadColors() const;

  const core::TriangleMesh& mesh_;
  const PhotoProjectionOptions& options_;
  std::vector<SeenColors> seen_;
  const Eigen::Hyperplane<double, 3>* mirror_ = nullptr;
  core::TexturedMesh shape_;
  render::Scene scene_;
  float reach_ = 1.0f;
  std::vector<Eigen::Vector3f> vertex_colors_;
};

std::vector<Eigen::Vector3f> PhotoPainter::SpreadColors() const {
  const size_t count = mesh_.vertices.size();
  const std::vector<Eigen::Vector3d> normals = core::VertexNormals(mesh_);
  std::vector<std::vector<int>> neighbours(count);
  for (const Eigen::Vector3i& t : mesh_.triangles) {
    for (int k = 0; k < 3; ++k) neighbours[t[k]].push_back(t[(k + 1) % 3]);
  }
  std::vector<Eigen::Vector3f> colors(count, Eigen::Vector3f::Constant(0.5f));
  std::vector<char> fixed(count, 0), reached(count, 0);
  std::vector<int> queue;
  for (size_t v = 0; v < count; ++v) {
    const Sample sample = Blend(mesh_.vertices[v], normals[v]);
    if (sample.weight < 0.5f) continue;
    colors[v] = sample.color;
    fixed[v] = reached[v] = 1;
    queue.push_back(static_cast<int>(v));
  }
  if (queue.empty()) throw core::Error("the camera sees nothing of the mesh");
  for (size_t i = 0; i < queue.size(); ++i) {
    for (const int n : neighbours[queue[i]]) {
      if (reached[n]) continue;
      reached[n] = 1;
      colors[n] = colors[queue[i]];
      queue.push_back(n);
    }
  }
  constexpr int kIterations = 60;  // diffuses over about as many edges; finer detail is not visible
  for (int sweep = 0; sweep < kIterations; ++sweep) {
    for (const int v : queue) {
      if (fixed[v] || neighbours[v].empty()) continue;
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const int n : neighbours[v]) sum += colors[n];
      colors[v] = sum / static_cast<float>(neighbours[v].size());
    }
  }
  return colors;
}

void RequireFit(const PhotoView& view) {
  if (view.photo.width != view.alpha.width || view.photo.height != view.alpha.height ||
      view.photo.width != view.camera.width || view.photo.height != view.camera.height ||
      view.alpha.channels != 1) {
    throw core::Error("photo, matte and camera must have the same size");
  }
}

core::TexturedMesh Painted(const core::TriangleMesh& mesh, const PhotoPainter& painter,
                           const PhotoProjectionOptions& options) {
  core::TexturedMesh textured;
  textured.mesh = mesh;
  AtlasOptions atlas;
  atlas.size = options.texture_size;
  // A rough surface may need more charts than a small texture can hold.
  while (textured.corner_uvs.empty()) {
    try {
      textured.corner_uvs = UnwrapToAtlas(mesh, atlas);
    } catch (const core::Error&) {
      if (atlas.size >= kLargestTexture) throw;
      atlas.size *= 2;
    }
  }
  textured.textures.push_back(
      BakeTexture(mesh, textured.corner_uvs, atlas.size, atlas.padding + 2,
                  [&](const SurfacePoint& point) { return painter.Color(point); }));
  textured.materials.push_back({"photo", Eigen::Vector4f::Ones(), 0});
  textured.triangle_material.assign(mesh.triangles.size(), 0);
  textured.part_names.push_back("object");
  textured.triangle_part.assign(mesh.triangles.size(), 0);
  return textured;
}

}  // namespace

core::TexturedMesh ProjectPhoto(const core::TriangleMesh& mesh, const core::Camera& camera,
                                const core::Image& photo, const core::Image& alpha,
                                const Eigen::Hyperplane<double, 3>& mirror,
                                const PhotoProjectionOptions& options) {
  const PhotoView view{camera, photo, alpha};
  RequireFit(view);
  PhotoPainter painter(mesh, {view}, options);
  painter.FillHiddenByMirror(mirror);
  return Painted(mesh, painter, options);
}

core::TexturedMesh ProjectPhotos(const core::TriangleMesh& mesh,
                                 const std::vector<PhotoView>& views,
                                 const std::vector<Eigen::Vector3f>& hidden,
                                 const PhotoProjectionOptions& options) {
  if (views.empty()) throw core::Error("a texture needs at least one photo");
  if (hidden.size() != mesh.vertices.size()) {
    throw core::Error("the hidden side needs one colour per vertex");
  }
  for (const PhotoView& view : views) RequireFit(view);
  PhotoPainter painter(mesh, views, options);
  if (!painter.SeesAnything()) throw core::Error("no camera sees anything of the mesh");
  painter.FillHidden(hidden);
  return Painted(mesh, painter, options);
}

}  // namespace simwright::texture
