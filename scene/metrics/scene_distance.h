#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_sample.h"

namespace simwright::scene {

struct SceneDistanceOptions {
  double lever = 0.05;   // m per rad of rotation: lever arm of the rotation cost
  double cut_off = 1.0;  // m, largest cost of a pair, and the cost of an unmatched object

  bool IsValid(std::string* error) const;
};

struct NearestScene {
  int scene = -1;
  double distance = 0.0;  // m
};

// Distances between scenes: the cheapest assignment of objects within each class, with min(cut_off,
// |translation| + lever * angle) per pair and the cut-off per unmatched object, summed over all
// classes, m. This is the OSPA metric of order 1 (Schuhmacher et al. 2008), by class, not divided
// by the number of objects. 0 for equal scenes in any order of their objects.
class SceneDistances {
 public:
  // Throws core::Error for invalid options, or a category that the vocabulary lacks.
  SceneDistances(const std::vector<std::vector<SceneObject>>& scenes, const Vocabulary& vocabulary,
                 const SceneDistanceOptions& options = {});

  int size() const { return static_cast<int>(scenes_.size()); }
  double To(const std::vector<SceneObject>& objects, int scene) const;
  // Returns the nearest scene. Scenes are searched in ascending order of the cost of their counts
  // and skipped once a lower bound reaches the best distance; the result is exact. Throws
  // core::Error if there are no scenes.
  NearestScene Nearest(const std::vector<SceneObject>& objects) const;

 private:
  struct Place {
    Eigen::Vector3d translation;
    Eigen::Quaterniond rotation;
  };
  using ByClass = std::vector<std::vector<Place>>;

  ByClass Sorted(const std::vector<SceneObject>& objects) const;
  double CountCost(const ByClass& a, const ByClass& b) const;
  double ClassCost(const std::vector<Place>& a, const std::vector<Place>& b, double limit) const;
  // Returns the exact distance if it is below `limit`, otherwise any value >= `limit`.
  double Distance(const ByClass& a, const ByClass& b, double limit) const;

  Vocabulary vocabulary_;
  SceneDistanceOptions options_;
  std::vector<ByClass> scenes_;
};

}  // namespace simwright::scene
