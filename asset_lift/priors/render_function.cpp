#include "asset_lift/priors/render_function.h"

#include <cstring>

#include "core/error.h"

namespace simwright::asset_lift {
namespace {

template <typename Vector>
std::vector<Vector> TensorRows(const torch::Tensor& tensor, torch::ScalarType type) {
  const torch::Tensor rows = tensor.detach().to(torch::kCPU, type).contiguous();
  std::vector<Vector> vectors(static_cast<size_t>(rows.size(0)));
  static_assert(sizeof(Vector) == 3 * sizeof(typename Vector::Scalar));
  if (!vectors.empty()) {
    std::memcpy(vectors.front().data(), rows.data_ptr(), vectors.size() * sizeof(Vector));
  }
  return vectors;
}

template <typename Vector>
torch::Tensor FromRows(std::vector<Vector>* rows, const torch::Tensor& like) {
  const auto type = sizeof(typename Vector::Scalar) == 8 ? torch::kDouble : torch::kFloat;
  return torch::from_blob(rows->data(), {static_cast<std::int64_t>(rows->size()), 3}, type)
      .clone()
      .to(like.options());
}

torch::Tensor FromImage(const core::FloatImage& image) {
  return torch::from_blob(const_cast<float*>(image.values.data()),
                          {image.height, image.width, image.channels}, torch::kFloat)
      .clone();
}

core::FloatImage ToImage(const torch::Tensor& gradient, int channels, const core::Camera& camera) {
  if (!gradient.defined()) return {};  // means zero
  core::FloatImage image(camera.width, camera.height, channels);
  const torch::Tensor rows = gradient.to(torch::kCPU, torch::kFloat).contiguous();
  std::memcpy(image.values.data(), rows.data_ptr(), image.values.size() * sizeof(float));
  return image;
}

// The inputs of a rendered image.
struct Shot : torch::CustomClassHolder {
  render::DifferentiableRenderer* renderer = nullptr;
  core::Camera camera;
  std::uint64_t seed = 0;

  const render::DifferentiableBuffers& Draw(const torch::Tensor& vertices,
                                            const torch::Tensor& colors) const {
    renderer->SetVertices(0, TensorRows<Eigen::Vector3d>(vertices, torch::kDouble));
    if (colors.defined() && colors.numel() > 0) {
      renderer->SetVertexColors(0, TensorRows<Eigen::Vector3f>(colors, torch::kFloat));
    }
    return renderer->Render(camera, seed);
  }
};

class RenderNode : public torch::autograd::Function<RenderNode> {
 public:
  static torch::autograd::variable_list forward(torch::autograd::AutogradContext* context,
                                                const torch::Tensor& vertices,
                                                const torch::Tensor& colors,
                                                const c10::intrusive_ptr<Shot>& shot) {
    context->save_for_backward({vertices, colors});
    context->saved_data["shot"] = c10::IValue::make_capsule(shot);
    const render::DifferentiableBuffers& rendered = shot->Draw(vertices, colors);
    return {FromImage(rendered.color), FromImage(rendered.mask).squeeze(-1),
            FromImage(rendered.depth).squeeze(-1)};
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* context,
                                                 torch::autograd::variable_list gradients) {
    const torch::autograd::variable_list saved = context->get_saved_variables();
    const auto shot =
        c10::static_intrusive_pointer_cast<Shot>(context->saved_data["shot"].toCapsule());
    // Another image may have been rendered since.
    shot->Draw(saved[0], saved[1]);
    render::DifferentiableBuffers pixels;
    pixels.color = ToImage(gradients[0], 3, shot->camera);
    pixels.mask = ToImage(gradients[1], 1, shot->camera);
    pixels.depth = ToImage(gradients[2], 1, shot->camera);
    render::SceneGradients sums;
    shot->renderer->Backward(pixels, &sums);
    torch::Tensor of_colors;
    if (saved[1].numel() > 0) of_colors = FromRows(&sums.objects[0].vertex_colors, saved[1]);
    return {FromRows(&sums.objects[0].vertices, saved[0]), of_colors, torch::Tensor()};
  }
};

}  // namespace

RenderedTensors RenderTensors(render::DifferentiableRenderer* renderer,
                              const torch::Tensor& vertices, const torch::Tensor& vertex_colors,
                              const core::Camera& camera, std::uint64_t seed) {
  const auto count = static_cast<std::int64_t>(renderer->object(0).mesh.vertices.size());
  const bool colored = vertex_colors.defined() && vertex_colors.numel() > 0;
  if (vertices.dim() != 2 || vertices.size(0) != count || vertices.size(1) != 3 ||
      (colored && !vertex_colors.sizes().equals(vertices.sizes()))) {
    throw core::Error(
        "vertices and their colours must be (N x 3), with N that of the renderer's mesh");
  }
  auto shot = c10::make_intrusive<Shot>();
  shot->renderer = renderer;
  shot->camera = camera;
  shot->seed = seed;
  const torch::autograd::variable_list rendered =
      RenderNode::apply(vertices, colored ? vertex_colors : torch::empty({0, 3}), shot);
  return {rendered[0], rendered[1], rendered[2]};
}

}  // namespace simwright::asset_lift
