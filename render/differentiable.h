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

// A mesh whose parameters have gradients. Its albedo is base_color * texture * vertex colour, each
// where it is there, in the space that the caller thinks in: the renderer knows no transfer
// function (linear for lit pictures, sRGB for unlit ones).
struct DifferentiableObject {
  core::TriangleMesh mesh;                       // object frame, m
  std::vector<Eigen::Vector3f> vertex_colors;    // empty or (N x 3)
  core::FloatImage texture;                      // empty or (H x W x 3), bilinear, wrapping
  std::vector<Eigen::Vector2f> corner_uvs;       // (3M x 2) with a texture, origin lower left
  Eigen::Vector3f base_color{1.0f, 1.0f, 1.0f};  // has no gradient
  Eigen::Isometry3d world_from_object = Eigen::Isometry3d::Identity();
};

struct DifferentiableOptions {
  // N x N jittered rays a pixel. 2: four, at which the noise of edge samples and of pixels match.
  int samples_per_side = 2;
  // Over the whole picture. 4000 keep silhouette gradients of a 128 x 128 picture within 2% of
  // their limit up to 100k triangles.
  int edge_samples = 4000;
  // Off: colour is the albedo itself.
  bool lit = false;
  // On: area-weighted vertex normals. Off: each face's own; every edge is then a step in a lit
  // picture and in the normals, and is sampled as one.
  bool smooth_normals = true;
  // Fill, and differentiate, `normal`.
  bool draw_normals = false;
  // Nearer than this (m, along the optical axis) nothing is drawn. Where it cuts a surface, the cut
  // has no gradient.
  double near = 1e-3;
  SphericalHarmonicsLight light = SphericalHarmonicsLight::Studio({0.4f, -0.5f, 0.75f});

  bool IsValid(std::string* error) const;
};

// Means over each pixel of what is seen, 0 where nothing is: premultiplied by coverage. As
// gradients: dL/d(image), where an empty image stands for zeros.
struct DifferentiableBuffers {
  core::FloatImage color;   // (H x W x 3)
  core::FloatImage mask;    // (H x W x 1), [0, 1]
  core::FloatImage depth;   // (H x W x 1), m along the optical axis
  core::FloatImage normal;  // (H x W x 3), world, unit before the mean, facing the camera
};

// Of a rigid motion p -> p + translation + rotation x (p - origin), world axes, m and rad; the
// origin is that of the object, or the camera's position.
struct PoseGradient {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
};

struct ObjectGradients {
  std::vector<Eigen::Vector3d> vertices;       // (N x 3), object frame, per m
  std::vector<Eigen::Vector3f> vertex_colors;  // as the object's
  core::FloatImage texture;                    // as the object's
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

  // Keeps the sizes.
  void SetZero();
};

// Draws meshes and turns gradients of pictures into gradients of vertices, colours, texels, light,
// poses and camera, visibility included: where surfaces end in the picture the integral
// sum over edges of (f_in - f_out)(n . dx/dtheta) dl is sampled (Li et al. 2018, "Differentiable
// Monte Carlo ray tracing through edge sampling") with one ray through the edge point that is blind
// to the edge's own faces; the rest is ordinary derivatives through the hit points.
//
// Vertices that lie at the same point at the start count as one in the mesh's connectivity (UV
// seams), and in its smooth normals. Each copy gets the part of the gradient that came by its
// faces: whoever moves vertices sums over the copies (`WeldedVertices`) and moves them alike.
// Where surfaces cross each other, the step along the crossing has no gradient.
//
// Made for thousands of steps: buffers are kept, and moved vertices refit the tree. Renders from
// several threads (core::ThreadCount); not to be called from several threads itself. The same
// calls with the same seeds and threads give the same bytes.
class DifferentiableRenderer {
 public:
  // Throws core::Error for options, meshes, colours, textures or UVs that are not valid, and for a
  // mesh without faces.
  explicit DifferentiableRenderer(std::vector<DifferentiableObject> objects,
                                  const DifferentiableOptions& options = {});
  ~DifferentiableRenderer();
  DifferentiableRenderer(const DifferentiableRenderer&) = delete;
  DifferentiableRenderer& operator=(const DifferentiableRenderer&) = delete;

  int size() const;
  const DifferentiableObject& object(int index) const;
  const SphericalHarmonicsLight& light() const;

  // New values of parameters, sizes as before; in force from the next Render. Throw core::Error for
  // another size or values that are not finite.
  void SetVertices(int object, const std::vector<Eigen::Vector3d>& vertices);
  void SetPose(int object, const Eigen::Isometry3d& world_from_object);
  void SetVertexColors(int object, const std::vector<Eigen::Vector3f>& colors);
  void SetTexture(int object, const core::FloatImage& texture);
  void SetLight(const SphericalHarmonicsLight& light);

  // For each vertex the first one at its place. (N)
  const std::vector<int>& WeldedVertices(int object) const;

  // The picture; valid until the next Render. The seed moves the samples within their strata.
  // Throws core::Error for a camera without pixels, focal length or finite values.
  const DifferentiableBuffers& Render(const core::Camera& camera, std::uint64_t seed);

  // Adds the gradients of L, given dL/d(buffers) for the last picture, to `gradients` (made to fit
  // and zero where its sizes differ). Edge samples are drawn from that picture's seed. Throws
  // core::Error before a first Render, or where an image has another size.
  void Backward(const DifferentiableBuffers& pixel_gradients, SceneGradients* gradients);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace simwright::render
