#include "asset_lift/multi_view/multi_view_lift.h"

#include <algorithm>

#include "asset_lift/camera/view_frame.h"
#include "asset_lift/mesh_fit/shape_fit.h"
#include "asset_lift/multi_view/view_consistency.h"
#include "asset_lift/multi_view/visual_hull.h"
#include "asset_lift/priors/initial_shape.h"
#include "core/error.h"
#include "texture/photo_projection.h"

namespace simwright::asset_lift {
namespace {

// The photos without contradiction, and their views.
struct Agreeing {
  std::vector<texture::PhotoView> photos;
  std::vector<Matte> mattes;
  std::vector<ObservedView> views;
};

Agreeing CutOutAll(const std::vector<PosedPhoto>& photos, const CategoryPrior& prior,
                   const MultiViewOptions& options, core::Progress* progress) {
  Agreeing all;
  progress->Stage("segmentation", static_cast<int>(photos.size()));
  SegmentationOptions segmentation;
  segmentation.seed = options.seed;
  segmentation.round_object = prior.round;
  for (const PosedPhoto& photo : photos) {
    try {
      all.mattes.push_back(SegmentObject(photo.photo, std::nullopt, segmentation));
    } catch (const core::Error& error) {
      throw core::Error(error.what(), photo.name);
    }
    all.photos.push_back({photo.camera, photo.photo, all.mattes.back().alpha});
    // Only the learned priors use a frame's depth.
    all.views.push_back(CropView(photo.photo, all.mattes.back().alpha,
                                 FrameAround(all.mattes.back(), photo.camera, 1.0),
                                 options.fit_side));
    progress->Advance();
  }
  return all;
}

void ExcludeContradicting(const std::vector<PosedPhoto>& photos, Agreeing* all,
                          core::Findings* findings) {
  if (all->views.size() < 3) return;  // two views have no majority
  const ViewConsistency agreement = CheckViewConsistency(all->views);
  for (auto i = agreement.contradicting.rbegin(); i != agreement.contradicting.rend(); ++i) {
    const auto at = static_cast<std::ptrdiff_t>(*i);
    findings->push_back({"view-contradicts", core::Severity::kWarning, photos[*i].name,
                         "the camera of " + photos[static_cast<size_t>(*i)].name +
                             " contradicts those of the others: the photo is excluded",
                         0.0});
    all->views.erase(all->views.begin() + at);
    all->photos.erase(all->photos.begin() + at);
    all->mattes.erase(all->mattes.begin() + at);
  }
  if (all->views.size() < 2) {
    throw core::Error("the cameras contradict each other: fewer than two photos agree");
  }
}

}  // namespace

LiftedMesh LiftPhotos(const std::vector<PosedPhoto>& photos, const CategoryPrior& prior,
                      const MultiViewOptions& options, core::Progress* progress) {
  if (photos.size() < 2) {
    throw core::Error("posed reconstruction needs at least two photos of one object");
  }
  LiftedMesh lifted;
  Agreeing agreeing = CutOutAll(photos, prior, options, progress);
  ExcludeContradicting(photos, &agreeing, &lifted.findings);
  progress->Stage("visual hull");
  const core::TriangleMesh hull = VisualHull(agreeing.views);
  ShapeFitOptions stages = options.fit;
  stages.field_stage = options.field_stage;
  stages.field.seed = stages.mesh.seed = options.seed;
  const ShapeFit fit =
      FitShape(agreeing.views, InitialShapeFrom(hull), nullptr, nullptr, stages, progress);
  lifted.findings.insert(lifted.findings.end(), fit.findings.begin(), fit.findings.end());
  progress->Stage("texture");
  texture::PhotoProjectionOptions projection;
  projection.texture_size = options.texture_size;
  lifted.mesh = texture::ProjectPhotos(fit.mesh, agreeing.photos, fit.colors, projection);
  lifted.camera = agreeing.photos[0].camera;
  lifted.photo = agreeing.photos[0].photo;
  lifted.matte = agreeing.mattes[0];
  lifted.start = "the visual hull of " + std::to_string(agreeing.views.size()) + " photos";
  lifted.silhouette_iou = SilhouetteIou(fit.mesh, lifted.camera, lifted.matte);
  lifted.findings.push_back({"shape", core::Severity::kInfo, "",
                             "the shape began as " + lifted.start, lifted.silhouette_iou});
  progress->Finish();
  return lifted;
}

}  // namespace simwright::asset_lift
