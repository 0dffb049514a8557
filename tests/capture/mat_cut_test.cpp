#include "capture/mat_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <opencv2/imgproc.hpp>

#include "capture/color_mixture.h"
#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr int kPanSide = 140;
constexpr float kPanDeviation = 6.0f;  // of MatEvidence::difference, of 255
const Eigen::Vector3f kDarkInk(127, 0, 92), kLightInk(183, 237, 194);

// A photo of a chequered mat with a disc of the colour `disc` and a handle, 6 pixels thick, of the
// colour `handle`, which crosses dark and light squares.
struct PanOnMat {
  core::Image photo = core::Image(kPanSide, kPanSide, 3);
  MatEvidence evidence;
  std::vector<CutLabel> labels = std::vector<CutLabel>(
      static_cast<std::size_t>(kPanSide) * kPanSide, CutLabel::kLikelyBackground);
  cv::Mat truth = cv::Mat(kPanSide, kPanSide, CV_8U, cv::Scalar(0));

  CutLabel& Label(int x, int y) { return labels[static_cast<std::size_t>(y) * kPanSide + x]; }
  void SetLabels(const cv::Rect& area, CutLabel label) {
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) Label(x, y) = label;
    }
  }
  static bool Handle(int x, int y) { return x >= 60 && x < 130 && std::abs(y - 70) < 3; }
  static bool DarkSquare(int x, int y) { return (x / 14 + y / 14) % 2 == 0; }
};

PanOnMat MakePan(const Eigen::Vector3f& disc, const Eigen::Vector3f& handle) {
  PanOnMat pan;
  pan.evidence.albedo = pan.evidence.difference = pan.evidence.pattern =
      core::FloatImage(kPanSide, kPanSide, 1);
  pan.evidence.expected = core::Image(kPanSide, kPanSide, 3);
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0.0f, 3.0f);
  for (int y = 0; y < kPanSide; ++y) {
    for (int x = 0; x < kPanSide; ++x) {
      const bool in_disc = std::hypot(x - 45.0, y - 70.0) < 24.0;
      const bool inside = in_disc || PanOnMat::Handle(x, y);
      const Eigen::Vector3f mat = PanOnMat::DarkSquare(x, y) ? kDarkInk : kLightInk;
      const Eigen::Vector3f color = in_disc ? disc : inside ? handle : mat;
      float squared = 0.0f;
      for (int c = 0; c < 3; ++c) {
        const float value = std::clamp(color[c] + noise(random), 0.0f, 255.0f);
        pan.photo.At(x, y)[c] = static_cast<std::uint8_t>(std::lround(value));
        pan.evidence.expected.At(x, y)[c] = static_cast<std::uint8_t>(mat[c]);
        squared += (value - mat[c]) * (value - mat[c]);
      }
      *pan.evidence.difference.At(x, y) = std::sqrt(squared / 3.0f) / kPanDeviation;
      // Windows around the thin handle show the pattern in part.
      *pan.evidence.pattern.At(x, y) = in_disc ? 0.1f : inside ? 0.5f : 0.95f;
      pan.truth.at<std::uint8_t>(y, x) = inside;
      if (in_disc) pan.Label(x, y) = CutLabel::kObject;
      if (inside && !in_disc && !PanOnMat::DarkSquare(x, y)) {
        pan.Label(x, y) = CutLabel::kLikelyObject;
      }
    }
  }
  return pan;
}

// Returns the object's pixels of a cut, CV_8U.
cv::Mat InsideOf(const MatCut& cut) {
  cv::Mat inside(kPanSide, kPanSide, CV_8U);
  for (int y = 0; y < kPanSide; ++y) {
    for (int x = 0; x < kPanSide; ++x) inside.at<std::uint8_t>(y, x) = *cut.inside.At(x, y) > 0.0f;
  }
  return inside;
}

double PanIou(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

// The handle has almost the colour of half of the mat's squares.
TEST(MatCut, AHandleOfTheMatsColourIsFound) {
  const PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  EXPECT_GT(PanIou(InsideOf(CutFromMat(pan.photo, pan.evidence, pan.labels, nullptr)), pan.truth),
            0.97);
}

TEST(MatCut, ColoursThatTheMatExplainsAsWellAreUnsure) {
  const PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  const MatCut cut = CutFromMat(pan.photo, pan.evidence, pan.labels, nullptr);
  int over_dark = 0, unsure_over_dark = 0, elsewhere = 0, unsure_elsewhere = 0;
  for (int y = 0; y < kPanSide; ++y) {
    for (int x = 0; x < kPanSide; ++x) {
      const bool handle = PanOnMat::Handle(x, y) && std::hypot(x - 45.0, y - 70.0) > 26.0;
      const bool unsure = *cut.unsure.At(x, y) > 0.5f;
      (handle && PanOnMat::DarkSquare(x, y) ? over_dark : elsewhere) += 1;
      (handle && PanOnMat::DarkSquare(x, y) ? unsure_over_dark : unsure_elsewhere) += unsure;
    }
  }
  EXPECT_GT(unsure_over_dark, 0.5 * over_dark);
  EXPECT_LT(unsure_elsewhere, 0.01 * elsewhere);
}

// A cap that this photo shows beside the mat only, before a wall: other photos show its colour.
TEST(MatCut, ColoursOfOtherPhotosShowAPartBesideTheMat) {
  PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  const cv::Rect wall(100, 0, 40, 40), cap(110, 10, 20, 20);
  std::mt19937 random(4);
  std::normal_distribution<float> noise(0.0f, 3.0f);
  for (int y = wall.y; y < wall.y + wall.height; ++y) {
    for (int x = wall.x; x < wall.x + wall.width; ++x) {
      const bool in_cap = cap.contains({x, y});
      const Eigen::Vector3f color =
          in_cap ? Eigen::Vector3f(240, 240, 238) : Eigen::Vector3f(90, 130, 200);
      for (int c = 0; c < 3; ++c) {
        pan.photo.At(x, y)[c] =
            static_cast<std::uint8_t>(std::clamp(color[c] + noise(random), 0.0f, 255.0f));
      }
      *pan.evidence.difference.At(x, y) = -1.0f;
      *pan.evidence.pattern.At(x, y) = 0.0f;
      // Before the hull is known, nothing beside the mat is taken for the object.
      pan.Label(x, y) = CutLabel::kLikelyBackground;
    }
  }
  const auto share = [&](const ColorMixture* others) {
    const cv::Mat inside = InsideOf(CutFromMat(pan.photo, pan.evidence, pan.labels, others));
    EXPECT_LT(cv::countNonZero(inside(wall)), 1.05 * cap.area());
    return cv::countNonZero(inside(cap)) / static_cast<double>(cap.area());
  };
  const ColorMixture others(std::vector<Eigen::Vector3f>(100, Eigen::Vector3f(240, 240, 238)));
  EXPECT_LT(share(nullptr), 0.05);
  EXPECT_GT(share(&others), 0.95);
}

TEST(MatCut, CertainLabelsHold) {
  PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  pan.SetLabels(cv::Rect(60, 0, 80, kPanSide), CutLabel::kBackground);
  pan.SetLabels(cv::Rect(0, 0, 5, 5), CutLabel::kObject);
  const cv::Mat inside = InsideOf(CutFromMat(pan.photo, pan.evidence, pan.labels, nullptr));
  EXPECT_EQ(cv::countNonZero(inside(cv::Rect(70, 0, 70, kPanSide))), 0);
  EXPECT_EQ(cv::countNonZero(inside(cv::Rect(0, 0, 5, 5))), 25);
}

TEST(MatCut, WithoutAnObjectNothingIsInside) {
  PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  pan.SetLabels(cv::Rect(0, 0, kPanSide, kPanSide), CutLabel::kLikelyBackground);
  const MatCut cut = CutFromMat(pan.photo, pan.evidence, pan.labels, nullptr);
  EXPECT_EQ(cv::countNonZero(InsideOf(cut)), 0);
  EXPECT_EQ(std::count(cut.unsure.values.begin(), cut.unsure.values.end(), 0.0f),
            kPanSide * kPanSide);
}

TEST(MatCut, RefusesSizesThatDiffer) {
  const PanOnMat pan = MakePan({150, 150, 155}, {118, 10, 88});
  EXPECT_THROW(CutFromMat(pan.photo, pan.evidence, std::vector<CutLabel>(9), nullptr), core::Error);
}

// The closed form: a sample of one Gaussian with the deviation s has the density
// 0.95 / ((2 pi)^1.5 (s^2 + 25)^1.5) at its mean, 25 being the least variance.
TEST(ColorMixture, ASampleOfOneColourHasItsDensity) {
  const std::vector<Eigen::Vector3f> sample(500, Eigen::Vector3f(90, 120, 60));
  const ColorMixture mixture(sample);
  const double expected =
      -std::log(0.95) + 1.5 * std::log(2.0 * std::numbers::pi) + 1.5 * std::log(25.0);
  EXPECT_NEAR(mixture.Cost({90, 120, 60}), expected, 1e-3);
  EXPECT_NEAR(mixture.Cost({95, 120, 60}), expected + 0.5, 1e-3);
  // Colours that the sample lacks have the uniform share's density.
  EXPECT_NEAR(mixture.Cost({250, 10, 250}), -std::log(0.05 / std::pow(256.0, 3)), 1e-3);
}

TEST(ColorMixture, TwoColoursShareTheDensity) {
  std::vector<Eigen::Vector3f> sample(300, Eigen::Vector3f(20, 20, 20));
  sample.insert(sample.end(), 100, Eigen::Vector3f(220, 200, 20));
  const ColorMixture mixture(sample);
  EXPECT_NEAR(mixture.Cost({220, 200, 20}) - mixture.Cost({20, 20, 20}), std::log(3.0), 1e-2);
  EXPECT_THROW(ColorMixture({}), core::Error);
}

}  // namespace
}  // namespace simwright::capture
