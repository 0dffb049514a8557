#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "scene/dataset/vocabulary.h"
#include "scene/grammar/scene_draw.h"

namespace simwright::scene {

struct SceneDistanceOptions {
  double lever = 0.05;   // m a rad of rotation: what a point so far off the axis moves
  double cut_off = 1.0;  // m that two objects are apart at most, and that one without another costs

  bool IsValid(std::string* error) const;
};

struct NearestScene {
  int scene = -1;
  double distance = 0.0;  // m
};

// How far scenes are from each other: class by class the cheapest assignment of objects, a pair
// costing min(cut_off, |translation| + lever * angle) and an object that is left over the cut-off,
// all added up, m. That is the OSPA metric of order 1 (Schuhmacher et al. 2008), class by class,
// not divided by the number of objects. 0 for the same scene in any order of its objects.
class SceneDistances {
 public:
  // Throws core::Error for options that are not valid, or a slot that the vocabulary lacks.
  SceneDistances(const std::vector<std::vector<DrawnObject>>& scenes, const Vocabulary& vocabulary,
                 const SceneDistanceOptions& options = {});

  int size() const { return static_cast<int>(scenes_.size()); }
  double To(const std::vector<DrawnObject>& objects, int scene) const;
  // The nearest scene. Scenes are looked at in the order of what their counts
  // alone cost, and left as soon as a bound from below is no better than the best: the answer is
  // exact. Throws core::Error where there are no scenes.
  NearestScene Nearest(const std::vector<DrawnObject>& objects) const;

 private:
  struct Place {
    Eigen::Vector3d translation;
    Eigen::Quaterniond rotation;
  };
  using ByClass = std::vector<std::vector<Place>>;

  ByClass Sorted(const std::vector<DrawnObject>& objects) const;
  double CountCost(const ByClass& a, const ByClass& b) const;
  double ClassCost(const std::vector<Place>& a, const std::vector<Place>& b, double limit) const;
  // Exact where it is below `limit`, else anything from `limit` up.
  double Distance(const ByClass& a, const ByClass& b, double limit) const;

  Vocabulary vocabulary_;
  SceneDistanceOptions options_;
  std::vector<ByClass> scenes_;
};

}  // namespace simwright::scene
