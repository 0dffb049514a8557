#pragma once

#include "assets/articulated_asset.h"
#include "core/camera.h"
#include "core/mesh.h"
#include "library_fit/library_fit.h"

namespace simwright::library_fit {

// A mesh with the camera that sees it as the photo shows it.
struct FittedMesh {
  core::TexturedMesh mesh;
  core::Camera camera;  // for the photo's pixels, in the mesh's frame
};

// Returns the fitted object as one mesh of the fitted size (m), z up, turned so that the camera is
// on the side of -y. Visible sides take the photo's colours, the others those of the mirror image
// across the plane that faces the camera, or of their surroundings (texture/photo_projection.h).
// Throws core::Error where the camera sees nothing of the mesh.
FittedMesh TexturedFit(const FittedInstance& fit, const FitPhoto& photo);

// An instance and the camera that sees it, for the photo's pixels, in the frame of InstanceMesh.
struct SeenInstance {
  Instance instance;
  core::Camera camera;
};

// Returns the instance with the photo's colours, as PaintedFit does, and an articulated one as
// FittedAsset does.
core::TexturedMesh PaintedInstance(const SeenInstance& seen, const FitPhoto& photo);
assets::ArticulatedAsset PaintedAsset(const SeenInstance& seen, const FitPhoto& photo,
                                      double height = 0.0);

// Returns the fitted articulated object in the library's frame, the front towards -x. Surfaces that
// the photo shows take its colours, as a texture that all links share. The others take the mean
// colour in the photo of their look, and looks that the photo does not show keep the library's.
// `height`: of the asset, m; 0: as fitted. Throws core::Error for a rigid kind.
assets::ArticulatedAsset FittedAsset(const FittedInstance& fit, const FitPhoto& photo,
                                     double height = 0.0);

// Returns the fitted instance in its pose in the photo (PhotoCamera sees it), coloured as
// FittedAsset is.
core::TexturedMesh PaintedFit(const FittedInstance& fit, const FitPhoto& photo);

// The agreement of any mesh, seen by a camera for the photo's pixels, with the photo.
struct PhotoAgreement {
  double iou = 0.0;         // of the outlines in the crop
  double edge_error = 1.0;  // as FittedInstance::edge_error
  // The smaller the better: what `--shape auto` compares.
  double Disagreement() const { return 2.0 * (1.0 - iou) + 0.6 * edge_error; }
};
PhotoAgreement AgreementWithPhoto(const core::TexturedMesh& mesh, const core::Camera& camera,
                                  const FitPhoto& photo);

}  // namespace simwright::library_fit
