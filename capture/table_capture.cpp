#include "capture/table_capture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/object_frame.h"
#include "capture/object_masks.h"
#include "capture/table_evidence.h"
#include "capture/view_agreement.h"
#include "core/error.h"
#include "core/parallel.h"

namespace simwright::capture {
namespace {

constexpr int kHullCells = 72;             // of the first round's hull
constexpr double kWrongFirst = 0.15;       // share of the views whose first masks may be wrong ...
constexpr double kWrongBeside = 0.65;      // ... and where the table is unknown
constexpr double kTableReach = 3.0;        // sides of the painted table, in those of the box
constexpr int kMostCells = 1024;           // per side of the painted table
constexpr double kBlurred = 0.4;           // of the median sharpness
constexpr double kOtherShare = 0.25;       // of other things' points among those above the table
constexpr int kNamesShown = 5;             // in an error
constexpr float kSureDifference = 100.0f;  // of a pixel that a point of the object is seen in

class TableCapture {
 public:
  TableCapture(const CaptureSource& source, const TableCaptureOptions& options,
               core::Progress* progress)
      : source_(source), options_(options), progress_(progress) {}

  Capture Run() {
    Reconstruct();
    frame_ = PlaceOnTable(options_.seed, &structure_);
    ReportFrame();
    TakePoses();
    const Eigen::AlignedBox3d place = ObjectPlace();
    CutOut(place, options_.capture.first_side, {});
    std::vector<core::FloatImage> beside;
    for (const MatEvidence& evidence : evidence_) beside.push_back(PixelsBesideMat(evidence));
    result_.hull =
        Hull({VoteOf(result_.views, kWrongFirst, beside), VoteOf(result_.views, kWrongBeside, {})},
             place, kHullCells);
    for (const int cells : {kHullCells, options_.capture.hull_cells}) {
      const Eigen::AlignedBox3d box = Grown(core::Bounds(result_.hull));
      CutOut(box, options_.capture.crop_side, result_.hull);
      result_.hull =
          Hull({VoteOf(result_.views, options_.capture.tolerated_views, {})}, box, cells);
    }
    progress_->Stage("agreement of the views");
    LeaveOutContradictions(source_, &result_);
    AdviseMorePhotos(&result_);
    progress_->Finish();
    return std::move(result_);
  }

 private:
  void Reconstruct();
  // Throws core::Error, naming photos, if too few are placed.
  void RequireEnough() const;
  void ReportFrame();
  void TakePoses();
  Eigen::AlignedBox3d ObjectPlace() const;
  // Crops all photos to a box and segments them.
  void CutOut(const Eigen::AlignedBox3d& box, int side, const core::TriangleMesh& hull);
  // Marks what structure from motion knows of a view's pixels.
  void MarkPoints(std::size_t view, MatEvidence* evidence) const;
  core::TriangleMesh Hull(const std::vector<HullVote>& votes, const Eigen::AlignedBox3d& box,
                          int cells) const;

  const CaptureSource& source_;
  const TableCaptureOptions& options_;
  core::Progress* progress_;
  Structure structure_;
  ObjectFrame frame_;
  std::vector<int> placed_;            // the photos with a camera
  std::vector<MatEvidence> evidence_;  // one per view
  Capture result_;
};

void TableCapture::Reconstruct() {
  const int count = static_cast<int>(source_.photos.size());
  if (count < kMinCalibrationPhotos) {
    throw core::Error("photos of one object need to be at least " +
                          std::to_string(kMinCalibrationPhotos) + ", not " + std::to_string(count),
                      "capture", "take 20 to 30 photos from all around");
  }
  StructureInput input;
  for (const CaptureSource::Photo& photo : source_.photos) {
    input.photos.push_back({0, 0, photo.focal_35mm, photo.name});
  }
  const auto read = [&](int i) {
    core::Image photo = source_.read(i);
    StructureInput::Photo& of = input.photos[static_cast<std::size_t>(i)];
    of.width = photo.width;
    of.height = photo.height;
    return photo;
  };
  PhotoTracks tracks = FindFeatureTracks(count, read, options_.features, progress_);
  input.tracks = std::move(tracks.tracks);
  structure_ = ReconstructStructure(std::move(input), options_.structure, progress_);
  result_.findings = structure_.findings;
  std::vector<double> sorted = tracks.sharpness;
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.end());
  for (std::size_t i = 0; i < tracks.sharpness.size(); ++i) {
    if (tracks.sharpness[i] >= kBlurred * sorted[sorted.size() / 2]) continue;
    result_.findings.push_back({"photo-blurred", core::Severity::kWarning, source_.photos[i].name,
                                "the photo is much less sharp than the others",
                                tracks.sharpness[i] / sorted[sorted.size() / 2],
                                "take it again with a steady hand and more light"});
  }
  RequireEnough();
}

void TableCapture::RequireEnough() const {
  std::string names;
  int placed = 0, missing = 0;
  for (std::size_t i = 0; i < structure_.views.size(); ++i) {
    if (structure_.views[i].registered) {
      ++placed;
    } else if (++missing <= kNamesShown) {
      names += (names.empty() ? "" : ", ") + source_.photos[i].name;
    }
  }
  if (placed >= kMinCalibrationPhotos && 2 * placed >= placed + missing) return;
  if (missing > kNamesShown) names += " and " + std::to_string(missing - kNamesShown) + " more";
  throw core::Error("only " + std::to_string(placed) + " of " + std::to_string(placed + missing) +
                        " photos show one scene together; not " + names,
                    "capture",
                    "photograph one object on a textured table, each photo overlapping the last "
                    "one, or use a mat (simwright mat)");
}

void TableCapture::ReportFrame() {
  if (!frame_.table_found) {
    result_.findings.push_back(
        {"table-not-found", core::Severity::kWarning, "",
         "no table is seen around the object: its upright and its base are guessed from how the "
         "photos were held",
         0.0, "photograph it on a table with a pattern, such as a newspaper"});
  }
  const auto own = static_cast<int>(
      std::count(frame_.is_object.begin(), frame_.is_object.end(), std::uint8_t{1}));
  if (frame_.others > kOtherShare * (own + frame_.others)) {
    result_.findings.push_back(
        {"other-objects", core::Severity::kWarning, "",
         "other things stand beside the object: the one nearest to the middle is taken",
         static_cast<double>(frame_.others) / (own + frame_.others),
         "clear the table around the object"});
  }
}

void TableCapture::TakePoses() {
  result_.calibration.lenses = structure_.lenses;
  result_.calibration.error = structure_.error;
  for (std::size_t i = 0; i < structure_.views.size(); ++i) {
    const Structure::View& view = structure_.views[i];
    if (!view.registered) continue;
    placed_.push_back(static_cast<int>(i));
    result_.calibration.views.push_back({view.lens, view.world_from_camera, view.error});
  }
}

// Returns the box in which the object is looked for: features seldom lie on outlines.
Eigen::AlignedBox3d TableCapture::ObjectPlace() const {
  Eigen::AlignedBox3d place = frame_.box;
  const double margin = 0.25 * place.sizes().maxCoeff();
  place.min() -= Eigen::Vector3d(margin, margin, 0.0);
  place.max().array() += margin;
  return place;
}

void TableCapture::CutOut(const Eigen::AlignedBox3d& box, int side,
                          const core::TriangleMesh& hull) {
  const int count = static_cast<int>(placed_.size());
  progress_->Stage(hull.empty() ? "first masks" : "masks", 2 * count);
  result_.views.assign(placed_.size(), {});
  evidence_.assign(placed_.size(), {});
  std::vector<core::FloatImage> silhouettes(placed_.size());
  core::ParallelFor(count, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const MatCalibration::View& posed = result_.calibration.views[at];
    const Lens& lens = result_.calibration.lenses[static_cast<std::size_t>(posed.lens)];
    CaptureView& view = result_.views[at];
    view.index = placed_[at];
    view.camera = CropAround(box, lens, posed.world_from_camera, side);
    view.photo = RemoveDistortion(source_.read(view.index), lens, view.camera);
    if (!hull.empty()) silhouettes[at] = SilhouetteOf(hull, view.camera);
    progress_->Advance();
  });
  std::vector<TableView> views;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    views.push_back({&result_.views[i].photo, &result_.views[i].camera,
                     hull.empty() ? nullptr : &silhouettes[i]});
  }
  const Eigen::Vector2d half = 0.5 * kTableReach * box.sizes().head<2>();
  const Eigen::Vector2d center = box.center().head<2>();
  const TablePicture table = PaintTable(views, {center - half, center + half},
                                        std::min(kMostCells, static_cast<int>(kTableReach * side)));
  core::ParallelFor(count, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    evidence_[at] = CompareWithTable(views[at], table, i);
    if (hull.empty()) MarkPoints(at, &evidence_[at]);
    result_.views[at].opacity =
        SegmentOnMat(result_.views[at].photo, evidence_[at], silhouettes[at], nullptr).opacity;
    progress_->Advance();
  });
}

void TableCapture::MarkPoints(std::size_t view, MatEvidence* evidence) const {
  const core::Camera& camera = result_.views[view].camera;
  for (std::size_t p = 0; p < structure_.points.size(); ++p) {
    if (frame_.is_object[p] == 0 && frame_.is_table[p] == 0) continue;
    const Structure::Point& point = structure_.points[p];
    const std::vector<int>& seen = structure_.tracks[static_cast<std::size_t>(point.track)].photos;
    if (!std::binary_search(seen.begin(), seen.end(), placed_[view])) continue;
    const Eigen::Vector3d at = camera.Project(point.position);
    const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
    for (int j = std::max(0, y - 1); j <= std::min(camera.height - 1, y + 1); ++j) {
      for (int i = std::max(0, x - 1); i <= std::min(camera.width - 1, x + 1); ++i) {
        *evidence->difference.At(i, j) = frame_.is_object[p] != 0 ? kSureDifference : 0.0f;
        *evidence->pattern.At(i, j) = frame_.is_object[p] != 0 ? 0.0f : 1.0f;
      }
    }
  }
}

core::TriangleMesh TableCapture::Hull(const std::vector<HullVote>& votes,
                                      const Eigen::AlignedBox3d& box, int cells) const {
  core::TriangleMesh hull = HullOf(votes, box, cells, 0.0);
  if (hull.empty()) {
    throw core::Error("no object stands in the middle of all photos", "capture",
                      "leave the object where it stands and move around it, or use a mat "
                      "(simwright mat)");
  }
  return hull;
}

}  // namespace

Capture CaptureOnTable(const CaptureSource& source, const TableCaptureOptions& options,
                       core::Progress* progress) {
  return TableCapture(source, options, progress).Run();
}

void ScaleCapture(double factor, Capture* capture) {
  core::Transform(Eigen::Affine3d(Eigen::Scaling(factor)), &capture->hull);
  for (CaptureView& view : capture->views) view.camera.world_from_camera.translation() *= factor;
  for (MatCalibration::View& view : capture->calibration.views) {
    view.world_from_camera.translation() *= factor;
  }
}

}  // namespace simwright::capture
