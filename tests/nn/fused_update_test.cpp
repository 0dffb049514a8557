// Updates by kernels over all parameters against those parameter by parameter. Debian's libtorch
// has no such kernels: these tests run with PyTorch's own (run_with_libtorch2.py).
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "nn/trainer.h"
#include "nn/unet.h"

namespace simwright::nn {
namespace {

UNet NetworkOfSeed(std::uint64_t seed) {
  torch::manual_seed(seed);
  UNetOptions options;
  options.channels = {16, 24};
  options.attention_from = 1;
  return UNet(options);
}

torch::Tensor ShiftLoss(UNet network, int step) {
  torch::manual_seed(1000 + step);
  const torch::Tensor x = torch::randn({2, 4, 8, 8});
  return torch::mse_loss(network(x), x.roll(1, 1));
}

double LargestOff(const torch::nn::Module& a, const torch::nn::Module& b) {
  const auto first = a.parameters(), second = b.parameters();
  double largest = 0.0;
  for (size_t i = 0; i < first.size(); ++i) {
    largest = std::max(largest, (first[i] - second[i]).abs().max().item<double>());
  }
  return largest;
}

TrainerOptions Kernels(UpdateKernels kernels) {
  TrainerOptions options;
  options.steps = 40;
  options.largest_norm = 0.5;  // clips most steps
  options.kernels = kernels;
  return options;
}

TEST(FusedUpdate, IsRefusedWhereLibtorchHasNone) {
  UNet network = NetworkOfSeed(1);
  const core::TemporaryFolder folder;
  const Trainer automatic(network.get(), Kernels(UpdateKernels::kAutomatic), folder.path() / "a");
  EXPECT_FALSE(automatic.IsFused());  // the network is on the CPU
  if (HasFusedUpdate()) {
    EXPECT_TRUE(Trainer(network.get(), Kernels(UpdateKernels::kFused), folder.path()).IsFused());
  } else {
    EXPECT_THROW(Trainer(network.get(), Kernels(UpdateKernels::kFused), folder.path()),
                 core::Error);
  }
}

TEST(FusedUpdate, GoesWhereSeparateOnesGo) {
  if (!HasFusedUpdate()) GTEST_SKIP() << "this libtorch has no fused kernels";
  const core::TemporaryFolder folder;
  UNet one = NetworkOfSeed(1), all = NetworkOfSeed(1);
  Trainer separate(one.get(), Kernels(UpdateKernels::kSeparate), folder.path() / "separate");
  Trainer fused(all.get(), Kernels(UpdateKernels::kFused), folder.path() / "fused");
  for (int step = 0; step < 5; ++step) {
    separate.Step(step, ShiftLoss(one, step));
    fused.Step(step, ShiftLoss(all, step));
    EXPECT_LT(LargestOff(*one, *all), 1e-6) << step;
  }
  EXPECT_GT(LargestOff(*one, *NetworkOfSeed(1)), 1e-4);
  UNet average_one = NetworkOfSeed(2), average_all = NetworkOfSeed(3);
  separate.CopyAverageTo(average_one.get());
  fused.CopyAverageTo(average_all.get());
  EXPECT_LT(LargestOff(*average_one, *average_all), 1e-6);
  EXPECT_GT(LargestOff(*average_one, *one), 1e-5);
}

// The gradients of a linear layer's shares are transposed views.
TEST(FusedUpdate, TakesSharesOfABatch) {
  if (!HasFusedUpdate()) GTEST_SKIP() << "this libtorch has no fused kernels";
  const core::TemporaryFolder folder;
  const auto trained = [&](UpdateKernels kernels) {
    torch::manual_seed(7);
    torch::nn::Linear line(5, 3);
    Trainer trainer(line.get(), Kernels(kernels), folder.path() / "state");
    for (int step = 0; step < 5; ++step) {
      const torch::Tensor x = torch::randn({8, 5});
      const double sum = trainer.Step(step, 2, [&](int i) {
        const torch::Tensor part = x.narrow(0, 4 * i, 4);
        return (line(part) - part.narrow(1, 1, 3)).square().mean();
      });
      EXPECT_GT(sum, 0.1);
    }
    return line->weight.detach().clone();
  };
  const torch::Tensor separate = trained(UpdateKernels::kSeparate);
  EXPECT_LT((separate - trained(UpdateKernels::kFused)).abs().max().item<double>(), 1e-6);
}

TEST(FusedUpdate, LeavesLossesThatAreNotFiniteOut) {
  const core::TemporaryFolder folder;
  for (const UpdateKernels kernels : {UpdateKernels::kSeparate, UpdateKernels::kFused}) {
    if (kernels == UpdateKernels::kFused && !HasFusedUpdate()) continue;
    UNet network = NetworkOfSeed(1), without = NetworkOfSeed(1);
    Trainer trainer(network.get(), Kernels(kernels), folder.path() / "state");
    Trainer other(without.get(), Kernels(kernels), folder.path() / "other");
    trainer.Step(0, ShiftLoss(network, 0));
    other.Step(0, ShiftLoss(without, 0));
    EXPECT_EQ(trainer.SkippedInARow(), 0);
    trainer.Step(1, ShiftLoss(network, 1) * NAN);
    trainer.Step(1, ShiftLoss(network, 1) / 0.0);
    EXPECT_EQ(trainer.SkippedInARow(), 2);
    EXPECT_EQ(LargestOff(*network, *without), 0.0);
    trainer.Step(1, ShiftLoss(network, 1));
    other.Step(1, ShiftLoss(without, 1));
    EXPECT_EQ(trainer.SkippedInARow(), 0);
    EXPECT_EQ(LargestOff(*network, *without), 0.0);
    UNet average = NetworkOfSeed(2), other_average = NetworkOfSeed(3);
    trainer.CopyAverageTo(average.get());
    other.CopyAverageTo(other_average.get());
    EXPECT_EQ(LargestOff(*average, *other_average), 0.0);
    // The share of an average is counted in steps taken: a resumed training knows it too.
    const double sum = trainer.Step(2, 1, [&](int) { return ShiftLoss(network, 2) * NAN; });
    EXPECT_TRUE(std::isnan(sum));
    EXPECT_EQ(trainer.SkippedInARow(), 1);
  }
}

TEST(FusedUpdate, ResumesFromTheStateOfTheOther) {
  if (!HasFusedUpdate()) GTEST_SKIP() << "this libtorch has no fused kernels";
  const core::TemporaryFolder folder;
  for (const bool fused_first : {false, true}) {
    const auto state = folder.path() / "state";
    TrainerOptions before = Kernels(fused_first ? UpdateKernels::kFused : UpdateKernels::kSeparate);
    TrainerOptions after = Kernels(fused_first ? UpdateKernels::kSeparate : UpdateKernels::kFused);
    UNet whole = NetworkOfSeed(1), rest = NetworkOfSeed(5);
    Trainer through(whole.get(), before, state);
    for (int step = 0; step < 3; ++step) through.Step(step, ShiftLoss(whole, step));
    through.SaveState(3);
    after.resume = true;
    Trainer second(rest.get(), after, state);
    ASSERT_EQ(second.first_step(), 3);
    EXPECT_EQ(LargestOff(*whole, *rest), 0.0);
    for (int step = 3; step < 6; ++step) {
      through.Step(step, ShiftLoss(whole, step));
      second.Step(step, ShiftLoss(rest, step));
    }
    EXPECT_LT(LargestOff(*whole, *rest), 1e-6);
    UNet average_whole = NetworkOfSeed(2), average_rest = NetworkOfSeed(3);
    through.CopyAverageTo(average_whole.get());
    second.CopyAverageTo(average_rest.get());
    EXPECT_LT(LargestOff(*average_whole, *average_rest), 1e-6);
    UNetOptions wide;
    wide.channels = {16, 32};
    UNet other(wide);
    EXPECT_THROW(Trainer(other.get(), after, state), core::Error);
  }
}

}  // namespace
}  // namespace simwright::nn
