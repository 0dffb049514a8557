#pragma once

#include <vector>

#include <Eigen/Core>

namespace simwright::capture {

// A density of colours: Gaussians about the clusters of a sample (Rother et al. 2004), and a small
// uniform share for colours that the sample lacks.
class ColorMixture {
 public:
  // `sample`: RGB in [0, 255]; at least one. Clusters start at random with a fixed seed.
  explicit ColorMixture(const std::vector<Eigen::Vector3f>& sample);

  // Returns minus the logarithm of the density, per cubed level.
  float Cost(const Eigen::Vector3f& color) const;

 private:
  struct Gaussian {
    Eigen::Vector3f mean;
    Eigen::Matrix3f inverse;  // of the covariance
    float factor = 0.0f;      // its share over the Gaussian's normalisation
  };
  std::vector<Gaussian> gaussians_;
};

}  // namespace simwright::capture
