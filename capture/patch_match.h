#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/camera/observed_view.h"
#include "core/random.h"

namespace simwright::capture {

// A photo as stereo compares it: grey without its slow gradients, which any depth explains.
class MatchView {
 public:
  // A `view` without colours has no values. `blur_radius`: pixels, of the mean that is subtracted.
  MatchView(const asset_lift::ObservedView& view, int blur_radius);

  int width() const { return width_; }
  int height() const { return height_; }
  // Returns the value of a pixel, of 255; NaN outside the mask and without colours.
  float At(int x, int y) const { return values_[static_cast<std::size_t>(y) * width_ + x]; }
  const float* Row(int y) const { return &values_[static_cast<std::size_t>(y) * width_]; }
  const core::Camera& camera() const { return camera_; }
  // Maps (x, y, 1) in pixels to the ray of depth 1, camera frame.
  const Eigen::Matrix3d& inverse_intrinsics() const { return inverse_intrinsics_; }

 private:
  int width_, height_;
  core::Camera camera_;
  Eigen::Matrix3d inverse_intrinsics_;
  std::vector<float> values_;
};

// The piece of a plane that a pixel shows, in its camera's frame.
struct PatchPlane {
  float depth = 0.0f;                                  // along the optical axis, m
  Eigen::Vector3f normal = -Eigen::Vector3f::UnitZ();  // unit, towards the camera
  float cost = 2.0f;                                   // 1 - correlation, [0, 2]
};

// The part of a pixel's ray inside the hull, with the hull's normal where it enters.
struct HullInterval {
  float enter = 0.0f, leave = 0.0f;                    // depths, m; 0: the ray misses the hull
  Eigen::Vector3f normal = -Eigen::Vector3f::UnitZ();  // camera frame
};

struct PatchMatchOptions {
  int radius = 4, stride = 2;  // pixels, of the compared windows
  int best_views = 2;          // the neighbours whose costs count: the best ones
  int sweeps = 6;
  float least_deviation = 3.0f;  // of a window's values, of 255: less is no texture
  // The least eigenvalue of the gradients' covariance in a window, and its share of the greatest:
  // along a straight edge any depth matches.
  float least_gradient = 2.5f, least_roundness = 0.06f;
  float slack = 0.004f;     // diagonals by which the surface can be in front of the hull
  float most_cost = 0.35f;  // of a plane that is kept
  // The cost of planes this much nearer and farther (diagonals) must be larger by `distinct_cost`.
  float distinct_shift = 0.012f, distinct_cost = 0.12f;
};

// Finds the plane that each textured pixel of a view shows, by random hypotheses that spread from
// pixel to pixel (Bleyer, Rhemann and Rother 2011, "PatchMatch Stereo"), between the depths at
// which its ray enters and leaves the hull. A plane's cost is 1 minus the normalised correlation of
// the pixel's window with the neighbours' windows that the plane predicts, averaged over the best
// of them. Hypotheses are drawn from the hull's surface, behind it, and from horizontal planes.
class PatchMatch {
 public:
  // `up`: the world's vertical in the view's camera frame. `diagonal`: the hull's, m. All
  // references must outlive the object.
  PatchMatch(const MatchView& view, const std::vector<const MatchView*>& neighbors,
             const std::vector<HullInterval>& hull, const Eigen::Vector3f& up, double diagonal,
             const PatchMatchOptions& options);

  // Returns one plane per pixel, row by row; depth 0 where the pixel has no texture or no hull,
  // where no plane matches well, and where nearer and farther planes match as well.
  std::vector<PatchPlane> Run(core::Rng* rng);

 private:
  struct Warp {  // of a neighbour: pixel' ~ (turn + shift plane^T) pixel
    const MatchView* view;
    Eigen::Matrix3f turn;
    Eigen::Vector3f shift;
  };

  // Takes a pixel's window, reduced to mean 0 and length 1. Returns false where it has no texture.
  bool TakeWindow(int x, int y);
  // Returns true if a pixel's window varies in all directions.
  bool VariesAllAround(int x, int y) const;
  // Returns the cost of a plane through the pixel whose window is taken, [0, 2].
  float CostAt(int x, int y, float depth, const Eigen::Vector3f& normal);
  float CostIn(const Warp& warp, const Eigen::Vector3f& start, const Eigen::Vector3f& across,
               const Eigen::Vector3f& down) const;
  Eigen::Vector3f RayAt(int x, int y) const;
  void Try(int x, int y, float depth, const Eigen::Vector3f& normal, PatchPlane* best);
  void TryNeighbor(int x, int y, int from_x, int from_y, PatchPlane* best);
  void Start(int x, int y, core::Rng* rng);
  void Refine(int x, int y, core::Rng* rng, PatchPlane* best);
  void Sweep(bool forward, core::Rng* rng);
  bool IsDistinct(int x, int y);
  std::size_t Index(int x, int y) const { return static_cast<std::size_t>(y) * view_.width() + x; }

  const MatchView& view_;
  const std::vector<HullInterval>& hull_;
  Eigen::Vector3f up_;
  float diagonal_;
  PatchMatchOptions options_;
  Eigen::Matrix3f inverse_, inverse_transposed_;
  std::vector<Warp> warps_;
  std::vector<PatchPlane> planes_;
  std::vector<float> costs_;  // scratch, one per neighbour
  // The window that TakeWindow took last.
  std::vector<float> window_;
  std::vector<std::uint8_t> counts_;
  int used_ = 0;
};

}  // namespace simwright::capture
