#include "capture/mat_detection.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace simwright::capture {
namespace {

// The longer sides (pixels) of the photo in which markers are searched, and the share of the
// corners from which the second search is not needed.
constexpr double kMarkerSide = 1600.0, kFineMarkerSide = 4000.0, kEnoughCorners = 0.4;

cv::Ptr<cv::aruco::Dictionary> MarkerDictionary() {
  return cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250);
}

cv::Ptr<cv::aruco::CharucoBoard> BoardOf(const CaptureMat& mat) {
  cv::Ptr<cv::aruco::CharucoBoard> board =
      cv::aruco::CharucoBoard::create(mat.columns, mat.rows, static_cast<float>(mat.square),
                                      static_cast<float>(mat.marker), MarkerDictionary());
  for (int& id : board->ids) id += mat.first_marker;
  return board;
}

cv::Mat Grey(const core::Image& photo) {
  // The pixels are only read.
  const cv::Mat image(photo.height, photo.width, CV_8UC(photo.channels),
                      const_cast<std::uint8_t*>(photo.pixels.data()));
  if (photo.channels == 1) return image.clone();
  cv::Mat grey;
  cv::cvtColor(image, grey, photo.channels == 4 ? cv::COLOR_RGBA2GRAY : cv::COLOR_RGB2GRAY);
  return grey;
}

struct Markers {
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> outlines;  // (N x 4)
};

// Returns the markers of one mat.
Markers MarkersOf(const Markers& all, const CaptureMat& mat) {
  Markers own;
  const int count = mat.columns * mat.rows / 2;
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    if (all.ids[i] < mat.first_marker || all.ids[i] >= mat.first_marker + count) continue;
    own.ids.push_back(all.ids[i]);
    own.outlines.push_back(all.outlines[i]);
  }
  return own;
}

// Returns the half width of the window in which a corner is refined: within the squares beside it.
int RefinementWindow(const Markers& markers, double scale) {
  double shortest = 1e9;
  for (const auto& outline : markers.outlines) {
    for (int k = 0; k < 4; ++k) {
      shortest = std::min(shortest, cv::norm(outline[k] - outline[(k + 1) % 4]));
    }
  }
  return std::clamp(static_cast<int>(0.12 * shortest * scale), 2, 12);
}

// Returns the standard deviation of the corners along the direction in which they vary least, m:
// corners of one line do not tell where a camera is.
double Spread(const CaptureMat& mat, const std::vector<int>& corners) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const int corner : corners) mean += mat.Corner(corner).head<2>();
  mean /= static_cast<double>(corners.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const int corner : corners) {
    const Eigen::Vector2d d = mat.Corner(corner).head<2>() - mean;
    scatter += d * d.transpose() / static_cast<double>(corners.size());
  }
  return std::sqrt(
      std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvalues()[0]));
}

// Searches the mat in `grey`, scaled down by `scale`.
std::optional<MatObservation> DetectAtScale(const cv::Mat& grey, double scale) {
  cv::Mat small = grey;
  if (scale > 1.0) cv::resize(grey, small, {}, 1.0 / scale, 1.0 / scale, cv::INTER_AREA);
  Markers all;
  cv::aruco::detectMarkers(small, MarkerDictionary(), all.outlines, all.ids);
  Markers markers;
  const CaptureMat* mat = nullptr;
  for (const CaptureMat& candidate : CaptureMats()) {
    Markers own = MarkersOf(all, candidate);
    if (own.ids.size() <= markers.ids.size()) continue;
    markers = std::move(own);
    mat = &candidate;
  }
  if (mat == nullptr || markers.ids.size() < 2) return std::nullopt;
  std::vector<cv::Point2f> corners;
  std::vector<int> ids;
  cv::aruco::interpolateCornersCharuco(markers.outlines, markers.ids, small, BoardOf(*mat), corners,
                                       ids);
  if (static_cast<int>(ids.size()) < kMinMatCorners || Spread(*mat, ids) < 0.7 * mat->square) {
    return std::nullopt;
  }
  // An image resized by areas keeps its borders: pixel centres move by half a pixel.
  for (cv::Point2f& corner : corners) {
    corner.x = static_cast<float>((corner.x + 0.5) * scale - 0.5);
    corner.y = static_cast<float>((corner.y + 0.5) * scale - 0.5);
  }
  const int window = RefinementWindow(markers, scale);
  cv::cornerSubPix(grey, corners, {window, window}, {-1, -1},
                   {cv::TermCriteria::EPS + cv::TermCriteria::MAX_ITER, 30, 0.005});
  MatObservation found;
  found.paper = mat->paper;
  found.width = grey.cols;
  found.height = grey.rows;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    found.corners.push_back(ids[i]);
    found.pixels.emplace_back(corners[i].x + 0.5, corners[i].y + 0.5);
  }
  return found;
}

}  // namespace

std::optional<MatObservation> DetectMat(const core::Image& photo) {
  if (photo.empty()) throw core::Error("the photo is empty", "mat detection");
  const cv::Mat grey = Grey(photo);
  const double longer = std::max(photo.width, photo.height);
  std::optional<MatObservation> found;
  // A photo from a low angle shows markers so flat that only more pixels resolve them.
  for (const double side : {kMarkerSide, kFineMarkerSide}) {
    const double scale = std::max(1.0, longer / side);
    std::optional<MatObservation> now = DetectAtScale(grey, scale);
    if (now && (!found || now->corners.size() > found->corners.size())) found = std::move(now);
    if (scale == 1.0) break;
    if (found && static_cast<int>(found->corners.size()) >=
                     kEnoughCorners * CaptureMatOf(found->paper).corner_count()) {
      break;
    }
  }
  return found;
}

}  // namespace simwright::capture
