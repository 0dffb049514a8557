#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/eigen/dense.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "core/camera.h"
#include "core/error.h"
#include "python/bindings/arrays.h"
#include "python/bindings/bindings.h"
#include "python/bindings/calls.h"
#include "render/differentiable.h"
#include "render/forward.h"

namespace simwright::python {
namespace {

using nb::literals::operator""_a;
using Matrix93 = Eigen::Matrix<double, 9, 3, Eigen::RowMajor>;
using ImageArgument = nb::ndarray<const float, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

constexpr int kMostPixels = 8192;       // a side
constexpr int kMostSamples = 32;        // a side of a pixel
constexpr int kMostOcclusion = 100000;  // rays of a hit

void MakeCamera(core::Camera* self, int width, int height, double fx, double fy, double cx,
                double cy, const Eigen::Matrix4d& pose) {
  if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels) {
    throw core::Error("width and height are " + std::to_string(width) + " and " +
                          std::to_string(height) + " pixels, outside 1 to " +
                          std::to_string(kMostPixels),
                      "camera");
  }
  if (!(fx > 0.0 && fy > 0.0 && std::isfinite(fx + fy + cx + cy))) {
    throw core::Error("needs focal lengths > 0 and a finite principal point, in pixels", "camera");
  }
  const Eigen::Matrix3d rotation = pose.topLeftCorner<3, 3>();
  if (!pose.allFinite() || !rotation.isUnitary(1e-6) || rotation.determinant() < 0.0 ||
      pose.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw core::Error("the pose is not a rotation and a translation", "camera",
                      "give world from camera, (4, 4)");
  }
  new (self) core::Camera{width, height, fx, fy, cx, cy, Eigen::Isometry3d::Identity()};
  self->world_from_camera.matrix() = pose;
}

void BindCamera(nb::module_& module) {
  nb::class_<core::Camera>(
      module, "Camera",
      "A pinhole camera that looks along +z, x right, y down (OpenCV); pixel centres at .5.")
      .def("__init__", &MakeCamera, "width"_a, "height"_a, "fx"_a, "fy"_a, "cx"_a, "cy"_a, "pose"_a)
      .def_ro("width", &core::Camera::width, "pixels")
      .def_ro("height", &core::Camera::height, "pixels")
      .def_ro("fx", &core::Camera::fx, "pixels")
      .def_ro("fy", &core::Camera::fy, "pixels")
      .def_ro("cx", &core::Camera::cx, "pixels")
      .def_ro("cy", &core::Camera::cy, "pixels")
      .def_prop_ro(
          "pose",
          [](const core::Camera& camera) {
            return Eigen::Matrix4d(camera.world_from_camera.matrix());
          },
          "(4, 4) world from camera, m");
  module.def(
      "orbit_camera",
      [](const Eigen::Vector3d& target, double distance, double elevation, double azimuth,
         double vertical_fov, int width, int height) {
        if (!target.allFinite() || !std::isfinite(distance + elevation + azimuth + vertical_fov)) {
          throw core::Error("needs finite numbers", "orbit_camera");
        }
        return core::OrbitCamera(target, distance, elevation, azimuth, vertical_fov, width, height);
      },
      "target"_a, "distance"_a, "elevation"_a, "azimuth"_a, "vertical_fov"_a, "width"_a,
      "height"_a);
}

void RequireSamples(int samples_per_side) {
  if (samples_per_side >= 1 && samples_per_side <= kMostSamples) return;
  throw core::Error(
      "is " + std::to_string(samples_per_side) + ", outside 1 to " + std::to_string(kMostSamples),
      "samples_per_side");
}

// Renders meshes in the world's frame.
nb::dict Render(const std::vector<const core::TexturedMesh*>& meshes, const core::Camera& camera,
                int samples_per_side, int occlusion_rays) {
  RequireSamples(samples_per_side);
  if (occlusion_rays < 0 || occlusion_rays > kMostOcclusion) {
    throw core::Error(
        "is " + std::to_string(occlusion_rays) + ", outside 0 to " + std::to_string(kMostOcclusion),
        "occlusion_rays");
  }
  render::ForwardBuffers buffers = RunLong(nb::none(), [&](core::Progress* /*progress*/) {
    render::Scene scene;
    for (const core::TexturedMesh* mesh : meshes) scene.Add(mesh);
    scene.Commit();
    render::ForwardOptions options;
    options.shaded = true;
    options.samples_per_side = samples_per_side;
    options.occlusion_rays = occlusion_rays;
    options.cancellable = true;
    return render::RenderForward(scene, camera, options);
  });
  const auto height = static_cast<size_t>(buffers.height),
             width = static_cast<size_t>(buffers.width);
  auto [normal, memory] = NewArray<float>({height, width, 3});
  for (size_t i = 0; i < buffers.normal.size(); ++i) {
    std::copy_n(buffers.normal[i].data(), 3, memory + 3 * i);
  }
  nb::dict dict;
  dict["color"] = Owned(std::move(buffers.color.pixels), {height, width, 4});
  dict["depth"] = Owned(std::move(buffers.depth), {height, width});
  dict["normal"] = normal;
  dict["mask"] = Owned(std::move(buffers.mask), {height, width});
  dict["label"] = Owned(std::move(buffers.label), {height, width});
  dict["triangle"] = Owned(std::move(buffers.triangle), {height, width});
  return dict;
}

core::FloatImage ImageOf(const ImageArgument& array) {
  core::FloatImage image;
  image.height = static_cast<int>(array.shape(0));
  image.width = static_cast<int>(array.shape(1));
  image.channels = static_cast<int>(array.shape(2));
  image.values.assign(array.data(), array.data() + array.size());
  return image;
}

nb::ndarray<nb::numpy, float> ArrayOf(const core::FloatImage& image) {
  std::vector<float> values = image.values;
  return Owned(std::move(values),
               {static_cast<size_t>(image.height), static_cast<size_t>(image.width),
                static_cast<size_t>(image.channels)});
}

std::vector<Eigen::Vector3d> PointsOf(const PointsArgument& array) {
  std::vector<Eigen::Vector3d> points(array.shape(0));
  std::copy_n(array.data(), 3 * points.size(), points.data()->data());
  return points;
}

template <typename Vector, typename Number = typename Vector::Scalar>
nb::ndarray<nb::numpy, Number> ArrayOf(const std::vector<Vector>& rows) {
  auto [array, memory] = NewArray<Number>({rows.size(), 3});
  for (size_t i = 0; i < rows.size(); ++i) std::copy_n(rows[i].data(), 3, memory + 3 * i);
  return array;
}

// One mesh with one colour per vertex or a texture, and its renderer.
class BoundRenderer {
 public:
  BoundRenderer(
      const core::TriangleMesh& mesh, const std::optional<PointsArgument>& colors,
      const std::optional<ImageArgument>& texture,
      const std::optional<
          nb::ndarray<const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>>& corner_uvs,
      bool lit, bool smooth_normals, bool render_normals, int samples_per_side, int edge_samples) {
    RequireSamples(samples_per_side);
    render::DifferentiableObject object;
    object.mesh = mesh;
    if (colors) object.vertex_colors = ColorsOf(*colors);
    if (texture) object.texture = ImageOf(*texture);
    if (corner_uvs) {
      object.corner_uvs.resize(corner_uvs->shape(0));
      std::copy_n(corner_uvs->data(), corner_uvs->size(), object.corner_uvs.data()->data());
    }
    render::DifferentiableOptions options;
    options.lit = lit;
    options.smooth_normals = smooth_normals;
    options.render_normals = render_normals;
    options.samples_per_side = samples_per_side;
    options.edge_samples = edge_samples;
    renderer_ = std::make_unique<render::DifferentiableRenderer>(
        std::vector<render::DifferentiableObject>{std::move(object)}, options);
  }

  void SetVertices(const PointsArgument& vertices) {
    const ExclusiveUse use(&used_, kName);
    renderer_->SetVertices(0, PointsOf(vertices));
  }
  void SetColors(const PointsArgument& colors) {
    const ExclusiveUse use(&used_, kName);
    renderer_->SetVertexColors(0, ColorsOf(colors));
  }
  void SetTexture(const ImageArgument& texture) {
    const ExclusiveUse use(&used_, kName);
    renderer_->SetTexture(0, ImageOf(texture));
  }
  void SetLight(const Matrix93& radiance) {
    const ExclusiveUse use(&used_, kName);
    render::SphericalHarmonicsLight light;
    light.radiance = radiance.cast<float>();
    renderer_->SetLight(light);
  }

  nb::dict Render(const core::Camera& camera, std::uint64_t seed) {
    const ExclusiveUse use(&used_, kName);
    const render::DifferentiableBuffers* buffers = nullptr;
    {
      const nb::gil_scoped_release released;
      buffers = &renderer_->Render(camera, seed);
    }
    nb::dict dict;
    dict["color"] = ArrayOf(buffers->color);
    dict["mask"] = ArrayOf(buffers->mask);
    dict["depth"] = ArrayOf(buffers->depth);
    if (!buffers->normal.empty()) dict["normal"] = ArrayOf(buffers->normal);
    return dict;
  }

  nb::dict Backward(const std::optional<ImageArgument>& color,
                    const std::optional<ImageArgument>& mask,
                    const std::optional<ImageArgument>& depth,
                    const std::optional<ImageArgument>& normal) {
    const ExclusiveUse use(&used_, kName);
    render::DifferentiableBuffers gradient;
    if (color) gradient.color = ImageOf(*color);
    if (mask) gradient.mask = ImageOf(*mask);
    if (depth) gradient.depth = ImageOf(*depth);
    if (normal) gradient.normal = ImageOf(*normal);
    {
      const nb::gil_scoped_release released;
      gradients_.SetZero();
      renderer_->Backward(gradient, &gradients_);
    }
    const render::ObjectGradients& object = gradients_.objects.front();
    nb::dict dict;
    dict["vertices"] = ArrayOf(object.vertices);
    if (!object.vertex_colors.empty()) dict["colors"] = ArrayOf(object.vertex_colors);
    if (!object.texture.empty()) dict["texture"] = ArrayOf(object.texture);
    dict["light"] = Matrix93(gradients_.light);
    return dict;
  }

  std::vector<int> Welded() const { return renderer_->WeldedVertices(0); }

 private:
  static std::vector<Eigen::Vector3f> ColorsOf(const PointsArgument& array) {
    std::vector<Eigen::Vector3f> colors;
    for (const Eigen::Vector3d& color : PointsOf(array)) colors.push_back(color.cast<float>());
    return colors;
  }

  static constexpr const char* kName = "renderer";
  std::unique_ptr<render::DifferentiableRenderer> renderer_;
  render::SceneGradients gradients_;
  std::atomic_flag used_;
};

}  // namespace

void BindRendering(nb::module_& module) {
  BindCamera(module);
  module.def("render", &Render, "meshes"_a, "camera"_a, "samples_per_side"_a, "occlusion_rays"_a);
  module.def(
      "light",
      [](const Eigen::Vector3f& key) {
        return Matrix93(render::SphericalHarmonicsLight::Studio(key).radiance.cast<double>());
      },
      "key"_a);
  nb::class_<BoundRenderer>(module, "DifferentiableRenderer")
      .def(nb::init<const core::TriangleMesh&, const std::optional<PointsArgument>&,
                    const std::optional<ImageArgument>&,
                    const std::optional<
                        nb::ndarray<const float, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>>&,
                    bool, bool, bool, int, int>(),
           "mesh"_a, "colors"_a.none(), "texture"_a.none(), "corner_uvs"_a.none(), "lit"_a,
           "smooth_normals"_a, "render_normals"_a, "samples_per_side"_a, "edge_samples"_a)
      .def("set_vertices", &BoundRenderer::SetVertices, "vertices"_a)
      .def("set_colors", &BoundRenderer::SetColors, "colors"_a)
      .def("set_texture", &BoundRenderer::SetTexture, "texture"_a)
      .def("set_light", &BoundRenderer::SetLight, "radiance"_a)
      .def("render", &BoundRenderer::Render, "camera"_a, "seed"_a)
      .def("backward", &BoundRenderer::Backward, "color"_a.none(), "mask"_a.none(),
           "depth"_a.none(), "normal"_a.none())
      .def_prop_ro("welded", &BoundRenderer::Welded);
}

}  // namespace simwright::python
