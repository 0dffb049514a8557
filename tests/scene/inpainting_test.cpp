// Sampling with a mask: kept values, forbidden classes, and the noise of kept values.
#include "scene/model/inpainting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/files.h"
#include "scene/dataset/tokens.h"
#include "scene/model/scene_model.h"
#include "scene/model/weights_file.h"

namespace simwright::scene {
namespace {

Vocabulary InpaintingWords() {
  return {"test", 5, {"cup", "plate", "table"}, {false, false, true}};
}

PoseRange InpaintingRange() {
  std::array<double, kPoseWidth> low, high;
  low.fill(-1.0);
  high.fill(1.5);
  return PoseRange(low, high);
}

// Returns a model of random weights, read from a file.
SceneModel InpaintingModel(DenoiserKind kind, bool continuous) {
  SceneModelOptions options;
  options.kind = kind;
  options.continuous = continuous;
  options.width = 32;
  options.double_blocks = options.single_blocks = 1;
  options.diffusion_steps = 100;
  torch::manual_seed(5);
  const std::shared_ptr<Denoiser> denoiser = MakeDenoiser(options, InpaintingWords().ClassCount());
  {
    const torch::NoGradGuard no_gradient;
    for (torch::Tensor& one : denoiser->parameters()) one.add_(0.1 * torch::randn_like(one));
  }
  const core::TemporaryFolder folder;
  WriteWeights(*denoiser, {InpaintingWords(), options, InpaintingRange(), 1, 1, 1, 1},
               folder.path() / "model.pt");
  return SceneModel::Load(folder.path() / "model.pt");
}

// Returns `count` scenes of a table, a cup, a plate and padding.
std::vector<float> InpaintingTokens(int count) {
  const auto size = static_cast<size_t>(InpaintingWords().entries * InpaintingWords().TokenWidth());
  std::vector<float> tokens(size * static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    std::vector<SceneObject> objects(3);
    const char* const categories[] = {"table", "cup", "plate"};
    for (size_t j = 0; j < objects.size(); ++j) {
      objects[j].category = categories[j];
      objects[j].world_from_object =
          Eigen::Translation3d(0.1 * static_cast<double>(j), 0.01 * i, 0.5) *
          Eigen::AngleAxisd(0.3 * static_cast<double>(j), Eigen::Vector3d::UnitZ());
    }
    EncodeScene(objects, InpaintingWords(), &tokens[static_cast<size_t>(i) * size]);
  }
  return tokens;
}

SampleOptions TenSteps(Clamping clamping) {
  SampleOptions options;
  options.steps = 10;
  options.clamping = clamping;
  return options;
}

// Masks the poses of entries 1 and 2, and pose and class of entries 3 and 4.
InpaintingMask MixedMask(int count) {
  InpaintingMask mask;
  for (int i = 0; i < count; ++i) {
    for (const int flag : {0, 1, 1, 1, 1}) mask.pose.push_back(static_cast<char>(flag));
    for (const int flag : {0, 0, 0, 1, 1}) mask.classes.push_back(static_cast<char>(flag));
  }
  return mask;
}

TEST(Inpainting, KeptValuesAreTheInputsBitByBit) {
  const std::vector<float> tokens = InpaintingTokens(3);
  const InpaintingMask mask = MixedMask(3);
  const auto width = static_cast<size_t>(InpaintingWords().TokenWidth());
  core::Progress progress;
  for (const DenoiserKind kind :
       {DenoiserKind::kFlux, DenoiserKind::kTransformer, DenoiserKind::kUnet}) {
    for (const bool continuous : {false, true}) {
      const SceneModel model = InpaintingModel(kind, continuous);
      for (const Clamping clamping : {Clamping::kCleanValues, Clamping::kForwardNoised}) {
        const std::vector<float> made = model.Inpaint(tokens, mask, TenSteps(clamping), &progress);
        ASSERT_EQ(made.size(), tokens.size());
        int moved = 0;
        for (size_t i = 0; i < mask.pose.size(); ++i) {
          const size_t at = i * width;
          const std::vector<float> pose(&made[at], &made[at + kPoseWidth]),
              given(&tokens[at], &tokens[at + kPoseWidth]);
          if (!mask.pose[i]) {
            EXPECT_EQ(pose, given);
          }
          if (mask.pose[i] && i % 5 < 3) moved += pose != given;
          if (!mask.classes[i]) {
            EXPECT_EQ(std::vector<float>(&made[at + kPoseWidth], &made[at + width]),
                      std::vector<float>(&tokens[at + kPoseWidth], &tokens[at + width]));
          }
        }
        EXPECT_EQ(moved, 6) << NameOf(kind);
      }
    }
  }
}

TEST(Inpainting, AFullMaskSamplesAndAnEmptyOneReturnsTheInput) {
  const std::vector<float> tokens = InpaintingTokens(5);
  core::Progress progress;
  for (const bool continuous : {false, true}) {
    const SceneModel model = InpaintingModel(DenoiserKind::kFlux, continuous);
    for (const Clamping clamping : {Clamping::kCleanValues, Clamping::kForwardNoised}) {
      SampleOptions options = TenSteps(clamping);
      options.batch = 2;
      EXPECT_EQ(model.Inpaint(tokens, InpaintingMask::All(5, 5), options, &progress),
                model.Sample(5, options, &progress));
      InpaintingMask none = InpaintingMask::All(5, 5);
      std::fill(none.pose.begin(), none.pose.end(), 0);
      std::fill(none.classes.begin(), none.classes.end(), 0);
      EXPECT_EQ(model.Inpaint(tokens, none, options, &progress), tokens);
      // The kept values matter: another pose of the table gives other poses of the rest. Poses at
      // the ends of the range, where a network of random weights has many, may stay the same.
      std::vector<float> other = tokens;
      const auto width = static_cast<std::ptrdiff_t>(InpaintingWords().TokenWidth());
      const std::ptrdiff_t scene = InpaintingWords().entries * width;
      for (auto table = other.begin(); table != other.end(); table += scene) *table += 0.3f;
      const InpaintingMask mask = MixedMask(5);
      const std::vector<float> a = model.Inpaint(tokens, mask, options, &progress),
                               b = model.Inpaint(other, mask, options, &progress);
      int changed = 0;
      for (int i = 0; i < 5; ++i) {
        const std::ptrdiff_t cup = i * scene + width;
        changed += !std::equal(a.begin() + cup, a.begin() + cup + 2 * width, b.begin() + cup);
      }
      EXPECT_GE(changed, 4);
    }
  }
}

// Entries that must become objects do, and none becomes furniture.
TEST(Inpainting, ForbiddenClassesDoNotAppear) {
  constexpr int kScenes = 40;
  const std::vector<float> tokens = InpaintingTokens(kScenes);
  InpaintingMask mask = MixedMask(kScenes);
  const Vocabulary words = InpaintingWords();
  for (int i = 0; i < kScenes; ++i) {
    mask.Forbid(words, 5 * i + 3, words.EmptyClass());
    mask.Forbid(words, 5 * i + 3, words.ClassOf("table"));
    mask.Forbid(words, 5 * i + 4, words.ClassOf("table"));
  }
  // Class-only: the cup may become anything but empty, because it keeps its pose.
  for (size_t i = 1; i < mask.pose.size(); i += 5) {
    mask.pose[i] = 0;
    mask.classes[i] = 1;
  }
  core::Progress progress;
  const auto size = static_cast<size_t>(words.entries * words.TokenWidth());
  for (const bool continuous : {false, true}) {
    const SceneModel model = InpaintingModel(DenoiserKind::kFlux, continuous);
    for (const Clamping clamping : {Clamping::kCleanValues, Clamping::kForwardNoised}) {
      const std::vector<float> made = model.Inpaint(tokens, mask, TenSteps(clamping), &progress);
      int empty = 0;
      for (size_t i = 0; i < kScenes; ++i) {
        const float* const scene = &made[i * size];
        const auto is = [&](int entry, int one_class) {
          return scene[entry * words.TokenWidth() + kPoseWidth + one_class] == 1.0f;
        };
        EXPECT_FALSE(is(3, words.EmptyClass()) || is(3, words.ClassOf("table")));
        EXPECT_FALSE(is(4, words.ClassOf("table")));
        EXPECT_FALSE(is(1, words.EmptyClass()));
        EXPECT_EQ(scene[words.TokenWidth()],
                  tokens[i * size + static_cast<size_t>(words.TokenWidth())]);
        empty += is(4, words.EmptyClass());
      }
      EXPECT_LT(empty, kScenes);
    }
  }
}

TEST(Inpainting, MasksAndTokensThatDoNotFitAreRefused) {
  const SceneModel model = InpaintingModel(DenoiserKind::kFlux, false);
  core::Progress progress;
  const std::vector<float> tokens = InpaintingTokens(2);
  const auto refuses = [&](const std::vector<float>& given, const InpaintingMask& mask,
                           const std::string& reason) {
    try {
      model.Inpaint(given, mask, TenSteps(Clamping::kCleanValues), &progress);
      ADD_FAILURE() << reason;
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  refuses(tokens, InpaintingMask::All(1, 5), "sizes");
  std::vector<float> changed = tokens;
  changed[4] = std::numeric_limits<float>::quiet_NaN();
  refuses(changed, MixedMask(2), "scene 0, entry 0: a number is not finite");
  changed = tokens;
  changed[kPoseWidth] = 1.0f;  // a second class
  refuses(changed, MixedMask(2), "one-hot");
  InpaintingMask mask = MixedMask(2);
  mask.pose[9] = 0;
  refuses(tokens, mask, "scene 1, entry 4: it has no object");
  mask = MixedMask(2);
  for (int c = 0; c < 4; ++c) mask.Forbid(InpaintingWords(), 3, c);
  refuses(tokens, mask, "forbidden");
}

// Kept values are noised as q(x_t | x_0): mean a x_0, deviation s; a class stays with a_t + b_t and
// is masked with c_t.
TEST(Inpainting, ForwardNoiseHasTheStatisticsOfTheDiffusion) {
  constexpr int kScenes = 4000, kTime = 400;
  const SceneDiffusion diffusion({}, 4);
  const CleanScenes clean{torch::full({kScenes, 3, kPoseWidth}, 0.7),
                          torch::full({kScenes, 3}, 2, torch::kLong)};
  const NoisyScenes noisy = diffusion.NoisyAt(clean, kTime, at::detail::createCPUGenerator(3));
  const nn::DiffusionSchedule schedule = nn::DiffusionSchedule::Linear(1000, 1e-4, 0.02);
  const double deviation = schedule.NoiseAt(kTime), samples = kScenes * 3.0 * kPoseWidth;
  EXPECT_NEAR(noisy.poses.mean().item<double>(), 0.7 * schedule.SignalAt(kTime),
              5.0 * deviation / std::sqrt(samples));
  EXPECT_NEAR(noisy.poses.var().item<double>(), deviation * deviation,
              5.0 * deviation * deviation * std::sqrt(2.0 / samples));
  const CategoryDiffusion classes(1000, 4);
  const auto share = [&](int one_class) {
    return noisy.classes.eq(one_class).to(torch::kFloat).mean().item<double>();
  };
  const double error = 5.0 * std::sqrt(0.25 / (kScenes * 3.0));
  EXPECT_NEAR(share(2), classes.Kept(kTime) + classes.Replaced(kTime), error);
  EXPECT_NEAR(share(4), classes.Masked(kTime), error);
}

}  // namespace
}  // namespace simwright::scene
