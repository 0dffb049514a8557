// `simwright mat` and `simwright lift` of photos on a mat, on rendered photos.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>

#include "assets/asset_folder.h"
#include "capture/mat_detection.h"
#include "core/files.h"
#include "core/json.h"
#include "program.h"
#include "tests/capture/mat_photos.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr double kRad = std::numbers::pi / 180.0;
const Eigen::Vector3d kSides(0.06, 0.045, 0.09);  // m

class MatLift : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new core::TemporaryFolder;
    capture::MatPhotoOptions options;
    options.lens = capture::PhoneLens(1000, 750, 65 * kRad);
    poses_ = capture::OrbitPoses(12, {18 * kRad, 40 * kRad, 62 * kRad}, 0.13, options.lens, 5);
    const auto photos =
        capture::RenderMatPhotos(capture::PlainBox(kSides, {0.85f, 0.6f, 0.2f}), poses_, options);
    for (std::size_t i = 0; i < photos.size(); ++i) {
      core::WriteFile(Photo(i), core::EncodeJpeg(photos[i].photo, 97));
    }
  }
  static void TearDownTestSuite() { delete folder_; }

  static fs::path Photo(std::size_t i) {
    return folder_->path() / ("photo" + std::to_string(10 + i) + ".jpg");
  }
  static std::string Photos(std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += " " + Photo(i).string();
    return all;
  }

  static core::TemporaryFolder* folder_;
  static std::vector<Eigen::Isometry3d> poses_;
};
core::TemporaryFolder* MatLift::folder_ = nullptr;
std::vector<Eigen::Isometry3d> MatLift::poses_;

TEST_F(MatLift, GivesTheTrueSizeTheCamerasAndAnAssetThatPasses) {
  const fs::path asset = folder_->path() / "carton";
  const Outcome lift =
      RunProgram("lift" + Photos(12) + " --category box --quiet -o " + asset.string());
  ASSERT_EQ(lift.code, 0) << lift.text;
  const Eigen::Vector3d size = core::Bounds(assets::ReadAsset(asset).visual.mesh).sizes();
  // Twelve silhouettes leave ridges on the faces of a box, the highest one on its top.
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(size[k], kSides[k], (k < 2 ? 0.06 : 0.09) * kSides.maxCoeff()) << k;
  }
  const core::JsonDocument capture =
      core::JsonDocument::Read(asset / "capture.json", 1 << 20, "lift again");
  EXPECT_EQ(capture.root()["mat"].Text(), "A4");
  EXPECT_LT(capture.root()["error_pixels"].Number(), 0.6);
  std::size_t i = 0;
  for (const core::JsonField& photo : capture.root()["photos"].Elements()) {
    EXPECT_EQ(photo["photo"].Text(), Photo(i).filename());
    int row = 0;
    for (const core::JsonField& values : photo["world_from_camera"].Elements()) {
      if (row < 3) {
        EXPECT_NEAR(values.Elements()[3].Number(), poses_[i].translation()[row], 0.004);
      }
      ++row;
    }
    ++i;
  }
  EXPECT_EQ(i, 12u);
  EXPECT_TRUE(fs::exists(asset / "capture.html"));
  const Outcome check = RunProgram("check " + asset.string() + " --quiet");
  EXPECT_EQ(check.code, 0) << check.text;
  // The exported files say how it looks; the lift said the same.
  const Outcome looks = RunProgram("check " + asset.string() + " --json");
  const core::JsonDocument report(looks.text, "check", "");
  const core::JsonField appearance = report.root()["reports"].Elements().at(0)["appearance"];
  EXPECT_GT(appearance["measures"].Elements().at(0)["figure"].Number(), 0.9);
  const std::string sentence = "it looks " + appearance["grade"].Text();
  int said = 0;
  for (const core::Finding& finding : assets::ReadAsset(asset).findings) {
    said += finding.code == "appearance" && finding.sentence.starts_with(sentence);
  }
  EXPECT_EQ(said, 1) << sentence;
}

TEST_F(MatLift, RefusesTooFewPhotosAndAHeightThatTheMatContradicts) {
  const fs::path asset = folder_->path() / "refused";
  const Outcome few = RunProgram("lift" + Photos(3) + " --category box -o " + asset.string());
  EXPECT_EQ(few.code, 1);
  EXPECT_NE(few.text.find("at least 4"), std::string::npos) << few.text;
  const Outcome height =
      RunProgram("lift" + Photos(4) + " --height 0.1 --category box -o " + asset.string());
  EXPECT_EQ(height.code, 1);
  EXPECT_NE(height.text.find("--height"), std::string::npos) << height.text;
  EXPECT_FALSE(fs::exists(asset));
}

TEST_F(MatLift, RefusesFlippedPhotosThatItCannotUse) {
  const fs::path asset = folder_->path() / "flipped";
  const Outcome each = RunProgram("lift" + Photos(4) + " --each --flipped" + Photos(4) +
                                  " --category box -o " + asset.string());
  EXPECT_EQ(each.code, 1);
  EXPECT_NE(each.text.find("--flipped needs photos on a mat"), std::string::npos) << each.text;
  EXPECT_FALSE(fs::exists(asset));
}

TEST(MatCommand, WritesAPageOfTrueSizeAndKeepsExistingFiles) {
  const core::TemporaryFolder folder;
  const fs::path file = folder.path() / "mat.pdf";
  const Outcome made = RunProgram("mat --size A3 -o " + file.string());
  ASSERT_EQ(made.code, 0) << made.text;
  const std::string pdf = core::ReadFile(file, 1 << 22);
  EXPECT_EQ(pdf.substr(0, 8), "%PDF-1.4");
  // A3 in points, 1/72 inch.
  EXPECT_NE(pdf.find("/MediaBox [0 0 841.8898 1190.5512]"), std::string::npos);
  // Poppler's picture of the page shows each corner where a ruler finds it.
  const fs::path picture = folder.path() / "page";
  ASSERT_EQ(
      std::system(
          ("pdftoppm -singlefile -r 254 -png " + file.string() + " " + picture.string()).c_str()),
      0);
  const core::Image page = core::ReadImage(picture.string() + ".png");
  const auto found = capture::DetectMat(page);
  ASSERT_TRUE(found.has_value());
  const capture::CaptureMat& mat = capture::CaptureMatOf(capture::PaperSize::kA3);
  EXPECT_EQ(found->paper, mat.paper);
  EXPECT_EQ(static_cast<int>(found->corners.size()), mat.corner_count());
  for (std::size_t i = 0; i < found->corners.size(); ++i) {
    const Eigen::Vector3d at = mat.Corner(found->corners[i]);
    // 254 dots an inch are 10 a millimetre.
    const Eigen::Vector2d expected(1e4 * (at.x() + 0.5 * mat.width),
                                   1e4 * (0.5 * mat.height - at.y()));
    EXPECT_LT((found->pixels[i] - expected).norm(), 1.5);
  }
  EXPECT_EQ(RunProgram("mat -o " + file.string()).code, 1);
  EXPECT_EQ(core::ReadFile(file, 1 << 22), pdf);
}

}  // namespace
}  // namespace simwright
