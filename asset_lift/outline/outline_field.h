#pragma once

#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "asset_lift/outline/upright_body.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// An implicit solid in the world whose silhouette stays inside a mask: the union of the added
// bodies, intersected with the mask's cone. Values are approximate metres, negative inside.
class OutlineField {
 public:
  // `mask` is CV_8U and has the camera's image size.
  OutlineField(const core::Camera& camera, const cv::Mat& mask);

  void AddUprightBody(const UprightBody& body);
  // Hollows the last upright body from above, leaving `wall` (m) at the sides and the bottom.
  void HollowUprightBody(const UprightBody& body, double wall);
  // Adds a squared half depth map (pixels^2, see depth_map.h) about the plane through `anchor` that
  // faces the camera.
  void AddDepthMap(const cv::Mat& squared_depth, const Eigen::Vector3d& anchor);

  // Removes the half space direction.dot(point) > reach; `direction` is a unit vector in the world
  // frame.
  void Cut(const Eigen::Vector3d& direction, double reach) {
    cut_direction_ = direction;
    cut_reach_ = reach;
  }

  // Extracts the closed surface; `resolution` is the number of cells along the longest side of the
  // bodies' AABB. Throws core::Error where the solid is empty.
  core::TriangleMesh Extract(int resolution) const;

  // Returns the field at a world point. Requires an added body.
  double Value(const Eigen::Vector3d& point) const;
  bool empty() const { return bodies_.empty(); }
  // Returns the world AABB of the bodies.
  const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  core::Camera camera_;
  cv::Mat edge_distance_;  // pixels, positive inside
  std::vector<std::function<double(const Eigen::Vector3d&)>> bodies_;
  std::vector<std::function<double(const Eigen::Vector3d&)>> hollows_;
  Eigen::AlignedBox3d box_;
  Eigen::Vector3d cut_direction_ = -Eigen::Vector3d::UnitZ();
  double cut_reach_ = 1e30;
};

}  // namespace simwright::asset_lift
