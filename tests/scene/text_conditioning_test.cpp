// Prompts in the three denoisers: what must change a prediction and what must not, guidance against
// its formula, and an external encoder.
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"
#include "core/parallel.h"
#include "nn/torch.h"
#include "nn/torch_script.h"
#include "scene/model/guidance.h"
#include "scene/model/prompt_encoder.h"
#include "scene/model/scene_diffusion.h"

namespace simwright::scene {
namespace {

constexpr int kTextClasses = 4;

const std::vector<std::string> kTextPrompts = {"A scene with two apples and a bowl.", "",
                                               "A scene with 12 objects."};

WordPieces TextPieces() {
  return WordPieces::Learn(kTextPrompts, 128);
}

SceneModelOptions TextModel(DenoiserKind kind, bool continuous) {
  SceneModelOptions options;
  options.kind = kind;
  options.continuous = continuous;
  options.width = 32;
  options.double_blocks = 2;
  options.single_blocks = 1;
  options.text = true;
  options.text_pieces = TextPieces().size();
  return options;
}

std::shared_ptr<Denoiser> TextDenoiser(const SceneModelOptions& options) {
  torch::manual_seed(5);
  std::shared_ptr<Denoiser> denoiser = MakeDenoiser(options, kTextClasses);
  const torch::NoGradGuard no_gradient;
  for (torch::Tensor& one : denoiser->parameters()) one.add_(0.1 * torch::randn_like(one));
  return denoiser;
}

NoisyScenes TextScenes(bool continuous) {
  return {torch::randn({3, 7, 12}),
          continuous ? torch::randn({3, 7, kTextClasses})
                     : torch::randint(0, kTextClasses + 1, {3, 7}, torch::kLong),
          torch::tensor({3, 500, 999}, torch::kLong),
          {}};
}

double Off(const torch::Tensor& a, const torch::Tensor& b) {
  return (a - b).abs().max().item<double>();
}

template <typename Check>
void ForEachTextModel(const Check& check) {
  for (const DenoiserKind kind :
       {DenoiserKind::kFlux, DenoiserKind::kTransformer, DenoiserKind::kUnet}) {
    for (const bool continuous : {false, true}) check(TextModel(kind, continuous));
  }
}

TEST(TextConditioning, APromptChangesThePredictionAndItsPaddingDoesNot) {
  const torch::NoGradGuard no_gradient;
  ForEachTextModel([](const SceneModelOptions& options) {
    const std::shared_ptr<Denoiser> denoiser = TextDenoiser(options);
    NoisyScenes scenes = TextScenes(options.continuous);
    TextInput text = PiecesOf(kTextPrompts, TextPieces(), 110);
    scenes.text = denoiser->EncodeText(text);
    const Denoised before = denoiser->Predict(scenes);
    // More padding, filled with another piece.
    const std::int64_t length = text.pieces.size(1);
    text.pieces = torch::cat({text.pieces, torch::full({3, 5}, 7, torch::kLong)}, 1);
    text.mask = torch::cat({text.mask, torch::zeros({3, 5}, torch::kBool)}, 1);
    scenes.text = denoiser->EncodeText(text);
    const Denoised padded = denoiser->Predict(scenes);
    EXPECT_LT(Off(before.pose_noise, padded.pose_noise), 1e-4) << NameOf(options.kind);
    EXPECT_LT(Off(before.classes, padded.classes), 1e-4) << NameOf(options.kind);
    // Another word, in the first prompt only.
    text.pieces[0][length - 3] = 8;
    scenes.text = denoiser->EncodeText(text);
    const Denoised other = denoiser->Predict(scenes);
    EXPECT_GT(Off(before.pose_noise[0], other.pose_noise[0]), 1e-5) << NameOf(options.kind);
    EXPECT_GT(Off(before.classes[0], other.classes[0]), 1e-5) << NameOf(options.kind);
    EXPECT_LT(Off(padded.pose_noise[2], other.pose_noise[2]), 1e-6) << NameOf(options.kind);
  });
}

TEST(TextConditioning, TheOrderOfTheObjectsStaysWithoutMeaning) {
  const torch::NoGradGuard no_gradient;
  ForEachTextModel([](const SceneModelOptions& options) {
    const std::shared_ptr<Denoiser> denoiser = TextDenoiser(options);
    NoisyScenes scenes = TextScenes(options.continuous);
    scenes.text = denoiser->EncodeText(PiecesOf(kTextPrompts, TextPieces(), 110));
    const Denoised before = denoiser->Predict(scenes);
    const torch::Tensor order = torch::randperm(7, torch::kLong);
    scenes.poses = scenes.poses.index_select(1, order);
    scenes.classes = scenes.classes.index_select(1, order);
    const Denoised after = denoiser->Predict(scenes);
    EXPECT_LT(Off(before.pose_noise.index_select(1, order), after.pose_noise), 1e-5);
    EXPECT_LT(Off(before.classes.index_select(1, order), after.classes), 1e-5);
  });
}

TEST(TextConditioning, SharesOfABatchAreTheWholeAndGradientsReachTheEncoder) {
  ForEachTextModel([](const SceneModelOptions& options) {
    const std::shared_ptr<Denoiser> denoiser = TextDenoiser(options);
    const SceneDiffusion diffusion(options, kTextClasses);
    const CleanScenes scenes{torch::rand({3, 5, 12}) * 2.0 - 1.0,
                             torch::randint(0, kTextClasses, {3, 5}, torch::kLong)};
    DenoisingBatch batch = diffusion.AddNoise(scenes, at::detail::createCPUGenerator(3));
    batch.text = PiecesOf(kTextPrompts, TextPieces(), 110);
    const torch::Tensor loss = diffusion.Loss(denoiser.get(), batch).total;
    const double first = diffusion.Loss(denoiser.get(), batch.Part(0, 1)).total.item<double>();
    const double last = diffusion.Loss(denoiser.get(), batch.Part(1, 2)).total.item<double>();
    EXPECT_NEAR((first + 2.0 * last) / 3.0, loss.item<double>(), 1e-5 * loss.item<double>());
    loss.backward();
    for (const auto& one : denoiser->named_parameters()) {
      if (one.key().rfind("text.", 0) != 0) continue;
      ASSERT_TRUE(one.value().grad().defined()) << one.key();
      EXPECT_GT(one.value().grad().abs().max().item<double>(), 0.0) << one.key();
    }
  });
}

TEST(TextConditioning, GuidanceExtrapolatesFromTheUnpromptedPrediction) {
  const torch::NoGradGuard no_gradient;
  ForEachTextModel([](const SceneModelOptions& options) {
    const std::shared_ptr<Denoiser> denoiser = TextDenoiser(options);
    NoisyScenes scenes = TextScenes(options.continuous);
    const auto encode = [&](const std::vector<std::string>& prompts) {
      return denoiser->EncodeText(PiecesOf(prompts, TextPieces(), 110));
    };
    scenes.text = encode({"", "", ""});
    const Denoised free = denoiser->Predict(scenes);
    scenes.text = encode(kTextPrompts);
    const Denoised prompted = denoiser->Predict(scenes);
    core::SetThreadCount(2);
    const Denoised guided = PredictGuided(denoiser.get(), scenes, {1.5, encode({""})});
    const Denoised plain = PredictGuided(denoiser.get(), scenes, {});
    core::SetThreadCount(0);
    const torch::Tensor wanted = 2.5 * prompted.pose_noise - 1.5 * free.pose_noise;
    EXPECT_LT(Off(guided.pose_noise, wanted), 1e-4);
    EXPECT_LT(Off(guided.classes, 2.5 * prompted.classes - 1.5 * free.classes), 1e-4);
    EXPECT_LT(Off(plain.pose_noise, prompted.pose_noise), 1e-4);
    // The second prompt is the empty one.
    EXPECT_LT(Off(guided.pose_noise[1], free.pose_noise[1]), 1e-4);
  });
}

TEST(TextConditioning, BaselinesWithCrossAttentionAreAsLargeWithinATenth) {
  for (const char* const size : {"tiny", "base"}) {
    SceneModelOptions ours = SceneModelOptions::OfSize(size);
    ours.text = true;
    ours.text_pieces = 300;
    const auto count = [](const SceneModelOptions& options) {
      return static_cast<double>(ParameterCount(*MakeDenoiser(options, 15)));
    };
    const double wanted = count(ours);
    EXPECT_NEAR(count(ours.AsMiDiffusion()) / wanted, 1.0, 0.1) << size;
    EXPECT_NEAR(count(ours.AsDiffuScene()) / wanted, 1.0, 0.1) << size;
  }
}

TEST(TextConditioning, AModelWithoutTextRefusesPrompts) {
  SceneModelOptions options = TextModel(DenoiserKind::kFlux, false);
  options.text = false;
  options.text_pieces = 0;
  const std::shared_ptr<Denoiser> denoiser = MakeDenoiser(options, kTextClasses);
  EXPECT_THROW(denoiser->EncodeText(PiecesOf(kTextPrompts, TextPieces(), 110)), core::Error);
  std::string error;
  options.text_pieces = 5;
  EXPECT_FALSE(options.IsValid(&error));
  options.text = true;
  options.text_features = 5;
  EXPECT_FALSE(options.IsValid(&error));
}

// Writes an encoder of features of width 6 with its vocabulary; returns its file.
std::filesystem::path ScriptedEncoder(const std::filesystem::path& folder,
                                      const std::string& result) {
  torch::jit::script::Module module("encoder");
  module.register_parameter("table", torch::randn({64, 6}), false);
  module.define("def forward(self, pieces, mask):\n    x = torch.embedding(self.table, pieces)\n" +
                result);
  const std::filesystem::path file = folder / "encoder.pt";
  module.save(file.string());
  std::string lines;
  const WordPieces pieces = WordPieces::Learn(kTextPrompts, 64);
  for (const std::string& piece : pieces.pieces()) lines += piece + "\n";
  core::WriteFile(folder / "encoder.pt.vocab.txt", lines);
  return file;
}

TEST(ExternalTextEncoder, GivesTheFeaturesOfItsModule) {
  const core::TemporaryFolder folder;
  const ExternalTextEncoder encoder(
      ScriptedEncoder(folder.path(), "    return (x * mask.unsqueeze(-1), mask)\n"));
  EXPECT_EQ(encoder.features(), 6);
  const TextInput text = TextInputOf(kTextPrompts, encoder.pieces(), 110, &encoder);
  EXPECT_FALSE(text.pieces.defined());
  ASSERT_EQ(text.features.sizes(), (std::vector<std::int64_t>{3, text.mask.size(1), 6}));
  EXPECT_EQ(text.features[1][2].abs().max().item<double>(), 0.0);  // the padding of ""
  SceneModelOptions options = TextModel(DenoiserKind::kFlux, false);
  options.text_pieces = 0;
  options.text_features = 6;
  const std::shared_ptr<Denoiser> denoiser = TextDenoiser(options);
  EXPECT_EQ(denoiser->EncodeText(text).features.size(-1), options.width);
  options.text_features = 7;
  EXPECT_THROW(TextDenoiser(options)->EncodeText(text), core::Error);
}

TEST(ExternalTextEncoder, SaysWhatIsWrong) {
  const core::TemporaryFolder folder;
  EXPECT_THROW(ExternalTextEncoder(ScriptedEncoder(folder.path(), "    return x.sum(-1)\n")),
               core::Error);
  EXPECT_THROW(ExternalTextEncoder(ScriptedEncoder(folder.path(), "    return x / 0.0 * 0.0\n")),
               core::Error);
  EXPECT_THROW(
      ExternalTextEncoder(ScriptedEncoder(folder.path(), "    return x.reshape([2, 3])\n")),
      core::Error);
  const std::filesystem::path file = ScriptedEncoder(folder.path(), "    return x\n");
  std::filesystem::remove(folder.path() / "encoder.pt.vocab.txt");
  EXPECT_THROW((ExternalTextEncoder(file)), core::Error);
  EXPECT_THROW((ExternalTextEncoder(folder.path() / "none.pt")), core::Error);
}

}  // namespace
}  // namespace simwright::scene
