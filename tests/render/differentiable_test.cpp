#include "render/differentiable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/render/gate_scenes.h"

namespace simwright::render {
namespace {

const char* const kNames[] = {"color", "mask", "depth", "normal"};

void ExpectGate(const Comparison& comparison, const char* what) {
  for (int k = 0; k < kOutputs; ++k) {
    const Agreement a = comparison.Of(k);
    if (a.size < 1e-9) continue;
    std::printf("  %-10s %-7s |d| %8.3f  error %6.3f%%  cosine %.5f\n", what, kNames[k], a.size,
                100.0 * a.error, a.cosine);
    EXPECT_LE(a.error, 0.02) << what << ", " << kNames[k];
    EXPECT_GE(a.cosine, 0.99) << what << ", " << kNames[k];
  }
}

void RunGates(const GateScene& scene, int fields, int vertices) {
  const auto gradients = Gradients(scene, 24, 100000);
  ExpectGate(CompareFields(scene, fields, 24, 1, gradients), "fields");
  ExpectGate(CompareVertices(scene, vertices, 500000, gradients), "vertices");
  ExpectGate(ComparePose(scene, Moved::kCamera, Motion::kTranslation, 24, 2, gradients),
             "camera t");
  ExpectGate(ComparePose(scene, Moved::kCamera, Motion::kRotation, 24, 2, gradients), "camera r");
  ExpectGate(ComparePose(scene, Moved::kObject, Motion::kTranslation, 24, 2, gradients),
             "object t");
  ExpectGate(ComparePose(scene, Moved::kObject, Motion::kRotation, 24, 2, gradients), "object r");
  ExpectGate(CompareLens(scene, 24, 2, gradients), "lens");
}

TEST(GradientGate, ATriangle) {
  RunGates(TriangleScene(32), 8, 3);
}
TEST(GradientGate, AClippedTriangle) {
  RunGates(ClippedTriangleScene(32), 8, 3);
}
TEST(GradientGate, ATriangleThroughTheNearPlane) {
  RunGates(NearTriangleScene(32), 8, 3);
}
TEST(GradientGate, TwoOccludingTriangles) {
  RunGates(OccludingTrianglesScene(32), 8, 3);
}
TEST(GradientGate, ATexturedQuad) {
  RunGates(TexturedQuadScene(32), 8, 9);
}
TEST(GradientGate, ABumpySphere) {
  RunGates(BumpySphereScene(32, 4), 8, 16);
}

}  // namespace
}  // namespace simwright::render
