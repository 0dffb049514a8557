// The operations of programs, against the standard library in double.
#include "reward/runtime/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace simwright::reward {
namespace {

struct Accuracy {
  ScalarOperation operation;
  double (*truth)(double);
  float low, high;
};

double SigmoidTruth(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

TEST(RewardKernels, AreWithinAMillionthOfTheTruth) {
  using enum ScalarOperation;
  const Accuracy all[] = {
      {kExponential, std::exp, -80.0f, 88.0f},   {kLogarithm, std::log, 1e-30f, 1e3f},
      {kSine, std::sin, -50.0f, 50.0f},          {kCosine, std::cos, -50.0f, 50.0f},
      {kArcSine, std::asin, -1.0f, 1.0f},        {kArcCosine, std::acos, -1.0f, 1.0f},
      {kArcTangent, std::atan, -100.0f, 100.0f}, {kHyperbolicTangent, std::tanh, -10.0f, 10.0f},
      {kSigmoid, SigmoidTruth, -40.0f, 40.0f}};
  constexpr int kCount = 200'003;
  std::vector<float> x(kCount), y(kCount);
  for (const Accuracy& one : all) {
    for (int i = 0; i < kCount; ++i) x[i] = one.low + (one.high - one.low) * i / (kCount - 1);
    const int operation = static_cast<int>(one.operation);
    Kernels().kernels[operation][0](y.data(), x.data(), nullptr, nullptr, kCount);
    double worst = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const double truth = one.truth(x[i]);
      // Near a zero of a sine the rounding of the argument dominates the error.
      const bool angle = one.operation == kSine || one.operation == kCosine;
      const double size = angle ? std::max(std::fabs(truth), 0.1) : std::fabs(truth);
      if (truth != 0.0) worst = std::max(worst, std::fabs(y[i] - truth) / size);
    }
    EXPECT_LE(worst, 1e-6) << "operation " << operation;
  }
}

TEST(RewardKernels, TreatSpecialNumbersAsTorchDoes) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto of = [](ScalarOperation operation, float a, float b = 0.0f) {
    return EvaluateScalar(operation, a, b, 0.0f);
  };
  using enum ScalarOperation;
  EXPECT_EQ(of(kExponential, infinity), infinity);
  EXPECT_EQ(of(kExponential, -infinity), 0.0f);
  EXPECT_EQ(of(kLogarithm, 0.0f), -infinity);
  EXPECT_EQ(of(kLogarithm, infinity), infinity);
  EXPECT_TRUE(std::isnan(of(kLogarithm, -1.0f)));
  for (const ScalarOperation operation :
       {kExponential, kLogarithm, kSine, kCosine, kArcSine, kArcCosine, kArcTangent,
        kHyperbolicTangent, kSigmoid, kSquareRoot}) {
    EXPECT_TRUE(std::isnan(of(operation, nan))) << static_cast<int>(operation);
  }
  EXPECT_TRUE(std::isnan(of(kMaximum, nan, 1.0f)) && std::isnan(of(kMaximum, 1.0f, nan)));
  EXPECT_TRUE(std::isnan(of(kMinimum, nan, 1.0f)) && std::isnan(of(kMinimum, 1.0f, nan)));
  EXPECT_EQ(of(kRound, 2.5f), 2.0f);
  EXPECT_EQ(of(kFloorRemainder, -1.0f, 3.0f), 2.0f);
  EXPECT_EQ(of(kTruncatedRemainder, -1.0f, 3.0f), -1.0f);
  EXPECT_EQ(of(kFloorDivide, -7.0f, 2.0f), -4.0f);
  EXPECT_EQ(of(kArcTangent2, 0.0f, 0.0f), 0.0f);
  EXPECT_FLOAT_EQ(of(kArcTangent2, 0.0f, -1.0f), 3.14159265f);
  EXPECT_FLOAT_EQ(of(kArcTangent2, -1.0f, 0.0f), -1.57079633f);
  EXPECT_FLOAT_EQ(of(kHyperbolicTangent, 100.0f), 1.0f);
  EXPECT_FLOAT_EQ(of(kSine, 1e6f), std::sin(1e6f));
}

TEST(RewardKernels, AllInstructionSetsGiveTheSameNumbers) {
  constexpr int kCount = 1003;
  std::vector<float> a(kCount), b(kCount), c(kCount), first(kCount), second(kCount);
  for (int i = 0; i < kCount; ++i) {
    a[i] = std::sin(0.37f * i) * (i % 7);
    b[i] = std::cos(0.53f * i) * (i % 5);
    c[i] = std::sin(1.1f * i);
  }
  for (int operation = 0; operation < kScalarOperations; ++operation) {
    for (int uniform = 0; uniform < 8; ++uniform) {
      const Kernel plain = PlainKernels().kernels[operation][uniform];
      if (plain == nullptr) continue;
      plain(first.data(), a.data(), b.data(), c.data(), kCount);
      Kernels().kernels[operation][uniform](second.data(), a.data(), b.data(), c.data(), kCount);
      int differing = 0;
      for (int i = 0; i < kCount; ++i) {
        const bool both_nan = std::isnan(first[i]) && std::isnan(second[i]);
        differing += !both_nan && std::memcmp(&first[i], &second[i], sizeof(float)) != 0;
      }
      EXPECT_EQ(differing, 0) << "operation " << operation;
    }
  }
}

}  // namespace
}  // namespace simwright::reward
