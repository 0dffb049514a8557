#include <algorithm>
#include <cmath>

#include "core/mesh.h"
#include "texture/materials/noise.h"
#include "texture/materials/substances.h"

namespace simwright::texture {
namespace {

constexpr float kLabelFrom = -0.52f, kLabelTo = 0.42f;  // of the part's height, in [-1, 1]

Eigen::Vector3f PrintColor(const core::Image& print, float u, float v) {
  const float inset = 0.5f / static_cast<float>(print.height);
  return core::SampleTexture(print, {u, std::clamp(v, inset, 1.0f - inset)}).head<3>();
}

// Coordinates in [0, 1] of the panel of a carton: two large and two small sides; lids are plain.
Eigen::Vector2f PanelPlace(const PartFrame& frame, const MaterialPoint& point, bool* is_panel) {
  const Eigen::Vector3f unit = 0.5f * (UnitPlace(frame, point.position) + Eigen::Vector3f::Ones());
  const Eigen::Vector3f size = frame.box.sizes();
  const Eigen::Vector3f& n = point.normal;
  // A flat carton, such as a book, is printed on its top and bottom.
  const int flat = size.z() < 0.5f * std::min(size.x(), size.y()) ? 2
                   : size.y() <= size.x()                         ? 1
                                                                  : 0;
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  *is_panel = axis == flat;
  if (flat == 2) return {n.z() > 0 ? unit.y() : 1.0f - unit.y(), 1.0f - unit.x()};
  const float along = flat == 1 ? unit.x() : unit.y();
  const bool mirrored = flat == 1 ? n.y() > 0 : n.x() < 0;
  return {mirrored ? 1.0f - along : along, unit.z()};
}

}  // namespace

MaterialSample PrintAt(const SurfaceMaterial& m, const PartFrame& frame,
                       const MaterialPoint& point) {
  MaterialSample sample;
  sample.color = m.color;
  sample.roughness = m.roughness;
  if (!m.print) return sample;
  const Eigen::Vector3f unit = UnitPlace(frame, point.position);
  if (m.print_is_label || frame.round) {
    const float from = m.print_is_label ? kLabelFrom : -0.96f,
                to = m.print_is_label ? kLabelTo : 0.94f;
    const bool side = std::abs(point.normal.z()) < 0.6f;
    if (side && unit.z() > from && unit.z() < to) {
      // The picture goes around twice: its middle shows at -y and at +y.
      const Eigen::Vector3f p = point.position - frame.box.center();
      const float turn = std::atan2(p.y(), p.x()) / 3.1415927f + 1.0f;
      sample.color = PrintColor(*m.print, turn - std::floor(turn), (unit.z() - from) / (to - from));
      sample.roughness = 0.35f;
    }
  } else {
    bool is_panel = false;
    const Eigen::Vector2f at = PanelPlace(frame, point, &is_panel);
    if (is_panel) sample.color = PrintColor(*m.print, at.x(), at.y());
  }
  const float fibre = FractalNoise(point.position / 0.0015f, 2, point.footprint / 0.0015f, m.seed);
  sample.color *= 1.0f + 0.012f * fibre;
  sample.height = 6e-6f * fibre;
  return sample;
}

}  // namespace simwright::texture
