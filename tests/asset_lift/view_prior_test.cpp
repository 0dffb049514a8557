// View priors from TorchScript, and score distillation through them.
#include <gtest/gtest.h>

#include <cmath>

#include "asset_lift/priors/score_distillation.h"
#include "asset_lift/priors/scripted_view_prior.h"
#include "asset_lift/priors/view_prior.h"
#include "core/error.h"
#include "core/files.h"
#include "nn/torch_script.h"

namespace simwright::asset_lift {
namespace {

// A module with the given methods, saved.
std::filesystem::path Save(const core::TemporaryFolder& folder, const std::string& name,
                           const std::string& methods, int side) {
  torch::jit::Module module(name);
  module.register_attribute("side", c10::IntType::get(), side);
  module.define(methods);
  const std::filesystem::path path = folder.path() / (name + ".pt");
  module.save(path.string());
  return path;
}

ReferenceView Reference() {
  ReferenceView view;
  view.frame.camera = core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, 0.3, -M_PI / 2, 0.6, 64, 64);
  view.frame.center_x = view.frame.center_y = 32;
  view.frame.half = 24;
  view.photo = core::Image(64, 64, 3, 120);
  view.alpha = core::Image(64, 64, 1, 255);
  return view;
}

TEST(RelativeCamera, CountsFromTheReferenceRoundTheVertical) {
  const core::Camera from = core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, 0.3, -3.0, 0.6, 8, 8);
  const core::Camera to = core::OrbitCamera(Eigen::Vector3d::Zero(), 1.5, 0.7, 3.0, 0.6, 8, 8);
  const RelativeCamera relative = RelativeTo(from, to);
  EXPECT_NEAR(relative.elevation, 0.4, 1e-12);
  EXPECT_NEAR(relative.azimuth, 6.0 - 2 * M_PI, 1e-12);  // the shorter arc
  EXPECT_NEAR(relative.distance, 0.5, 1e-12);
}

// A perfect model of an image of one grey, g: its noise is (x_t - a_t g) / s_t, with the a_t of the
// scaled-linear schedule. Distillation must lead any image there.
TEST(ScoreDistillation, LeadsToThePictureThatTheModelKnows) {
  const core::TemporaryFolder folder;
  const std::filesystem::path path = Save(folder, "grey", R"(
def forward(self, image, camera, noisy, t):
    root = torch.linspace(0.02915475947, 0.10954451150, 1000).double()
    kept = torch.cumprod(1.0 - root * root, 0)[t].float().reshape(-1, 1, 1, 1)
    grey = 0.25
    return (noisy - torch.sqrt(kept) * grey) / torch.sqrt(1.0 - kept)
)",
                                          16);
  const std::shared_ptr<ViewPrior> prior = LoadScriptedViewPrior(path);
  EXPECT_EQ(prior->side(), 16);
  const ReferenceView view = Reference();
  ScoreDistillation distillation(prior, view.frame, view.photo, view.alpha);
  core::Rng rng(3);
  ObjectImage picture{core::FloatImage(32, 32, 3, 0.1f), core::FloatImage(32, 32, 1, 1.0f)};
  for (int step = 0; step < 150; ++step) {
    ObjectImage gradient;
    const core::Camera camera = distillation.NextCamera(step / 150.0, &rng);
    EXPECT_NEAR(camera.position().norm(), 1.0, 1e-9);
    distillation.Evaluate(camera, picture, step / 150.0, &rng, &gradient);
    for (size_t i = 0; i < picture.color.values.size(); ++i) {
      picture.color.values[i] -= 0.5f * gradient.color.values[i];
    }
  }
  // 0.25 in [-1, 1] is 0.625 in [0, 1], over white with opacity 1.
  for (const float value : picture.color.values) EXPECT_NEAR(value, 0.625f, 0.02f);
}

TEST(ScriptedViewPrior, HandsOnTheCameraAsZeroOneToThreeCountsIt) {
  const core::TemporaryFolder folder;
  const std::shared_ptr<ViewPrior> prior = LoadScriptedViewPrior(Save(folder, "camera", R"(
def forward(self, image, camera, noisy, t):
    return noisy * 0.0 + camera.reshape(-1, 1, 1, 4).repeat(1, 3, 8, 2)
)",
                                                                      8));
  prior->SetReference(Reference());
  const core::Camera above =
      core::OrbitCamera(Eigen::Vector3d::Zero(), 1.0, 0.8, -M_PI / 2 + 0.4, 0.6, 8, 8);
  const torch::Tensor told = prior->PredictNoise(torch::zeros({1, 3, 8, 8}),
                                                 torch::zeros({1}, torch::kLong), {above}, true);
  EXPECT_NEAR(told[0][0][0][0].item<double>(), -0.5, 1e-6);  // 0.5 nearer to the zenith
  EXPECT_NEAR(told[0][0][0][1].item<double>(), std::sin(-0.4), 1e-6);
  EXPECT_NEAR(told[0][0][0][2].item<double>(), std::cos(0.4), 1e-6);
  EXPECT_EQ(told[0][0][0][3].item<double>(), 0.0);
}

// The message names the file and what was expected.
void ExpectRefused(const std::filesystem::path& path, const std::string& part) {
  try {
    LoadScriptedViewPrior(path);
    FAIL() << path << " was taken";
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(ScriptedViewPrior, RefusesWhatIsNoneAndSaysWhatWasExpected) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "text.pt", "not a module");
  ExpectRefused(folder.path() / "text.pt", "not a TorchScript");
  ExpectRefused(Save(folder, "two", "def forward(self, a, b):\n    return a\n", 8),
                "expected forward(image");
  ExpectRefused(Save(folder, "shape", R"(
def forward(self, image, camera, noisy, t):
    return noisy[:, :1]
)",
                     8),
                "returns noise of shape [1, 1, 8, 8] for [1, 3, 8, 8]");
  ExpectRefused(Save(folder, "kind", R"(
def forward(self, image, camera, noisy, t):
    return 3
)",
                     8),
                "expected a tensor");
}

TEST(ScoreDistillationOptions, SaysWhatIsWrong) {
  ScoreDistillationOptions options;
  std::string error;
  EXPECT_TRUE(options.IsValid(&error));
  options.t_min_first = 0.9;
  EXPECT_FALSE(options.IsValid(&error));
  EXPECT_NE(error.find("t_min"), std::string::npos);
}

}  // namespace
}  // namespace simwright::asset_lift
