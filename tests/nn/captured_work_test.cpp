// Work that is captured on a GPU, and runs each time elsewhere, sees the new values of its tensors.
#include "nn/captured_work.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/files.h"
#include "nn/trainer.h"

namespace simwright::nn {
namespace {

TEST(CapturedWork, RunsEveryTimeOnACpu) {
  EXPECT_FALSE(CapturedWork::IsAvailable(torch::kCPU));
  const torch::Tensor in = torch::zeros({3});
  torch::Tensor out;
  int runs = 0;
  CapturedWork work(torch::kCPU, [&] {
    out = in * 2.0;
    ++runs;
  });
  for (int i = 0; i < 6; ++i) {
    in.fill_(i);
    work.Run();
    EXPECT_TRUE(torch::equal(out, torch::full({3}, 2.0 * i)));
  }
  EXPECT_EQ(runs, 6);
  CapturedWork fails(torch::kCPU, [] { throw std::runtime_error("work"); });
  EXPECT_THROW(fails.Run(), std::runtime_error);
}

// Trains a line with captured updates on a GPU, and in the same way without.
TEST(CapturedWork, UpdatesOnAGpuLikeSeparateOnes) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "there is no GPU";
  const torch::Device gpu(torch::kCUDA, 0);
  if (!CapturedWork::IsAvailable(gpu)) GTEST_SKIP() << "built without the headers of CUDA";
  const core::TemporaryFolder folder;
  TrainerOptions options;
  options.steps = 20;
  const auto trained = [&](bool capture) {
    torch::manual_seed(4);
    torch::nn::Linear line(6, 2);
    line->to(gpu);
    Trainer trainer(line.get(), options, folder.path() / "state");
    torch::Tensor x = torch::zeros({16, 6}, gpu), loss;
    const auto update = [&] {
      loss = (line(x) - x.narrow(1, 0, 2)).square().mean();
      trainer.Update(loss);
    };
    CapturedWork work(gpu, update);
    for (int step = 0; step < options.steps; ++step) {
      torch::manual_seed(step);
      x.copy_(torch::randn({16, 6}));
      trainer.SetStep(step);
      if (capture) {
        work.Run();
      } else {
        update();
      }
    }
    return line->weight.detach().cpu();
  };
  const torch::Tensor captured = trained(true), separate = trained(false);
  EXPECT_LT((captured - separate).abs().max().item<double>(), 1e-6);
}

}  // namespace
}  // namespace simwright::nn
