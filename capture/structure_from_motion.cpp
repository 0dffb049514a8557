#include "capture/structure_from_motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <opencv2/calib3d.hpp>

#include "capture/structure_adjustment.h"
#include "capture/track_triangulation.h"
#include "core/error.h"

namespace simwright::capture {
namespace {

constexpr double kUsualFocal = 0.85;      // in longer sides, where EXIF says nothing
constexpr double kFullFrameWidth = 36.0;  // mm, of EXIF's equivalent focal lengths
constexpr std::size_t kPairsTried = 60;   // as the first pair
constexpr int kPhotosPerAdjustment = 3;   // that are added between two adjustments
constexpr int kPhotosForFullLens = 10;    // fewer do not determine the principal point
constexpr double kLeastInliers = 0.25;    // share of a photo's points that fit its pose
constexpr int kRansacSeed = 1;            // of OpenCV's generator

// The observation of a track in a photo, or null.
const Eigen::Vector2d* PixelIn(const FeatureTrack& track, int photo) {
  const auto at = std::lower_bound(track.photos.begin(), track.photos.end(), photo);
  if (at == track.photos.end() || *at != photo) return nullptr;
  return &track.pixels[static_cast<std::size_t>(at - track.photos.begin())];
}

Eigen::Isometry3d PoseFrom(const cv::Mat& rotation, const cv::Mat& translation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      pose.linear()(row, column) = rotation.at<double>(row, column);
    }
    pose.translation()[row] = translation.at<double>(row);
  }
  return pose;
}

class StructureBuilder {
 public:
  StructureBuilder(StructureInput input, const StructureOptions& options, core::Progress* progress)
      : input_(std::move(input)),
        options_(options),
        limits_{options.inlier_pixels, options.least_angle},
        progress_(progress) {}

  Structure Run();

 private:
  struct Pair {
    int a = 0, b = 0;
    std::vector<int> tracks;
  };

  void StartLenses();
  std::vector<Pair> Pairs() const;
  bool Start();
  // Places two photos and their points. Returns false where the median angle between the rays is
  // under `least_angle`, rad, or too few points result.
  bool StartFrom(const Pair& pair, double least_angle);
  // Returns the photo that sees most reconstructed points, or -1.
  int NextPhoto(const std::set<int>& refused) const;
  bool AddPhoto(int photo);
  void AddPhotos();
  // Places the points of all tracks that have none yet.
  void Triangulate();
  // Adjusts all that is placed, and drops the observations whose errors stay large.
  void Adjust(LensFit fit);
  // Lenses with too few placed photos take over the values of their turned size.
  void CopyTurnedLenses();
  void Finish();

  const Lens& LensOf(int photo) const {
    return structure_
        .lenses[static_cast<std::size_t>(structure_.views[static_cast<std::size_t>(photo)].lens)];
  }
  double Tolerance(int photo) const { return ErrorLimit(LensOf(photo), options_.inlier_pixels); }
  // Returns the point of the image plane (z = 1) that the lens shows at a pixel.
  cv::Point2d Straight(int photo, const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d at = DirectionOf(LensOf(photo), pixel);
    return {at.x(), at.y()};
  }

  StructureInput input_;  // its tracks move into structure_
  const StructureOptions& options_;
  TriangulationLimits limits_;
  core::Progress* progress_;
  Structure structure_;
  std::vector<double> focal_priors_;  // per lens, pixels; 0: none
  std::vector<int> point_of_track_;   // index into structure_.points, or -1
};

void StructureBuilder::StartLenses() {
  std::map<std::pair<int, int>, int> by_size;
  std::vector<std::vector<double>> exif;
  structure_.views.resize(input_.photos.size());
  for (std::size_t i = 0; i < input_.photos.size(); ++i) {
    const StructureInput::Photo& photo = input_.photos[i];
    const auto [found, fresh] = by_size.try_emplace({photo.width, photo.height},
                                                    static_cast<int>(structure_.lenses.size()));
    structure_.views[i].lens = found->second;
    const double longer = std::max(photo.width, photo.height);
    if (fresh) {
      Lens lens;
      lens.width = photo.width;
      lens.height = photo.height;
      lens.fx = lens.fy = kUsualFocal * longer;
      lens.cx = 0.5 * photo.width;
      lens.cy = 0.5 * photo.height;
      structure_.lenses.push_back(lens);
      exif.emplace_back();
    }
    if (photo.focal_35mm > 0.0) {
      exif[static_cast<std::size_t>(found->second)].push_back(photo.focal_35mm / kFullFrameWidth *
                                                              longer);
    }
  }
  for (std::size_t l = 0; l < exif.size(); ++l) {
    focal_priors_.push_back(0.0);
    if (exif[l].empty()) continue;
    std::nth_element(exif[l].begin(), exif[l].begin() + exif[l].size() / 2, exif[l].end());
    focal_priors_[l] = exif[l][exif[l].size() / 2];
    structure_.lenses[l].fx = structure_.lenses[l].fy = focal_priors_[l];
  }
}

// Returns the pairs of photos by the number of their tracks, most first.
std::vector<StructureBuilder::Pair> StructureBuilder::Pairs() const {
  std::map<std::pair<int, int>, std::vector<int>> shared;
  for (std::size_t t = 0; t < structure_.tracks.size(); ++t) {
    const std::vector<int>& photos = structure_.tracks[t].photos;
    for (std::size_t i = 0; i < photos.size(); ++i) {
      for (std::size_t j = i + 1; j < photos.size(); ++j) {
        shared[{photos[i], photos[j]}].push_back(static_cast<int>(t));
      }
    }
  }
  std::vector<Pair> pairs;
  for (auto& [photos, tracks] : shared) {
    if (static_cast<int>(tracks.size()) < options_.least_points) continue;
    pairs.push_back({photos.first, photos.second, std::move(tracks)});
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.tracks.size() > b.tracks.size(); });
  return pairs;
}

bool StructureBuilder::StartFrom(const Pair& pair, double least_angle) {
  std::vector<cv::Point2d> at_a, at_b;
  for (const int t : pair.tracks) {
    const FeatureTrack& track = structure_.tracks[static_cast<std::size_t>(t)];
    at_a.push_back(Straight(pair.a, *PixelIn(track, pair.a)));
    at_b.push_back(Straight(pair.b, *PixelIn(track, pair.b)));
  }
  const cv::Mat identity = cv::Mat::eye(3, 3, CV_64F);
  cv::Mat inliers, rotation, translation;
  cv::setRNGSeed(kRansacSeed);
  const cv::Mat essential = cv::findEssentialMat(at_a, at_b, identity, cv::RANSAC, 0.9999,
                                                 Tolerance(pair.a) / LensOf(pair.a).fx, inliers);
  if (essential.rows != 3) return false;
  const int front =
      cv::recoverPose(essential, at_a, at_b, identity, rotation, translation, inliers);
  if (front < options_.least_points) return false;
  const Eigen::Isometry3d b_from_a = PoseFrom(rotation, translation);
  std::vector<double> angles;
  for (std::size_t i = 0; i < at_a.size(); ++i) {
    if (inliers.at<std::uint8_t>(static_cast<int>(i)) == 0) continue;
    const Eigen::Vector3d ray_a(at_a[i].x, at_a[i].y, 1.0);
    const Eigen::Vector3d ray_b =
        b_from_a.linear().transpose() * Eigen::Vector3d(at_b[i].x, at_b[i].y, 1.0);
    angles.push_back(std::atan2(ray_a.cross(ray_b).norm(), ray_a.dot(ray_b)));
  }
  std::nth_element(angles.begin(), angles.begin() + angles.size() / 2, angles.end());
  if (angles[angles.size() / 2] < least_angle) return false;
  Structure::View& first = structure_.views[static_cast<std::size_t>(pair.a)];
  Structure::View& second = structure_.views[static_cast<std::size_t>(pair.b)];
  first.world_from_camera.setIdentity();
  second.world_from_camera = b_from_a.inverse();
  first.registered = second.registered = true;
  Triangulate();
  Adjust(LensFit::kUsual);
  if (static_cast<int>(structure_.points.size()) >= options_.least_points) return true;
  first.registered = second.registered = false;
  structure_.points.clear();
  std::fill(point_of_track_.begin(), point_of_track_.end(), -1);
  return false;
}

bool StructureBuilder::Start() {
  const std::vector<Pair> pairs = Pairs();
  // A wide angle makes the first points accurate; where none is, a smaller one has to do.
  for (const double share : {1.0, 0.5, 0.25}) {
    for (std::size_t i = 0; i < std::min(pairs.size(), kPairsTried); ++i) {
      core::CheckCancelled();
      if (StartFrom(pairs[i], share * options_.first_pair_angle)) return true;
    }
  }
  return false;
}

int StructureBuilder::NextPhoto(const std::set<int>& refused) const {
  std::vector<int> seen(input_.photos.size(), 0);
  for (const Structure::Point& point : structure_.points) {
    for (const int photo : structure_.tracks[static_cast<std::size_t>(point.track)].photos) {
      ++seen[static_cast<std::size_t>(photo)];
    }
  }
  int best = -1;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (structure_.views[i].registered || refused.contains(static_cast<int>(i))) continue;
    if (seen[i] < options_.least_points) continue;
    if (best < 0 || seen[i] > seen[static_cast<std::size_t>(best)]) best = static_cast<int>(i);
  }
  return best;
}

bool StructureBuilder::AddPhoto(int photo) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const Structure::Point& point : structure_.points) {
    const FeatureTrack& track = structure_.tracks[static_cast<std::size_t>(point.track)];
    const Eigen::Vector2d* pixel = PixelIn(track, photo);
    if (pixel == nullptr) continue;
    points.emplace_back(point.position.x(), point.position.y(), point.position.z());
    pixels.push_back(Straight(photo, *pixel));
  }
  cv::Mat rotation, translation, matrix, inliers;
  cv::setRNGSeed(kRansacSeed);
  const bool found = cv::solvePnPRansac(
      points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation, translation, false, 1000,
      static_cast<float>(2.0 * Tolerance(photo) / LensOf(photo).fx), 0.9999, inliers,
      cv::SOLVEPNP_SQPNP);
  if (!found || inliers.rows < options_.least_points ||
      inliers.rows < kLeastInliers * static_cast<double>(points.size())) {
    return false;
  }
  cv::Rodrigues(rotation, matrix);
  Structure::View& view = structure_.views[static_cast<std::size_t>(photo)];
  view.world_from_camera = PoseFrom(matrix, translation).inverse();
  view.registered = true;
  return true;
}

void StructureBuilder::Triangulate() {
  for (std::size_t t = 0; t < structure_.tracks.size(); ++t) {
    if (point_of_track_[t] >= 0) continue;
    const std::optional<Eigen::Vector3d> point =
        TriangulateTrack(structure_, limits_, &structure_.tracks[t]);
    if (!point) continue;
    point_of_track_[t] = static_cast<int>(structure_.points.size());
    structure_.points.push_back({*point, static_cast<int>(t)});
  }
}

void StructureBuilder::CopyTurnedLenses() {
  std::vector<int> placed(structure_.lenses.size(), 0);
  for (const Structure::View& view : structure_.views) {
    placed[static_cast<std::size_t>(view.lens)] += view.registered;
  }
  for (std::size_t l = 0; l < structure_.lenses.size(); ++l) {
    if (placed[l] >= 3) continue;
    for (std::size_t other = 0; other < structure_.lenses.size(); ++other) {
      const Lens& from = structure_.lenses[other];
      Lens& to = structure_.lenses[l];
      if (placed[other] < 3 || from.width != to.height || from.height != to.width) continue;
      to.fx = to.fy = from.fx;
      to.k1 = from.k1;
      to.k2 = from.k2;
    }
  }
}

void StructureBuilder::Adjust(LensFit fit) {
  CopyTurnedLenses();
  AdjustStructure(fit, focal_priors_, &structure_);
  std::vector<Structure::Point> kept;
  std::fill(point_of_track_.begin(), point_of_track_.end(), -1);
  for (const Structure::Point& point : structure_.points) {
    const auto track = static_cast<std::size_t>(point.track);
    if (!KeepAgreeing(structure_, limits_, point.position, &structure_.tracks[track])) continue;
    point_of_track_[track] = static_cast<int>(kept.size());
    kept.push_back(point);
  }
  structure_.points = std::move(kept);
}

void StructureBuilder::AddPhotos() {
  std::set<int> refused;
  int added = 0;
  for (int photo = NextPhoto(refused); photo >= 0; photo = NextPhoto(refused)) {
    progress_->Advance();
    if (!AddPhoto(photo)) {
      refused.insert(photo);
      continue;
    }
    Triangulate();
    if (++added % kPhotosPerAdjustment != 0) continue;
    Adjust(LensFit::kUsual);
    Triangulate();
    refused.clear();
  }
}

void StructureBuilder::Finish() {
  double all = 0.0;
  int count = 0;
  std::vector<double> sums(input_.photos.size(), 0.0);
  for (const Structure::Point& point : structure_.points) {
    const FeatureTrack& track = structure_.tracks[static_cast<std::size_t>(point.track)];
    for (std::size_t k = 0; k < track.photos.size(); ++k) {
      const auto photo = static_cast<std::size_t>(track.photos[k]);
      Structure::View& view = structure_.views[photo];
      if (!view.registered) continue;
      const Eigen::Vector3d at = view.world_from_camera.inverse() * point.position;
      const double squared = (LensOf(track.photos[k]).Project(at) - track.pixels[k]).squaredNorm();
      sums[photo] += squared;
      all += squared;
      ++view.points;
      ++count;
    }
  }
  structure_.error = count > 0 ? std::sqrt(all / count) : 0.0;
  for (std::size_t i = 0; i < input_.photos.size(); ++i) {
    Structure::View& view = structure_.views[i];
    if (view.points > 0) view.error = std::sqrt(sums[i] / view.points);
    if (view.registered) continue;
    structure_.findings.push_back(
        {"photo-not-placed", core::Severity::kWarning, input_.photos[i].name,
         "the photo shares too little with the others to be placed: it is left out", 0.0,
         "take photos that overlap by half, of a textured table or on a mat"});
  }
}

Structure StructureBuilder::Run() {
  input_.Validate();
  StartLenses();
  structure_.tracks = std::move(input_.tracks);
  point_of_track_.assign(structure_.tracks.size(), -1);
  progress_->Stage("cameras", static_cast<int>(input_.photos.size()));
  if (!Start()) {
    throw core::Error("no two photos show the same scene from different places", "cameras",
                      "take overlapping photos of a textured table, or use a mat (simwright mat)");
  }
  AddPhotos();
  // Photos and points that a lens not yet adjusted had refused get another chance.
  for (int round = 0; round < 2; ++round) {
    Adjust(LensFit::kUsual);
    Triangulate();
    AddPhotos();
  }
  const auto placed = std::count_if(structure_.views.begin(), structure_.views.end(),
                                    [](const Structure::View& view) { return view.registered; });
  for (int round = 0; round < 2; ++round) {
    Adjust(placed >= kPhotosForFullLens ? LensFit::kFull : LensFit::kUsual);
    Triangulate();
  }
  Adjust(placed >= kPhotosForFullLens ? LensFit::kFull : LensFit::kUsual);
  Finish();
  return std::move(structure_);
}

}  // namespace

void StructureInput::Validate() const {
  if (photos.size() < 3) {
    throw core::Error("cameras need at least 3 photos, not " + std::to_string(photos.size()),
                      "structure from motion");
  }
  for (const Photo& photo : photos) {
    if (photo.width < 1 || photo.height < 1) throw core::Error("has no pixels", photo.name);
  }
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    int last = -1;
    for (const int photo : tracks[t].photos) {
      if (photo <= last || photo >= static_cast<int>(photos.size())) {
        throw core::Error(
            "names photo " + std::to_string(photo) + " after photo " + std::to_string(last),
            "track " + std::to_string(t));
      }
      last = photo;
    }
    if (tracks[t].photos.size() != tracks[t].pixels.size()) {
      throw core::Error("has another number of pixels than photos", "track " + std::to_string(t));
    }
  }
}

Structure ReconstructStructure(StructureInput input, const StructureOptions& options,
                               core::Progress* progress) {
  return StructureBuilder(std::move(input), options, progress).Run();
}

}  // namespace simwright::capture
