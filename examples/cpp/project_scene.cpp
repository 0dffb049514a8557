// Moves two overlapping boxes apart with the least displacement.
#include <cmath>
#include <cstdio>

#include <simwright/scene/feasibility/depenetration.h>

namespace scene = simwright::scene;

int main() {
  simwright::geometry::ConvexShape box;
  for (int i = 0; i < 8; ++i) {
    box.vertices.emplace_back(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
  }
  const std::vector<simwright::geometry::ConvexShape> parts{box};
  std::vector<scene::ProjectedBody> bodies(2);
  for (auto& body : bodies) body.parts = &parts;
  bodies[1].world_from_body.translation().x() = 0.8;  // 0.2 m of overlap
  const scene::Projection projection = scene::ResolvePenetrations(bodies);
  std::printf("feasible %d after %d rounds, shifts %.4f and %.4f m\n", projection.feasible,
              projection.rounds, projection.shifts[0].x(), projection.shifts[1].x());
  return projection.feasible && std::abs(projection.shifts[1].x() - 0.1) < 1e-4 ? 0 : 1;
}
