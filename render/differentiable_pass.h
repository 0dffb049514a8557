#pragma once

#include <cstdint>
#include <vector>

#include "render/differentiable_surface.h"
#include "render/ray_tree.h"
#include "render/silhouette_edges.h"

namespace simwright::render {

// One picture and its gradients: what DifferentiableRenderer does between a camera and the sums.
// Remembers what each ray met, so that gradients trace only the edges' rays again.
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
  // Points in the camera's frame, facing sides and normals.
  void Prepare();
  void DrawRow(int y, DifferentiableBuffers* buffers);
  // Image coordinates of a sample.
  Eigen::Vector2d SamplePosition(int x, int y, int sample) const;
  Eigen::Vector3d RayThrough(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - camera_.cx) / camera_.fx, (pixel.y() - camera_.cy) / camera_.fy, 1.0};
  }
  // Traces a row's rays, in its order of samples.
  void TraceRow(int y, SeenPoint* seen) const;

  void BackpropagateRow(int y, const DifferentiableBuffers& gradient, GradientSums* sums) const;
  void BackpropagateEdges(int slice, int slices, const DifferentiableBuffers& gradient,
                          GradientSums* sums) const;
  void BackpropagateEdgePoint(const EdgePoint& point, double weight,
                              const DifferentiableBuffers& gradient, GradientSums* sums) const;
  // Of the edge's faces on one side of it in the picture the nearest one, as a seen point; object
  // -1: there is none. `towards`: in the camera's frame, along the picture, into that side.
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
  std::vector<GradientSums> sums_;  // one a thread
  bool summing_ = false;
};

}  // namespace simwright::render
