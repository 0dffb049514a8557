#include "geometry/closed_surface.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace simwright::geometry {
namespace {

// Returns for each vertex a number that vertices at the same position share.
std::vector<int> PositionNumbers(const std::vector<Eigen::Vector3d>& vertices) {
  const auto before = [&](int a, int b) {
    const Eigen::Vector3d &p = vertices[static_cast<size_t>(a)],
                          &q = vertices[static_cast<size_t>(b)];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<int> order(vertices.size()), numbers(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), before);
  int number = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && before(order[i - 1], order[i])) ++number;
    numbers[static_cast<size_t>(order[i])] = number;
  }
  return numbers;
}

}  // namespace

bool IsClosed(const core::TriangleMesh& mesh) {
  const std::vector<int> numbers = PositionNumbers(mesh.vertices);
  // The edges by their two positions, the lower first, and their direction.
  std::vector<std::pair<std::pair<int, int>, int>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int c = 0; c < 3; ++c) {
      const int a = numbers[static_cast<size_t>(triangle[c])];
      const int b = numbers[static_cast<size_t>(triangle[(c + 1) % 3])];
      if (a != b) edges.push_back({std::minmax(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (size_t i = 0; i < edges.size();) {
    int balance = 0;
    const std::pair<int, int> edge = edges[i].first;
    for (; i < edges.size() && edges[i].first == edge; ++i) balance += edges[i].second;
    if (balance != 0) return false;
  }
  return !edges.empty();
}

}  // namespace simwright::geometry
