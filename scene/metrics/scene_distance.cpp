#include "scene/metrics/scene_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "scene/metrics/assignment.h"

namespace simwright::scene {

bool SceneDistanceOptions::IsValid(std::string* error) const {
  if (!(std::isfinite(lever) && lever >= 0.0)) {
    *error = "lever must be at least 0 m";
    return false;
  }
  if (!(std::isfinite(cut_off) && cut_off > 0.0)) {
    *error = "cut_off must be above 0 m";
    return false;
  }
  return true;
}

SceneDistances::SceneDistances(const std::vector<std::vector<SceneObject>>& scenes,
                               const Vocabulary& vocabulary, const SceneDistanceOptions& options)
    : vocabulary_(vocabulary), options_(options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("distance of scenes: " + error);
  scenes_.reserve(scenes.size());
  for (const std::vector<SceneObject>& objects : scenes) scenes_.push_back(Sorted(objects));
}

SceneDistances::ByClass SceneDistances::Sorted(const std::vector<SceneObject>& objects) const {
  ByClass classes(vocabulary_.categories.size());
  for (const SceneObject& object : objects) {
    const int index = vocabulary_.ClassOf(object.category);
    if (index < 0) throw core::Error("the vocabulary has no such category", object.category);
    classes[static_cast<size_t>(index)].push_back(
        {object.world_from_object.translation(),
         Eigen::Quaterniond(object.world_from_object.linear())});
  }
  return classes;
}

double SceneDistances::CountCost(const ByClass& a, const ByClass& b) const {
  size_t left_over = 0;
  for (size_t c = 0; c < a.size(); ++c) {
    left_over += std::max(a[c].size(), b[c].size()) - std::min(a[c].size(), b[c].size());
  }
  return options_.cut_off * static_cast<double>(left_over);
}

// Returns the cost of the pairs only. Each object of the smaller set costs at least as much as its
// nearest one, which decides most comparisons without an assignment.
double SceneDistances::ClassCost(const std::vector<Place>& a, const std::vector<Place>& b,
                                 double limit) const {
  if (a.empty() || b.empty()) return 0.0;
  const std::vector<Place>&few = a.size() <= b.size() ? a : b, &many = a.size() <= b.size() ? b : a;
  Eigen::MatrixXd cost(few.size(), many.size());
  double bound = 0.0;
  for (Eigen::Index i = 0; i < cost.rows(); ++i) {
    const Place& one = few[static_cast<size_t>(i)];
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
      const Place& other = many[static_cast<size_t>(j)];
      double apart = (one.translation - other.translation).norm();
      if (apart < options_.cut_off && options_.lever > 0.0) {
        // The angle from its tangent: exact for small ones too.
        const Eigen::Quaterniond turn = one.rotation.conjugate() * other.rotation;
        apart += options_.lever * 2.0 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
      }
      cost(i, j) = std::min(options_.cut_off, apart);
    }
    bound += cost.row(i).minCoeff();
    if (bound >= limit) return bound;
  }
  if (cost.rows() == 1) return bound;
  return CheapestAssignment(cost).cost;
}

double SceneDistances::Distance(const ByClass& a, const ByClass& b, double limit) const {
  double sum = CountCost(a, b);
  for (size_t c = 0; c < a.size() && sum < limit; ++c) sum += ClassCost(a[c], b[c], limit - sum);
  return sum;
}

double SceneDistances::To(const std::vector<SceneObject>& objects, int scene) const {
  return Distance(Sorted(objects), scenes_.at(static_cast<size_t>(scene)),
                  std::numeric_limits<double>::infinity());
}

NearestScene SceneDistances::Nearest(const std::vector<SceneObject>& objects) const {
  if (scenes_.empty()) throw core::Error("there are no scenes to compare with");
  const ByClass sorted = Sorted(objects);
  std::vector<double> bounds(scenes_.size());
  for (size_t i = 0; i < scenes_.size(); ++i) bounds[i] = CountCost(sorted, scenes_[i]);
  std::vector<size_t> order(scenes_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) {
    return bounds[i] != bounds[j] ? bounds[i] < bounds[j] : i < j;
  });
  NearestScene nearest{-1, std::numeric_limits<double>::infinity()};
  for (const size_t i : order) {
    if (bounds[i] >= nearest.distance) break;
    const double distance = Distance(sorted, scenes_[i], nearest.distance);
    if (distance < nearest.distance) nearest = {static_cast<int>(i), distance};
  }
  return nearest;
}

}  // namespace simwright::scene
