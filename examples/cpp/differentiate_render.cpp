// Renders a square and moves it to the right by the gradient of its image.
#include <cmath>
#include <cstdio>

#include <simwright/render/differentiable.h>

namespace render = simwright::render;

int main() {
  render::DifferentiableObject square;
  square.mesh.vertices = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
  square.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  simwright::core::Camera camera;
  camera.width = camera.height = 64;
  camera.fx = camera.fy = 64.0;
  camera.cx = camera.cy = 32.0;
  camera.world_from_camera.translation().z() = -2.0;
  render::DifferentiableRenderer renderer({square});
  // L = the sum over pixels of mask * x: its gradient by a shift of the square is the area in
  // pixels times the focal length over the depth.
  const render::DifferentiableBuffers& image = renderer.Render(camera, 1);
  double area = 0.0;
  render::DifferentiableBuffers pixel_gradients;
  pixel_gradients.mask = image.mask;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      area += image.mask.At(x, y)[0];
      pixel_gradients.mask.At(x, y)[0] = static_cast<float>(x + 0.5);
    }
  }
  render::SceneGradients gradients;
  renderer.Backward(pixel_gradients, &gradients);
  const double expected = area * camera.fx / 2.0;
  std::printf("area %.1f pixels, dL/dx %.1f, expected %.1f\n", area,
              gradients.objects[0].pose.translation.x(), expected);
  return std::abs(gradients.objects[0].pose.translation.x() - expected) < 0.02 * expected ? 0 : 1;
}
