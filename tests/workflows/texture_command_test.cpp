// `simwright texture`: what it writes, what stays as it was, and its errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include "assets/articulated_folder.h"
#include "assets/asset_folder.h"
#include "assets/pbr_look.h"
#include "core/error.h"
#include "core/files.h"
#include "core/json.h"
#include "core/progress.h"
#include "program.h"
#include "texture/image_generator.h"
#include "workflows/texture/texturing.h"

namespace simwright::workflows {
namespace {
namespace fs = std::filesystem;

std::string TexturedAssetOf(const std::string& kind, const fs::path& folder) {
  const Outcome made = RunProgram("library --kind " + kind + " --no-check --quiet -o " +
                                  (folder / "library").string());
  EXPECT_EQ(made.code, 0) << made.text;
  return (folder / "library" / (kind + "_1")).string();
}

bool HasFinding(const core::Json& report, const std::string& code) {
  return std::any_of(report["findings"].begin(), report["findings"].end(),
                     [&](const core::Json& finding) { return finding["code"] == code; });
}

// Expects that geometry, mass and collision parts of two rigid assets are the same bytes.
void ExpectSameBody(const fs::path& a, const fs::path& b) {
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(a)) {
    const std::string name = entry.path().filename().string();
    if (name != "solid.obj" && !name.starts_with("collision_")) continue;
    EXPECT_EQ(core::ReadFile(entry.path()), core::ReadFile(b / name)) << name;
    ++compared;
  }
  EXPECT_GE(compared, 2);
  const assets::Asset first = assets::ReadAsset(a), second = assets::ReadAsset(b);
  EXPECT_EQ(first.inertial.mass, second.inertial.mass);
  EXPECT_EQ(first.inertial.inertia, second.inertial.inertia);
  ASSERT_EQ(first.visual.mesh.triangles.size(), second.visual.mesh.triangles.size());
}

TEST(TextureCommand, TexturesAMugByWordsAndLeavesItsBody) {
  const core::TemporaryFolder folder;
  const fs::path mug = TexturedAssetOf("mug", folder.path());
  const std::string out = (folder.path() / "out").string();
  const std::string arguments =
      "texture " + mug.string() + " --variants 2 --size 256 -o " + out +
      " --prompt \"a dark blue glazed mug with a white inside, a red handle and a fluffy lid\"";
  const Outcome made = RunProgram(arguments + " --json", "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  const core::Json report = core::ParseJson(made.text, "the report");
  ASSERT_EQ(report["variants"].size(), 2u);
  EXPECT_TRUE(HasFinding(report, "texture-words-unused"));  // fluffy
  const fs::path first = fs::path(out) / "mug_1_000";
  ExpectSameBody(mug, first);
  const assets::Asset asset = assets::ReadAsset(first);
  ASSERT_EQ(asset.visual.textures.size(), 1u);
  EXPECT_EQ(asset.visual.textures[0].width, 256);
  // The texture holds the colours of the words: dark blue, white, red.
  int blue = 0, white = 0, red = 0;
  const core::Image& texture = asset.visual.textures[0];
  for (std::size_t i = 0; i < texture.pixels.size(); i += 3) {
    const int r = texture.pixels[i], g = texture.pixels[i + 1], b = texture.pixels[i + 2];
    blue += b > 60 && b > 2 * r;
    white += r > 200 && g > 200 && b > 200;
    red += r > 140 && g < 70;
  }
  EXPECT_GT(blue, 8000);
  EXPECT_GT(white, 3000);
  EXPECT_GT(red, 800);
  EXPECT_FALSE(assets::ReadPbrLook(first).empty());
  EXPECT_TRUE(fs::exists(fs::path(out) / "mug_1_sheet.png"));
  const core::Json json = core::ParseJson(core::ReadFile(first / "asset.json"), "asset.json");
  EXPECT_EQ(json["texture"]["generator"], "materials");
  EXPECT_EQ(json["texture"]["seed"], 1);
  // The output is kept unless it is to be replaced, and then it is the same.
  const std::string before = core::ReadFile(first / "texture.png");
  EXPECT_EQ(RunProgram(arguments).code, 1);
  ASSERT_EQ(RunProgram(arguments + " --force --quiet").code, 0);
  EXPECT_EQ(core::ReadFile(first / "texture.png"), before);
}

TEST(TextureCommand, VariantsOfOneFolderShareTheMesh) {
  const core::TemporaryFolder folder;
  const fs::path bowl = TexturedAssetOf("bowl", folder.path());
  const std::string out = (folder.path() / "out").string();
  const Outcome made = RunProgram("texture " + bowl.string() +
                                  " --variants 3 --as materials --size 128 --quiet -o " + out);
  ASSERT_EQ(made.code, 0) << made.text;
  const fs::path written = fs::path(out) / "bowl_1";
  const core::Json json = core::ParseJson(core::ReadFile(written / "asset.json"), "asset.json");
  ASSERT_EQ(json["appearances"].size(), 3u);
  std::string former;
  for (const core::Json& one : json["appearances"]) {
    const std::string picture = core::ReadFile(written / one["base_color_map"].get<std::string>());
    EXPECT_NE(picture, former);
    former = picture;
    EXPECT_EQ(core::ReadImage(written / one["normal_map"].get<std::string>()).width, 128);
  }
  ExpectSameBody(bowl, written);
}

TEST(TextureCommand, TexturesAnArticulatedAssetPartByPart) {
  const core::TemporaryFolder folder;
  const fs::path cabinet = TexturedAssetOf("cabinet", folder.path());
  const std::string out = (folder.path() / "out").string();
  const Outcome made =
      RunProgram("texture " + cabinet.string() +
                 " --prompt \"walnut with black handles\" --size 256 --quiet -o " + out);
  ASSERT_EQ(made.code, 0) << made.text;
  const assets::ArticulatedAsset before = assets::ReadArticulatedAsset(cabinet);
  const assets::ArticulatedAsset after =
      assets::ReadArticulatedAsset(fs::path(out) / "cabinet_1_000");
  ASSERT_EQ(before.links.size(), after.links.size());
  for (std::size_t i = 0; i < before.links.size(); ++i) {
    EXPECT_EQ(before.links[i].inertial.mass, after.links[i].inertial.mass);
    ASSERT_EQ(after.links[i].visual.textures.size(), 1u);
    double sum = 0.0;
    for (const std::uint8_t value : after.links[i].visual.textures[0].pixels) sum += value;
    const double mean = sum / static_cast<double>(after.links[i].visual.textures[0].pixels.size());
    if (after.links[i].label == "handle") {
      EXPECT_LT(mean, 110.0);  // brass, plated black
    } else {
      EXPECT_NEAR(mean, 75.0, 30.0);  // walnut
    }
  }
  EXPECT_EQ(RunProgram("texture " + cabinet.string() + " --as materials -o " + out + "2").code, 1);
}

TEST(TextureCommand, TakesTheLookOfAPictureAndOfAnAsset) {
  const core::TemporaryFolder folder;
  const fs::path bowl = TexturedAssetOf("bowl", folder.path());
  const fs::path picture = folder.path() / "stripes.png";
  core::Image stripes(200, 200, 3, 230);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      if (x / 10 % 2 == 0) stripes.At(x, y)[0] = stripes.At(x, y)[1] = 40;  // blue
    }
  }
  core::WritePng(picture, stripes);
  const std::string out = (folder.path() / "out").string();
  const Outcome made = RunProgram("texture " + bowl.string() + " --exemplar " + picture.string() +
                                      " --size 256 --json -o " + out,
                                  "/dev/null");
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_TRUE(HasFinding(core::ParseJson(made.text, "the report"), "texture-exemplar"));
  const core::Image texture = assets::ReadAsset(fs::path(out) / "bowl_1_000").visual.textures[0];
  int blue = 0, white = 0;
  for (std::size_t i = 0; i < texture.pixels.size(); i += 3) {
    blue += texture.pixels[i] < 90 && texture.pixels[i + 2] > 180;
    white += texture.pixels[i] > 190;
  }
  EXPECT_GT(blue, 10000);
  EXPECT_GT(white, 10000);
  const Outcome like = RunProgram("texture " + bowl.string() + " --like " + out +
                                  "/bowl_1_000 --size 256 --quiet -o " + out + "2");
  EXPECT_EQ(like.code, 0) << like.text;
}

TEST(TextureCommand, SaysWhatIsWrong) {
  const core::TemporaryFolder folder;
  const fs::path bowl = TexturedAssetOf("bowl", folder.path());
  const auto expect = [&](const std::string& arguments, const std::string& says) {
    const Outcome outcome = RunProgram("texture " + arguments);
    EXPECT_NE(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find(says), std::string::npos) << outcome.text;
  };
  expect(folder.path().string(), "holds no asset.json");
  expect(bowl.string() + " --exemplar none.png -o " + (folder.path() / "x").string(), "none.png");
  expect(bowl.string() + " --size 10", "--size");
  expect(bowl.string() + " --exemplar a.png --like b", "--like");
  expect(
      bowl.string() + " --like " + folder.path().string() + " -o " + (folder.path() / "x").string(),
      "holds no asset.json");
  EXPECT_FALSE(fs::exists(folder.path() / "x"));
}

// An endpoint that paints everything green, until it asks for a stop.
class GreenEndpoint : public texture::ImageGenerator {
 public:
  std::string name() const override { return "green"; }
  core::Image Generate(const texture::ImageRequest& request) override {
    EXPECT_EQ(request.prompt, prompt);
    if (++calls > stops_after) core::RequestCancel();
    core::CheckCancelled();
    core::Image picture(request.camera.width, request.camera.height, 3);
    for (std::size_t i = 1; i < picture.pixels.size(); i += 3) picture.pixels[i] = 200;
    return picture;
  }
  core::Findings TakeFindings() override {
    return {{"image-depth-unused", core::Severity::kWarning, "green", "it takes no depth"}};
  }

  std::string prompt = "a green bowl";
  int calls = 0, stops_after = 1000;
};

// Words go to an endpoint, its colours and its findings arrive, and a stop keeps what is finished.
TEST(Texturing, PaintsOverAGenerator) {
  const core::TemporaryFolder folder;
  const auto green = std::make_shared<GreenEndpoint>();
  TextureRequest request;
  request.asset = TexturedAssetOf("bowl", folder.path());
  request.prompt = green->prompt;
  request.generator = green;
  request.size = 128;
  request.variants = 2;
  request.output = folder.path() / "out";
  core::Progress silent;
  const TextureReport report = TextureAsset(request, &silent);
  EXPECT_FALSE(report.interrupted);
  const int views = green->calls / request.variants;
  EXPECT_LT(report.variants[0].unseen_share, 0.2);
  // The generator tells it for each variant, the report once.
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].code, "image-depth-unused");
  const auto record = [](const TextureVariant& variant) {
    return core::ParseJson(core::ReadFile(variant.folder / "asset.json"), "asset.json");
  };
  EXPECT_TRUE(HasFinding(record(report.variants[0]), "image-depth-unused"));
  const core::Image texture = assets::ReadAsset(report.variants[0].folder).visual.textures[0];
  for (std::size_t i = 0; i < texture.pixels.size(); i += 3) {
    ASSERT_EQ(texture.pixels[i], 0);
    ASSERT_EQ(texture.pixels[i + 1], 200);
  }
  TextureRequest empty = request;
  empty.prompt.clear();
  EXPECT_THROW(TextureAsset(empty, &silent), core::Error);

  // A stop in the second variant; the prompt is no UTF-8.
  request.prompt = green->prompt = "a green \xff bowl";
  green->stops_after = green->calls + views;
  request.output = folder.path() / "stopped";
  const TextureReport stopped = TextureAsset(request, &silent);
  core::ClearCancelRequest();
  EXPECT_TRUE(stopped.interrupted);
  ASSERT_EQ(stopped.variants.size(), 1u);
  EXPECT_EQ(record(stopped.variants[0])["texture"]["prompt"], "a green \xef\xbf\xbd bowl");
  EXPECT_FALSE(fs::exists(request.output / "bowl_1_001"));
  EXPECT_TRUE(fs::exists(stopped.sheet));
  EXPECT_NO_THROW(TextureReportJson(stopped));

  // One folder of all variants is there complete or not at all.
  request.as_materials = true;
  green->stops_after = green->calls;
  request.output = folder.path() / "none";
  EXPECT_THROW(TextureAsset(request, &silent), core::Cancelled);
  core::ClearCancelRequest();
  EXPECT_FALSE(fs::exists(request.output));
}

}  // namespace
}  // namespace simwright::workflows
