#include "capture/feature_tracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr float kLeastProduct = 0.75f;  // of descriptors that match: a distance of 0.7

struct PhotoFeatures {
  std::vector<cv::KeyPoint> points;  // scaled down
  cv::Mat descriptors;               // (N x 128), float, by RootSIFT
  double scale = 1.0;                // of the photo over the image in which they were found
  double sharpness = 0.0;            // PhotoTracks
};

// Returns the 95th percentile of the change of grey values between neighbouring pixels.
double SharpnessOf(const cv::Mat& grey) {
  std::array<std::int64_t, 256> counts{};
  for (int y = 0; y < grey.rows; ++y) {
    const std::uint8_t* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x + 1 < grey.cols; ++x) {
      ++counts[static_cast<std::size_t>(std::abs(row[x + 1] - row[x]))];
    }
  }
  std::int64_t left = static_cast<std::int64_t>(grey.rows) * (grey.cols - 1) / 20;
  for (int change = 255; change >= 0; --change) {
    left -= counts[static_cast<std::size_t>(change)];
    if (left <= 0) return change;
  }
  return 0.0;
}

PhotoFeatures FeaturesOf(const core::Image& photo, const FeatureTrackOptions& options) {
  PhotoFeatures features;
  const cv::Mat image(photo.height, photo.width, CV_8UC(photo.channels),
                      const_cast<std::uint8_t*>(photo.pixels.data()));
  cv::Mat grey = image;
  if (photo.channels > 1) {
    cv::cvtColor(image, grey, photo.channels == 4 ? cv::COLOR_RGBA2GRAY : cv::COLOR_RGB2GRAY);
  }
  features.scale =
      std::max(1.0, static_cast<double>(std::max(photo.width, photo.height)) / options.max_side);
  if (features.scale > 1.0) {
    cv::resize(grey, grey, {}, 1.0 / features.scale, 1.0 / features.scale, cv::INTER_AREA);
  }
  features.sharpness = SharpnessOf(grey);
  cv::SIFT::create(options.max_features, 3, 0.02)
      ->detectAndCompute(grey, cv::noArray(), features.points, features.descriptors);
  // RootSIFT (Arandjelovic and Zisserman 2012): the square roots of the shares of each bin.
  for (int i = 0; i < features.descriptors.rows; ++i) {
    cv::Mat row = features.descriptors.row(i);
    row /= std::max(1e-7, cv::norm(row, cv::NORM_L1));
    cv::sqrt(row, row);
  }
  return features;
}

// The best match of a descriptor and the product of the second best.
struct NearestTwo {
  int best = -1;
  float first = -2.0f, second = -2.0f;

  void Offer(int candidate, float product) {
    if (product > first) {
      second = first;
      first = product;
      best = candidate;
    } else if (product > second) {
      second = product;
    }
  }
  // Descriptors have unit length, so squared distances are 2 - 2 product.
  bool IsDistinct(double ratio) const {
    return best >= 0 && first > kLeastProduct && 1.0f - first < ratio * ratio * (1.0f - second);
  }
};

using DescriptorRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::Map<const DescriptorRows> RowsOf(const cv::Mat& descriptors) {
  return {descriptors.ptr<float>(), descriptors.rows, descriptors.cols};
}

using Matches = std::vector<std::pair<int, int>>;

// Returns the pairs of descriptors that are each other's nearest among those that `admits(i, j)`,
// each by Lowe's ratio.
template <typename Admits>
Matches MutualNearest(const cv::Mat& a, const cv::Mat& b, double ratio, const Admits& admits) {
  constexpr int kBlock = 256;  // rows whose products are kept at a time
  std::vector<NearestTwo> of_a(static_cast<std::size_t>(a.rows)),
      of_b(static_cast<std::size_t>(b.rows));
  const auto rows_a = RowsOf(a), rows_b = RowsOf(b);
  DescriptorRows products;
  for (int from = 0; from < a.rows; from += kBlock) {
    const int count = std::min(kBlock, a.rows - from);
    products.noalias() = rows_a.middleRows(from, count) * rows_b.transpose();
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < b.rows; ++j) {
        if (!admits(from + i, j)) continue;
        of_a[static_cast<std::size_t>(from + i)].Offer(j, products(i, j));
        of_b[static_cast<std::size_t>(j)].Offer(from + i, products(i, j));
      }
    }
  }
  Matches pairs;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const NearestTwo& forth = of_a[i];
    if (!forth.IsDistinct(ratio)) continue;
    const NearestTwo& back = of_b[static_cast<std::size_t>(forth.best)];
    if (back.best != static_cast<int>(i) || !back.IsDistinct(ratio)) continue;
    pairs.emplace_back(static_cast<int>(i), forth.best);
  }
  return pairs;
}

// Matches features again among those near each other's epipolar lines: with fewer candidates, more
// matches are distinct. `fundamental`: b' F a = 0.
Matches MatchAlongLines(const PhotoFeatures& a, const PhotoFeatures& b, const cv::Mat& fundamental,
                        const FeatureTrackOptions& options) {
  std::vector<cv::Vec3f> lines;
  const cv::Matx33d f(fundamental);
  for (const cv::KeyPoint& point : a.points) {
    const cv::Vec3d line = f * cv::Vec3d(point.pt.x, point.pt.y, 1.0);
    const double norm = std::max(1e-12, std::hypot(line[0], line[1]));
    lines.emplace_back(static_cast<float>(line[0] / norm), static_cast<float>(line[1] / norm),
                       static_cast<float>(line[2] / norm));
  }
  const auto limit = static_cast<float>(options.epipolar_pixels);
  return MutualNearest(a.descriptors, b.descriptors, options.ratio, [&](int i, int j) {
    const cv::Vec3f& line = lines[static_cast<std::size_t>(i)];
    const cv::Point2f& at = b.points[static_cast<std::size_t>(j)].pt;
    return std::abs(line[0] * at.x + line[1] * at.y + line[2]) < limit;
  });
}

Matches VerifiedMatches(const PhotoFeatures& a, const PhotoFeatures& b,
                        const FeatureTrackOptions& options) {
  if (a.descriptors.rows < options.least_matches || b.descriptors.rows < options.least_matches) {
    return {};
  }
  const Matches matches =
      MutualNearest(a.descriptors, b.descriptors, options.ratio, [](int, int) { return true; });
  std::vector<cv::Point2f> at_a, at_b;
  for (const auto& [i, j] : matches) {
    at_a.push_back(a.points[static_cast<std::size_t>(i)].pt);
    at_b.push_back(b.points[static_cast<std::size_t>(j)].pt);
  }
  if (static_cast<int>(matches.size()) < options.least_matches) return {};
  cv::Mat inliers;
  cv::setRNGSeed(1);  // of this thread: the same photos give the same matches
  const cv::Mat fundamental = cv::findFundamentalMat(at_a, at_b, cv::USAC_MAGSAC,
                                                     options.epipolar_pixels, 0.999, 5000, inliers);
  if (fundamental.rows != 3 || cv::countNonZero(inliers) < options.least_matches) return {};
  return MatchAlongLines(a, b, fundamental, options);
}

// Joins features that match, directly or through others.
class TrackJoiner {
 public:
  explicit TrackJoiner(const std::vector<PhotoFeatures>& features) : features_(features) {
    for (const PhotoFeatures& photo : features) {
      first_.push_back(static_cast<int>(root_.size()));
      for (std::size_t i = 0; i < photo.points.size(); ++i) {
        root_.push_back(static_cast<int>(root_.size()));
      }
    }
  }

  void Join(int photo_a, int photo_b, const Matches& matches) {
    for (const auto& [i, j] : matches) {
      root_[static_cast<std::size_t>(Find(first_[static_cast<std::size_t>(photo_a)] + i))] =
          Find(first_[static_cast<std::size_t>(photo_b)] + j);
    }
  }

  std::vector<FeatureTrack> Tracks() {
    std::map<int, FeatureTrack> by_root;
    std::map<int, bool> twice;
    for (std::size_t photo = 0; photo < features_.size(); ++photo) {
      for (std::size_t i = 0; i < features_[photo].points.size(); ++i) {
        const int root = Find(first_[photo] + static_cast<int>(i));
        FeatureTrack& track = by_root[root];
        if (!track.photos.empty() && track.photos.back() == static_cast<int>(photo)) {
          twice[root] = true;
        }
        const cv::Point2f at = features_[photo].points[i].pt;
        const double scale = features_[photo].scale;
        track.photos.push_back(static_cast<int>(photo));
        track.pixels.emplace_back((at.x + 0.5) * scale, (at.y + 0.5) * scale);
      }
    }
    std::vector<FeatureTrack> tracks;
    for (auto& [root, track] : by_root) {
      if (track.photos.size() >= 2 && !twice.contains(root)) tracks.push_back(std::move(track));
    }
    return tracks;
  }

 private:
  int Find(int i) {
    while (root_[static_cast<std::size_t>(i)] != i) {
      int& up = root_[static_cast<std::size_t>(i)];
      up = root_[static_cast<std::size_t>(up)];
      i = up;
    }
    return i;
  }

  const std::vector<PhotoFeatures>& features_;
  std::vector<int> first_;  // per photo, the index of its first feature
  std::vector<int> root_;
};

}  // namespace

PhotoTracks FindFeatureTracks(int count, const std::function<core::Image(int)>& read,
                              const FeatureTrackOptions& options, core::Progress* progress) {
  if (count < 2) throw core::Error("tracks need at least two photos", "features");
  std::vector<PhotoFeatures> features(static_cast<std::size_t>(count));
  progress->Stage("features", count);
  core::ParallelFor(count, [&](int i) {
    features[static_cast<std::size_t>(i)] = FeaturesOf(read(i), options);
    progress->Advance();
  });
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) pairs.emplace_back(a, b);
  }
  std::vector<Matches> matches(pairs.size());
  progress->Stage("matches", static_cast<int>(pairs.size()));
  core::ParallelFor(static_cast<int>(pairs.size()), [&](int p) {
    const auto& [a, b] = pairs[static_cast<std::size_t>(p)];
    matches[static_cast<std::size_t>(p)] = VerifiedMatches(
        features[static_cast<std::size_t>(a)], features[static_cast<std::size_t>(b)], options);
    progress->Advance();
  });
  TrackJoiner joiner(features);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    joiner.Join(pairs[p].first, pairs[p].second, matches[p]);
  }
  PhotoTracks result;
  result.tracks = joiner.Tracks();
  for (const PhotoFeatures& photo : features) result.sharpness.push_back(photo.sharpness);
  return result;
}

}  // namespace simwright::capture
