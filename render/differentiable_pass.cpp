#include "render/differentiable_pass.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/progress.h"
#include "render/gradient_collection.h"

namespace simwright::render {
namespace {

// Hashes `x` (the mixer of Steele, Lea and Flood 2014, "Fast splittable pseudorandom number
// generators").
std::uint64_t MixedColors(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

double High(std::uint64_t bits) {
  return static_cast<double>(bits >> 32) * 0x1.0p-32;
}

double Low(std::uint64_t bits) {
  return static_cast<double>(bits & 0xffffffffu) * 0x1.0p-32;
}

constexpr float kFar = 1e30f;
constexpr std::uint64_t kEdgeStream = 0x5851f42d4c957f2dull;

// dL/d(the values that a pixel averages); the mask's gradient is separate.
struct PixelGradient {
  SurfaceValue value;
  float mask = 0.0f;

  PixelGradient(const DifferentiableBuffers& images, int x, int y) {
    if (!images.color.empty()) {
      value.color = Eigen::Map<const Eigen::Vector3f>(images.color.At(x, y));
    }
    if (!images.normal.empty()) {
      value.normal = Eigen::Map<const Eigen::Vector3f>(images.normal.At(x, y));
    }
    if (!images.depth.empty()) value.depth = *images.depth.At(x, y);
    if (!images.mask.empty()) mask = *images.mask.At(x, y);
  }

  // Returns true if any gradient besides the coverage's is not zero.
  bool Any() const {
    return value.depth != 0.0f || !value.color.isZero(0.0f) || !value.normal.isZero(0.0f);
  }

  void Scale(float factor) {
    value.color *= factor;
    value.normal *= factor;
    value.depth *= factor;
  }

  float Dot(const SurfaceValue& seen) const {
    return mask + value.color.dot(seen.color) + value.normal.dot(seen.normal) +
           value.depth * seen.depth;
  }
};

void Resize(const core::Camera& camera, int channels, core::FloatImage* image) {
  image->width = camera.width;
  image->height = camera.height;
  image->channels = channels;
  image->values.resize(static_cast<std::size_t>(camera.width) * camera.height * channels);
}

int Corner(const Eigen::Vector3i& triangle, int vertex) {
  return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

void ComputeNormals(bool smooth, PreparedObject* of) {
  const std::vector<Eigen::Vector3i>& triangles = of->topology.welded_triangles;
  of->normals.assign(smooth ? of->world.size() : triangles.size(), Eigen::Vector3f::Zero());
  of->normal_lengths.resize(of->normals.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Eigen::Vector3i& t = triangles[f];
    const Eigen::Vector3f& p = of->world[t[0]];
    const Eigen::Vector3f area = (of->world[t[1]] - p).cross(of->world[t[2]] - p);
    if (smooth) {
      for (int k = 0; k < 3; ++k) of->normals[t[k]] += area;
    } else {
      of->normals[f] = area;
    }
  }
  for (std::size_t i = 0; i < of->normals.size(); ++i) {
    of->normal_lengths[i] = of->normals[i].stableNorm();
    if (of->normal_lengths[i] > 0.0f) of->normals[i] /= of->normal_lengths[i];
  }
}

}  // namespace

void DifferentiablePass::Prepare() {
  const Eigen::Isometry3d camera_from_world = camera_.world_from_camera.inverse();
  for (PreparedObject& of : objects_) {
    of.camera.resize(of.world.size());
    for (std::size_t i = 0; i < of.world.size(); ++i) {
      of.camera[i] = (camera_from_world * of.world[i].cast<double>()).cast<float>();
    }
    const std::vector<Eigen::Vector3i>& triangles = of.object.mesh.triangles;
    of.front.resize(triangles.size());
    for (std::size_t f = 0; f < triangles.size(); ++f) {
      const Eigen::Vector3i& t = triangles[f];
      const Eigen::Vector3f& p = of.camera[t[0]];
      of.front[f] = p.dot((of.camera[t[1]] - p).cross(of.camera[t[2]] - p)) < 0.0f;
    }
    if (options_.lit || options_.render_normals) ComputeNormals(options_.smooth_normals, &of);
  }
}

Eigen::Vector2d DifferentiablePass::SamplePosition(int x, int y, int sample) const {
  const int n = options_.samples_per_side;
  const std::uint64_t index = (static_cast<std::uint64_t>(y) * camera_.width + x) * n * n + sample;
  const std::uint64_t bits = MixedColors(seed_ ^ MixedColors(index));
  const int column = sample % n, row = sample / n;
  return {x + (column + High(bits)) / n, y + (row + Low(bits)) / n};
}

void DifferentiablePass::TraceRow(int y, SeenPoint* seen) const {
  const int samples = options_.samples_per_side * options_.samples_per_side;
  const int rays = camera_.width * samples;
  const Eigen::Matrix3d turn = camera_.world_from_camera.linear();
  const auto near = static_cast<float>(options_.near);
  PacketDirections directions;
  PacketHits hits;
  for (int first = 0; first < rays; first += kPacket) {
    const int count = std::min(kPacket, rays - first);
    for (int k = 0; k < kPacket; ++k) {
      const int ray = first + std::min(k, count - 1);
      const Eigen::Vector3f direction =
          (turn * RayThrough(SamplePosition(ray / samples, y, ray % samples))).cast<float>();
      directions.x[k] = direction.x();
      directions.y[k] = direction.y();
      directions.z[k] = direction.z();
      directions.valid[k] = k < count ? -1 : 0;
    }
    tree_.IntersectPacket(origin_, directions, near, kFar, &hits);
    for (int k = 0; k < count; ++k) {
      SeenPoint& point = seen[first + k];
      point = {};
      if (hits.part[k] < 0) continue;
      point = {hits.part[k], hits.triangle[k], hits.u[k], hits.v[k], hits.depth[k]};
    }
  }
}

void DifferentiablePass::Draw(const core::Camera& camera, std::uint64_t seed,
                              DifferentiableBuffers* buffers) {
  camera_ = camera;
  seed_ = MixedColors(seed);
  origin_ = camera.position().cast<float>();
  Prepare();
  Resize(camera, 3, &buffers->color);
  Resize(camera, 1, &buffers->mask);
  Resize(camera, 1, &buffers->depth);
  if (options_.render_normals) Resize(camera, 3, &buffers->normal);
  const std::size_t samples =
      static_cast<std::size_t>(options_.samples_per_side) * options_.samples_per_side;
  seen_.resize(static_cast<std::size_t>(camera.width) * camera.height * samples);
  core::ParallelFor(camera.height, [&](int y) {
    core::CheckCancelled();
    DrawRow(y, buffers);
  });
}

void DifferentiablePass::DrawRow(int y, DifferentiableBuffers* buffers) {
  const int samples = options_.samples_per_side * options_.samples_per_side;
  SeenPoint* seen = &seen_[static_cast<std::size_t>(y) * camera_.width * samples];
  TraceRow(y, seen);
  for (int x = 0; x < camera_.width; ++x) {
    Eigen::Vector3d color = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double depth = 0.0;
    int covered = 0;
    for (int s = 0; s < samples; ++s, ++seen) {
      if (seen->object < 0) continue;
      const SurfaceValue value = shading_.Value(*seen);
      ++covered;
      color += value.color.cast<double>();
      depth += value.depth;
      normal += value.normal.cast<double>();
    }
    const double share = 1.0 / samples;
    Eigen::Map<Eigen::Vector3f>(buffers->color.At(x, y)) = (share * color).cast<float>();
    *buffers->mask.At(x, y) = static_cast<float>(share * covered);
    *buffers->depth.At(x, y) = static_cast<float>(share * depth);
    if (options_.render_normals) {
      Eigen::Map<Eigen::Vector3f>(buffers->normal.At(x, y)) = (share * normal).cast<float>();
    }
  }
}

void DifferentiablePass::BackpropagateRow(int y, const DifferentiableBuffers& gradient,
                                          GradientSums* sums) const {
  const int samples = options_.samples_per_side * options_.samples_per_side;
  const SeenPoint* seen = &seen_[static_cast<std::size_t>(y) * camera_.width * samples];
  for (int x = 0; x < camera_.width; ++x, seen += samples) {
    PixelGradient pixel(gradient, x, y);
    if (!pixel.Any()) continue;
    pixel.Scale(1.0f / static_cast<float>(samples));
    for (int s = 0; s < samples; ++s) {
      if (seen[s].object < 0) continue;
      const Eigen::Vector3f ray = RayThrough(SamplePosition(x, y, s)).cast<float>();
      shading_.Backpropagate(seen[s], ray, pixel.value, camera_, sums);
    }
  }
}

SeenPoint DifferentiablePass::NearestFace(const ScreenEdge& edge, const EdgePoint& point,
                                          const Eigen::Vector3f& ray,
                                          const Eigen::Vector3f& towards,
                                          bool positive_side) const {
  const PreparedObject& of = objects_[edge.object];
  const MeshEdge& ends = of.topology.edges[edge.edge];
  SeenPoint nearest;
  float steepest = 0.0f;
  for (int i = 0; i < ends.count; ++i) {
    const EdgeFace& face = of.topology.faces[ends.first + i];
    // Seen from the camera, corners of a back face run so that the face lies on the positive side
    // of an edge along which it runs forward.
    const bool on_positive = (of.front[face.triangle] == 0) == face.forward;
    if (on_positive != positive_side) continue;
    const Eigen::Vector3i& t = of.object.mesh.triangles[face.triangle];
    const Eigen::Vector3f& p = of.camera[t[0]];
    const Eigen::Vector3f normal = (of.camera[t[1]] - p).cross(of.camera[t[2]] - p);
    const float across = normal.dot(ray);
    if (across == 0.0f) continue;
    // The face plane's depth along ray + e * towards is z (1 - e * rise) to first order.
    const float rise = normal.dot(towards) / across;
    if (nearest.object >= 0 && rise <= steepest) continue;
    steepest = rise;
    const Eigen::Vector3i& welded = of.topology.welded_triangles[face.triangle];
    float weights[3] = {0.0f, 0.0f, 0.0f};
    weights[Corner(welded, of.topology.welded[ends.a])] = static_cast<float>(1.0 - point.t);
    weights[Corner(welded, of.topology.welded[ends.b])] = static_cast<float>(point.t);
    nearest = {edge.object, face.triangle, weights[1], weights[2], 0.0f};
  }
  return nearest;
}

void DifferentiablePass::BackpropagateEdgePoint(const EdgePoint& at, double weight,
                                                const DifferentiableBuffers& gradient,
                                                GradientSums* sums) const {
  const ScreenEdge& edge = edges_.edges()[at.edge];
  const PreparedObject& of = objects_[edge.object];
  const MeshEdge& ends = of.topology.edges[edge.edge];
  const Eigen::Vector3d a = of.camera[ends.a].cast<double>(), b = of.camera[ends.b].cast<double>();
  const Eigen::Vector3d p = a + at.t * (b - a);
  const Eigen::Vector3d ray = p / p.z();
  const int x =
      std::clamp(static_cast<int>(camera_.fx * ray.x() + camera_.cx), 0, camera_.width - 1);
  const int y =
      std::clamp(static_cast<int>(camera_.fy * ray.y() + camera_.cy), 0, camera_.height - 1);
  const PixelGradient pixel(gradient, x, y);
  if (pixel.mask == 0.0f && !pixel.Any()) return;

  int faces[8];
  const int count = std::min(ends.count, 8);
  for (int i = 0; i < count; ++i) faces[i] = of.topology.faces[ends.first + i].triangle;
  const Hit behind =
      tree_.IntersectIgnoring(origin_, (camera_.world_from_camera.linear() * ray).cast<float>(),
                              static_cast<float>(options_.near), kFar, {edge.object, faces, count});
  if (behind.instance >= 0 && behind.depth < p.z()) return;  // occluded

  // The direction across the edge in the image, into the side that a x b points to.
  const Eigen::Vector3d plane = a.cross(b - a);
  const Eigen::Vector2d normal =
      Eigen::Vector2d(plane.x() / camera_.fx, plane.y() / camera_.fy).stableNormalized();
  const Eigen::Vector3f towards(static_cast<float>(normal.x() / camera_.fx),
                                static_cast<float>(normal.y() / camera_.fy), 0.0f);
  float step = 0.0f;  // L's density before the edge minus that behind it
  for (const bool positive : {false, true}) {
    SeenPoint seen = NearestFace(edge, at, ray.cast<float>(),
                                 positive ? towards : Eigen::Vector3f(-towards), positive);
    if (seen.object >= 0) {
      seen.depth = static_cast<float>(p.z());
    } else {
      seen = {behind.instance, behind.triangle, behind.u, behind.v, behind.depth};
    }
    if (seen.object >= 0) step += (positive ? -1.0f : 1.0f) * pixel.Dot(shading_.Value(seen));
  }
  if (step == 0.0f) return;
  // dL = step * normal . dx for x = (fx X / Z + cx, fy Y / Z + cy).
  const Eigen::Vector2d of_x = weight * step * normal;
  const double gx = of_x.x() * camera_.fx / p.z(), gy = of_x.y() * camera_.fy / p.z();
  const Eigen::Vector3d of_p(gx, gy, -(gx * ray.x() + gy * ray.y()));
  sums->objects[edge.object].points[ends.a] += (1.0 - at.t) * of_p;
  sums->objects[edge.object].points[ends.b] += at.t * of_p;
  sums->fx += of_x.x() * ray.x();
  sums->fy += of_x.y() * ray.y();
  sums->cx += of_x.x();
  sums->cy += of_x.y();
}

void DifferentiablePass::BackpropagateEdges(int slice, int slices,
                                            const DifferentiableBuffers& gradient,
                                            GradientSums* sums) const {
  const std::int64_t samples = options_.edge_samples;
  const std::int64_t first = samples * slice / slices, last = samples * (slice + 1) / slices;
  const double stratum = edges_.length() / static_cast<double>(samples);
  int hint = -1;
  for (std::int64_t i = first; i < last; ++i) {
    const double jitter =
        High(MixedColors(seed_ ^ kEdgeStream ^ MixedColors(static_cast<std::uint64_t>(i))));
    const EdgePoint point = edges_.Locate((static_cast<double>(i) + jitter) * stratum, hint);
    hint = point.edge;
    BackpropagateEdgePoint(point, stratum, gradient, sums);
  }
}

void DifferentiablePass::Backpropagate(const DifferentiableBuffers& gradient,
                                       SceneGradients* gradients) {
  const int slices = core::ThreadCount();
  if (summing_) sums_.clear();  // an earlier pass was interrupted by Ctrl-C
  summing_ = true;
  sums_.resize(static_cast<std::size_t>(slices));
  for (GradientSums& sums : sums_) FitSums(objects_, &sums);
  edges_.Find(objects_, camera_, options_.near);
  const bool any_edge = options_.edge_samples > 0 && edges_.length() > 0.0;
  core::ParallelFor(slices, [&](int slice) {
    for (int y = slice; y < camera_.height; y += slices) {
      core::CheckCancelled();
      BackpropagateRow(y, gradient, &sums_[slice]);
    }
    if (any_edge) BackpropagateEdges(slice, slices, gradient, &sums_[slice]);
  });
  Collect(objects_, camera_, options_.smooth_normals, &sums_, gradients);
  summing_ = false;
}

}  // namespace simwright::render
