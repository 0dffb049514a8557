#include "asset_lift/mesh_fit/mesh_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "asset_lift/mesh_fit/area_penalty.h"
#include "asset_lift/mesh_fit/floor_contact.h"
#include "asset_lift/mesh_fit/large_steps.h"
#include "asset_lift/mesh_fit/normal_penalty.h"
#include "asset_lift/mesh_fit/view_loss.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "core/error.h"
#include "geometry/mesh_validity.h"
#include "geometry/self_intersection_smoothing.h"
#include "geometry/surface_distance.h"
#include "tests/asset_lift/fit_scene.h"

namespace simwright::asset_lift {
namespace {

double Chamfer(const core::TriangleMesh& one, const core::TriangleMesh& other) {
  const auto mean = [](const core::TriangleMesh& from, const core::TriangleMesh& to) {
    const std::vector<double> d =
        geometry::DistancesToSurface(geometry::SampleSurface(from, 4000, 7), to);
    return std::accumulate(d.begin(), d.end(), 0.0) / static_cast<double>(d.size());
  };
  return 0.5 * (mean(one, other) + mean(other, one));
}

MeshFitOptions Quick() {
  MeshFitOptions options;
  options.rounds = 2;
  options.steps_per_round = 40;
  options.first_edge_ratio = 0.07;
  options.last_edge_ratio = 0.045;
  options.max_side = 48;
  options.views_per_step = 2;
  options.edge_samples = 1500;
  return options;
}

TEST(LargeSteps, SolveUndoesApplyAndKeepsTranslations) {
  const core::TriangleMesh mesh = Sphere(0.1);
  const LargeSteps steps(mesh, 5.0);
  const Eigen::MatrixX3d v =
      Eigen::MatrixX3d::Random(static_cast<Eigen::Index>(mesh.vertices.size()), 3);
  EXPECT_LT((steps.Solve(steps.Apply(v)) - v).norm(), 1e-9 * v.norm());
  const Eigen::MatrixX3d one = Eigen::MatrixX3d::Ones(v.rows(), 3);
  EXPECT_LT((steps.Apply(one) - one).norm(), 1e-9);
  // A spike at one vertex spreads, because the inverse matrix smooths.
  Eigen::MatrixX3d spike = Eigen::MatrixX3d::Zero(v.rows(), 3);
  spike(7, 0) = 1.0;
  const Eigen::MatrixX3d spread = steps.Solve(spike);
  EXPECT_LT(spread(7, 0), 0.2);
  EXPECT_GT(spread.col(0).minCoeff(), -1e-12);
  EXPECT_NEAR(spread.col(0).sum(), 1.0, 1e-9);
  EXPECT_THROW(LargeSteps(mesh, -1.0), core::Error);
}

TEST(LargeSteps, AdamKeepsTheGradientsDirection) {
  AdamUniform adam(2);
  Eigen::MatrixX3d gradient(2, 3);
  gradient << 3.0, -1.0, 0.5, 0.1, 0.0, 2.0;
  // With the first step's corrections: -rate * g / max|g|.
  const Eigen::MatrixX3d step = adam.Step(gradient, 0.3);
  EXPECT_LT((step + 0.1 * gradient).norm(), 1e-12);
}

TEST(AreaPenalty, IsTheAreaWithItsDerivative) {
  core::TriangleMesh mesh = BumpySphere();
  const core::TriangleMesh ball = Sphere(0.1);
  std::vector<Eigen::Vector3d> unused(ball.vertices.size(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(AddAreaPenalty(ball, 0.2, 0.0, &unused), M_PI, 0.02);  // 4 pi r^2 over (2 r)^2
  std::vector<Eigen::Vector3d> gradient(mesh.vertices.size(), Eigen::Vector3d::Zero());
  AddAreaPenalty(mesh, 0.3, 2.0, &gradient);
  for (const int v : {3, 100, 999}) {
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kStep = 1e-7;
      const auto value = [&](double by) {
        core::TriangleMesh moved = mesh;
        moved.vertices[v][axis] += by;
        std::vector<Eigen::Vector3d> none(mesh.vertices.size(), Eigen::Vector3d::Zero());
        return AddAreaPenalty(moved, 0.3, 0.0, &none);
      };
      EXPECT_NEAR(gradient[v][axis], (value(kStep) - value(-kStep)) / kStep, 1e-5);
    }
  }
}

TEST(FloorContact, PutsTheBaseOnTheFloorAndNothingBelow) {
  core::TriangleMesh box = Hook();  // its base is at -0.1
  for (Eigen::Vector3d& v : box.vertices) v.z() += 0.1;
  core::TriangleMesh sunk = box;
  for (Eigen::Vector3d& v : sunk.vertices) v.z() -= 0.02 * (1.0 + v.x() / 0.1);
  EXPECT_TRUE(StandOnFloor(0.004, &sunk));
  EXPECT_EQ(core::Bounds(sunk).min().z(), 0.0);
  core::TriangleMesh raised = box;
  for (Eigen::Vector3d& v : raised.vertices) v.z() += 0.003;
  EXPECT_TRUE(StandOnFloor(0.004, &raised));
  double top = 0.0;
  int on_floor = 0;
  for (std::size_t i = 0; i < raised.vertices.size(); ++i) {
    on_floor += raised.vertices[i].z() == 0.0;
    top = std::max(top, raised.vertices[i].z() - box.vertices[i].z());
  }
  EXPECT_GT(on_floor, 100);
  EXPECT_NEAR(top, 0.003, 1e-12);  // what is no base keeps its height
  core::TriangleMesh high = box;
  for (Eigen::Vector3d& v : high.vertices) v.z() += 0.01;
  EXPECT_FALSE(StandOnFloor(0.004, &high));
}

TEST(NormalPenalty, DerivativeMatchesDifferences) {
  core::TriangleMesh mesh = BumpySphere();
  for (const double crease : {0.0, 0.15}) {
    const NormalPenalty penalty(mesh, crease);
    std::vector<Eigen::Vector3d> gradient(mesh.vertices.size(), Eigen::Vector3d::Zero()), unused;
    penalty.Add(mesh.vertices, 2.0, &gradient);
    for (const int v : {3, 100, 999}) {
      for (int axis = 0; axis < 3; ++axis) {
        constexpr double kStep = 1e-7;
        const auto value = [&](double by) {
          std::vector<Eigen::Vector3d> moved = mesh.vertices;
          moved[v][axis] += by;
          unused.assign(moved.size(), Eigen::Vector3d::Zero());
          return 2.0 * penalty.Add(moved, 1.0, &unused);
        };
        const double difference = (value(kStep) - value(-kStep)) / (2.0 * kStep);
        EXPECT_NEAR(gradient[v][axis], difference, 1e-3 * gradient[v].norm());
      }
    }
  }
}

// A square roof of slope 0.35 over a square box, whose faces are divided once. With creases the
// flat top costs less than the roof, without them more.
TEST(NormalPenalty, CreasesMakeFlatTopsCheaperThanRoofs) {
  const auto box = [](double height) {
    core::TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) {
      mesh.vertices.emplace_back((i & 1) ? 1.0 : -1.0, (i >> 1 & 1) ? 1.0 : -1.0, (i >> 2) * 1.0);
    }
    mesh.vertices.emplace_back(0.0, 0.0, 1.0 + height);
    for (const Eigen::Vector3i& t : {Eigen::Vector3i(0, 2, 1),
                                     {1, 2, 3},
                                     {0, 1, 4},
                                     {1, 5, 4},
                                     {2, 6, 3},
                                     {3, 6, 7},
                                     {0, 4, 2},
                                     {2, 4, 6},
                                     {1, 3, 5},
                                     {3, 7, 5},
                                     {4, 5, 8},
                                     {5, 7, 8},
                                     {7, 6, 8},
                                     {6, 4, 8}}) {
      mesh.triangles.push_back(t);
    }
    return mesh;
  };
  const auto cost = [&](double height, double crease) {
    const core::TriangleMesh mesh = box(height);
    std::vector<Eigen::Vector3d> unused(mesh.vertices.size(), Eigen::Vector3d::Zero());
    return NormalPenalty(mesh, crease).Add(mesh.vertices, 1.0, &unused);
  };
  EXPECT_LT(cost(0.0, 0.2), cost(0.35, 0.2));
  EXPECT_GT(cost(0.0, 0.0), cost(0.35, 0.0));
}

TEST(ViewLoss, TargetsAreAveragedDown) {
  std::vector<ObservedView> views = ViewsOf(Sphere(0.1), 1, 64);
  const ViewTarget target = MakeTarget(views[0], 16);
  EXPECT_EQ(target.camera.width, 16);
  EXPECT_NEAR(target.camera.fx, views[0].camera.fx / 4.0, 1e-9);
  const double area =
      std::accumulate(views[0].opacity.values.begin(), views[0].opacity.values.end(), 0.0);
  EXPECT_NEAR(target.area, area / 16.0, 1e-3);
  const ViewTarget same = MakeTarget(views[0], 100);
  EXPECT_EQ(same.opacity.values, views[0].opacity.values);
  // 64 to 48: each small pixel holds 4/3 of a large one, the sum of areas stays.
  EXPECT_NEAR(MakeTarget(views[0], 48).area, area * 0.5625, 1e-2);
}

TEST(ViewLoss, DerivativeMatchesDifferences) {
  const std::vector<ObservedView> views = ViewsOf(Sphere(0.1), 2, 12);
  const ViewTarget target = MakeTarget(views[0], 12);
  render::DifferentiableBuffers picture{views[1].color, views[1].opacity, views[1].depth, {}};
  ViewLossWeights weights;
  weights.length = 0.3;
  render::DifferentiableBuffers gradient, unused;
  ViewLoss(target, picture, weights, &gradient);
  const auto check = [&](core::FloatImage* image, const core::FloatImage& slope, int at) {
    const float value = image->values[at];
    image->values[at] = value + 1e-3f;
    const double up = ViewLoss(target, picture, weights, &unused);
    image->values[at] = value - 1e-3f;
    const double down = ViewLoss(target, picture, weights, &unused);
    image->values[at] = value;
    EXPECT_NEAR((up - down) / 2e-3, slope.values[at], 1e-3 * std::abs(slope.values[at]) + 1e-6);
  };
  const int middle = 6 * 12 + 4;
  check(&picture.color, gradient.color, 3 * middle + 1);
  check(&picture.depth, gradient.depth, middle);
  check(&picture.mask, gradient.mask, 14);
  EXPECT_NE(gradient.depth.values[middle], 0.0f);
  // A depth that is wrong by more than the tolerance counts linearly.
  const float slope = gradient.depth.values[middle];
  picture.depth.values[middle] = target.depth.values[middle] + 0.02f;
  weights.depth_tolerance = 0.005;
  ViewLoss(target, picture, weights, &gradient);
  check(&picture.depth, gradient.depth, middle);
  EXPECT_NE(gradient.depth.values[middle], slope);
  picture.depth.values[middle] = target.depth.values[middle] + 0.04f;
  render::DifferentiableBuffers farther;
  ViewLoss(target, picture, weights, &farther);
  EXPECT_FLOAT_EQ(farther.depth.values[middle], gradient.depth.values[middle]);
}

TEST(CrossingRepair, AFoldIsSmoothedAway) {
  core::TriangleMesh mesh = Sphere(0.1);
  mesh.vertices[50] = -1.1 * mesh.vertices[50];  // through the other side
  ASSERT_GT(geometry::Examine(mesh).self_intersections, 0);
  EXPECT_TRUE(geometry::SmoothSelfIntersections(&mesh, {.rounds = 15}));
  EXPECT_TRUE(geometry::Examine(mesh).IsSolid());
}

TEST(MeshFit, ABumpySphereFromASphere) {
  const core::TriangleMesh truth = BumpySphere();
  const std::vector<ObservedView> views = ViewsOf(truth, 8, 48);
  const core::TriangleMesh start = Sphere(0.085);
  const MeshFitResult result = FitMesh(start, views, nullptr, Quick());
  const double diagonal = core::Bounds(truth).diagonal().norm();
  EXPECT_GT(Chamfer(start, truth), 0.03 * diagonal);
  EXPECT_LT(Chamfer(result.mesh, truth), 0.007 * diagonal);
  EXPECT_TRUE(geometry::Examine(result.mesh).IsSolid());
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.steps, 80);
  ASSERT_EQ(result.mask_iou.size(), 8u);
  for (const double iou : result.mask_iou) EXPECT_GT(iou, 0.95);
  for (const double error : result.color_error) EXPECT_LT(error, 0.08);
  EXPECT_EQ(result.vertex_colors.size(), result.mesh.vertices.size());
}

// One camera cannot distinguish size from distance; depths can.
TEST(MeshFit, DepthsPlaceWhatMasksAloneCannot) {
  std::vector<ObservedView> views = ViewsOf(Sphere(0.1), 1, 48);
  views[0].color = {};
  // A smaller ball, nearer: nearly the same outline.
  core::TriangleMesh start = Sphere(0.08);
  const Eigen::Vector3d eye = views[0].camera.position();
  for (Eigen::Vector3d& v : start.vertices) v += 0.2 * eye;
  MeshFitOptions options = Quick();
  options.views_per_step = 1;
  // The distance of the mesh's front from its target.
  const auto miss = [&](const core::TriangleMesh& mesh) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& v : mesh.vertices) nearest = std::min(nearest, (v - eye).norm());
    return std::abs(nearest - (eye.norm() - 0.1));
  };
  ASSERT_GT(miss(start), 0.09);
  const double with_depth = miss(FitMesh(start, views, nullptr, options).mesh);
  views[0].depth = {};
  const double without = miss(FitMesh(start, views, nullptr, options).mesh);
  EXPECT_LT(with_depth, 0.01);
  EXPECT_GT(without, 0.05);
}

// An objective whose target is a view's image, from the view's camera; may become non-finite.
class LikeAView : public ImageObjective {
 public:
  LikeAView(const std::vector<ObservedView>& views, int wrong_from, int wrong_to)
      : wrong_from_(wrong_from), wrong_to_(wrong_to) {
    for (const ObservedView& view : views) targets_.push_back(MakeTarget(view, 48));
  }
  core::Camera NextCamera(double, core::Rng* rng) override {
    at_ = static_cast<int>(core::UniformIndex(*rng, static_cast<int>(targets_.size())));
    return targets_[at_].camera;
  }
  double Evaluate(const core::Camera&, const ObjectImage& picture, double, core::Rng*,
                  ObjectImage* gradient) override {
    render::DifferentiableBuffers shown, slope;
    shown.color = picture.color;
    shown.mask = picture.opacity;
    ViewLossWeights weights;
    weights.depth = 0.0;
    const double loss = ViewLoss(targets_[at_], shown, weights, &slope);
    *gradient = {slope.color, slope.mask};
    const int call = calls_++;
    if (call >= wrong_from_ && call < wrong_to_) {
      gradient->opacity.values[30 * 48 + 24] = std::numeric_limits<float>::quiet_NaN();
    }
    return loss;
  }

 private:
  std::vector<ViewTarget> targets_;
  int at_ = 0, calls_ = 0, wrong_from_, wrong_to_;
};

int Count(const MeshFitResult& result, const std::string& code) {
  int count = 0;
  for (const core::Finding& finding : result.findings) count += finding.code == code;
  return count;
}

TEST(MeshFit, TheLeastAreaFlattensWhatOutlinesLeaveOpen) {
  const core::TriangleMesh box = SurfaceOf(
      [](const Eigen::Vector3d& p) {
        return (p.cwiseAbs() - Eigen::Vector3d(0.1, 0.06, 0.04)).maxCoeff();
      },
      0.13, 40);
  std::vector<ObservedView> views = ViewsOf(box, 7, 96);
  for (ObservedView& view : views) view.color = view.depth = {};
  VisualHullOptions of_hull;
  of_hull.cells = 48;
  const core::TriangleMesh hull = VisualHull(views, of_hull);
  MeshFitOptions options = Quick();
  options.max_side = 96;
  options.steps_per_round = 120;
  options.first_edge_ratio = 0.04;
  options.last_edge_ratio = 0.025;
  const double plain = Chamfer(box, FitMesh(hull, views, nullptr, options).mesh);
  options.first_area_weight = 0.6;
  options.last_area_weight = 0.1;
  const double flat = Chamfer(box, FitMesh(hull, views, nullptr, options).mesh);
  EXPECT_GT(plain, 0.002);  // m: its hull has roofs over its sides
  EXPECT_LT(flat, 0.6 * plain);
}

TEST(MeshFit, AnObjectiveAloneShapesTheMesh) {
  const core::TriangleMesh truth = BumpySphere();
  LikeAView objective(ViewsOf(truth, 8, 48), 0, 0);
  MeshFitOptions options = Quick();
  options.steps_per_round = 80;
  const MeshFitResult result = FitMesh(Sphere(0.085), {}, &objective, options);
  EXPECT_LT(Chamfer(result.mesh, truth), 0.01 * core::Bounds(truth).diagonal().norm());
  EXPECT_EQ(result.steps, 160);
}

TEST(MeshFit, NotFiniteNowAndThenCostsAStepBack) {
  const core::TriangleMesh truth = BumpySphere();
  const std::vector<ObservedView> views = ViewsOf(truth, 8, 48);
  LikeAView objective(views, 33, 35);
  const MeshFitResult result = FitMesh(Sphere(0.085), views, &objective, Quick());
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(Count(result, "stepped-back"), 2);
  EXPECT_EQ(result.steps, 78);
  EXPECT_LT(Chamfer(result.mesh, truth), 0.01 * core::Bounds(truth).diagonal().norm());
}

TEST(MeshFit, NotFiniteForGoodStopsWithTheLastGoodMesh) {
  const core::TriangleMesh truth = BumpySphere();
  const std::vector<ObservedView> views = ViewsOf(truth, 8, 48);
  LikeAView objective(views, 30, 1000);
  const MeshFitResult result = FitMesh(Sphere(0.085), views, &objective, Quick());
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(Count(result, "stopped-early"), 1);
  EXPECT_EQ(result.steps, 30);
  EXPECT_TRUE(geometry::Examine(result.mesh).IsSolid());
  EXPECT_LT(Chamfer(result.mesh, truth), 0.03 * core::Bounds(truth).diagonal().norm());
}

TEST(MeshFit, TheSameSeedGivesTheSameMesh) {
  const std::vector<ObservedView> views = ViewsOf(BumpySphere(), 4, 32);
  MeshFitOptions options = Quick();
  options.steps_per_round = 10;
  const MeshFitResult one = FitMesh(Sphere(0.085), views, nullptr, options);
  const MeshFitResult two = FitMesh(Sphere(0.085), views, nullptr, options);
  EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
  EXPECT_EQ(one.vertex_colors, two.vertex_colors);
}

TEST(MeshFit, AWrongCameraIsNamed) {
  std::vector<ObservedView> views = ViewsOf(Hook(), 6, 48);
  views[4].camera.world_from_camera =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) * views[4].camera.world_from_camera;
  MeshFitOptions options = Quick();
  options.rounds = options.steps_per_round = 1;
  const MeshFitResult result = FitMesh(Sphere(0.1), views, nullptr, options);
  ASSERT_EQ(Count(result, "view-contradicts"), 1);
  EXPECT_EQ(result.findings.back().place, "view 4");
}

TEST(MeshFit, BadInputIsNamed) {
  const std::vector<ObservedView> views = ViewsOf(Sphere(0.1), 2, 24);
  EXPECT_THROW(FitMesh({}, views, nullptr), core::Error);
  EXPECT_THROW(FitMesh(Sphere(0.1), {}, nullptr), core::Error);
  MeshFitOptions options;
  options.step_ratio = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(FitMesh(Sphere(0.1), views, nullptr, options), core::Error);
  options = {};
  options.color_weight = -1.0;
  EXPECT_THROW(FitMesh(Sphere(0.1), views, nullptr, options), core::Error);
  std::vector<ObservedView> broken = views;
  broken[1].camera.fx = 0.0;
  EXPECT_THROW(FitMesh(Sphere(0.1), broken, nullptr), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
