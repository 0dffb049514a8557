#pragma once

#include <cstdint>
#include <vector>

#include "render/differentiable_surface.h"
#include "render/ray_tree.h"
#include "render/silhouette_edges.h"

namespace simwright::render {

// Renders one image and its gradients for DifferentiableRenderer, between the camera and the
// gradient sums. It stores what each ray hit, so that the gradient pass retraces only the edges'
// rays.
class DifferentiablePass {
 public:
  DifferentiablePass(std::vector<PreparedObject>* objects, const RayTree* tree,
                     const DifferentiableOptions* options)
      : objects_(*objects),
        tree_(*tree),
        options_(*options),
        shading_(*objects, options->light, *options) {}

  void Draw(const core::Camera& camera, std::uint64_t seed, DifferentiableBuffers* buffers);
  void Backpropagate(const DifferentiableBuffers& gradient, SceneGradients* gradients);

 private:
  // Computes camera-frame points, front-facing flags and normals.
  void Prepare();
  void DrawRow(int y, DifferentiableBuffers* buffers);
  // Returns the image coordinates of a sample.
  Eigen::Vector2d SamplePosition(int x, int y, int sample) const;
  Eigen::Vector3d RayThrough(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - camera_.cx) / camera_.fx, (pixel.y() - camera_.cy) / camera_.fy, 1.0};
  }
  // Traces a row's rays in sample order.
  void TraceRow(int y, SeenPoint* seen) const;

  void BackpropagateRow(int y, const DifferentiableBuffers& gradient, GradientSums* sums) const;
  void BackpropagateEdges(int slice, int slices, const DifferentiableBuffers& gradient,
                          GradientSums* sums) const;
  void BackpropagateEdgePoint(const EdgePoint& point, double weight,
                              const DifferentiableBuffers& gradient, GradientSums* sums) const;
  // Returns, as a seen point, the nearest of the edge's faces on one side of it in the image;
  // object -1 if there is none. `towards` points into that side, along the image plane, in the
  // camera's frame.
  SeenPoint NearestFace(const ScreenEdge& edge, const EdgePoint& point, const Eigen::Vector3f& ray,
                        const Eigen::Vector3f& towards, bool positive_side) const;

  std::vector<PreparedObject>& objects_;
  const RayTree& tree_;
  const DifferentiableOptions& options_;
  SurfaceShading shading_;

  core::Camera camera_;
  std::uint64_t seed_ = 0;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  std::vector<SeenPoint> seen_;  // (height x width x samples)
  SilhouetteEdges edges_;
  std::vector<GradientSums> sums_;  // one per thread
  bool summing_ = false;
};

}  // namespace simwright::render
