#include "bench/render/bumpy_ball.h"

#include <cmath>

namespace simwright {

core::TriangleMesh BumpyBall(int rings) {
  core::TriangleMesh ball;
  const int sectors = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const double polar = M_PI * (i + 0.5) / (rings + 1.0), turn = 2.0 * M_PI * j / sectors;
      const double r = 0.5 + 0.03 * std::sin(9.0 * polar) * std::cos(7.0 * turn);
      ball.vertices.emplace_back(r * std::sin(polar) * std::cos(turn),
                                 r * std::sin(polar) * std::sin(turn), r * std::cos(polar));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      ball.triangles.emplace_back(a, a + sectors, b + sectors);
      ball.triangles.emplace_back(a, b + sectors, b);
    }
  }
  return ball;
}

void CloseAtPoles(core::TriangleMesh* ball) {
  const int count = static_cast<int>(ball->vertices.size());
  // count = (rings + 1) 2 rings
  const int rings = static_cast<int>(std::lround(0.5 * (std::sqrt(1.0 + 2.0 * count) - 1.0)));
  const int sectors = 2 * rings, last = rings * sectors;
  ball->vertices.emplace_back(0.0, 0.0, 0.5);
  ball->vertices.emplace_back(0.0, 0.0, -0.5);
  for (int j = 0; j < sectors; ++j) {
    const int next = (j + 1) % sectors;
    ball->triangles.emplace_back(count, j, next);
    ball->triangles.emplace_back(count + 1, last + next, last + j);
  }
}

}  // namespace simwright
