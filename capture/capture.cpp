#include "capture/capture.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capture/capture_doubts.h"
#include "capture/mat_evidence.h"
#include "capture/mat_sharpness.h"
#include "capture/object_masks.h"
#include "capture/view_agreement.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr double kHeightOverPage = 1.3;    // the tallest object, in heights of the page
constexpr int kFirstCells = 72;            // of the first round's hull
constexpr double kFirstMargin = 0.6;       // cells, by which that hull is grown
constexpr double kFirstTolerated = 0.15;   // share of the views whose first masks may be wrong ...
constexpr double kGuessTolerated = 0.65;   // ... and beside the mat
constexpr std::size_t kLeastColors = 200;  // pixels in all photos, from which colours are learnt

class MatCapture {
 public:
  MatCapture(const CaptureSource& source, const CaptureOptions& options, core::Progress* progress)
      : source_(source), options_(options), progress_(progress) {}

  Capture Run() {
    Calibrate();
    const Eigen::AlignedBox3d place = ObjectPlace();
    CutOut(place, options_.first_side, {});
    // Beside the mat, first masks are no more than a guess by colour.
    result_.hull = Hull({FirstVote(), VoteOf(result_.views, kGuessTolerated, {})}, place,
                        kFirstCells, kFirstMargin);
    const Eigen::AlignedBox3d box = Grown(core::Bounds(result_.hull));
    CutOut(box, options_.crop_side, result_.hull);
    result_.hull =
        Hull({VoteOf(result_.views, options_.tolerated_views, {})}, box, options_.hull_cells, 0.0);
    core::ParallelFor(static_cast<int>(result_.views.size()), [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      CaptureView& view = result_.views[at];
      ClipBesideMat(evidence_[at], SilhouetteOf(result_.hull, view.camera), &view.opacity);
    });
    progress_->Stage("agreement of the views");
    LeaveOutContradictions(source_, &result_);
    BelieveHullWhereUnsure();
    AdviseMorePhotos(&result_);
    Append(CaptureDoubts(source_, result_, options_.print_scale));
    progress_->Finish();
    return std::move(result_);
  }

 private:
  void Append(const core::Findings& findings) {
    result_.findings.insert(result_.findings.end(), findings.begin(), findings.end());
  }
  void Calibrate();
  Eigen::AlignedBox3d ObjectPlace() const;
  // Crops all photos to a box and segments them.
  void CutOut(const Eigen::AlignedBox3d& box, int side, const core::TriangleMesh& hull);
  void Segment(const std::vector<core::FloatImage>& silhouettes);
  void LearnColors();
  // Returns the vote of the first masks where they are sure and lie before the mat.
  HullVote FirstVote() const;
  // Takes from the hull what a photo cannot tell.
  void BelieveHullWhereUnsure();
  core::TriangleMesh Hull(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                          int cells, double margin) const;

  const CaptureSource& source_;
  const CaptureOptions& options_;
  core::Progress* progress_;
  std::vector<int> shown_;              // the photos that show the mat
  std::vector<MatEvidence> evidence_;   // one per view
  std::vector<ObjectMask> masks_;       // one per view
  std::optional<ColorMixture> colors_;  // of the object, in all photos
  Capture result_;
};

void MatCapture::Calibrate() {
  const int count = static_cast<int>(source_.photos.size());
  progress_->Stage("mat", count);
  std::vector<std::optional<MatObservation>> mats(source_.photos.size());
  std::vector<double> edge_widths(mats.size(), 0.0);
  core::ParallelFor(count, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const core::Image photo = source_.read(i);
    mats[at] = DetectMat(photo);
    if (mats[at]) edge_widths[at] = EdgeWidthOnMat(photo, *mats[at]);
    progress_->Advance();
  });
  std::vector<std::string> names;
  for (const CaptureSource::Photo& photo : source_.photos) names.push_back(photo.name);
  Append(BlurredPhotos(edge_widths, names));
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
  Append(result_.calibration.findings);
}

Eigen::AlignedBox3d MatCapture::ObjectPlace() const {
  const CaptureMat& mat = CaptureMatOf(*result_.paper);
  const Eigen::Vector2d half =
      0.5 * options_.print_scale * mat.square * Eigen::Vector2d(mat.columns, mat.rows);
  return {Eigen::Vector3d(-half.x(), -half.y(), 0.0),
          Eigen::Vector3d(half.x(), half.y(), options_.print_scale * kHeightOverPage * mat.height)};
}

void MatCapture::CutOut(const Eigen::AlignedBox3d& box, int side, const core::TriangleMesh& hull) {
  progress_->Stage(hull.empty() ? "first masks" : "masks", static_cast<int>(shown_.size()));
  result_.views.assign(shown_.size(), {});
  evidence_.assign(shown_.size(), {});
  masks_.assign(shown_.size(), {});
  std::vector<core::FloatImage> silhouettes(shown_.size());
  core::ParallelFor(static_cast<int>(shown_.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const MatCalibration::View& posed = result_.calibration.views[at];
    const Lens& lens = result_.calibration.lenses[static_cast<std::size_t>(posed.lens)];
    CaptureView& view = result_.views[at];
    view.index = shown_[at];
    view.camera = CropAround(box, lens, posed.world_from_camera, side);
    view.photo = RemoveDistortion(source_.read(view.index), lens, view.camera);
    evidence_[at] =
        CompareWithMat(view.photo, view.camera, CaptureMatOf(*result_.paper), options_.print_scale);
    if (!hull.empty()) silhouettes[at] = SilhouetteOf(hull, view.camera);
    progress_->Advance();
  });
  // Parts that one photo shows beside the mat, another shows before it: their colours tell.
  if (hull.empty()) {
    Segment(silhouettes);
    LearnColors();
  }
  Segment(silhouettes);
}

void MatCapture::Segment(const std::vector<core::FloatImage>& silhouettes) {
  core::ParallelFor(static_cast<int>(masks_.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    masks_[at] = SegmentOnMat(result_.views[at].photo, evidence_[at], silhouettes[at],
                              colors_ ? &*colors_ : nullptr);
    result_.views[at].opacity = masks_[at].opacity;
  });
}

void MatCapture::LearnColors() {
  std::vector<Eigen::Vector3f> sample;
  for (std::size_t i = 0; i < masks_.size(); ++i) {
    const std::vector<Eigen::Vector3f> colors =
        ColorsBeforeMat(result_.views[i].photo, evidence_[i], masks_[i]);
    sample.insert(sample.end(), colors.begin(), colors.end());
  }
  if (sample.size() >= kLeastColors) colors_.emplace(sample);
}

void MatCapture::BelieveHullWhereUnsure() {
  core::ParallelFor(static_cast<int>(result_.views.size()), [&](int i) {
    CaptureView& view = result_.views[static_cast<std::size_t>(i)];
    const auto at = std::find(shown_.begin(), shown_.end(), view.index) - shown_.begin();
    const std::vector<float>& unsure = masks_[static_cast<std::size_t>(at)].unsure.values;
    const core::FloatImage hull = SilhouetteOf(result_.hull, view.camera);
    for (std::size_t k = 0; k < unsure.size(); ++k) {
      if (unsure[k] > 0.0f) view.opacity.values[k] = hull.values[k];
    }
  });
}

HullVote MatCapture::FirstVote() const {
  std::vector<core::FloatImage> open;
  for (std::size_t i = 0; i < masks_.size(); ++i) {
    open.push_back(PixelsBesideMat(evidence_[i]));
    const std::vector<float>& unsure = masks_[i].unsure.values;
    for (std::size_t k = 0; k < unsure.size(); ++k) {
      open[i].values[k] = std::max(open[i].values[k], unsure[k]);
    }
  }
  return VoteOf(result_.views, kFirstTolerated, open);
}

core::TriangleMesh MatCapture::Hull(const std::vector<HullVote>& votes,
                                    const Eigen::AlignedBox3d& box, int cells,
                                    double margin) const {
  core::TriangleMesh hull = HullOf(votes, box, cells, margin);
  if (hull.empty()) {
    throw core::Error(
        "no object stands on the mat in all photos", "capture",
        "leave the object where it stands and move around it; clear glass and mirrors "
        "have no outline: dull them with removable powder");
  }
  return hull;
}

}  // namespace

Capture CaptureOnMat(const CaptureSource& source, const CaptureOptions& options,
                     core::Progress* progress) {
  return MatCapture(source, options, progress).Run();
}

}  // namespace simwright::capture
