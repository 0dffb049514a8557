#include "capture/mat_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <opencv2/calib3d.hpp>

#include "capture/brown_conrady.h"
#include "core/error.h"

namespace simwright::capture {
namespace {

using LensValues = std::array<double, kLensValues>;
using PoseValues = std::array<double, 6>;  // camera_from_world: rotation vector, translation

constexpr double kHuberPixels = 1.0;
constexpr double kFocalDeviation = 0.1;    // of EXIF's focal length, relative
constexpr double kCenterDeviation = 0.02;  // of the principal point, in longer sides
constexpr std::size_t kPhotosForK3 = 12;   // fewer do not determine the third coefficient
constexpr double kWrongPixels = 2.0;       // of a corner that something hides in part
constexpr double kUncertainFocal = 0.03;   // relative deviation from which a finding warns

struct CornerError {
  Eigen::Vector3d point;
  Eigen::Vector2d pixel;

  template <typename T>
  bool operator()(const T* lens, const T* pose, T* residual) const {
    const T world[3] = {T(point.x()), T(point.y()), T(point.z())};
    T at[3];
    ceres::AngleAxisRotatePoint(pose, world, at);
    for (int k = 0; k < 3; ++k) at[k] += pose[3 + k];
    if (at[2] <= T(1e-9)) return false;
    ProjectByLens(lens, at, residual);
    residual[0] -= T(pixel.x());
    residual[1] -= T(pixel.y());
    return true;
  }
};

// Keeps lens values near their usual ones where the corners do not determine them.
struct LensPrior {
  LensValues usual;
  LensValues deviation;  // 0: free

  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    for (int k = 0; k < kLensValues; ++k) {
      residual[k] = deviation[k] > 0.0 ? (lens[k] - T(usual[k])) / T(deviation[k]) : T(0.0);
    }
    return true;
  }
};

std::vector<cv::Point3f> ObjectPoints(const MatObservation& mat, double scale) {
  std::vector<cv::Point3f> points;
  for (const int corner : mat.corners) {
    const Eigen::Vector3d at = scale * CaptureMatOf(mat.paper).Corner(corner);
    points.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()), 0.0f);
  }
  return points;
}

std::vector<cv::Point2f> ImagePoints(const MatObservation& mat) {
  std::vector<cv::Point2f> points;
  for (const Eigen::Vector2d& p : mat.pixels) {
    points.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  return points;
}

// The photos of one size, which share a lens.
class LensGroup {
 public:
  LensGroup(const MatCalibrationInput& input, std::vector<int> photos)
      : input_(&input), photos_(std::move(photos)) {
    const MatObservation& first = input_->photos[static_cast<std::size_t>(photos_[0])].mat;
    width_ = first.width;
    height_ = first.height;
  }

  const std::vector<int>& photos() const { return photos_; }
  const LensValues& values() const { return lens_; }
  bool determines_lens() const { return static_cast<int>(photos_.size()) >= kMinCalibrationPhotos; }

  // Fits lens and poses. `known`: the values of another group's lens, which this one takes over
  // except for the principal point; null: fits its own.
  void Fit(const LensValues* known);

  Lens lens() const {
    Lens lens;
    lens.width = width_;
    lens.height = height_;
    lens.fx = lens.fy = lens_[kFocal];
    lens.cx = lens_[kCenterX];
    lens.cy = lens_[kCenterY];
    lens.k1 = lens_[kK1];
    lens.k2 = lens_[kK2];
    lens.k3 = lens_[kK3];
    lens.p1 = lens_[kP1];
    lens.p2 = lens_[kP2];
    return lens;
  }
  Eigen::Isometry3d WorldFromCamera(std::size_t index) const;
  // Returns the root mean square reprojection error of a photo's used corners, pixels.
  double Error(std::size_t index) const;
  double focal_deviation() const { return focal_deviation_; }  // relative; 0: not fitted

 private:
  const MatObservation& Mat(std::size_t index) const {
    return input_->photos[static_cast<std::size_t>(photos_[index])].mat;
  }
  double ExifFocal() const;
  std::vector<double> CornerErrors(std::size_t index) const;
  void DropWrongCorners();
  void Solve(bool known_lens);
  void StartLens();
  void StartPoses();
  void AddCorners(ceres::Problem* problem);
  void AddPrior(ceres::Problem* problem);
  void MeasureFocalDeviation(ceres::Problem* problem);

  const MatCalibrationInput* input_;
  std::vector<int> photos_;
  int width_ = 0, height_ = 0;
  LensValues lens_{};
  std::vector<PoseValues> poses_;
  std::vector<std::vector<char>> used_;  // per photo and corner
  double focal_deviation_ = 0.0;
};

// Returns the median focal length of the photos' EXIF blocks, pixels; 0: none.
double LensGroup::ExifFocal() const {
  std::vector<double> focal;
  for (const int photo : photos_) {
    const double mm = input_->photos[static_cast<std::size_t>(photo)].focal_35mm;
    if (mm > 0.0) focal.push_back(mm / 36.0 * std::max(width_, height_));
  }
  if (focal.empty()) return 0.0;
  std::nth_element(focal.begin(), focal.begin() + focal.size() / 2, focal.end());
  return focal[focal.size() / 2];
}

void LensGroup::StartLens() {
  lens_ = {};
  lens_[kCenterX] = 0.5 * width_;
  lens_[kCenterY] = 0.5 * height_;
  lens_[kFocal] = ExifFocal();
  if (lens_[kFocal] > 0.0) return;
  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (std::size_t i = 0; i < photos_.size(); ++i) {
    points.push_back(ObjectPoints(Mat(i), input_->print_scale));
    pixels.push_back(ImagePoints(Mat(i)));
  }
  const cv::Mat start = cv::initCameraMatrix2D(points, pixels, {width_, height_}, 1.0);
  const double longer = std::max(width_, height_);
  lens_[kFocal] = start.at<double>(0, 0);
  // Views square to the mat leave the focal length open.
  if (!std::isfinite(lens_[kFocal]) || lens_[kFocal] < 0.3 * longer ||
      lens_[kFocal] > 10.0 * longer) {
    lens_[kFocal] = 1.1 * longer;
  }
}

void LensGroup::StartPoses() {
  const cv::Matx33d matrix(lens_[kFocal], 0, lens_[kCenterX], 0, lens_[kFocal], lens_[kCenterY], 0,
                           0, 1);
  const cv::Vec<double, 5> distortion(lens_[kK1], lens_[kK2], lens_[kP1], lens_[kP2], lens_[kK3]);
  poses_.assign(photos_.size(), {});
  for (std::size_t i = 0; i < photos_.size(); ++i) {
    // The mat is a plane: of the two poses that explain it, OpenCV returns the better one first.
    std::vector<cv::Vec3d> rotations, translations;
    const int found =
        cv::solvePnPGeneric(ObjectPoints(Mat(i), input_->print_scale), ImagePoints(Mat(i)), matrix,
                            distortion, rotations, translations, false, cv::SOLVEPNP_IPPE);
    const cv::Vec3d rotation = found > 0 ? rotations[0] : cv::Vec3d();
    const cv::Vec3d translation = found > 0 ? translations[0] : cv::Vec3d();
    if (!(translation[2] > 0.0)) {
      throw core::Error("the mat's corners do not give a camera",
                        input_->photos[static_cast<std::size_t>(photos_[i])].name,
                        "leave the photo out");
    }
    for (int k = 0; k < 3; ++k) {
      poses_[i][k] = rotation[k];
      poses_[i][3 + k] = translation[k];
    }
  }
}

void LensGroup::AddCorners(ceres::Problem* problem) {
  for (std::size_t i = 0; i < photos_.size(); ++i) {
    const MatObservation& mat = Mat(i);
    for (std::size_t c = 0; c < mat.corners.size(); ++c) {
      if (!used_[i][c]) continue;
      const Eigen::Vector3d point =
          input_->print_scale * CaptureMatOf(mat.paper).Corner(mat.corners[c]);
      problem->AddResidualBlock(new ceres::AutoDiffCostFunction<CornerError, 2, kLensValues, 6>(
                                    new CornerError{point, mat.pixels[c]}),
                                new ceres::HuberLoss(kHuberPixels), lens_.data(), poses_[i].data());
    }
  }
}

void LensGroup::AddPrior(ceres::Problem* problem) {
  LensPrior prior{};
  prior.usual[kCenterX] = 0.5 * width_;
  prior.usual[kCenterY] = 0.5 * height_;
  const double longer = std::max(width_, height_);
  prior.deviation[kCenterX] = prior.deviation[kCenterY] = kCenterDeviation * longer;
  prior.usual[kFocal] = ExifFocal();
  prior.deviation[kFocal] = kFocalDeviation * prior.usual[kFocal];
  prior.deviation[kK1] = prior.deviation[kK2] = prior.deviation[kK3] = 0.5;
  prior.deviation[kP1] = prior.deviation[kP2] = 0.01;
  problem->AddResidualBlock(
      new ceres::AutoDiffCostFunction<LensPrior, kLensValues, kLensValues>(new LensPrior(prior)),
      nullptr, lens_.data());
}

void LensGroup::MeasureFocalDeviation(ceres::Problem* problem) {
  ceres::Covariance covariance({});
  const std::vector<std::pair<const double*, const double*>> blocks = {
      {lens_.data(), lens_.data()}};
  focal_deviation_ = 1.0;
  if (!covariance.Compute(blocks, problem)) return;
  std::array<double, kLensValues * kLensValues> values{};
  if (!covariance.GetCovarianceBlock(lens_.data(), lens_.data(), values.data())) return;
  focal_deviation_ = std::sqrt(std::max(0.0, values[0])) / lens_[kFocal];
}

void LensGroup::Fit(const LensValues* known) {
  StartLens();
  if (known != nullptr) {
    const double x = lens_[kCenterX], y = lens_[kCenterY];
    lens_ = *known;
    lens_[kCenterX] = x;
    lens_[kCenterY] = y;
  }
  StartPoses();
  used_.clear();
  for (std::size_t i = 0; i < photos_.size(); ++i) used_.emplace_back(Mat(i).corners.size(), 1);
  Solve(known != nullptr);
  DropWrongCorners();
  Solve(known != nullptr);
}

void LensGroup::Solve(bool known_lens) {
  ceres::Problem problem;
  AddCorners(&problem);
  if (known_lens) {
    problem.SetParameterBlockConstant(lens_.data());
  } else {
    AddPrior(&problem);
    if (photos_.size() < kPhotosForK3) {
      problem.SetManifold(lens_.data(), new ceres::SubsetManifold(kLensValues, {kK3}));
    }
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw core::Error("the mat's corners do not determine the cameras: " + summary.message,
                      "calibration", "take the photos from more directions");
  }
  if (!known_lens) MeasureFocalDeviation(&problem);
}

// Drops the corners whose errors stand out, but never so many that a photo keeps under four.
void LensGroup::DropWrongCorners() {
  for (std::size_t i = 0; i < photos_.size(); ++i) {
    const std::vector<double> errors = CornerErrors(i);
    std::vector<double> sorted = errors;
    std::sort(sorted.begin(), sorted.end());
    const double limit = std::max({kWrongPixels, 4.0 * sorted[sorted.size() / 2], sorted[3]});
    for (std::size_t c = 0; c < errors.size(); ++c) used_[i][c] = errors[c] <= limit;
  }
}

Eigen::Isometry3d LensGroup::WorldFromCamera(std::size_t index) const {
  const PoseValues& pose = poses_[index];
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d rotation(pose[0], pose[1], pose[2]);
  if (rotation.norm() > 0.0) {
    camera_from_world.linear() =
        Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix();
  }
  camera_from_world.translation() = Eigen::Vector3d(pose[3], pose[4], pose[5]);
  return camera_from_world.inverse();
}

std::vector<double> LensGroup::CornerErrors(std::size_t index) const {
  const MatObservation& mat = Mat(index);
  const Eigen::Isometry3d camera_from_world = WorldFromCamera(index).inverse();
  const Lens own = lens();
  std::vector<double> errors;
  for (std::size_t c = 0; c < mat.corners.size(); ++c) {
    const Eigen::Vector3d point =
        input_->print_scale * CaptureMatOf(mat.paper).Corner(mat.corners[c]);
    errors.push_back((own.Project(camera_from_world * point) - mat.pixels[c]).norm());
  }
  return errors;
}

double LensGroup::Error(std::size_t index) const {
  const std::vector<double> errors = CornerErrors(index);
  double sum = 0.0;
  int count = 0;
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (!used_[index][c]) continue;
    sum += errors[c] * errors[c];
    ++count;
  }
  return std::sqrt(sum / count);
}

// Returns the groups of photos by size, the largest first.
std::vector<LensGroup> GroupsOf(const MatCalibrationInput& input) {
  std::map<std::pair<int, int>, std::vector<int>> by_size;
  for (std::size_t i = 0; i < input.photos.size(); ++i) {
    const MatObservation& mat = input.photos[i].mat;
    by_size[{mat.width, mat.height}].push_back(static_cast<int>(i));
  }
  std::vector<LensGroup> groups;
  for (auto& [size, photos] : by_size) groups.emplace_back(input, std::move(photos));
  std::stable_sort(groups.begin(), groups.end(), [](const LensGroup& a, const LensGroup& b) {
    return a.photos().size() > b.photos().size();
  });
  return groups;
}

}  // namespace

void MatCalibrationInput::Validate() const {
  if (static_cast<int>(photos.size()) < kMinCalibrationPhotos) {
    throw core::Error("the mat is seen in " + std::to_string(photos.size()) +
                          " photos, but the cameras need at least " +
                          std::to_string(kMinCalibrationPhotos),
                      "calibration", "take more photos with most of the mat in view");
  }
  if (!(print_scale >= 0.5 && print_scale <= 2.0)) {
    throw core::Error("the print's scale " + std::to_string(print_scale) + " is not in [0.5, 2]",
                      "calibration");
  }
  for (const Photo& photo : photos) {
    const MatObservation& mat = photo.mat;
    if (mat.paper != photos[0].mat.paper) {
      throw core::Error("shows the " + CaptureMatOf(mat.paper).name + " mat, but " +
                            photos[0].name + " shows the " +
                            CaptureMatOf(photos[0].mat.paper).name + " mat",
                        photo.name, "use one mat for all photos of an object");
    }
    if (mat.corners.size() != mat.pixels.size() || mat.corners.size() < 4 || mat.width <= 0 ||
        mat.height <= 0) {
      throw core::Error("has " + std::to_string(mat.corners.size()) + " corners of the mat",
                        photo.name);
    }
    for (const int corner : mat.corners) CaptureMatOf(mat.paper).Corner(corner);
  }
}

MatCalibration CalibrateOnMat(const MatCalibrationInput& input) {
  input.Validate();
  MatCalibration result;
  result.views.resize(input.photos.size());
  double sum = 0.0;
  std::vector<LensGroup> groups = GroupsOf(input);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    LensGroup& group = groups[g];
    group.Fit(g > 0 && !group.determines_lens() ? &groups[0].values() : nullptr);
    result.lenses.push_back(group.lens());
    for (std::size_t i = 0; i < group.photos().size(); ++i) {
      const auto photo = static_cast<std::size_t>(group.photos()[i]);
      result.views[photo] = {static_cast<int>(g), group.WorldFromCamera(i), group.Error(i)};
      sum += result.views[photo].error * result.views[photo].error;
    }
    if (group.focal_deviation() > kUncertainFocal) {
      result.findings.push_back(
          {"focal-uncertain", core::Severity::kWarning, "",
           "the photos do not determine the focal length well: distances may be wrong",
           group.focal_deviation(), "take some photos from a lower angle"});
    }
  }
  result.error = std::sqrt(sum / static_cast<double>(input.photos.size()));
  return result;
}

}  // namespace simwright::capture
