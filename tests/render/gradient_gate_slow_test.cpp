// The gates of the differentiable renderer: finite differences with common random numbers, 1024
// samples per pixel, 32 smooth displacement fields, up to 64 single vertices, camera, lens, light.
#include <gtest/gtest.h>

#include "tests/render/gate_scenes.h"

namespace simwright::render {
namespace {

constexpr int kSamples = 32;  // per pixel side

void RunGates(const GateScene& scene, int fields, int vertices) {
  const auto gradients = Gradients(scene, kSamples, 400000);
  ExpectGate(CompareFields(scene, fields, kSamples, 1, gradients), "smooth fields");
  ExpectGate(CompareVertices(scene, vertices, kStep, 1000000, gradients), "single vertices");
  ExpectGate(ComparePose(scene, 0, 2, kSamples, 1, gradients), "camera moves");
  ExpectGate(ComparePose(scene, 3, 5, kSamples, 1, gradients), "camera turns");
  ExpectGate(ComparePose(scene, 6, 11, kSamples, 1, gradients), "object's pose");
  ExpectGate(CompareLens(scene, kSamples, 1, gradients), "lens");
}

TEST(GradientGateSlow, ATriangle) {
  RunGates(TriangleScene(32), 32, 3);
}

TEST(GradientGateSlow, AClippedTriangle) {
  RunGates(ClippedTriangleScene(32), 32, 3);
}

TEST(GradientGateSlow, ATriangleThroughTheNearPlane) {
  RunGates(NearTriangleScene(32), 32, 3);
}

TEST(GradientGateSlow, TwoOccludingTriangles) {
  RunGates(OccludingTrianglesScene(32), 32, 3);
}

TEST(GradientGateSlow, ATexturedQuad) {
  RunGates(TexturedQuadScene(32), 32, 9);
}

TEST(GradientGateSlow, ABumpySphereOfTenThousandTriangles) {
  RunGates(BumpySphereScene(32, 22), 32, 0);
  // Differences of single vertices are noisy, with few rays at the silhouette: test their cosine.
  const GateScene large = BumpySphereScene(128, 22);
  ExpectGate(CompareVertices(large, 64, kFineStep, 200000, Gradients(large, 8, 1000000)),
             "64 vertices", 0.15);
}

TEST(GradientGateSlow, AFlatShadedSphereWhoseEdgesAreAllSteps) {
  GateScene scene = BumpySphereScene(32, 3);
  scene.options.smooth_normals = false;
  RunGates(scene, 8, 8);
}

// The silhouette's noise at 4000 samples against a reference of 4 million, at three densities.
TEST(GradientGateSlow, FourThousandEdgeSamplesAreEnoughUpToAHundredThousandTriangles) {
  for (const int n : {7, 22, 71}) {
    GateScene scene = BumpySphereScene(128, n);
    scene.options.lit = scene.options.render_normals = false;
    DifferentiableBuffers mask;
    mask.mask = SmoothImage(scene.camera, 1, 2);
    const auto gradient = [&](int edge_samples, std::uint64_t seed) {
      DifferentiableOptions options = scene.options;
      options.edge_samples = edge_samples;
      DifferentiableRenderer renderer(scene.objects, options);
      renderer.Render(scene.camera, seed);
      SceneGradients gradients;
      renderer.Backward(mask, &gradients);
      return gradients.objects[0];
    };
    const ObjectGradients reference = gradient(4000000, 1), few = gradient(4000, 2);
    double rr = 0.0, ff = 0.0, rf = 0.0;
    for (std::size_t i = 0; i < few.vertices.size(); ++i) {
      rr += reference.vertices[i].squaredNorm();
      ff += few.vertices[i].squaredNorm();
      rf += few.vertices[i].dot(reference.vertices[i]);
    }
    const double error = (few.pose.translation - reference.pose.translation).norm() /
                         reference.pose.translation.norm();
    const double cosine = rf / std::sqrt(rr * ff);
    std::printf("    %6d triangles: translation %.2f%% off, per-vertex cosine %.4f\n", 20 * n * n,
                100.0 * error, cosine);
    EXPECT_LE(error, 0.02);
    EXPECT_GE(cosine, 0.99);
  }
}

// At a hundred thousand triangles single vertices take a day: test only fields.
TEST(GradientGateSlow, FieldsOnAHundredThousandTriangles) {
  const GateScene scene = BumpySphereScene(32, 71);
  const auto gradients = Gradients(scene, kSamples, 4000000);
  ExpectGate(CompareFields(scene, 8, 24, 1, gradients), "8 fields, 100k");
}

}  // namespace
}  // namespace simwright::render
