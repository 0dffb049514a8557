#include "twin/photo_check.h"

#include <cmath>
#include <cstddef>
#include <cstdio>

#include "core/error.h"

namespace simwright::twin {
namespace {

constexpr double kBlackMean = 14.0, kDarkMean = 45.0;  // of 255
constexpr double kPlainDeviation = 1.0;                // of 255
constexpr double kWhite = 250.0, kMostWhite = 0.5;
constexpr char kLightRemedy[] = "take it again in even light, without flash, the table in focus";

}  // namespace

core::Findings CheckTablePhoto(const core::Image& photo, const std::string& where) {
  const std::size_t pixels = photo.pixels.size() / 3;
  double sum = 0.0, squares = 0.0;
  std::size_t white = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    // Luma of Rec. 709.
    const double value = 0.2126 * photo.pixels[3 * i] + 0.7152 * photo.pixels[3 * i + 1] +
                         0.0722 * photo.pixels[3 * i + 2];
    sum += value;
    squares += value * value;
    white += value > kWhite ? 1 : 0;
  }
  const double mean = sum / static_cast<double>(pixels);
  const double deviation =
      std::sqrt(std::max(0.0, squares / static_cast<double>(pixels) - mean * mean));
  char sentence[120];
  if (mean < kBlackMean) {
    std::snprintf(sentence, sizeof sentence,
                  "the photo is too dark: its mean luminance is %.0f of 255", mean);
    throw core::Error(sentence, where, kLightRemedy);
  }
  if (deviation < kPlainDeviation) {
    throw core::Error("the photo shows nothing but one colour", where, kLightRemedy);
  }
  core::Findings findings;
  if (mean < kDarkMean) {
    std::snprintf(sentence, sizeof sentence,
                  "the photo is dark, its mean luminance is %.0f of 255; outlines may be missed",
                  mean);
    findings.push_back({"twin-dark", core::Severity::kWarning, "", sentence, mean, kLightRemedy});
  }
  const double share = static_cast<double>(white) / static_cast<double>(pixels);
  if (share > kMostWhite) {
    findings.push_back({"twin-overexposed", core::Severity::kWarning, "",
                        "more than half of the photo is white; outlines may be missed", share,
                        kLightRemedy});
  }
  return findings;
}

}  // namespace simwright::twin
