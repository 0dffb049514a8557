// Noise and tables on a device: on the CPU they are those of a plain generator and a plain table.
#include "nn/noise.h"

#include <gtest/gtest.h>

#include "nn/device_table.h"
#include "nn/diffusion_schedule.h"

namespace simwright::nn {
namespace {

TEST(Noise, OfTheCpuIsThatOfItsGenerator) {
  for (const bool on_device : {false, true}) {
    const at::Generator ours = SeededGenerator(7, torch::kCPU, on_device);
    const at::Generator plain = at::detail::createCPUGenerator(7);
    EXPECT_TRUE(
        torch::equal(UniformNumbers({3, 50}, ours), torch::rand({3, 50}, plain, torch::kFloat)));
    EXPECT_TRUE(
        torch::equal(NormalNumbers({40, 9}, ours), torch::randn({40, 9}, plain, torch::kFloat)));
  }
}

TEST(Noise, LeavesTheDefaultGeneratorAlone) {
  torch::manual_seed(3);
  const torch::Tensor before = torch::rand({8});
  torch::manual_seed(3);
  NormalNumbers({100}, SeededGenerator(3, torch::kCPU, true));
  EXPECT_TRUE(torch::equal(before, torch::rand({8})));
}

TEST(Noise, OfAGpuStaysThere) {
  if (!torch::cuda::is_available()) GTEST_SKIP() << "there is no GPU";
  const torch::Device gpu(torch::kCUDA, 0);
  const torch::Tensor far = NormalNumbers({1000}, SeededGenerator(7, gpu, true));
  EXPECT_TRUE(far.is_cuda());
  EXPECT_TRUE(torch::equal(far, NormalNumbers({1000}, SeededGenerator(7, gpu, true))));
  EXPECT_FALSE(torch::equal(far, NormalNumbers({1000}, SeededGenerator(8, gpu, true))));
  EXPECT_LT(std::abs(far.mean().item<double>()), 0.15);
  const torch::Tensor near = NormalNumbers({1000}, SeededGenerator(7, gpu, false));
  EXPECT_TRUE(torch::equal(near, NormalNumbers({1000}, SeededGenerator(7, torch::kCPU, false))));
}

TEST(DeviceTable, IsCopiedToADeviceOnce) {
  const torch::Tensor values = torch::linspace(0.0, 1.0, 11, torch::kDouble);
  const DeviceTable table(values);
  EXPECT_EQ(table.size(), 11);
  EXPECT_EQ(table.At(3), values[3].item<double>());
  EXPECT_TRUE(torch::equal(table.On(torch::kCPU), values));
  // The meta device stands for one that the CPU's memory is copied to.
  const DeviceTable same = table;
  const torch::Tensor far = table.On(torch::kMeta);
  EXPECT_TRUE(far.is_meta());
  EXPECT_TRUE(far.is_same(table.On(torch::kMeta)));
  EXPECT_TRUE(far.is_same(same.On(torch::kMeta)));
}

TEST(DeviceTable, GivesASchedulesColumnsBitByBit) {
  constexpr int kSteps = 50;
  const DiffusionSchedule schedule = DiffusionSchedule::Linear(kSteps, 1e-4, 0.02);
  const torch::Tensor kept =
      torch::cumprod(1.0 - torch::linspace(1e-4, 0.02, kSteps, torch::kDouble), 0);
  const torch::Tensor t = torch::arange(kSteps, torch::kLong);
  EXPECT_TRUE(
      torch::equal(schedule.Signal(t, 3), torch::sqrt(kept).to(torch::kFloat).reshape({-1, 1, 1})));
  EXPECT_TRUE(torch::equal(schedule.Noise(t, 3),
                           torch::sqrt(1.0 - kept).to(torch::kFloat).reshape({-1, 1, 1})));
  EXPECT_EQ(schedule.SignalAt(7), torch::sqrt(kept)[7].item<double>());
}

}  // namespace
}  // namespace simwright::nn
