// A training on a GPU goes on from its saved state as if it had never stopped, there or on a CPU.
// Without a GPU these tests are skipped.
#include <gtest/gtest.h>

#include "core/files.h"
#include "nn/mixed_precision.h"
#include "nn/prefetcher.h"
#include "nn/trainer.h"
#include "nn/unet.h"

namespace simwright::nn {
namespace {

UNet NetworkOn(const torch::Device& device, std::uint64_t seed) {
  torch::manual_seed(seed);
  UNetOptions options;
  options.channels = {16, 24};
  options.attention_from = 1;
  UNet network(options);
  network->to(device);
  return network;
}

// Trains steps first .. last - 1 on batches that a thread makes ahead.
void TrainSteps(UNet network, Trainer* trainer, const torch::Device& device, int first, int last) {
  Prefetcher<torch::Tensor> batches(true, first, last, [&](int step) {
    return torch::randn({4, 4, 8, 8}, at::detail::createCPUGenerator(1000 + step), torch::kFloat)
        .to(device);
  });
  for (int step = first; step < last; ++step) {
    const torch::Tensor x = batches.Next();
    torch::Tensor loss;
    {
      const MixedPrecision half(device, false);
      loss = torch::mse_loss(network(x), x.roll(1, 1));
    }
    trainer->Step(step, loss);
  }
}

double LargestGap(UNet a, UNet b) {
  const auto first = a->parameters(), second = b->parameters();
  double largest = 0.0;
  for (size_t i = 0; i < first.size(); ++i) {
    largest = std::max(largest, (first[i].cpu() - second[i].cpu()).abs().max().item<double>());
  }
  return largest;
}

// Compares a training without a stop with one that is resumed on `device` from a state of the GPU.
void ExpectResumes(const torch::Device& device, UpdateKernels kernels) {
  const torch::Device gpu(torch::kCUDA, 0);
  const core::TemporaryFolder folder;
  TrainerOptions options;
  options.steps = 12;
  options.kernels = kernels;
  UNet whole = NetworkOn(gpu, 1);
  Trainer through(whole.get(), options, folder.path() / "whole");
  TrainSteps(whole, &through, gpu, 0, 5);
  through.SaveState(5);
  std::filesystem::copy_file(folder.path() / "whole", folder.path() / "state");
  TrainSteps(whole, &through, gpu, 5, 8);

  options.resume = true;
  options.kernels = UpdateKernels::kAutomatic;
  UNet rest = NetworkOn(device, 3);
  Trainer second(rest.get(), options, folder.path() / "state");
  ASSERT_EQ(second.first_step(), 5);
  TrainSteps(rest, &second, device, 5, 8);
  EXPECT_EQ(through.SkippedInARow(), 0);
  EXPECT_LT(LargestGap(whole, rest), 1e-4);
  EXPECT_GT(LargestGap(whole, NetworkOn(gpu, 1)), 1e-3);
  UNet average_whole = NetworkOn(gpu, 4), average_rest = NetworkOn(torch::kCPU, 5);
  through.CopyAverageTo(average_whole.get());
  second.CopyAverageTo(average_rest.get());
  EXPECT_LT(LargestGap(average_whole, average_rest), 1e-4);
}

TEST(ResumeOnCuda, GoesOnOnTheGpu) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "there is no GPU";
  ExpectResumes(torch::Device(torch::kCUDA, 0), UpdateKernels::kAutomatic);
  ExpectResumes(torch::Device(torch::kCUDA, 0), UpdateKernels::kSeparate);
}

TEST(ResumeOnCuda, GoesOnOnTheCpu) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "there is no GPU";
  ExpectResumes(torch::kCPU, UpdateKernels::kAutomatic);
}

// A process that has trained and saved on a GPU ends without a crash.
TEST(ResumeOnCuda, EndsWithExitCodeZero) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "there is no GPU";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ExpectResumes(torch::Device(torch::kCUDA, 0), UpdateKernels::kAutomatic);
        std::exit(::testing::Test::HasFailure() ? 1 : 0);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace simwright::nn
