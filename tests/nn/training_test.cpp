// State written to disk is restored: weights, and everything from which a training resumes.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "nn/checkpoint.h"
#include "nn/trainer.h"
#include "nn/unet.h"

namespace simwright::nn {
namespace {

namespace fs = std::filesystem;

UNet SmallUNet(std::uint64_t seed) {
  torch::manual_seed(seed);
  UNetOptions options;
  options.channels = {16, 24};
  options.attention_from = 1;
  return UNet(options);
}

double Difference(const torch::nn::Module& a, const torch::nn::Module& b) {
  const auto first = a.parameters(), second = b.parameters();
  double largest = 0.0;
  for (size_t i = 0; i < first.size(); ++i) {
    largest = std::max(largest, (first[i] - second[i]).abs().max().item<double>());
  }
  return largest;
}

torch::Tensor LossOf(UNet network, int step) {
  torch::manual_seed(1000 + step);
  const torch::Tensor x = torch::randn({2, 4, 8, 8});
  return torch::mse_loss(network(x), x.roll(1, 1));
}

TEST(Checkpoint, KeepsWeightsToHalfPrecisionAndSaysItsKind) {
  const core::TemporaryFolder folder;
  UNet written = SmallUNet(1), read = SmallUNet(2);
  ASSERT_GT(Difference(*written, *read), 0.1);
  SaveCheckpoint(*written, {{"kind", "shape"}, {"step", "7"}}, folder.path() / "w.pt");
  EXPECT_EQ(LoadCheckpoint(folder.path() / "w.pt", "shape", read.get()).at("step"), "7");
  EXPECT_LT(Difference(*written, *read), 1e-3);
  EXPECT_THROW(LoadCheckpoint(folder.path() / "w.pt", "view", read.get()), core::Error);
  UNetOptions other;
  other.channels = {16, 32};
  UNet wider(other);
  EXPECT_THROW(LoadCheckpoint(folder.path() / "w.pt", "shape", wider.get()), core::Error);
  core::WriteFile(folder.path() / "bad.pt", "no weights");
  EXPECT_THROW(LoadCheckpoint(folder.path() / "bad.pt", "shape", read.get()), core::Error);
  EXPECT_THROW(LoadCheckpoint(folder.path() / "none.pt", "shape", read.get()), core::Error);
}

TEST(Checkpoint, KeepsLargeMatricesToEightBitsPerRow) {
  const core::TemporaryFolder folder;
  const fs::path half = folder.path() / "half.pt", bytes = folder.path() / "bytes.pt";
  UNetOptions options;
  options.channels = {32, 64};
  UNet written(options), read(options);
  {
    const torch::NoGradGuard no_grad;
    written->parameters()[0][0].zero_();  // a row without a scale
  }
  SaveCheckpoint(*written, {{"kind", "shape"}}, half);
  SaveCheckpoint(*written, {{"kind", "shape"}}, bytes, StoredPrecision::kEightBits);
  EXPECT_LT(fs::file_size(bytes), 0.6 * static_cast<double>(fs::file_size(half)));
  LoadCheckpoint(bytes, "shape", read.get());
  const std::vector<torch::Tensor> before = written->parameters(), after = read->parameters();
  bool rounded = false;
  for (size_t i = 0; i < before.size(); ++i) {
    const torch::Tensor rows = before[i].reshape({before[i].size(0), -1});
    const torch::Tensor off = (after[i].reshape(rows.sizes()) - rows).abs().amax(1);
    // Half a step; small tensors are in half precision, which is finer.
    const torch::Tensor step = rows.abs().amax(1) / 127.0;
    EXPECT_TRUE((off <= 0.501 * step + 1e-7).all().item<bool>()) << i;
    rounded = rounded || off.max().item<double>() > 1e-3 * rows.abs().max().item<double>();
  }
  EXPECT_TRUE(rounded);
}

TEST(Checkpoint, RefusesIntegersWithoutAScale) {
  const core::TemporaryFolder folder;
  UNetOptions options;
  options.channels = {32, 64};
  UNet network(options);
  const fs::path path = folder.path() / "w.pt";
  SaveCheckpoint(*network, {{"kind", "shape"}}, path, StoredPrecision::kEightBits);
  NamedTensors tensors = ReadTensors(path);
  const size_t all = tensors.size();
  std::erase_if(tensors, [](const auto& entry) { return entry.first.ends_with(".row_scale"); });
  ASSERT_LT(tensors.size(), all);
  WriteTensors(tensors, path);
  EXPECT_THROW(LoadCheckpoint(path, "shape", network.get()), core::Error);
}

TEST(Trainer, GoesOnAsIfItHadNeverStopped) {
  const core::TemporaryFolder folder;
  TrainerOptions options;
  options.steps = 12;
  UNet whole = SmallUNet(1);
  Trainer through(whole.get(), options, folder.path() / "whole");
  const double before = LossOf(whole, 0).item<double>();
  for (int step = 0; step < 12; ++step) through.Step(step, LossOf(whole, step));
  EXPECT_LT(LossOf(whole, 0).item<double>(), 0.98 * before);

  UNet half = SmallUNet(1);
  Trainer first(half.get(), options, folder.path() / "state");
  for (int step = 0; step < 5; ++step) first.Step(step, LossOf(half, step));
  first.SaveState(5);
  UNet rest = SmallUNet(3);
  options.resume = true;
  Trainer second(rest.get(), options, folder.path() / "state");
  ASSERT_EQ(second.first_step(), 5);
  for (int step = 5; step < 12; ++step) second.Step(step, LossOf(rest, step));
  EXPECT_LT(Difference(*whole, *rest), 1e-6);
  UNet average_whole = SmallUNet(4), average_rest = SmallUNet(5);
  through.CopyAverageTo(average_whole.get());
  second.CopyAverageTo(average_rest.get());
  EXPECT_LT(Difference(*average_whole, *average_rest), 1e-6);
  EXPECT_GT(Difference(*average_whole, *whole), 1e-5);  // it is an average, not the last

  core::WriteFile(folder.path() / "state", "damaged");
  EXPECT_THROW(Trainer(rest.get(), options, folder.path() / "state"), core::Error);
}

TEST(Trainer, SharesGoWhereTheWholeGoes) {
  const core::TemporaryFolder folder;
  TrainerOptions options;
  options.steps = 100;
  options.largest_norm = 0.01;  // of the sum, not of a share
  UNet whole = SmallUNet(1), shared = SmallUNet(1);
  Trainer one(whole.get(), options, folder.path() / "one");
  Trainer three(shared.get(), options, folder.path() / "three");
  for (int step = 0; step < 5; ++step) {
    torch::manual_seed(step);
    const torch::Tensor x = torch::randn({6, 4, 8, 8}), y = x.roll(1, 1);
    const torch::Tensor loss = torch::mse_loss(whole(x), y);
    one.Step(step, loss);
    const double sum = three.Step(step, 3, [&](int i) {
      return torch::mse_loss(shared(x.narrow(0, 2 * i, 2)), y.narrow(0, 2 * i, 2)) / 3.0;
    });
    EXPECT_NEAR(sum, loss.item<double>(), 1e-5 * sum);
  }
  EXPECT_LT(Difference(*whole, *shared), 2e-5);
  EXPECT_GT(Difference(*whole, *SmallUNet(1)), 1e-3);

  UNet before = SmallUNet(9), after = SmallUNet(9);
  Trainer skips(after.get(), options, folder.path() / "skips");
  const double bad =
      skips.Step(0, 2, [&](int i) { return after->parameters()[0].sum() * (i == 1 ? NAN : 1.0); });
  EXPECT_TRUE(std::isnan(bad));
  EXPECT_EQ(Difference(*before, *after), 0.0);
}

TEST(Trainer, RateWarmsUpAndFallsToATwentieth) {
  UNet network = SmallUNet(1);
  TrainerOptions options;
  options.steps = 1000;
  options.learning_rate = 1.0;
  const Trainer trainer(network.get(), options, "unused");
  EXPECT_LT(trainer.LearningRate(0), 0.05);
  EXPECT_NEAR(trainer.LearningRate(30), 1.0, 0.01);
  EXPECT_NEAR(trainer.LearningRate(500), 0.525, 1e-9);
  EXPECT_NEAR(trainer.LearningRate(1000), 0.05, 1e-9);
}

}  // namespace
}  // namespace simwright::nn
