#include "texture/painting/exemplar_generator.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/progress.h"
#include "core/random.h"

namespace simwright::texture {
namespace {

constexpr int kLeastSwatch = 32, kMostSwatch = 512;  // pixels per side
constexpr int kLeastPatch = 16, kMostPatch = 56;
constexpr int kCandidates = 500;
constexpr int kFeather = 2;         // pixels on both sides of a cut that are mixed
constexpr double kNearBest = 1.15;  // patches up to this times the least error are drawn from

cv::Mat MatOf(const core::Image& image) {
  return cv::Mat(image.height, image.width, CV_8UC(image.channels),
                 const_cast<std::uint8_t*>(image.pixels.data()))
      .clone();
}

core::Image ImageOf(const cv::Mat& mat) {
  core::Image image(mat.cols, mat.rows, mat.channels());
  for (int y = 0; y < mat.rows; ++y) {
    std::copy_n(mat.ptr(y), static_cast<std::size_t>(mat.cols) * mat.channels(), image.At(0, y));
  }
  return image;
}

int SquaredStep(const cv::Vec3b& a, const cv::Vec3b& b) {
  int sum = 0;
  for (int c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

// Fills the unknown pixels of a picture with patches of a swatch.
class Quilt {
 public:
  Quilt(const cv::Mat& swatch, cv::Mat picture, cv::Mat known, cv::Mat wanted, std::uint64_t seed)
      : swatch_(swatch),
        picture_(std::move(picture)),
        known_(std::move(known)),
        wanted_(std::move(wanted)),
        rng_(core::StreamRng(seed, 41)) {
    const int side = std::min(swatch.cols, swatch.rows);
    patch_ = std::clamp(side / 3, kLeastPatch, kMostPatch);
    overlap_ = std::max(5, patch_ / 3);
  }

  cv::Mat Fill() {
    const cv::Rect box = cv::boundingRect(wanted_);
    const int step = patch_ - overlap_;
    for (int y = box.y - overlap_; y < box.y + box.height; y += step) {
      core::CheckCancelled();
      for (int x = box.x - overlap_; x < box.x + box.width; x += step) {
        const cv::Rect place =
            cv::Rect(x, y, patch_, patch_) & cv::Rect(0, 0, picture_.cols, picture_.rows);
        if (place.empty() || cv::countNonZero(wanted_(place)) == 0) continue;
        Lay(place, BestSource(place));
      }
    }
    return picture_;
  }

 private:
  // The pixels of a place that are known, every other one of large places.
  struct KnownPixel {
    int x, y;
    cv::Vec3b color;
  };

  std::vector<KnownPixel> KnownOf(const cv::Rect& place) const {
    std::vector<KnownPixel> pixels;
    for (int y = 0; y < place.height; ++y) {
      for (int x = 0; x < place.width; ++x) {
        if (known_.at<std::uint8_t>(place.y + y, place.x + x) == 0 || (x + y) % 2 != 0) continue;
        pixels.push_back({x, y, picture_.at<cv::Vec3b>(place.y + y, place.x + x)});
      }
    }
    return pixels;
  }

  cv::Point RandomSource(const cv::Rect& place) {
    return {static_cast<int>(core::UniformIndex(rng_, swatch_.cols - place.width + 1)),
            static_cast<int>(core::UniformIndex(rng_, swatch_.rows - place.height + 1))};
  }

  cv::Point BestSource(const cv::Rect& place) {
    const std::vector<KnownPixel> known = KnownOf(place);
    if (known.empty()) return RandomSource(place);
    std::vector<std::pair<double, cv::Point>> candidates;
    double best = 1e300;
    for (int k = 0; k < kCandidates; ++k) {
      const cv::Point at = RandomSource(place);
      double error = 0.0;
      for (const KnownPixel& pixel : known) {
        error += SquaredStep(swatch_.at<cv::Vec3b>(at.y + pixel.y, at.x + pixel.x), pixel.color);
        if (error > kNearBest * best) break;
      }
      best = std::min(best, error);
      candidates.emplace_back(error, at);
    }
    std::erase_if(candidates, [&](const auto& one) { return one.first > kNearBest * best + 1.0; });
    return candidates[static_cast<std::size_t>(
                          core::UniformIndex(rng_, static_cast<std::int64_t>(candidates.size())))]
        .second;
  }

  // The square of the difference between what is there and the patch; where nothing is there, the
  // patch is free.
  cv::Mat DifferenceAt(const cv::Rect& place, const cv::Point& source) const {
    cv::Mat error(place.height, place.width, CV_32F, cv::Scalar(0));
    for (int y = 0; y < place.height; ++y) {
      for (int x = 0; x < place.width; ++x) {
        if (known_.at<std::uint8_t>(place.y + y, place.x + x) == 0) continue;
        error.at<float>(y, x) =
            static_cast<float>(SquaredStep(picture_.at<cv::Vec3b>(place.y + y, place.x + x),
                                           swatch_.at<cv::Vec3b>(source.y + y, source.x + x)));
      }
    }
    return error;
  }

  // Returns for each row the column from which the patch replaces what is there: the path of least
  // difference from top to bottom within the overlap.
  std::vector<int> Cut(const cv::Mat& error) const {
    const int rows = error.rows, width = std::min(overlap_, error.cols);
    cv::Mat sum = error(cv::Rect(0, 0, width, rows)).clone();
    for (int y = 1; y < rows; ++y) {
      for (int x = 0; x < width; ++x) {
        float least = sum.at<float>(y - 1, x);
        if (x > 0) least = std::min(least, sum.at<float>(y - 1, x - 1));
        if (x + 1 < width) least = std::min(least, sum.at<float>(y - 1, x + 1));
        sum.at<float>(y, x) += least;
      }
    }
    std::vector<int> cut(static_cast<std::size_t>(rows));
    int at = 0;
    for (int x = 1; x < width; ++x) {
      if (sum.at<float>(rows - 1, x) < sum.at<float>(rows - 1, at)) at = x;
    }
    for (int y = rows - 1; y >= 0; --y) {
      cut[static_cast<std::size_t>(y)] = at;
      if (y == 0) break;
      int next = at;
      for (const int x : {at - 1, at + 1}) {
        if (x < 0 || x >= width) continue;
        if (sum.at<float>(y - 1, x) < sum.at<float>(y - 1, next)) next = x;
      }
      at = next;
    }
    return cut;
  }

  void Lay(const cv::Rect& place, const cv::Point& source) {
    const cv::Mat error = DifferenceAt(place, source);
    const std::vector<int> left = Cut(error);
    const std::vector<int> top = Cut(error.t());
    for (int y = 0; y < place.height; ++y) {
      for (int x = 0; x < place.width; ++x) {
        std::uint8_t& known = known_.at<std::uint8_t>(place.y + y, place.x + x);
        if (wanted_.at<std::uint8_t>(place.y + y, place.x + x) == 0) continue;
        cv::Vec3b& color = picture_.at<cv::Vec3b>(place.y + y, place.x + x);
        const cv::Vec3b& patch = swatch_.at<cv::Vec3b>(source.y + y, source.x + x);
        // The distance (pixels) past the nearer cut; mixed about it.
        const int past =
            std::min(x - left[static_cast<std::size_t>(y)], y - top[static_cast<std::size_t>(x)]);
        const double share = std::clamp(0.5 + 0.5 * past / kFeather, 0.0, 1.0);
        if (known == 0) {
          color = patch;
        } else {
          for (int c = 0; c < 3; ++c) {
            color[c] = cv::saturate_cast<std::uint8_t>(color[c] + share * (patch[c] - color[c]));
          }
        }
        known = 255;
      }
    }
  }

  const cv::Mat& swatch_;
  cv::Mat picture_, known_, wanted_;
  core::Rng rng_;
  int patch_ = 32, overlap_ = 8;
};

double MeanDepth(const core::FloatImage& depth) {
  double sum = 0.0, count = 0.0;
  for (const float value : depth.values) {
    if (!(value > 0.0f)) continue;
    sum += value;
    ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

// Returns the swatch at the scale of the view.
cv::Mat ScaledSwatch(const Swatch& swatch, const ImageRequest& request) {
  const double depth = MeanDepth(request.depth);
  if (!(depth > 0.0) || !(request.camera.fx > 0.0)) return MatOf(swatch.picture);
  return MatOf(Rescaled(swatch, depth / request.camera.fx).picture);
}

}  // namespace

ExemplarGenerator::ExemplarGenerator(Swatch swatch) : swatch_(std::move(swatch)) {
  const core::Image& picture = swatch_.picture;
  if (picture.channels != 3 || std::min(picture.width, picture.height) < kLeastSwatch ||
      !(swatch_.pixel_size > 0.0)) {
    throw core::Error("a swatch is an RGB picture of at least 32 pixels per side");
  }
}

core::Image ExemplarGenerator::Generate(const ImageRequest& request) {
  const cv::Mat swatch = ScaledSwatch(swatch_, request);
  if (request.render.empty()) {
    cv::Mat picture(request.height, request.width, CV_8UC3, cv::Scalar(0, 0, 0));
    const cv::Mat known(picture.size(), CV_8U, cv::Scalar(0));
    const cv::Mat wanted(picture.size(), CV_8U, cv::Scalar(255));
    return ImageOf(Quilt(swatch, picture, known.clone(), wanted, request.seed).Fill());
  }
  const cv::Mat picture = MatOf(request.render);
  cv::Mat known(picture.size(), CV_8U, cv::Scalar(0)), wanted = known.clone();
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      if (!(*request.depth.At(x, y) > 0.0f)) continue;
      const bool keep = *request.trimap.At(x, y) == kTrimapKeep;
      const cv::Vec3b color = picture.at<cv::Vec3b>(y, x);
      // The grey of unpainted surface.
      const bool painted = color != cv::Vec3b(128, 128, 128);
      const bool is_band = *request.trimap.At(x, y) == kTrimapGenerate && painted;
      if (!keep) wanted.at<std::uint8_t>(y, x) = 255;
      if (painted && (keep || is_band)) known.at<std::uint8_t>(y, x) = 255;
    }
  }
  return ImageOf(Quilt(swatch, picture, known, wanted, request.seed).Fill());
}

Swatch Rescaled(const Swatch& swatch, double pixel_size) {
  const cv::Mat picture = MatOf(swatch.picture);
  const double side = std::min(picture.cols, picture.rows);
  const double factor = std::clamp(swatch.pixel_size / pixel_size, (kLeastSwatch + 0.5) / side,
                                   (kMostSwatch + 0.5) / side);
  if (std::abs(factor - 1.0) < 0.01) return swatch;
  cv::Mat scaled;
  cv::resize(picture, scaled, {}, factor, factor, factor < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  return {ImageOf(scaled), swatch.pixel_size / factor};
}

core::Image WithoutShading(const core::Image& picture) {
  cv::Mat linear;
  MatOf(picture).convertTo(linear, CV_32FC3, 1.0 / 255.0);
  cv::Mat light, slow;
  cv::cvtColor(linear, light, cv::COLOR_RGB2GRAY);
  const double sigma = 0.22 * std::min(picture.width, picture.height);
  cv::GaussianBlur(light, slow, {0, 0}, sigma, sigma, cv::BORDER_REFLECT);
  const double mean = cv::mean(slow)[0];
  for (int y = 0; y < linear.rows; ++y) {
    for (int x = 0; x < linear.cols; ++x) {
      const float gain =
          std::clamp(static_cast<float>(mean) / std::max(0.02f, slow.at<float>(y, x)), 0.5f, 2.0f);
      linear.at<cv::Vec3f>(y, x) *= gain;
    }
  }
  cv::Mat bytes;
  linear.convertTo(bytes, CV_8UC3, 255.0);
  return ImageOf(bytes);
}

core::Image LargestSwatch(const core::Image& picture, const core::Image& mask, int side,
                          double* scale) {
  cv::Mat inside(picture.height, picture.width, CV_8U, cv::Scalar(255));
  if (!mask.empty()) cv::threshold(MatOf(mask), inside, 200, 255, cv::THRESH_BINARY);
  const cv::Rect object = cv::boundingRect(inside);
  const int margin = std::max(1, static_cast<int>(0.03 * std::max(object.width, object.height)));
  if (!mask.empty()) {
    cv::erode(inside, inside, cv::Mat::ones(2 * margin + 1, 2 * margin + 1, CV_8U));
  }
  // The largest square that ends at each pixel.
  cv::Mat squares(inside.size(), CV_32S, cv::Scalar(0));
  int largest = 0;
  cv::Point corner;
  for (int y = 0; y < inside.rows; ++y) {
    for (int x = 0; x < inside.cols; ++x) {
      if (inside.at<std::uint8_t>(y, x) == 0) continue;
      int& here = squares.at<int>(y, x);
      here = 1;
      if (x > 0 && y > 0) {
        here += std::min(
            {squares.at<int>(y - 1, x), squares.at<int>(y, x - 1), squares.at<int>(y - 1, x - 1)});
      }
      if (here > largest) {
        largest = here;
        corner = {x, y};
      }
    }
  }
  if (largest < kLeastSwatch) {
    throw core::Error("no square of 32 pixels lies inside the object", "exemplar",
                      "give a larger picture of the material");
  }
  const cv::Rect square(corner.x - largest + 1, corner.y - largest + 1, largest, largest);
  core::Image swatch(largest, largest, 3);
  for (int y = 0; y < largest; ++y) {
    for (int x = 0; x < largest; ++x) {
      const std::uint8_t* from = picture.At(square.x + x, square.y + y);
      for (int c = 0; c < 3; ++c) swatch.At(x, y)[c] = from[picture.channels < 3 ? 0 : c];
    }
  }
  *scale = 1.0;
  if (largest > side) {
    *scale = static_cast<double>(side) / largest;
    swatch = core::Resize(swatch, side, side);
  }
  return swatch;
}

}  // namespace simwright::texture
