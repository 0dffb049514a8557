#pragma once

#include <cstdint>
#include <vector>

#include "render/differentiable.h"
#include "render/edge_topology.h"

namespace simwright::render {

// An object with the data for rendering it from one camera.
struct PreparedObject {
  DifferentiableObject object;
  EdgeTopology topology;
  std::vector<Eigen::Vector3f> world;    // (N x 3)
  std::vector<Eigen::Vector3f> camera;   // (N x 3), the camera's frame
  std::vector<Eigen::Vector3f> normals;  // world, unit; per welded vertex, or per face if flat
  std::vector<float> normal_lengths;     // lengths of their area-vector sums
  std::vector<std::uint8_t> front;       // (M) 1: the face is front-facing
};

// A visible surface point.
struct SeenPoint {
  int object = -1;  // -1: no hit
  int triangle = 0;
  float b1 = 0.0f, b2 = 0.0f;  // barycentric weights of corners 1 and 2
  float depth = 0.0f;          // along the optical axis, m
};

// The values that a pixel's buffers average, or dL/d of them.
struct SurfaceValue {
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float depth = 0.0f;
};

// Gradient sums of one thread. Texels are cleared and read in blocks, since an image touches few of
// a large texture's texels.
struct ObjectSums {
  static constexpr std::size_t kTexelBlock = 3 * 512;

  std::vector<Eigen::Vector3d> points;   // (N x 3), the camera's frame
  std::vector<Eigen::Vector3d> normals;  // like PreparedObject::normals
  std::vector<Eigen::Vector3f> colors;   // like the object's
  std::vector<float> texels;             // like the object's
  std::vector<std::uint8_t> touched;     // one flag per block of texels
  bool normals_touched = false;
};

struct GradientSums {
  std::vector<ObjectSums> objects;
  Eigen::Matrix<double, 9, 3> light = Eigen::Matrix<double, 9, 3>::Zero();
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;
};

// Evaluates shading at seen points, and the ordinary derivatives through them.
class SurfaceShading {
 public:
  SurfaceShading(const std::vector<PreparedObject>& objects, const SphericalHarmonicsLight& light,
                 const DifferentiableOptions& options)
      : objects_(objects), light_(light), options_(options) {}

  // Returns the shaded value. Requires point.object >= 0. Normals are filled only if the options
  // request them.
  SurfaceValue Value(const SeenPoint& point) const;

  // Backpropagates the gradient of the value at `point`, seen along `ray` (in the camera's frame,
  // third component 1), to vertices, normals, colours, texels, light and focal length.
  void Backpropagate(const SeenPoint& point, const Eigen::Vector3f& ray,
                     const SurfaceValue& gradient, const core::Camera& camera,
                     GradientSums* sums) const;

 private:
  struct Albedo;
  Albedo AlbedoAt(const PreparedObject& of, const SeenPoint& point) const;
  // Returns the smooth or flat normal towards the camera, not normalised; world.
  Eigen::Vector3f RawNormal(const PreparedObject& of, const SeenPoint& point) const;
  void BackpropagateColor(const SeenPoint& point, const Eigen::Vector3f& gradient,
                          const Eigen::Vector3f& normal, Eigen::Vector3f* normal_gradient,
                          float* b1, float* b2, GradientSums* sums) const;
  void BackpropagateNormal(const SeenPoint& point, const Eigen::Vector3f& raw,
                           const Eigen::Vector3f& gradient, float* b1, float* b2,
                           ObjectSums* sums) const;

  const std::vector<PreparedObject>& objects_;
  const SphericalHarmonicsLight& light_;
  const DifferentiableOptions& options_;
};

}  // namespace simwright::render
