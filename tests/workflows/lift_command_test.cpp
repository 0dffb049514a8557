// `simwright lift` on inputs that need fitting.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/camera.h"
#include "core/files.h"
#include "core/image.h"
#include "program.h"

namespace simwright {
namespace {
namespace fs = std::filesystem;

constexpr double kRadius = 0.05;  // m

// A ball around `center` with a colour per direction, as a cut-out.
core::Image BallPhoto(const core::Camera& camera, const Eigen::Vector3d& center) {
  core::Image photo(camera.width, camera.height, 4);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray = camera.Ray({x + 0.5, y + 0.5}).normalized();
      const Eigen::Vector3d to = center - camera.position();
      const double along = to.dot(ray), gap = kRadius * kRadius - (to - along * ray).squaredNorm();
      if (gap < 0.0) continue;
      const Eigen::Vector3d normal =
          (camera.position() + (along - std::sqrt(gap)) * ray - center) / kRadius;
      for (int c = 0; c < 3; ++c) {
        photo.At(x, y)[c] = static_cast<std::uint8_t>(128 + 90 * std::sin(5 * normal[c] + c));
      }
      photo.At(x, y)[3] = 255;
    }
  }
  return photo;
}

std::string PhotosAndCameras(const fs::path& folder, int count, int wrong) {
  nlohmann::json cameras = nlohmann::json::array();
  std::string names;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center(0.3, -0.2, kRadius);
    core::Camera camera =
        core::OrbitCamera(center, 0.4, 0.2 + 0.3 * (i % 2), 2 * M_PI * i / count, 0.6, 160, 160);
    const std::string name = "view" + std::to_string(i) + ".png";
    core::WriteFile(folder / name, core::EncodePng(BallPhoto(camera, center)));
    names += (folder / name).string() + " ";
    if (i == wrong) camera.world_from_camera.translation() += Eigen::Vector3d(0.05, 0.06, 0.04);
    nlohmann::json rows = nlohmann::json::array();
    const Eigen::Matrix4d matrix = camera.world_from_camera.matrix();
    for (int r = 0; r < 4; ++r) {
      rows.push_back({matrix(r, 0), matrix(r, 1), matrix(r, 2), matrix(r, 3)});
    }
    cameras.push_back({{"photo", name},
                       {"width", camera.width},
                       {"height", camera.height},
                       {"fx", camera.fx},
                       {"fy", camera.fy},
                       {"cx", camera.cx},
                       {"cy", camera.cy},
                       {"world_from_camera", rows}});
  }
  core::WriteFile(folder / "cams.json", nlohmann::json{{"cameras", cameras}}.dump());
  return names;
}

TEST(LiftCommand, SeveralPhotosGiveTheSizeInMetresAndTheWrongCamera) {
  const core::TemporaryFolder folder;
  const std::string photos = PhotosAndCameras(folder.path(), 7, 4);
  const fs::path out = folder.path() / "out";
  const Outcome lift =
      RunProgram("lift " + photos + "--cameras " + (folder.path() / "cams.json").string() +
                 " --category ball --fast --json -o " + out.string());
  ASSERT_EQ(lift.code, 0) << lift.text;
  EXPECT_NE(lift.text.find("view4.png contradicts"), std::string::npos) << lift.text;
  const nlohmann::json asset = nlohmann::json::parse(core::ReadFile(out / "asset.json"));
  for (const char* side : {"length", "width", "height"}) {
    EXPECT_NEAR(asset.at("size_m").at(side).at("sample").get<double>(), 2 * kRadius,
                0.04 * 2 * kRadius)
        << side;
  }
}

TEST(LiftCommand, APhotoOfAnotherSizeThanItsCamerasIsRefused) {
  const core::TemporaryFolder folder;
  const std::string photos = PhotosAndCameras(folder.path(), 3, -1);
  core::WriteFile(folder.path() / "view1.png", core::EncodePng(core::Image(80, 80, 3, 100)));
  const Outcome lift =
      RunProgram("lift " + photos + "--cameras " + (folder.path() / "cams.json").string() +
                 " --category ball --quiet -o " + (folder.path() / "out").string());
  EXPECT_EQ(lift.code, 1) << lift.text;
  EXPECT_NE(lift.text.find("view1.png"), std::string::npos) << lift.text;
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
}

// The silhouette of a box resembles that of a solid of revolution; its category tells that it is
// not one.
TEST(LiftCommand, ABoxIsNoTurnedBody) {
  const core::TemporaryFolder folder;
  core::Image photo(160, 160, 4);
  for (int y = 30; y < 130; ++y) {
    for (int x = 50; x < 110; ++x) {
      photo.At(x, y)[1] = static_cast<std::uint8_t>(y);
      photo.At(x, y)[3] = 255;
    }
  }
  core::WriteFile(folder.path() / "front.png", core::EncodePng(photo));
  const auto lift = [&](const std::string& category) {
    const Outcome outcome = RunProgram("lift " + (folder.path() / "front.png").string() +
                                       " --elevation 0 --fast --category " + category + " -o " +
                                       (folder.path() / category).string());
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return outcome.text;
  };
  EXPECT_NE(lift("bottle").find("revolved upright"), std::string::npos);
  EXPECT_NE(lift("box").find("the learned prior"), std::string::npos);
}

// A bracket is not a solid of revolution, so its hidden side must be predicted and fitted.
TEST(LiftCommand, AFitIsTheSameTwice) {
  const core::TemporaryFolder folder;
  core::Image photo(200, 200, 4);
  for (int y = 30; y < 170; ++y) {
    for (int x = 40; x < 160; ++x) {
      if (x > 80 && y < 120) continue;
      photo.At(x, y)[0] = static_cast<std::uint8_t>(x);
      photo.At(x, y)[1] = static_cast<std::uint8_t>(y);
      photo.At(x, y)[3] = 255;
    }
  }
  core::WriteFile(folder.path() / "bracket.png", core::EncodePng(photo));
  for (const char* name : {"a", "b"}) {
    const Outcome lift = RunProgram("lift " + (folder.path() / "bracket.png").string() +
                                    " --category object --fast --seed 3 -o " +
                                    (folder.path() / name / "bracket").string());
    ASSERT_EQ(lift.code, 0) << lift.text;
  }
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.path() / "a" / "bracket")) {
    ++files;
    EXPECT_EQ(core::ReadFile(entry.path()),
              core::ReadFile(folder.path() / "b" / "bracket" / entry.path().filename()))
        << entry.path();
  }
  EXPECT_GE(files, 10);
}

// A brown board is fitted as a brick: a solid with planes.
TEST(LiftCommand, ShapeFittedTakesAnObjectOfTheLibrary) {
  const core::TemporaryFolder folder;
  core::Image photo(160, 160, 4);
  for (int y = 50; y < 110; ++y) {
    for (int x = 20; x < 140; ++x) {
      photo.At(x, y)[0] = 150;
      photo.At(x, y)[1] = y < 80 ? 90 : 60;
      photo.At(x, y)[3] = 255;
    }
  }
  core::WriteFile(folder.path() / "front.png", core::EncodePng(photo));
  const std::string lift = "lift " + (folder.path() / "front.png").string() + " -o " +
                           (folder.path() / "out").string() + " --shape ";
  const Outcome fitted = RunProgram(lift + "fitted --category brick");
  ASSERT_EQ(fitted.code, 0) << fitted.text;
  EXPECT_NE(fitted.text.find("[shape-fitted]"), std::string::npos) << fitted.text;
  const std::string asset = core::ReadFile(folder.path() / "out" / "asset.json");
  EXPECT_NE(asset.find("shape-fitted"), std::string::npos);
  const Outcome unknown = RunProgram(lift + "fitted --force --category elephant");
  EXPECT_EQ(unknown.code, 1) << unknown.text;
  EXPECT_EQ(RunProgram(lift + "round --category brick").code, 2);
}

}  // namespace
}  // namespace simwright
