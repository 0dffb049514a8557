#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "capture/mat_calibration.h"
#include "capture/mat_detection.h"
#include "core/error.h"
#include "core/random.h"
#include "tests/capture/mat_photos.h"

namespace simwright::capture {
namespace {

constexpr double kOneDegree = std::numbers::pi / 180.0;

// OpenCV draws its board itself: an independent picture of the same mat.
TEST(CaptureMat, LooksAsOpenCvDrawsIt) {
  for (const CaptureMat& mat : CaptureMats()) {
    const int pixels = 40;  // per square
    const cv::Ptr<cv::aruco::CharucoBoard> board = cv::aruco::CharucoBoard::create(
        mat.columns, mat.rows, static_cast<float>(mat.square), static_cast<float>(mat.marker),
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250));
    for (int& id : board->ids) id += mat.first_marker;
    cv::Mat expected;
    board->draw({mat.columns * pixels, mat.rows * pixels}, expected, 0, 1);
    const core::Image picture = MatPicture(mat, pixels / mat.square);
    const int left = (picture.width - expected.cols) / 2;
    const int top = (picture.height - expected.rows) / 2;
    int different = 0;
    for (int y = 0; y < expected.rows; ++y) {
      for (int x = 0; x < expected.cols; ++x) {
        different +=
            std::abs(expected.at<std::uint8_t>(y, x) - picture.At(left + x, top + y)[0]) > 128;
      }
    }
    // Edges may fall on the other side of a pixel.
    EXPECT_LT(different, 0.08 * expected.rows * expected.cols) << mat.name;
    EXPECT_LE(mat.columns * mat.square + 0.02, mat.width) << mat.name;
    EXPECT_LE(mat.rows * mat.square + 0.03, mat.height) << mat.name;
  }
}

TEST(MatDetection, FindsEachCornerOfAFlatPictureWhereItIs) {
  for (const CaptureMat& mat : CaptureMats()) {
    const double scale = 2000.0 / mat.height;
    const core::Image picture = MatPicture(mat, scale);
    const auto found = DetectMat(picture);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->paper, mat.paper);
    EXPECT_EQ(static_cast<int>(found->corners.size()), mat.corner_count());
    for (std::size_t i = 0; i < found->corners.size(); ++i) {
      const Eigen::Vector3d at = mat.Corner(found->corners[i]);
      const Eigen::Vector2d expected(scale * (at.x() + 0.5 * mat.width),
                                     scale * (0.5 * mat.height - at.y()));
      EXPECT_LT((found->pixels[i] - expected).norm(), 0.6);
    }
  }
  EXPECT_FALSE(DetectMat(core::Image(640, 480, 3, 200)).has_value());
  EXPECT_THROW(DetectMat({}), core::Error);
}

TEST(MatCalibration, FindsTheCamerasOfPhotosWithDistortion) {
  MatPhotoOptions options;
  options.lens = PhoneLens(1200, 900, 65 * kOneDegree);
  options.samples_per_side = 1;
  const auto poses =
      OrbitPoses(9, {30 * kOneDegree, 50 * kOneDegree, 70 * kOneDegree}, 0.13, options.lens, 3);
  const auto photos =
      RenderMatPhotos(PlainBox({0.05, 0.07, 0.09}, {0.8f, 0.25f, 0.2f}), poses, options);
  MatCalibrationInput input;
  for (const MatPhoto& photo : photos) {
    const auto mat = DetectMat(photo.photo);
    ASSERT_TRUE(mat.has_value());
    input.photos.push_back({*mat, 0.0, "photo"});
  }
  const MatCalibration result = CalibrateOnMat(input);
  EXPECT_TRUE(result.findings.empty());
  ASSERT_EQ(result.lenses.size(), 1u);
  EXPECT_LT(result.error, 0.5);
  EXPECT_NEAR(result.lenses[0].fx / options.lens.fx, 1.0, 0.003);
  EXPECT_NEAR(result.lenses[0].cx, options.lens.cx, 4.0);
  EXPECT_NEAR(result.lenses[0].cy, options.lens.cy, 4.0);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double distance = poses[i].translation().norm();
    EXPECT_LT((result.views[i].world_from_camera.translation() - poses[i].translation()).norm(),
              0.004 * distance);
    const Eigen::Matrix3d turn =
        result.views[i].world_from_camera.linear().transpose() * poses[i].linear();
    EXPECT_LT(Eigen::AngleAxisd(turn).angle(), 0.004);
  }
  // A print that is 10 % larger is 10 % larger, cameras and all.
  input.print_scale = 1.1;
  const MatCalibration larger = CalibrateOnMat(input);
  EXPECT_NEAR(larger.views[0].world_from_camera.translation().norm() /
                  result.views[0].world_from_camera.translation().norm(),
              1.1, 1e-4);
}

TEST(MatCalibration, RefusesInputThatDoesNotFit) {
  MatCalibrationInput input;
  EXPECT_THROW(CalibrateOnMat(input), core::Error);
  MatObservation mat;
  mat.width = 640;
  mat.height = 480;
  for (int i = 0; i < 8; ++i) {
    mat.corners.push_back(i);
    mat.pixels.emplace_back(10.0 * i, 20.0);
  }
  input.photos.assign(4, {mat, 0.0, "a.jpg"});
  input.photos[2].mat.paper = PaperSize::kA3;
  input.photos[2].name = "b.jpg";
  try {
    CalibrateOnMat(input);
    ADD_FAILURE();
  } catch (const core::Error& error) {
    EXPECT_NE(std::string(error.what()).find("b.jpg"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("A3"), std::string::npos);
  }
}

TEST(Lens, RemovesTheDistortionThatProjectAdds) {
  const Lens lens = PhoneLens(800, 600, 65 * kOneDegree);
  core::Image photo(lens.width, lens.height, 1, 0);
  // A grid of dots where the lens shows directions.
  std::vector<Eigen::Vector2d> directions;
  for (double x = -0.4; x <= 0.41; x += 0.2) {
    for (double y = -0.3; y <= 0.31; y += 0.15) {
      directions.emplace_back(x, y);
      const Eigen::Vector2d at = lens.Project({x, y, 1.0});
      cv::Mat image(photo.height, photo.width, CV_8U, photo.pixels.data());
      cv::circle(image, cv::Point(static_cast<int>(at.x()), static_cast<int>(at.y())), 3, 255, -1);
    }
  }
  core::Camera crop;
  crop.width = lens.width;
  crop.height = lens.height;
  crop.fx = lens.fx;
  crop.fy = lens.fy;
  crop.cx = lens.cx;
  crop.cy = lens.cy;
  const core::Image straight = RemoveDistortion(photo, lens, crop);
  for (const Eigen::Vector2d& d : directions) {
    const int x = static_cast<int>(crop.fx * d.x() + crop.cx);
    const int y = static_cast<int>(crop.fy * d.y() + crop.cy);
    EXPECT_GT(straight.At(x, y)[0], 200) << d.transpose();
  }
}

}  // namespace
}  // namespace simwright::capture
