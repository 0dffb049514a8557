#pragma once

#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "asset_lift/upright_body.h"
#include "core/camera.h"
#include "core/mesh.h"

namespace simwright::asset_lift {

// An implicit solid in the world whose picture stays inside an outline: the union of the bodies
// added, cut by the outline's cone. Values are about metres, negative inside.
class OutlineField {
 public:
  // `mask` CV_8U, of the camera's size.
  OutlineField(const core::Camera& camera, const cv::Mat& mask);

  void AddUprightBody(const UprightBody& body);
  // Opens the last upright body from above, leaving `wall` (m) round and below.
  void HollowUprightBody(const UprightBody& body, double wall);
  // A squared half depth (pixels^2, see depth_map.h) about the plane through `anchor` that faces
  // the camera.
  void AddDepthMap(const cv::Mat& squared_depth, const Eigen::Vector3d& anchor);

  // Nothing remains where direction.dot(point) > reach; `direction` unit, world.
  void Cut(const Eigen::Vector3d& direction, double reach) {
    cut_direction_ = direction;
    cut_reach_ = reach;
  }

  // The closed surface; `resolution` cells along the longest side of the bodies' box. Throws
  // core::Error where nothing lies inside.
  core::TriangleMesh Extract(int resolution) const;

 private:
  double Value(const Eigen::Vector3d& point) const;

  core::Camera camera_;
  cv::Mat edge_distance_;  // pixels, positive inside
  std::vector<std::function<double(const Eigen::Vector3d&)>> bodies_;
  std::vector<std::function<double(const Eigen::Vector3d&)>> hollows_;
  Eigen::AlignedBox3d box_;
  Eigen::Vector3d cut_direction_ = -Eigen::Vector3d::UnitZ();
  double cut_reach_ = 1e30;
};

}  // namespace simwright::asset_lift
