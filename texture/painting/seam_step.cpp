#include "texture/painting/seam_step.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "core/error.h"

namespace simwright::texture {
namespace {

constexpr double kOneGrey = 1.0 / 255.0;

float ColorStep(const core::Image& texture, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  const Eigen::Vector4f step = core::SampleTexture(texture, a) - core::SampleTexture(texture, b);
  return step.head<3>().norm() / std::sqrt(3.0f);
}

// Returns one number per vertex, the same for vertices at one place.
std::vector<int> WeldedVertices(const core::TriangleMesh& mesh) {
  const double cell = 1e-6 * std::max(1e-9, core::Bounds(mesh).diagonal().norm());
  std::map<std::tuple<long, long, long>, int> places;
  std::vector<int> welded;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const auto key = std::make_tuple(std::lround(v.x() / cell), std::lround(v.y() / cell),
                                     std::lround(v.z() / cell));
    welded.push_back(places.try_emplace(key, static_cast<int>(places.size())).first->second);
  }
  return welded;
}

constexpr float kInset = 1.0f;     // texels from the edge to the points compared across it
constexpr float kDistance = 2.0f;  // texels between two points that are compared

// The side of a triangle at an edge: texture coordinates of the edge's ends, in the edge's order,
// and of the third corner.
struct EdgeSide {
  int triangle = 0;
  Eigen::Vector2f from{0, 0}, to{0, 0}, apex{0, 0};

  // Returns the point at share t of the edge, `inset` inside the triangle (texture coordinates).
  Eigen::Vector2f At(float t, float inset) const {
    const Eigen::Vector2f along = to - from;
    const Eigen::Vector2f on = from + t * along;
    Eigen::Vector2f inward(-along.y(), along.x());
    if (inward.dot(apex - from) < 0.0f) inward = -inward;
    const float length = inward.norm();
    return length > 0.0f ? Eigen::Vector2f(on + inset / length * inward) : on;
  }

  bool Contains(const Eigen::Vector2f& p) const {
    const Eigen::Vector2f corners[3] = {from, to, apex};
    int left = 0, right = 0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f a = corners[k], ab = corners[(k + 1) % 3] - a, ap = p - a;
      const float side = ab.x() * ap.y() - ab.y() * ap.x();
      left += side >= 0.0f;
      right += side <= 0.0f;
    }
    return left == 3 || right == 3;
  }
};

void Summarise(std::vector<float> steps, int* count, double* mean, double* p95) {
  *count = static_cast<int>(steps.size());
  if (steps.empty()) return;
  for (const float step : steps) *mean += step / static_cast<double>(steps.size());
  std::sort(steps.begin(), steps.end());
  *p95 = steps[static_cast<std::size_t>(0.95 * static_cast<double>(steps.size() - 1))];
}

std::map<std::pair<int, int>, std::vector<EdgeSide>> EdgesOf(const core::TexturedMesh& mesh) {
  const std::vector<int> welded = WeldedVertices(mesh.mesh);
  std::map<std::pair<int, int>, std::vector<EdgeSide>> edges;
  for (std::size_t t = 0; t < mesh.mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = welded[mesh.mesh.triangles[t][k]];
      const int b = welded[mesh.mesh.triangles[t][(k + 1) % 3]];
      if (a == b) continue;
      EdgeSide side;
      side.triangle = static_cast<int>(t);
      side.from = mesh.corner_uvs[3 * t + k];
      side.to = mesh.corner_uvs[3 * t + (k + 1) % 3];
      side.apex = mesh.corner_uvs[3 * t + (k + 2) % 3];
      if (a > b) std::swap(side.from, side.to);
      edges[std::minmax(a, b)].push_back(side);
    }
  }
  return edges;
}

// The steps across the borders, away from them and along them.
struct BorderSteps {
  std::vector<float> across, beside, along;
};

BorderSteps StepsAtBorders(const core::TexturedMesh& mesh, double largest_turn) {
  const core::Image& texture = mesh.textures.front();
  const float texel = 1.0f / static_cast<float>(texture.width);
  BorderSteps steps;
  for (const auto& [ends, sides] : EdgesOf(mesh)) {
    if (sides.size() != 2) continue;
    const bool joined = (sides[0].from - sides[1].from).norm() < 1e-6f &&
                        (sides[0].to - sides[1].to).norm() < 1e-6f;
    if (joined) continue;
    const Eigen::Vector3d n0 = core::TriangleAreaVector(mesh.mesh, sides[0].triangle);
    const Eigen::Vector3d n1 = core::TriangleAreaVector(mesh.mesh, sides[1].triangle);
    if (n0.norm() == 0.0 || n1.norm() == 0.0) continue;
    if (n0.normalized().dot(n1.normalized()) < std::cos(largest_turn)) continue;
    const float length =
        std::min((sides[0].to - sides[0].from).norm(), (sides[1].to - sides[1].from).norm());
    const int samples = std::clamp(static_cast<int>(length / texel / 2.0f), 1, 64);
    for (int s = 0; s < samples; ++s) {
      const float t = (static_cast<float>(s) + 0.5f) / static_cast<float>(samples);
      const float inset = kInset * texel, far = (kInset + kDistance) * texel;
      bool has_beside = false;
      const bool is_wide =
          sides[0].Contains(sides[0].At(t, inset)) && sides[1].Contains(sides[1].At(t, inset));
      if (!is_wide) continue;
      for (const EdgeSide& side : sides) {
        const Eigen::Vector2f beyond = side.At(t, far);
        if (!side.Contains(beyond)) continue;
        steps.beside.push_back(ColorStep(texture, side.At(t, inset), beyond));
        const Eigen::Vector2f along = kDistance * texel * (side.to - side.from).normalized();
        const Eigen::Vector2f further = side.At(t, inset) + along;
        if (side.Contains(further)) {
          steps.along.push_back(ColorStep(texture, side.At(t, inset), further));
        }
        has_beside = true;
      }
      if (!has_beside) continue;
      steps.across.push_back(ColorStep(texture, sides[0].At(t, inset), sides[1].At(t, inset)));
    }
  }
  return steps;
}

}  // namespace

double SeamSteps::Ratio() const {
  return seam_samples == 0 ? 0.0 : seam_mean / std::max(inside_mean, kOneGrey);
}

SeamSteps MeasureSeamSteps(const core::TexturedMesh& mesh, double largest_turn) {
  if (mesh.textures.empty() || mesh.corner_uvs.size() != 3 * mesh.mesh.triangles.size() ||
      mesh.mesh.empty()) {
    throw core::Error("the mesh has no texture to measure");
  }
  const BorderSteps borders = StepsAtBorders(mesh, largest_turn);
  SeamSteps steps;
  Summarise(borders.across, &steps.seam_samples, &steps.seam_mean, &steps.seam_p95);
  for (const std::vector<float>* inside : {&borders.beside, &borders.along}) {
    int count = 0;
    double mean = 0.0, p95 = 0.0;
    Summarise(*inside, &count, &mean, &p95);
    if (mean < steps.inside_mean) continue;
    steps.inside_mean = mean;
    steps.inside_p95 = p95;
  }
  return steps;
}

}  // namespace simwright::texture
