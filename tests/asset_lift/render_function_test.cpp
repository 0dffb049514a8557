#include "asset_lift/priors/render_function.h"

#include <gtest/gtest.h>

#include "asset_lift/priors/shape_parts.h"
#include "core/error.h"

namespace simwright::asset_lift {
namespace {

torch::Tensor Tensor(const std::vector<Eigen::Vector3d>& rows) {
  return torch::from_blob(const_cast<Eigen::Vector3d*>(rows.data()),
                          {static_cast<std::int64_t>(rows.size()), 3}, torch::kDouble)
      .clone();
}

// Descent through libtorch's graph moves a displaced ball back to where its picture was taken.
TEST(RenderTensors, LeadGradientsOfPicturesToVerticesAndColours) {
  const core::TriangleMesh ball = SuperquadricPart({0.3, 0.3, 0.3}, 1, 1, 24);
  render::DifferentiableObject object;
  object.mesh = ball;
  object.vertex_colors.assign(ball.vertices.size(), Eigen::Vector3f(0.5f, 0.5f, 0.5f));
  render::DifferentiableRenderer renderer({object});
  const core::Camera camera =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 2.0, 0.2, 0.3, 0.6, 48, 48);
  const torch::Tensor truth = Tensor(ball.vertices);
  const torch::Tensor red = torch::zeros({truth.size(0), 3}) + torch::tensor({0.9f, 0.1f, 0.1f});
  const RenderedTensors target = RenderTensors(&renderer, truth, red, camera, 1);
  EXPECT_NEAR(target.mask.max().item<double>(), 1.0, 1e-6);
  EXPECT_NEAR(target.color[24][24][0].item<double>(), 0.9, 1e-4);
  EXPECT_NEAR(target.depth[24][24].item<double>(), 1.7, 0.02);

  const Eigen::Vector3d right = camera.world_from_camera.linear().col(0);
  torch::Tensor offset =
      torch::tensor({0.08 * right.x(), 0.08 * right.y(), 0.08 * right.z()}, torch::kDouble)
          .requires_grad_(true);
  torch::Tensor color = torch::full({3}, 0.5f).requires_grad_(true);
  torch::optim::Adam adam({offset, color}, torch::optim::AdamOptions(0.01));
  for (int step = 0; step < 80; ++step) {
    adam.zero_grad();
    const RenderedTensors drawn =
        RenderTensors(&renderer, truth + offset, color.unsqueeze(0).expand({truth.size(0), 3}),
                      camera, static_cast<std::uint64_t>(step));
    const torch::Tensor loss =
        torch::mse_loss(drawn.color, target.color) + torch::mse_loss(drawn.mask, target.mask);
    loss.backward();
    adam.step();
  }
  const auto along =
      offset.detach().dot(torch::tensor({right.x(), right.y(), right.z()}, torch::kDouble));
  EXPECT_LT(std::abs(along.item<double>()), 0.01);
  EXPECT_NEAR(color[0].item<double>(), 0.9, 0.05);
  EXPECT_NEAR(color[1].item<double>(), 0.1, 0.05);
}

TEST(RenderTensors, RefuseSizesThatDoNotFit) {
  render::DifferentiableObject object;
  object.mesh = BoxPart({1, 1, 1});
  render::DifferentiableRenderer renderer({object});
  EXPECT_THROW(RenderTensors(&renderer, torch::zeros({3, 3}), {}, core::Camera{}, 1), core::Error);
}

}  // namespace
}  // namespace simwright::asset_lift
