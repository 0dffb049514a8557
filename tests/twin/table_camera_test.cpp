#include "twin/table_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"

namespace simwright::twin {
namespace {

TEST(TableCamera, KeepsItsNumbers) {
  for (const double roll : {-0.3, 0.0, 0.2}) {
    const TableCamera numbers{0.7, roll, 1.2, 0.8};
    const core::Camera camera = numbers.At(640, 480);
    const TableCamera back = TableCameraOf(camera);
    EXPECT_NEAR(back.elevation, numbers.elevation, 1e-12);
    EXPECT_NEAR(back.roll, numbers.roll, 1e-12);
    EXPECT_NEAR(back.focal, numbers.focal, 1e-12);
    EXPECT_NEAR(back.height, numbers.height, 1e-12);
    EXPECT_NEAR(camera.world_from_camera.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(TableCamera, LooksAtTheTableByTheElevation) {
  // The optical axis meets the plane at height / tan(elevation) in front of the camera.
  const TableCamera numbers{0.6, 0.0, 1.0, 0.5};
  const core::Camera camera = numbers.At(400, 300);
  const Eigen::Vector3d seen = camera.Project(Eigen::Vector3d(0.0, 0.5 / std::tan(0.6), 0.0));
  EXPECT_NEAR(seen.x(), 200.0, 1e-9);
  EXPECT_NEAR(seen.y(), 150.0, 1e-9);
  EXPECT_NEAR(seen.z(), 0.5 / std::sin(0.6), 1e-12);
  // The image keeps the world's right and its up.
  EXPECT_GT(camera.Project(Eigen::Vector3d(0.1, 0.7, 0.0)).x(), 200.0);
  EXPECT_LT(camera.Project(Eigen::Vector3d(0.0, 0.7, 0.2)).y(),
            camera.Project(Eigen::Vector3d(0.0, 0.7, 0.0)).y());
}

TEST(TableCamera, RefusesWhatSeesNoTable) {
  std::string error;
  EXPECT_TRUE((TableCamera{0.6, 0.0, 1.0, 0.5}.IsValid(&error)));
  EXPECT_FALSE((TableCamera{0.0, 0.0, 1.0, 0.5}.IsValid(&error)));
  EXPECT_NE(error.find("elevation"), std::string::npos);
  EXPECT_FALSE((TableCamera{0.6, 0.0, NAN, 0.5}.IsValid(&error)));
  EXPECT_FALSE((TableCamera{0.6, 0.0, 1.0, -1.0}.IsValid(&error)));
  core::Camera upwards = TableCamera{0.6, 0.0, 1.0, 0.5}.At(64, 64);
  upwards.world_from_camera.linear().col(2) *= -1.0;
  EXPECT_THROW(TableCameraOf(upwards), core::Error);
}

}  // namespace
}  // namespace simwright::twin
