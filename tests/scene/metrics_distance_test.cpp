// Distances between scenes, against known permutations and displacements.
#include "scene/metrics/scene_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "scene/metrics/assignment.h"

namespace simwright::scene {
namespace {

// Returns the least cost of min(rows, columns) pairs by trying all.
double LeastOfAll(const Eigen::MatrixXd& cost) {
  if (cost.rows() > cost.cols()) return LeastOfAll(cost.transpose());
  std::vector<int> columns(static_cast<size_t>(cost.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  double least = std::numeric_limits<double>::infinity();
  do {
    double sum = 0.0;
    for (int i = 0; i < cost.rows(); ++i) sum += cost(i, columns[static_cast<size_t>(i)]);
    least = std::min(least, sum);
  } while (std::next_permutation(columns.begin(), columns.end()));
  return least;
}

TEST(CheapestAssignment, IsTheBestOfAllPermutations) {
  core::Rng rng = core::StreamRng(1, 0);
  for (int round = 0; round < 300; ++round) {
    const auto rows = static_cast<Eigen::Index>(1 + core::UniformIndex(rng, 6));
    const auto columns = static_cast<Eigen::Index>(1 + core::UniformIndex(rng, 6));
    Eigen::MatrixXd cost(rows, columns);
    for (Eigen::Index i = 0; i < cost.size(); ++i) {
      // Integers half of the time, so that there are ties.
      const double value = core::Uniform(rng, -5.0, 5.0);
      cost(i) = round % 2 == 0 ? value : std::round(value);
    }
    const Assignment assignment = CheapestAssignment(cost);
    EXPECT_NEAR(assignment.cost, LeastOfAll(cost), 1e-9);
    double sum = 0.0;
    std::vector<int> used;
    for (Eigen::Index i = 0; i < rows; ++i) {
      const int column = assignment.column[static_cast<size_t>(i)];
      if (column < 0) continue;
      sum += cost(i, column);
      used.push_back(column);
    }
    EXPECT_NEAR(sum, assignment.cost, 1e-9);
    std::sort(used.begin(), used.end());
    EXPECT_EQ(std::unique(used.begin(), used.end()), used.end());
    EXPECT_EQ(static_cast<Eigen::Index>(used.size()), std::min(rows, columns));
  }
  EXPECT_EQ(CheapestAssignment(Eigen::MatrixXd(0, 3)).cost, 0.0);
  EXPECT_THROW(CheapestAssignment(Eigen::MatrixXd::Constant(2, 2, NAN)), core::Error);
}

Vocabulary MetricsDistanceWords() {
  return {"test", 12, {"cup", "plate", "table"}, {false, false, true}};
}

using MetricsDistanceObjects = std::vector<SceneObject>;

// Returns a table and up to 10 cups and plates around it, with random rotations.
MetricsDistanceObjects RandomScene(core::Rng& rng) {
  MetricsDistanceObjects objects(2 + static_cast<size_t>(core::UniformIndex(rng, 10)));
  for (size_t i = 0; i < objects.size(); ++i) {
    objects[i].category = i == 0 ? "table" : i % 2 == 0 ? "cup" : "plate";
    if (i == 0) continue;
    objects[i].world_from_object.translation() << core::Uniform(rng, -0.5, 0.5),
        core::Uniform(rng, -0.5, 0.5), 0.7;
    objects[i].world_from_object.linear() =
        Eigen::AngleAxisd(core::Uniform(rng, 0.0, 6.0), Eigen::Vector3d::UnitZ())
            .toRotationMatrix();
  }
  return objects;
}

std::vector<MetricsDistanceObjects> RandomScenes(int count) {
  core::Rng rng = core::StreamRng(3, 0);
  std::vector<MetricsDistanceObjects> scenes;
  for (int i = 0; i < count; ++i) scenes.push_back(RandomScene(rng));
  return scenes;
}

TEST(SceneDistances, ACopyIsAtItsPlace) {
  const std::vector<MetricsDistanceObjects> scenes = RandomScenes(200);
  const SceneDistances distances(scenes, MetricsDistanceWords());
  for (int i = 0; i < 200; i += 20) {
    MetricsDistanceObjects copy = scenes[static_cast<size_t>(i)];
    std::reverse(copy.begin(), copy.end());
    const NearestScene nearest = distances.Nearest(copy);
    EXPECT_EQ(nearest.scene, i);
    EXPECT_NEAR(nearest.distance, 0.0, 1e-6);
  }
}

TEST(SceneDistances, AMovedOneIsAsFarAsItsShift) {
  const std::vector<MetricsDistanceObjects> scenes = RandomScenes(200);
  const SceneDistances distances(scenes, MetricsDistanceWords());
  MetricsDistanceObjects moved = scenes[7];
  moved[1].world_from_object.translation() += Eigen::Vector3d(0.006, -0.008, 0.0);
  EXPECT_EQ(distances.Nearest(moved).scene, 7);
  EXPECT_NEAR(distances.Nearest(moved).distance, 0.01, 1e-6);
  // Plus a rotation by half a radian at a lever of 5 cm.
  moved[1].world_from_object.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(distances.Nearest(moved).distance, 0.035, 1e-6);
  EXPECT_NEAR(distances.To(moved, 7), 0.035, 1e-6);
  // One more object, and one farther away than the cut-off: 1 m each.
  moved.push_back(moved[1]);
  moved[0].world_from_object.translation().x() += 30.0;
  EXPECT_NEAR(distances.To(moved, 7), 2.0 + distances.To(scenes[7], 7) + 0.035, 1e-6);
}

TEST(SceneDistances, IsTheNearestOfAll) {
  const std::vector<MetricsDistanceObjects> scenes = RandomScenes(300);
  const SceneDistances distances(scenes, MetricsDistanceWords());
  core::Rng rng = core::StreamRng(9, 0);
  for (int round = 0; round < 30; ++round) {
    const MetricsDistanceObjects scene = RandomScene(rng);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < distances.size(); ++i) least = std::min(least, distances.To(scene, i));
    EXPECT_NEAR(distances.Nearest(scene).distance, least, 1e-9);
    EXPECT_GT(least, 0.05);
  }
}

TEST(SceneDistances, RefusesWhatIsNone) {
  EXPECT_THROW(SceneDistances({}, MetricsDistanceWords()).Nearest({}), core::Error);
  MetricsDistanceObjects spoon(1);
  spoon[0].category = "spoon";
  EXPECT_THROW(SceneDistances({spoon}, MetricsDistanceWords()), core::Error);
  EXPECT_THROW(SceneDistances({}, MetricsDistanceWords(), {-1.0, 1.0}), core::Error);
  EXPECT_THROW(SceneDistances({}, MetricsDistanceWords(), {0.05, 0.0}), core::Error);
}

}  // namespace
}  // namespace simwright::scene
