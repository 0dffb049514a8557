#include "capture/capture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/coverage.h"
#include "capture/mat_evidence.h"
#include "capture/object_masks.h"
#include "capture/voting_hull.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr double kHeightOverPage = 1.3;   // the tallest object, in heights of the page
constexpr int kFirstCells = 72;           // of the first round's hull
constexpr double kGuessTolerated = 0.65;  // ... and beside the mat
constexpr double kFirstTolerated = 0.15;  // share of the views whose first masks may be wrong

constexpr double kLeastAgreement = 0.75;  // IoU of a view's mask and the hull's silhouette

class MatCapture {
 public:
  MatCapture(const CaptureSource& source, const CaptureOptions& options, core::Progress* progress)
      : source_(source), options_(options), progress_(progress) {}

  Capture Run() {
    Calibrate();
    const Eigen::AlignedBox3d place = ObjectPlace();
    CutOut(place, options_.first_side, {});
    // Beside the mat, first masks are no more than a guess by colour.
    result_.hull =
        Hull({Vote(kFirstTolerated, true), Vote(kGuessTolerated, false)}, place, kFirstCells);
    const Eigen::AlignedBox3d box = Around(core::Bounds(result_.hull));
    CutOut(box, options_.crop_side, result_.hull);
    result_.hull = Hull({Vote(options_.tolerated_views, false)}, box, options_.hull_cells);
    LeaveOutContradictions();
    AdviseMorePhotos();
    progress_->Finish();
    return std::move(result_);
  }

 private:
  void Calibrate();
  Eigen::AlignedBox3d ObjectPlace() const;
  // Crops all photos to a box and segments them.
  void CutOut(const Eigen::AlignedBox3d& box, int side, const core::TriangleMesh& hull);
  // Leaves out the views whose masks and hull disagree.
  void LeaveOutContradictions();
  void AdviseMorePhotos();
  HullVote Vote(double tolerated, bool open_beside_mat) const;
  core::TriangleMesh Hull(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                          int cells) const;
  static Eigen::AlignedBox3d Around(Eigen::AlignedBox3d box) {
    const double margin = 0.06 * box.diagonal().norm();
    box.min().array() -= margin;
    box.max().array() += margin;
    return box;
  }

  const CaptureSource& source_;
  const CaptureOptions& options_;
  core::Progress* progress_;
  std::vector<int> shown_;             // the photos that show the mat
  std::vector<MatEvidence> evidence_;  // one per view
  Capture result_;
};

void MatCapture::Calibrate() {
  const int count = static_cast<int>(source_.photos.size());
  progress_->Stage("mat", count);
  std::vector<std::optional<MatObservation>> mats(source_.photos.size());
  core::ParallelFor(count, [&](int i) {
    mats[static_cast<std::size_t>(i)] = DetectMat(source_.read(i));
    progress_->Advance();
  });
  MatCalibrationInput input;
  input.print_scale = options_.print_scale;
  for (int i = 0; i < count; ++i) {
    const CaptureSource::Photo& photo = source_.photos[static_cast<std::size_t>(i)];
    if (!mats[static_cast<std::size_t>(i)]) {
      result_.findings.push_back({"mat-not-found", core::Severity::kWarning, photo.name,
                                  "the photo shows no mat: it is left out", 0.0,
                                  "photograph most of the mat, sharp and evenly lit"});
      continue;
    }
    input.photos.push_back({*mats[static_cast<std::size_t>(i)], photo.focal_35mm, photo.name});
    shown_.push_back(i);
  }
  progress_->Stage("cameras");
  result_.calibration = CalibrateOnMat(input);
  result_.paper = input.photos[0].mat.paper;
  result_.findings.insert(result_.findings.end(), result_.calibration.findings.begin(),
                          result_.calibration.findings.end());
}

Eigen::AlignedBox3d MatCapture::ObjectPlace() const {
  const CaptureMat& mat = CaptureMatOf(result_.paper);
  const Eigen::Vector2d half =
      0.5 * options_.print_scale * mat.square * Eigen::Vector2d(mat.columns, mat.rows);
  return {Eigen::Vector3d(-half.x(), -half.y(), 0.0),
          Eigen::Vector3d(half.x(), half.y(), options_.print_scale * kHeightOverPage * mat.height)};
}

void MatCapture::CutOut(const Eigen::AlignedBox3d& box, int side, const core::TriangleMesh& hull) {
  progress_->Stage(hull.empty() ? "first masks" : "masks", static_cast<int>(shown_.size()));
  result_.views.assign(shown_.size(), {});
  evidence_.assign(shown_.size(), {});
  core::ParallelFor(static_cast<int>(shown_.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const MatCalibration::View& posed = result_.calibration.views[at];
    const Lens& lens = result_.calibration.lenses[static_cast<std::size_t>(posed.lens)];
    CaptureView& view = result_.views[at];
    view.index = shown_[at];
    view.camera = CropAround(box, lens, posed.world_from_camera, side);
    view.photo = RemoveDistortion(source_.read(view.index), lens, view.camera);
    evidence_[at] =
        CompareWithMat(view.photo, view.camera, CaptureMatOf(result_.paper), options_.print_scale);
    view.opacity =
        SegmentOnMat(view.photo, evidence_[at],
                     hull.empty() ? core::FloatImage() : SilhouetteOf(hull, view.camera));
    progress_->Advance();
  });
}

// Returns the masks that show something, with the share of them that may be wrong.
HullVote MatCapture::Vote(double tolerated, bool open_beside_mat) const {
  HullVote vote;
  for (std::size_t i = 0; i < result_.views.size(); ++i) {
    const core::FloatImage& opacity = result_.views[i].opacity;
    const bool any = std::any_of(opacity.values.begin(), opacity.values.end(),
                                 [](float v) { return v >= 0.5f; });
    if (!any) continue;
    asset_lift::ObservedView view;
    view.camera = result_.views[i].camera;
    view.opacity = open_beside_mat ? OpenBesideMat(opacity, evidence_[i]) : opacity;
    vote.views.push_back(std::move(view));
  }
  vote.tolerated =
      static_cast<int>(std::lround(tolerated * static_cast<double>(vote.views.size())));
  return vote;
}

core::TriangleMesh MatCapture::Hull(const std::vector<HullVote>& votes,
                                    const Eigen::AlignedBox3d& box, int cells) const {
  core::TriangleMesh hull;
  const bool enough = std::all_of(votes.begin(), votes.end(), [](const HullVote& vote) {
    return static_cast<int>(vote.views.size()) > vote.tolerated + 1;
  });
  if (enough) hull = VotingHull(votes, box, {cells, 0.0});
  if (hull.empty()) {
    throw core::Error("no object stands on the mat in all photos", "capture",
                      "leave the object where it stands and move around it");
  }
  return hull;
}

// Returns the intersection of two masks over their union.
double MaskIou(const core::FloatImage& a, const core::FloatImage& b) {
  double both = 0.0, either = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const bool in_a = a.values[i] >= 0.5f, in_b = b.values[i] >= 0.5f;
    both += in_a && in_b;
    either += in_a || in_b;
  }
  return either > 0.0 ? both / either : 1.0;
}

void MatCapture::LeaveOutContradictions() {
  progress_->Stage("agreement of the views");
  std::vector<double> agreement(result_.views.size());
  core::ParallelFor(static_cast<int>(agreement.size()), [&](int i) {
    const CaptureView& view = result_.views[static_cast<std::size_t>(i)];
    agreement[static_cast<std::size_t>(i)] =
        MaskIou(view.opacity, SilhouetteOf(result_.hull, view.camera));
  });
  std::vector<CaptureView> kept;
  std::vector<MatCalibration::View> poses;
  for (std::size_t i = 0; i < agreement.size(); ++i) {
    if (agreement[i] >= kLeastAgreement) {
      kept.push_back(std::move(result_.views[i]));
      poses.push_back(result_.calibration.views[i]);
      continue;
    }
    result_.findings.push_back(
        {"view-contradicts", core::Severity::kWarning,
         source_.photos[static_cast<std::size_t>(result_.views[i].index)].name,
         "the outline of the object contradicts the other photos: the photo is left out",
         agreement[i], "look at capture.html; the object must not move between photos"});
  }
  if (static_cast<int>(kept.size()) < kMinCalibrationPhotos || 2 * kept.size() < agreement.size()) {
    throw core::Error("the outlines of the object agree in " + std::to_string(kept.size()) +
                          " of " + std::to_string(agreement.size()) + " photos only",
                      "capture",
                      "leave one object where it stands, move around it, and choose a background "
                      "of other colours");
  }
  result_.views = std::move(kept);
  result_.calibration.views = std::move(poses);
}

void MatCapture::AdviseMorePhotos() {
  const Eigen::Vector3d object = core::Bounds(result_.hull).center();
  std::vector<ViewDirection> directions;
  for (const CaptureView& view : result_.views) {
    directions.push_back(DirectionTo(object, view.camera.position()));
  }
  const core::Findings missing = MissingViews(directions);
  result_.findings.insert(result_.findings.end(), missing.begin(), missing.end());
}

}  // namespace

Capture CaptureOnMat(const CaptureSource& source, const CaptureOptions& options,
                     core::Progress* progress) {
  return MatCapture(source, options, progress).Run();
}

}  // namespace simwright::capture
