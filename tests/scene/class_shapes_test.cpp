// Classes embedded by the surfaces of their assets: class indices carry no information.
#include "scene/model/class_shapes.h"

#include <gtest/gtest.h>

#include "assets/primitive_meshes.h"
#include "core/error.h"
#include "scene/model/denoiser.h"

namespace simwright::scene {
namespace {

constexpr int kPoints = 48, kEntries = 5;

std::vector<Eigen::Vector3d> BoxShape(double x, double y, double z) {
  return ShapeOf(assets::BoxMesh({x, y, z}), kPoints);
}

SceneModelOptions ClassShapesSmall(DenoiserKind kind) {
  SceneModelOptions options;
  options.kind = kind;
  options.width = 32;
  options.heads = 2;
  options.double_blocks = 1;
  options.single_blocks = 1;
  options.shape_points = kPoints;
  return options;
}

// Copies the weights of `from` to `to`; shapes are unchanged.
void CopyParameters(const Denoiser& from, Denoiser* to) {
  const torch::NoGradGuard no_gradient;
  const auto values = from.named_parameters();
  for (auto& one : to->named_parameters()) {
    // None has a size that depends on the number of classes.
    ASSERT_EQ(one.value().sizes(), values[one.key()].sizes()) << one.key();
    one.value().copy_(values[one.key()] + 0.1 * torch::sin(values[one.key()] * 1e3));
  }
}

class ClassShapesOf : public ::testing::TestWithParam<DenoiserKind> {};

TEST_P(ClassShapesOf, AnotherOrderOfClassesIsTheSameInThatOrder) {
  torch::manual_seed(3);
  const auto cup = BoxShape(0.08, 0.08, 0.1), plate = BoxShape(0.25, 0.25, 0.02),
             floor = BoxShape(10, 10, 0.1);
  const auto start = MakeDenoiser(ClassShapesSmall(GetParam()), 4),
             a = MakeDenoiser(ClassShapesSmall(GetParam()), 4),
             b = MakeDenoiser(ClassShapesSmall(GetParam()), 5);
  CopyParameters(*start, a.get());
  CopyParameters(*start, b.get());
  a->SetShapes({{cup, plate, floor}});
  b->SetShapes({{plate, floor, cup, plate}});
  const torch::Tensor poses = torch::randn({2, kEntries, 12}), time = torch::tensor({10, 700});
  // In a: cup, plate, floor, empty (3), mask (4). In b the same assets are 2, 0 or 3, 1, 4, 5.
  const torch::Tensor classes = torch::tensor({{0, 1, 2, 3, 4}, {1, 1, 4, 0, 3}});
  const torch::Tensor renamed = torch::tensor({{2, 0, 1, 4, 5}, {3, 0, 5, 2, 4}});
  const Denoised of_a = a->Predict({poses, classes, time}),
                 of_b = b->Predict({poses, renamed, time});
  EXPECT_LT((of_a.pose_noise - of_b.pose_noise).abs().max().item<double>(), 1e-5);
  const torch::Tensor taken = of_b.classes.index_select(-1, torch::tensor({2, 0, 1, 4}));
  EXPECT_LT((of_a.classes - taken).abs().max().item<double>(), 1e-5);
  const torch::Tensor twins = of_b.classes.select(-1, 0) - of_b.classes.select(-1, 3);
  EXPECT_LT(twins.abs().max().item<double>(), 1e-5);
  // Different shapes have different logits.
  EXPECT_GT((of_a.classes.select(-1, 0) - of_a.classes.select(-1, 1)).abs().min().item<double>(),
            1e-4);
}

INSTANTIATE_TEST_SUITE_P(Denoisers, ClassShapesOf,
                         ::testing::Values(DenoiserKind::kFlux, DenoiserKind::kTransformer));

TEST(ClassShapes, KeepsWhatItWasGiven) {
  const auto denoiser = MakeDenoiser(ClassShapesSmall(DenoiserKind::kFlux), 3);
  const AssetShapes shapes = {{BoxShape(0.1, 0.2, 0.3), BoxShape(1, 1, 1)}};
  denoiser->SetShapes(shapes);
  const AssetShapes kept = denoiser->Shapes();
  for (size_t i = 0; i < 2; ++i) {
    for (size_t k = 0; k < kPoints; ++k) {
      EXPECT_LT((kept.surfaces[i][k] - shapes.surfaces[i][k]).norm(), 1e-6);
    }
  }
}

TEST(ClassShapes, RefusesOtherNumbersAndModelsWithATable) {
  const auto denoiser = MakeDenoiser(ClassShapesSmall(DenoiserKind::kFlux), 3);
  EXPECT_THROW(denoiser->SetShapes({{BoxShape(1, 1, 1)}}), core::Error);
  EXPECT_THROW(denoiser->SetShapes({{BoxShape(1, 1, 1), {{0, 0, 0}}}}), core::Error);
  SceneModelOptions table = ClassShapesSmall(DenoiserKind::kFlux);
  table.shape_points = 0;
  EXPECT_THROW(MakeDenoiser(table, 3)->Shapes(), core::Error);
  EXPECT_THROW(MakeDenoiser(ClassShapesSmall(DenoiserKind::kUnet), 3), core::Error);
  SceneModelOptions numbers = ClassShapesSmall(DenoiserKind::kFlux);
  numbers.continuous = true;
  EXPECT_THROW(MakeDenoiser(numbers, 3), core::Error);
}

}  // namespace
}  // namespace simwright::scene
