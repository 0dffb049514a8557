#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/float_image.h"
#include "core/mesh.h"
#include "render/light.h"

namespace simwright::render {

// A mesh whose parameters have gradients. Its albedo is the product of base_color, texture and
// vertex colour, where present, in the caller's colour space: the renderer applies no transfer
// function (use linear for lit images, sRGB for unlit ones).
struct DifferentiableObject {
  core::TriangleMesh mesh;                       // object frame, m
  std::vector<Eigen::Vector3f> vertex_colors;    // empty or (N x 3)
  core::FloatImage texture;                      // empty or (H x W x 3), bilinear, wrapping
  std::vector<Eigen::Vector2f> corner_uvs;       // (3M x 2) with a texture, origin lower left
  Eigen::Vector3f base_color{1.0f, 1.0f, 1.0f};  // has no gradient
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
};

struct DifferentiableOptions {
  // N x N jittered rays per pixel. With 2, i.e. four rays, the noise of edge and pixel samples
  // matches.
  int samples_per_side = 2;
  // Edge samples per image. 4000 keep silhouette gradients of a 128 x 128 image within 2% of their
  // limit up to 100k triangles.
  int edge_samples = 4000;
  // If false, the colour is the albedo itself.
  bool lit = false;
  // If true, uses area-weighted vertex normals. If false, uses face normals; every edge is then a
  // discontinuity in a lit image and in the normals, and is sampled as one.
  bool smooth_normals = true;
  // Fills, and differentiates, `normal`.
  bool render_normals = false;
  // The near plane (m, along the optical axis). Where it cuts a surface, the cut has no gradient.
  double near = 1e-3;
  SphericalHarmonicsLight light = SphericalHarmonicsLight::Studio({0.4f, -0.5f, 0.75f});

  bool IsValid(std::string* error) const;
};

// Means over each pixel of the visible values, 0 where nothing is visible: premultiplied by
// coverage. As gradients they are dL/d(image), where an empty image means zeros.
struct DifferentiableBuffers {
  core::FloatImage color;   // (H x W x 3)
  core::FloatImage mask;    // (H x W x 1), [0, 1]
  core::FloatImage depth;   // (H x W x 1), m along the optical axis
  core::FloatImage normal;  // (H x W x 3), world, unit before the mean, facing the camera
};

// The gradient with respect to a rigid motion p -> p + translation + rotation x (p - origin), world
// axes, m and rad; the origin is the object's or the camera's position.
struct PoseGradient {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

struct ObjectGradients {
  std::vector<Eigen::Vector3d> vertices;       // (N x 3), object frame, per m
  std::vector<Eigen::Vector3f> vertex_colors;  // like the object's
  core::FloatImage texture;                    // like the object's
  PoseGradient pose;
};

struct CameraGradients {
  PoseGradient pose;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // per pixel
};

struct SceneGradients {
  std::vector<ObjectGradients> objects;
  Eigen::Matrix<double, 9, 3> light = Eigen::Matrix<double, 9, 3>::Zero();  // of `radiance`
  CameraGradients camera;

  // Zeroes all gradients and keeps the sizes.
  void SetZero();
};

// Renders meshes and backpropagates image gradients to vertices, colours, texels, light, poses and
// camera, visibility included. At discontinuities of the image the boundary integral, the sum over
// edges of (f_in - f_out)(n . dx/dtheta) dl, is sampled (Li et al. 2018, "Differentiable Monte
// Carlo ray tracing through edge sampling") with one ray through the edge point that ignores the
// edge's own faces; the interior term is the ordinary derivative through the hit points.
//
// Vertices at the same initial position count as one in the mesh's connectivity (UV seams) and in
// its smooth normals. Each copy receives the part of the gradient from its own faces: to move
// vertices, sum over the copies (`WeldedVertices`) and move them together. Discontinuities where
// surfaces intersect have no gradient.
//
// Made for thousands of steps: buffers are reused, and the tree is refitted to moved vertices.
// Rendering is multi-threaded (core::ThreadCount), but the object must be used from one thread at a
// time. The same calls with the same seeds and threads give the same bytes.
class DifferentiableRenderer {
 public:
  // Throws core::Error for invalid options, meshes, colours, textures or UVs, and for a mesh
  // without faces.
  explicit DifferentiableRenderer(std::vector<DifferentiableObject> objects,
                                  const DifferentiableOptions& options = {});
  ~DifferentiableRenderer();
  DifferentiableRenderer(const DifferentiableRenderer&) = delete;
  DifferentiableRenderer& operator=(const DifferentiableRenderer&) = delete;

  int size() const;
  const DifferentiableObject& object(int index) const;
  const SphericalHarmonicsLight& light() const;

  // Set new parameter values of the same sizes, used from the next Render on. Throw core::Error for
  // another size or values that are not finite.
  void SetVertices(int object, const std::vector<Eigen::Vector3d>& vertices);
  void SetPose(int object, const Eigen::Isometry3d& world_from_object);
  void SetVertexColors(int object, const std::vector<Eigen::Vector3f>& colors);
  void SetTexture(int object, const core::FloatImage& texture);
  void SetLight(const SphericalHarmonicsLight& light);

  // Returns for each vertex the first vertex at the same position. (N)
  const std::vector<int>& WeldedVertices(int object) const;

  // Renders an image, valid until the next Render. The seed moves the samples within their strata.
  // Throws core::Error for a camera without pixels, focal length or finite values.
  const DifferentiableBuffers& Render(const core::Camera& camera, std::uint64_t seed);

  // Adds the gradients of L, given dL/d(buffers) for the last image, to `gradients` (resized and
  // zeroed if its sizes differ). Edge samples use that image's seed. Throws core::Error before a
  // first Render, or if an image has another size.
  void Backward(const DifferentiableBuffers& pixel_gradients, SceneGradients* gradients);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace simwright::render
