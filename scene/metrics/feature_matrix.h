#pragma once

#include <Eigen/Core>

namespace simwright::scene {

// Features of images, one image per row (N x D).
using FeatureMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace simwright::scene
