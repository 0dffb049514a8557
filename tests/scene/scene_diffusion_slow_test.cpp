// The three denoisers, their training and sampling, against a denoiser that knows the data: for few
// scenes the optimal prediction can be summed over all of them and all their orders.
#include "scene/model/scene_diffusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "nn/mixed_precision.h"
#include "scene/model/token_heads.h"

namespace simwright::scene {
namespace {

constexpr int kSceneDiffusionClasses = 4;  // the last is the empty one

SceneModelOptions SceneDiffusionSmall(DenoiserKind kind, bool continuous) {
  SceneModelOptions options;
  options.kind = kind;
  options.continuous = continuous;
  options.width = 32;
  options.heads = 4;
  options.double_blocks = 1;
  options.single_blocks = 1;
  return options;
}

// Returns a denoiser as after some training: no layer is zero any more.
std::shared_ptr<Denoiser> Stirred(const SceneModelOptions& options) {
  torch::manual_seed(5);
  std::shared_ptr<Denoiser> denoiser = MakeDenoiser(options, kSceneDiffusionClasses);
  const torch::NoGradGuard no_gradient;
  for (torch::Tensor& one : denoiser->parameters()) one.add_(0.1 * torch::randn_like(one));
  return denoiser;
}

TEST(Denoiser, AnotherOrderOfTheObjectsIsTheSamePredictionInThatOrder) {
  torch::manual_seed(1);
  for (const DenoiserKind kind :
       {DenoiserKind::kFlux, DenoiserKind::kTransformer, DenoiserKind::kUnet}) {
    for (const bool continuous : {false, true}) {
      const std::shared_ptr<Denoiser> denoiser = Stirred(SceneDiffusionSmall(kind, continuous));
      const torch::NoGradGuard no_gradient;
      NoisyScenes scenes{torch::randn({3, 7, 12}),
                         continuous
                             ? torch::randn({3, 7, kSceneDiffusionClasses})
                             : torch::randint(0, kSceneDiffusionClasses + 1, {3, 7}, torch::kLong),
                         torch::tensor({3, 500, 999}, torch::kLong)};
      const Denoised before = denoiser->Predict(scenes);
      const torch::Tensor order = torch::randperm(7, torch::kLong);
      scenes.poses = scenes.poses.index_select(1, order);
      scenes.classes = scenes.classes.index_select(1, order);
      const Denoised after = denoiser->Predict(scenes);
      const auto off = [&](const torch::Tensor& a, const torch::Tensor& b) {
        return (a.index_select(1, order) - b).abs().max().item<double>();
      };
      EXPECT_LT(off(before.pose_noise, after.pose_noise), 1e-5) << NameOf(kind);
      EXPECT_LT(off(before.classes, after.classes), 1e-5) << NameOf(kind);
      // The prediction depends on time, on its own token and on the others.
      const auto differs = [&](const NoisyScenes& other) {
        return (denoiser->Predict(other).pose_noise - after.pose_noise)
                   .abs()
                   .select(1, 0)
                   .max()
                   .item<double>() > 1e-4;
      };
      NoisyScenes later = scenes, moved = scenes, beside = scenes;
      later.time = later.time + 1 - 2 * later.time.gt(990).to(torch::kLong);
      moved.poses = scenes.poses.clone();
      moved.poses.select(1, 0).add_(0.5);
      beside.poses = scenes.poses.clone();
      beside.poses.select(1, 3).add_(0.5);
      EXPECT_TRUE(differs(later)) << NameOf(kind);
      EXPECT_TRUE(differs(moved)) << NameOf(kind);
      EXPECT_TRUE(differs(beside)) << NameOf(kind);
    }
  }
}

// e' + g (x - a x_0') / s with each of its predictions right or wrong.
// Threads share a batch: their predictions and losses equal those of the whole batch.
TEST(Denoiser, SharesOfABatchAreTheWhole) {
  for (const DenoiserKind kind :
       {DenoiserKind::kFlux, DenoiserKind::kTransformer, DenoiserKind::kUnet}) {
    for (const bool continuous : {false, true}) {
      const SceneModelOptions options = SceneDiffusionSmall(kind, continuous);
      const std::shared_ptr<Denoiser> denoiser = Stirred(options);
      const SceneDiffusion diffusion(options, kSceneDiffusionClasses);
      const torch::NoGradGuard no_gradient;
      const CleanScenes scenes{torch::rand({7, 5, 12}) * 2.0 - 1.0,
                               torch::randint(0, kSceneDiffusionClasses, {7, 5}, torch::kLong)};
      const DenoisingBatch batch = diffusion.AddNoise(scenes, at::detail::createCPUGenerator(3));
      const Denoised whole = denoiser->Predict(batch.noisy);
      core::SetThreadCount(3);
      const Denoised shared = denoiser->PredictParallel(batch.noisy);
      core::SetThreadCount(0);
      const auto off = [](const torch::Tensor& a, const torch::Tensor& b) {
        return (a - b).abs().max().item<double>();
      };
      EXPECT_LT(off(whole.pose_noise, shared.pose_noise), 1e-5) << NameOf(kind);
      EXPECT_LT(off(whole.classes, shared.classes), 1e-5) << NameOf(kind);
      const double loss = diffusion.Loss(denoiser.get(), batch).total.item<double>();
      const double first = diffusion.Loss(denoiser.get(), batch.Part(0, 3)).total.item<double>();
      const double last = diffusion.Loss(denoiser.get(), batch.Part(3, 4)).total.item<double>();
      EXPECT_NEAR((3.0 * first + 4.0 * last) / 7.0, loss, 1e-5 * loss) << NameOf(kind);
    }
  }
}

TEST(PoseBlend, IsTheNoiseByEitherWay) {
  torch::manual_seed(2);
  SceneModelOptions options;
  const PoseBlend blend(options);
  ASSERT_EQ(blend.Width(), 36);
  const torch::Tensor clean = 2.0 * torch::rand({4, 5, 12}) - 1.0, noise = torch::randn({4, 5, 12});
  const torch::Tensor time = torch::tensor({0, 10, 300, 999}, torch::kLong);
  const NoisyScenes scenes{PoseSchedule(1000).AddNoise(clean, noise, time), torch::Tensor(), time};
  const torch::Tensor shut = torch::full_like(clean, -1e4), open = torch::full_like(clean, 1e4);
  const torch::Tensor wrong = torch::randn_like(clean), none = torch::zeros_like(clean);
  const auto off = [&](const torch::Tensor& e, const torch::Tensor& x0, const torch::Tensor& g) {
    return (blend.Noise(torch::cat({e, x0, g}, -1), scenes) - noise).abs().max().item<double>();
  };
  EXPECT_LT(off(noise, wrong, shut), 1e-6);
  EXPECT_LT(off(none, clean, open), 1e-4);  // a hundredth of single precision
  EXPECT_GT(off(none, wrong, open), 1.0);
  EXPECT_GT(off(wrong, clean, shut), 0.1);
  // A clean pose that is off by d is a noise off by a d / s: 0.01 at the first step is about 1.
  const double first = PoseSchedule(1000).SignalAt(0) / PoseSchedule(1000).NoiseAt(0);
  const torch::Tensor guess = blend.Noise(torch::cat({none, clean + 0.01, open}, -1), scenes);
  EXPECT_NEAR((guess - noise)[0].mean().item<double>(), -0.01 * first, 1e-3);
  options.blends_clean_poses = false;
  EXPECT_EQ(PoseBlend(options).Width(), 12);
  EXPECT_TRUE(torch::equal(PoseBlend(options).Noise(wrong, scenes), wrong));
}

TEST(Denoiser, BaselinesAreAsLargeWithinATenth) {
  for (const char* const size : {"tiny", "base"}) {
    const SceneModelOptions ours = SceneModelOptions::OfSize(size);
    const auto count = [](const SceneModelOptions& options) {
      return static_cast<double>(ParameterCount(*MakeDenoiser(options, 9)));
    };
    const double wanted = count(ours);
    EXPECT_NEAR(count(ours.AsMiDiffusion()) / wanted, 1.0, 0.1) << size;
    EXPECT_NEAR(count(ours.AsDiffuScene()) / wanted, 1.0, 0.1) << size;
  }
  EXPECT_THROW(SceneModelOptions::OfSize("huge"), core::Error);
}

// Returns scenes of three objects: two of a class by the scene's number, one empty or of class 2.
CleanScenes FewScenes(int count) {
  torch::manual_seed(11);
  CleanScenes scenes{torch::rand({count, 3, 12}) * 2.0 - 1.0,
                     torch::zeros({count, 3}, torch::kLong)};
  for (int i = 0; i < count; ++i) {
    scenes.classes[i][1] = i % 2;
    scenes.classes[i][2] = 2 + i % 2;
  }
  return scenes;
}

// The optimal predictor for scenes sampled from `data`, with tokens in any order.
class BestDenoiser : public Denoiser {
 public:
  BestDenoiser(const CleanScenes& data, int steps)
      : poses_(nn::DiffusionSchedule::Linear(steps, 1e-4, 0.02)),
        classes_(steps, kSceneDiffusionClasses) {
    std::vector<torch::Tensor> poses, classes;
    std::vector<std::int64_t> order(static_cast<size_t>(data.poses.size(1)));
    std::iota(order.begin(), order.end(), 0);
    do {
      const torch::Tensor index = torch::tensor(order, torch::kLong);
      poses.push_back(data.poses.index_select(1, index));
      classes.push_back(data.classes.index_select(1, index));
    } while (std::next_permutation(order.begin(), order.end()));
    data_ = {torch::cat(poses), torch::cat(classes)};
  }

  Denoised Predict(const NoisyScenes& noisy) override {
    const std::int64_t batch = noisy.poses.size(0), m = data_.poses.size(0);
    const torch::Tensor signal = poses_.Signal(noisy.time, 2), spread = poses_.Noise(noisy.time, 2);
    const torch::Tensor x = noisy.poses.flatten(1), data = data_.poses.flatten(1);
    torch::Tensor log_weight = torch::zeros({batch, m});
    for (std::int64_t i = 0; i < m; ++i) {
      const torch::Tensor off = (x - signal * data[i]).square().sum(1) / spread.squeeze(1).square();
      log_weight.select(1, i).copy_(-0.5 * off + ClassEvidence(noisy, data_.classes[i]));
    }
    const torch::Tensor weight = torch::softmax(log_weight, 1);
    const torch::Tensor clean = torch::matmul(weight, data);
    const torch::Tensor one_hot =
        torch::one_hot(data_.classes, kSceneDiffusionClasses).to(torch::kFloat).flatten(1);
    const torch::Tensor share = torch::matmul(weight, one_hot)
                                    .reshape({batch, noisy.poses.size(1), kSceneDiffusionClasses});
    return {((x - signal * clean) / spread).reshape(noisy.poses.sizes()),
            torch::log(share.clamp_min(1e-12))};
  }

 private:
  // log q(classes_t | classes_0) over the tokens, (B).
  torch::Tensor ClassEvidence(const NoisyScenes& noisy, const torch::Tensor& clean) const {
    const torch::Tensor same = noisy.classes.eq(clean.unsqueeze(0)).to(torch::kFloat);
    const torch::Tensor masked = noisy.classes.eq(kSceneDiffusionClasses).to(torch::kFloat);
    std::vector<float> kept, replaced, mask;
    for (std::int64_t b = 0; b < noisy.time.size(0); ++b) {
      const int t = noisy.time[b].item<int>();
      kept.push_back(static_cast<float>(classes_.Kept(t)));
      replaced.push_back(static_cast<float>(classes_.Replaced(t)));
      mask.push_back(static_cast<float>(classes_.Masked(t)));
    }
    const auto column = [](const std::vector<float>& values) {
      return torch::tensor(values).unsqueeze(1);
    };
    const torch::Tensor q =
        masked * column(mask) + (1.0 - masked) * (same * column(kept) + column(replaced));
    return q.log().sum(1);
  }

  nn::DiffusionSchedule poses_;
  CategoryDiffusion classes_;
  CleanScenes data_;
};

// `count` scenes of the data, their tokens in any order.
CleanScenes Batch(const CleanScenes& data, std::int64_t count) {
  const torch::Tensor pick = torch::randint(0, data.poses.size(0), {count}, torch::kLong);
  const torch::Tensor order = torch::argsort(torch::rand({count, data.poses.size(1)}), 1, false);
  const torch::Tensor poses = data.poses.index_select(0, pick);
  return {poses.gather(1, order.unsqueeze(-1).expand_as(poses)),
          data.classes.index_select(0, pick).gather(1, order)};
}

// Products in bfloat16, of 8 bits, differ slightly; the gradient direction does not. libtorch 1.13
// has no such group norm of the U-Net for a CPU.
TEST(SceneDiffusion, MixedPrecisionHasTheSameGradient) {
  torch::manual_seed(1);
  const torch::Device cpu(torch::kCPU);
  for (const DenoiserKind kind : {DenoiserKind::kFlux, DenoiserKind::kTransformer}) {
    const SceneModelOptions options = SceneDiffusionSmall(kind, false);
    const std::shared_ptr<Denoiser> denoiser = Stirred(options);
    const SceneDiffusion diffusion(options, kSceneDiffusionClasses);
    const CleanScenes scenes{torch::rand({16, 6, 12}) * 2.0 - 1.0,
                             torch::randint(0, kSceneDiffusionClasses, {16, 6}, torch::kLong)};
    double losses[2];
    torch::Tensor gradients[2];
    for (const bool half : {false, true}) {
      const at::Generator generator = at::detail::createCPUGenerator(7);
      denoiser->zero_grad();
      const SceneLoss loss = [&] {
        const nn::MixedPrecision precision(cpu, half);
        return diffusion.Loss(denoiser.get(), diffusion.AddNoise(scenes, generator));
      }();
      loss.total.backward();
      losses[half] = loss.total.item<double>();
      std::vector<torch::Tensor> flat;
      for (const torch::Tensor& one : denoiser->parameters()) {
        ASSERT_EQ(one.scalar_type(), torch::kFloat);
        flat.push_back(one.grad().flatten().clone());
      }
      gradients[half] = torch::cat(flat);
    }
    EXPECT_NE(losses[0], losses[1]) << NameOf(kind);
    EXPECT_NEAR(losses[0], losses[1], 0.02 * losses[0]) << NameOf(kind);
    const double cosine = torch::cosine_similarity(gradients[0], gradients[1], 0).item<double>();
    EXPECT_GT(cosine, 0.99) << NameOf(kind);
    EXPECT_LT(cosine, 1.0 - 1e-9) << NameOf(kind);
  }
}

TEST(SceneDiffusion, OverfittingFewScenesGoesToWhereTheoryIs) {
  const CleanScenes data = FewScenes(8);
  SceneModelOptions options = SceneDiffusionSmall(DenoiserKind::kFlux, false);
  options.width = 48;
  options.double_blocks = 2;
  options.diffusion_steps = 100;
  options.class_weight = 30.0;
  const SceneDiffusion diffusion(options, kSceneDiffusionClasses);
  torch::manual_seed(2);
  const std::shared_ptr<Denoiser> denoiser = MakeDenoiser(options, kSceneDiffusionClasses);
  BestDenoiser best(data, options.diffusion_steps);
  const auto loss = [&](Denoiser* one) {
    const torch::NoGradGuard no_gradient;
    torch::manual_seed(99);
    const CleanScenes batch = Batch(data, 512);
    return diffusion.Loss(one, diffusion.AddNoise(batch, at::detail::createCPUGenerator(4)));
  };
  const SceneLoss ideal = loss(&best);
  const double start = loss(denoiser.get()).total.item<double>();
  torch::optim::AdamW optimizer(denoiser->parameters(), torch::optim::AdamWOptions(2e-3));
  const at::Generator generator = at::detail::createCPUGenerator(1);
  constexpr int kUpdates = 500;
  for (int i = 0; i < kUpdates; ++i) {
    static_cast<torch::optim::AdamWOptions&>(optimizer.param_groups()[0].options())
        .lr(2e-3 * (1.0 - static_cast<double>(i) / kUpdates));
    optimizer.zero_grad();
    diffusion.Loss(denoiser.get(), diffusion.AddNoise(Batch(data, 96), generator)).total.backward();
    torch::nn::utils::clip_grad_norm_(denoiser->parameters(), 1.0);
    optimizer.step();
  }
  const SceneLoss trained = loss(denoiser.get());
  const double floor = ideal.total.item<double>(), reached = trained.total.item<double>();
  // No loss is below the optimum; training closes most of the gap to it.
  EXPECT_GT(reached, floor);
  EXPECT_LT(reached - floor, 0.2 * (start - floor))
      << "from " << start << " to " << reached << ", best " << floor;
  EXPECT_NEAR(trained.divergence.item<double>(), ideal.divergence.item<double>(),
              3.0 * ideal.divergence.item<double>());
}

// Returns the index of the scene of `data` with these tokens, in any order; -1 for none.
int Found(const CleanScenes& data, const torch::Tensor& poses, const torch::Tensor& classes) {
  for (std::int64_t i = 0; i < data.poses.size(0); ++i) {
    int matched = 0;
    for (std::int64_t n = 0; n < poses.size(0); ++n) {
      for (std::int64_t k = 0; k < poses.size(0); ++k) {
        matched += (poses[n] - data.poses[i][k]).abs().max().item<double>() < 0.1 &&
                   classes[n].item<int>() == data.classes[i][k].item<int>();
      }
    }
    if (matched == poses.size(0)) return static_cast<int>(i);
  }
  return -1;
}

TEST(SceneDiffusion, WithTheBestDenoiserItDrawsTheDataEvenly) {
  const CleanScenes data = FewScenes(4);
  SceneModelOptions options;
  options.diffusion_steps = 200;
  const SceneDiffusion diffusion(options, kSceneDiffusionClasses);
  BestDenoiser best(data, options.diffusion_steps);
  const torch::NoGradGuard no_gradient;
  for (const auto& [steps, eta] : {std::pair(200, 1.0), std::pair(40, 1.0), std::pair(25, 0.0)}) {
    const at::Generator generator = at::detail::createCPUGenerator(8);
    constexpr int kScenes = 96;
    NoisyScenes scenes = diffusion.Noise(kScenes, 3, generator);
    std::vector<int> times = diffusion.Times(steps);
    EXPECT_EQ(times.front(), 199);
    times.push_back(-1);
    for (size_t i = 0; i + 1 < times.size(); ++i) {
      diffusion.Step(&best, times[i], times[i + 1], {eta, {}, {}}, generator, &scenes);
    }
    const CleanScenes drawn = diffusion.Clean(scenes);
    std::vector<int> counts(4, 0);
    for (std::int64_t b = 0; b < kScenes; ++b) {
      const int found = Found(data, drawn.poses[b], drawn.classes[b]);
      if (found >= 0) ++counts[static_cast<size_t>(found)];
    }
    const int all = std::accumulate(counts.begin(), counts.end(), 0);
    EXPECT_GE(all, kScenes * 9 / 10) << steps;
    for (const int count : counts) EXPECT_NEAR(count, kScenes / 4, 14) << steps;
  }
}

TEST(SceneDiffusion, TimesEndAtTheFirstStep) {
  SceneModelOptions options;
  const SceneDiffusion diffusion(options, kSceneDiffusionClasses);
  EXPECT_EQ(diffusion.Times(1000).size(), 1000u);
  EXPECT_EQ(diffusion.Times(1000).back(), 0);
  EXPECT_EQ(diffusion.Times(1), std::vector<int>{999});
  const std::vector<int> fast = diffusion.Times(50);
  EXPECT_EQ(fast.front(), 999);
  EXPECT_EQ(fast.back(), 19);
  EXPECT_TRUE(std::is_sorted(fast.rbegin(), fast.rend()));
  EXPECT_THROW(diffusion.Times(0), core::Error);
  EXPECT_THROW(diffusion.Times(1001), core::Error);
}

}  // namespace
}  // namespace simwright::scene
