#include "render/differentiable_surface.h"

#include <cmath>

namespace simwright::render {
namespace {

// The four texels around a texture coordinate, in core::SampleTexture's convention.
struct Bilinear {
  int x[2], y[2];
  float fx, fy;

  Bilinear(const core::FloatImage& texture, const Eigen::Vector2f& uv) {
    const float px = (uv.x() - std::floor(uv.x())) * static_cast<float>(texture.width) - 0.5f;
    const float py =
        (1.0f - (uv.y() - std::floor(uv.y()))) * static_cast<float>(texture.height) - 0.5f;
    const float x0 = std::floor(px), y0 = std::floor(py);
    fx = px - x0;
    fy = py - y0;
    for (int k = 0; k < 2; ++k) {
      x[k] = (static_cast<int>(x0) + k + texture.width) % texture.width;
      y[k] = (static_cast<int>(y0) + k + texture.height) % texture.height;
    }
  }
};

Eigen::Vector3f Texel(const core::FloatImage& texture, int x, int y) {
  return Eigen::Map<const Eigen::Vector3f>(texture.At(x, y));
}

template <typename Values>
auto Mix(const Values& values, const Eigen::Vector3i& corners, const SeenPoint& point) {
  return ((1.0f - point.b1 - point.b2) * values[corners[0]] + point.b1 * values[corners[1]] +
          point.b2 * values[corners[2]])
      .eval();
}

}  // namespace

// The factors of the albedo.
struct SurfaceShading::Albedo {
  Eigen::Vector3f vertex{1.0f, 1.0f, 1.0f};
  Eigen::Vector3f texture{1.0f, 1.0f, 1.0f};
  Eigen::Vector2f uv{0.0f, 0.0f};
};

SurfaceShading::Albedo SurfaceShading::AlbedoAt(const PreparedObject& of,
                                                const SeenPoint& point) const {
  const DifferentiableObject& object = of.object;
  Albedo albedo;
  if (!object.vertex_colors.empty()) {
    albedo.vertex = Mix(object.vertex_colors, object.mesh.triangles[point.triangle], point);
  }
  if (!object.texture.empty()) {
    const int c = 3 * point.triangle;
    albedo.uv = Mix(object.corner_uvs, {c, c + 1, c + 2}, point);
    const core::FloatImage& t = object.texture;
    const Bilinear at(t, albedo.uv);
    albedo.texture =
        (1.0f - at.fy) *
            ((1.0f - at.fx) * Texel(t, at.x[0], at.y[0]) + at.fx * Texel(t, at.x[1], at.y[0])) +
        at.fy * ((1.0f - at.fx) * Texel(t, at.x[0], at.y[1]) + at.fx * Texel(t, at.x[1], at.y[1]));
  }
  return albedo;
}

Eigen::Vector3f SurfaceShading::RawNormal(const PreparedObject& of, const SeenPoint& point) const {
  const Eigen::Vector3f normal =
      options_.smooth_normals ? Mix(of.normals, of.topology.welded_triangles[point.triangle], point)
                              : of.normals[point.triangle];
  return of.front[point.triangle] ? normal : Eigen::Vector3f(-normal);
}

SurfaceValue SurfaceShading::Value(const SeenPoint& point) const {
  const PreparedObject& of = objects_[point.object];
  const Albedo albedo = AlbedoAt(of, point);
  SurfaceValue value;
  value.depth = point.depth;
  value.color = of.object.base_color.cwiseProduct(albedo.vertex).cwiseProduct(albedo.texture);
  if (!options_.lit && !options_.render_normals) return value;
  const Eigen::Vector3f normal = RawNormal(of, point).stableNormalized();
  if (options_.lit) value.color = value.color.cwiseProduct(light_.Shade(normal));
  if (options_.render_normals) value.normal = normal;
  return value;
}

void SurfaceShading::BackpropagateColor(const SeenPoint& point, const Eigen::Vector3f& gradient,
                                        const Eigen::Vector3f& normal,
                                        Eigen::Vector3f* normal_gradient, float* b1, float* b2,
                                        GradientSums* sums) const {
  const DifferentiableObject& object = objects_[point.object].object;
  ObjectSums& own = sums->objects[point.object];
  const Albedo albedo = AlbedoAt(objects_[point.object], point);
  Eigen::Vector3f tinted = gradient.cwiseProduct(object.base_color);  // dL/d(vertex * texture)
  if (options_.lit) {
    const Eigen::Matrix<float, 9, 1> weights = IrradianceWeights(normal);
    const Eigen::Vector3f light = light_.radiance.transpose() * weights;
    Eigen::Vector3f of_light = tinted.cwiseProduct(albedo.vertex).cwiseProduct(albedo.texture);
    for (int c = 0; c < 3; ++c) {
      if (light[c] <= 0.0f) of_light[c] = 0.0f;
    }
    sums->light += (weights * of_light.transpose()).cast<double>();
    *normal_gradient +=
        IrradianceWeightsJacobian(normal).transpose() * (light_.radiance * of_light);
    tinted = tinted.cwiseProduct(light.cwiseMax(0.0f));
  }
  const float b0 = 1.0f - point.b1 - point.b2;
  if (!object.vertex_colors.empty()) {
    const Eigen::Vector3f of_vertex = tinted.cwiseProduct(albedo.texture);
    const Eigen::Vector3i& t = object.mesh.triangles[point.triangle];
    own.colors[t[0]] += b0 * of_vertex;
    own.colors[t[1]] += point.b1 * of_vertex;
    own.colors[t[2]] += point.b2 * of_vertex;
    const auto& colors = object.vertex_colors;
    *b1 += of_vertex.dot(colors[t[1]] - colors[t[0]]);
    *b2 += of_vertex.dot(colors[t[2]] - colors[t[0]]);
  }
  if (object.texture.empty()) return;
  const Eigen::Vector3f of_texture = tinted.cwiseProduct(albedo.vertex);
  const Bilinear at(object.texture, albedo.uv);
  Eigen::Vector2f of_uv = Eigen::Vector2f::Zero();
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      const float wx = i ? at.fx : 1.0f - at.fx, wy = j ? at.fy : 1.0f - at.fy;
      const std::size_t index =
          3 * (static_cast<std::size_t>(at.y[j]) * object.texture.width + at.x[i]);
      own.touched[index / ObjectSums::kTexelBlock] = 1;
      Eigen::Map<Eigen::Vector3f>(&own.texels[index]) += wx * wy * of_texture;
      const float along = of_texture.dot(Texel(object.texture, at.x[i], at.y[j]));
      of_uv.x() += (i ? wy : -wy) * along;
      of_uv.y() += (j ? wx : -wx) * along;
    }
  }
  of_uv.x() *= static_cast<float>(object.texture.width);
  of_uv.y() *= -static_cast<float>(object.texture.height);  // rows run down, v up
  const Eigen::Vector2f* uvs = &object.corner_uvs[3 * static_cast<std::size_t>(point.triangle)];
  *b1 += of_uv.dot(uvs[1] - uvs[0]);
  *b2 += of_uv.dot(uvs[2] - uvs[0]);
}

void SurfaceShading::BackpropagateNormal(const SeenPoint& point, const Eigen::Vector3f& raw,
                                         const Eigen::Vector3f& gradient, float* b1, float* b2,
                                         ObjectSums* sums) const {
  const PreparedObject& of = objects_[point.object];
  const float length = raw.norm();
  if (!(length > 1e-6f)) return;
  const Eigen::Vector3f unit = raw / length;
  Eigen::Vector3f of_raw = (gradient - unit * unit.dot(gradient)) / length;
  if (!of.front[point.triangle]) of_raw = -of_raw;
  sums->normals_touched = true;
  if (!options_.smooth_normals) {
    sums->normals[point.triangle] += of_raw.cast<double>();
    return;
  }
  const Eigen::Vector3i& t = of.topology.welded_triangles[point.triangle];
  sums->normals[t[0]] += ((1.0f - point.b1 - point.b2) * of_raw).cast<double>();
  sums->normals[t[1]] += (point.b1 * of_raw).cast<double>();
  sums->normals[t[2]] += (point.b2 * of_raw).cast<double>();
  *b1 += of_raw.dot(of.normals[t[1]] - of.normals[t[0]]);
  *b2 += of_raw.dot(of.normals[t[2]] - of.normals[t[0]]);
}

void SurfaceShading::Backpropagate(const SeenPoint& point, const Eigen::Vector3f& ray,
                                   const SurfaceValue& gradient, const core::Camera& camera,
                                   GradientSums* sums) const {
  const PreparedObject& of = objects_[point.object];
  ObjectSums& own = sums->objects[point.object];
  float g1 = 0.0f, g2 = 0.0f;  // dL/d(b1), dL/d(b2); b0 = 1 - b1 - b2
  Eigen::Vector3f raw = Eigen::Vector3f::Zero(), unit = Eigen::Vector3f::Zero();
  const bool needs_normal = options_.lit || options_.render_normals;
  if (needs_normal) {
    raw = RawNormal(of, point);
    unit = raw.stableNormalized();
  }
  Eigen::Vector3f normal_gradient = gradient.normal;
  BackpropagateColor(point, gradient.color, unit, &normal_gradient, &g1, &g2, sums);
  if (needs_normal) BackpropagateNormal(point, raw, normal_gradient, &g1, &g2, &own);
  // If the surface moves by q at the ray, b1 e1 + b2 e2 - t ray = -q to first order, solved by
  // Cramer's rule; `pull` is dL/dq.
  const Eigen::Vector3i& t = of.object.mesh.triangles[point.triangle];
  const Eigen::Vector3f& p = of.camera[t[0]];
  const Eigen::Vector3f e1 = of.camera[t[1]] - p, e2 = of.camera[t[2]] - p;
  const Eigen::Vector3f normal = e1.cross(e2);
  const float determinant = normal.dot(ray);
  // A face seen exactly edge-on has no area in the image.
  if (!(std::abs(determinant) > 1e-6f * normal.norm() * ray.norm())) return;
  const Eigen::Vector3f pull =
      (gradient.depth * normal - g1 * e2.cross(ray) - g2 * ray.cross(e1)) / determinant;
  own.points[t[0]] += ((1.0f - point.b1 - point.b2) * pull).cast<double>();
  own.points[t[1]] += (point.b1 * pull).cast<double>();
  own.points[t[2]] += (point.b2 * pull).cast<double>();
  const double along_x = point.depth * pull.x() / camera.fx;
  const double along_y = point.depth * pull.y() / camera.fy;
  sums->fx += along_x * ray.x();
  sums->fy += along_y * ray.y();
  sums->cx += along_x;
  sums->cy += along_y;
}

}  // namespace simwright::render
