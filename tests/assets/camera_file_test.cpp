#include "assets/camera_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/files.h"

namespace simwright::assets {
namespace {

constexpr char kGood[] =
    R"({"cameras": [{"photo": "views/a.jpg", "width": 64, "height": 48, "fx": 60, "fy": 61,
        "cx": 32, "cy": 24, "world_from_camera": [[0, 0, 1, 1], [-1, 0, 0, 2], [0, -1, 0, 3],
        [0, 0, 0, 1]]}]})";

TEST(CameraFile, IsReadAsItIsWritten) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "cams.json", kGood);
  const auto cameras = ReadCameraFile(folder.path() / "cams.json");
  const core::Camera& camera = cameras.at("a.jpg");
  EXPECT_EQ(camera.width, 64);
  EXPECT_EQ(camera.fy, 61);
  EXPECT_TRUE(camera.position().isApprox(Eigen::Vector3d(1, 2, 3)));
  // The camera looks along the world's x: a point ahead lies at the image centre.
  EXPECT_LT((camera.Project({6, 2, 3}) - Eigen::Vector3d(32, 24, 5)).norm(), 1e-12);
}

// Each fault in a valid file is rejected with a message that names it.
TEST(CameraFile, NamesWhatIsWrong) {
  const core::TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to, const char* part) {
    std::string text = kGood;
    text.replace(text.find(from), from.size(), to);
    core::WriteFile(folder.path() / "cams.json", text);
    try {
      ReadCameraFile(folder.path() / "cams.json");
      ADD_FAILURE() << to << " was taken";
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("\"fx\": 60", "\"fx\": -60", "fx: must be a number of at least 0.001, is -60");
  refused("\"fx\": 60", "\"f\": 60", "'fx' is missing");
  refused("[0, 0, 1, 1]", "[0, 0, 2, 1]", "not a rotation");
  refused("[0, 0, 1, 1]", "[0, 0, 1]", "world_from_camera[0]: must be an array of 4 numbers");
  refused("[0, 0, 1, 1]", "[0, 0, \"x\", 1]",
          "world_from_camera[0][2]: must be a number, is \"x\"");
  refused("\"photo\"", "\"picture\"", "'photo' is missing");
  refused("\"cameras\"", "\"views\"", "'cameras' is missing");
  refused("{", "[", "JSON");
  EXPECT_THROW(ReadCameraFile(folder.path() / "none.json"), core::Error);
}

}  // namespace
}  // namespace simwright::assets
