#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/camera.h"
#include "core/random.h"
#include "render/differentiable.h"

// Compares DifferentiableRenderer's gradients with finite differences under common random numbers.
namespace simwright::render {

constexpr double kStep = 4e-3;  // step of finite differences, world units; relative for lenses
// The step for single vertices of fine meshes: a vertex that moves by a share of its edges flips
// faces at the silhouette, where the image's derivative jumps.
constexpr double kFineStep = 2e-4;

enum Output { kColor, kMask, kDepth, kNormal, kOutputs };
using Losses = std::array<double, kOutputs>;

struct GateScene {
  std::vector<DifferentiableObject> objects;
  DifferentiableOptions options;
  core::Camera camera;
};

// A smooth random function of position, about 1 in magnitude.
class SmoothFunction {
 public:
  SmoothFunction(std::uint64_t seed, double frequency) {
    core::Rng rng = core::StreamRng(seed, 77);
    for (Wave& wave : waves_) {
      wave.direction = frequency * core::UniformDirection(rng);
      wave.phase = core::Uniform(rng, 0.0, 2.0 * std::numbers::pi);
    }
  }
  double operator()(const Eigen::Vector3d& p) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::cos(wave.direction.dot(p) + wave.phase);
    return sum / std::sqrt(2.0);
  }

 private:
  struct Wave {
    Eigen::Vector3d direction;
    double phase;
  };
  std::array<Wave, 4> waves_;
};

inline core::FloatImage SmoothImage(const core::Camera& camera, int channels, std::uint64_t seed) {
  core::FloatImage image(camera.width, camera.height, channels);
  for (int c = 0; c < channels; ++c) {
    const SmoothFunction f(seed + 10 * static_cast<std::uint64_t>(c), 6.0 / camera.width);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        image.At(x, y)[c] = static_cast<float>(0.3 + f({x + 0.5, y + 0.5, 0.0}));
      }
    }
  }
  return image;
}

// dL/d(image) of four losses, one per output.
inline DifferentiableBuffers LossImages(const GateScene& scene) {
  DifferentiableBuffers images;
  images.color = SmoothImage(scene.camera, 3, 1);
  images.mask = SmoothImage(scene.camera, 1, 2);
  images.depth = SmoothImage(scene.camera, 1, 3);
  if (scene.options.render_normals) images.normal = SmoothImage(scene.camera, 3, 4);
  return images;
}

inline DifferentiableBuffers Only(const DifferentiableBuffers& images, int output) {
  DifferentiableBuffers only;
  if (output == kColor) only.color = images.color;
  if (output == kMask) only.mask = images.mask;
  if (output == kDepth) only.depth = images.depth;
  if (output == kNormal) only.normal = images.normal;
  return only;
}

inline double Dot(const core::FloatImage& a, const core::FloatImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    sum += static_cast<double>(a.values[i]) * b.values[i];
  }
  return sum;
}

inline Losses LossesOf(const DifferentiableBuffers& picture, const DifferentiableBuffers& images) {
  return {Dot(images.color, picture.color), Dot(images.mask, picture.mask),
          Dot(images.depth, picture.depth), Dot(images.normal, picture.normal)};
}

// A crop of the camera's image, with the same pixels.
inline core::Camera Window(const core::Camera& camera, int x0, int y0, int x1, int y1) {
  core::Camera window = camera;
  window.width = x1 - x0;
  window.height = y1 - y0;
  window.cx -= x0;
  window.cy -= y0;
  return window;
}

inline core::FloatImage Window(const core::FloatImage& image, int x0, int y0, int x1, int y1) {
  if (image.empty()) return {};
  core::FloatImage window(x1 - x0, y1 - y0, image.channels);
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) {
      for (int c = 0; c < image.channels; ++c) window.At(x - x0, y - y0)[c] = image.At(x, y)[c];
    }
  }
  return window;
}

inline DifferentiableBuffers Window(const DifferentiableBuffers& images, int x0, int y0, int x1,
                                    int y1) {
  return {Window(images.color, x0, y0, x1, y1), Window(images.mask, x0, y0, x1, y1),
          Window(images.depth, x0, y0, x1, y1), Window(images.normal, x0, y0, x1, y1)};
}

// The gradients of the four losses from one image with many samples.
inline std::array<SceneGradients, kOutputs> Gradients(const GateScene& scene, int samples_per_side,
                                                      int edge_samples, std::uint64_t seed = 5) {
  DifferentiableOptions options = scene.options;
  options.samples_per_side = samples_per_side;
  options.edge_samples = edge_samples;
  DifferentiableRenderer renderer(scene.objects, options);
  renderer.Render(scene.camera, seed);
  const DifferentiableBuffers images = LossImages(scene);
  std::array<SceneGradients, kOutputs> gradients;
  for (int k = 0; k < kOutputs; ++k) renderer.Backward(Only(images, k), &gradients[k]);
  return gradients;
}

// The difference between finite differences and predictions for each output.
struct Agreement {
  double error = 0.0;   // |difference - prediction| / |difference|, over all components
  double cosine = 1.0;  // of the angle between them
  double size = 0.0;    // |difference|
};

class Comparison {
 public:
  void Add(const Losses& difference, const Losses& prediction) {
    for (int k = 0; k < kOutputs; ++k) {
      dd_[k] += difference[k] * difference[k];
      pp_[k] += prediction[k] * prediction[k];
      dp_[k] += difference[k] * prediction[k];
      off_[k] += (difference[k] - prediction[k]) * (difference[k] - prediction[k]);
    }
  }
  Agreement Of(int output) const {
    Agreement a;
    a.size = std::sqrt(dd_[output]);
    a.error = a.size > 0.0 ? std::sqrt(off_[output]) / a.size : std::sqrt(off_[output]);
    const double product = std::sqrt(dd_[output] * pp_[output]);
    a.cosine = product > 0.0 ? dp_[output] / product : 1.0;
    return a;
  }

 private:
  Losses dd_{}, pp_{}, dp_{}, off_{};
};

// Returns (L(+step) - L(-step)) / (2 step) with the same samples in both images. `apply` sets the
// renderer's parameter (and may change the camera).
inline Losses CentralDifference(DifferentiableRenderer* renderer, const core::Camera& camera,
                                const DifferentiableBuffers& images, double step, int seeds,
                                const std::function<void(double, core::Camera*)>& apply) {
  Losses difference{};
  for (const double sign : {1.0, -1.0}) {
    core::Camera moved = camera;
    apply(sign * step, &moved);
    for (int s = 0; s < seeds; ++s) {
      const Losses losses = LossesOf(renderer->Render(moved, 1000 + s), images);
      for (int k = 0; k < kOutputs; ++k) difference[k] += sign * losses[k] / (2.0 * step * seeds);
    }
  }
  core::Camera back = camera;
  apply(0.0, &back);
  return difference;
}

// Compares along `fields` smooth random displacements of all vertices of all objects.
inline Comparison CompareFields(const GateScene& scene, int fields, int samples_per_side, int seeds,
                                const std::array<SceneGradients, kOutputs>& gradients) {
  DifferentiableOptions options = scene.options;
  options.samples_per_side = samples_per_side;
  DifferentiableRenderer renderer(scene.objects, options);
  const DifferentiableBuffers images = LossImages(scene);
  Comparison comparison;
  for (int f = 0; f < fields; ++f) {
    std::vector<std::vector<Eigen::Vector3d>> displacements;  // by object and vertex
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const std::uint64_t seed = 100 + 10 * static_cast<std::uint64_t>(f) + 1000 * o;
      const SmoothFunction x(seed, 5.0), y(seed + 1, 5.0), z(seed + 2, 5.0);
      displacements.emplace_back();
      for (const Eigen::Vector3d& p : scene.objects[o].mesh.vertices) {
        displacements[o].emplace_back(x(p), y(p), z(p));
      }
    }
    const auto apply = [&](double step, core::Camera*) {
      for (std::size_t o = 0; o < scene.objects.size(); ++o) {
        std::vector<Eigen::Vector3d> vertices = scene.objects[o].mesh.vertices;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          vertices[i] += step * displacements[o][i];
        }
        renderer.SetVertices(static_cast<int>(o), vertices);
      }
    };
    Losses prediction{};
    for (std::size_t o = 0; o < scene.objects.size(); ++o) {
      const std::vector<Eigen::Vector3d>& vertices = scene.objects[o].mesh.vertices;
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Eigen::Vector3d& d = displacements[o][i];
        for (int k = 0; k < kOutputs; ++k) {
          prediction[k] += gradients[k].objects[o].vertices[i].dot(d);
        }
      }
    }
    comparison.Add(CentralDifference(&renderer, scene.camera, images, kStep, seeds, apply),
                   prediction);
  }
  return comparison;
}

// Returns the pixels in which a small move of a vertex of the first object changes the image: those
// of its faces and of the faces of their vertices. (x0, y0, x1, y1), empty if x0 >= x1.
inline Eigen::Vector4i Reach(const GateScene& scene, int vertex) {
  const core::TriangleMesh& mesh = scene.objects[0].mesh;
  std::vector<bool> near(mesh.vertices.size(), false);
  near[vertex] = true;
  for (int ring = 0; ring < 2; ++ring) {
    std::vector<bool> grown = near;
    for (const Eigen::Vector3i& t : mesh.triangles) {
      if (!near[t[0]] && !near[t[1]] && !near[t[2]]) continue;
      for (int k = 0; k < 3; ++k) grown[t[k]] = true;
    }
    near = grown;
  }
  Eigen::AlignedBox2d box;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (!near[i]) continue;
    const Eigen::Vector3d at =
        scene.camera.Project(scene.objects[0].world_from_object * mesh.vertices[i]);
    if (at.z() < 0.01) return {0, 0, scene.camera.width, scene.camera.height};
    box.extend(Eigen::Vector2d(at.head<2>()));
  }
  const auto within = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  return {within(std::floor(box.min().x()) - 1.0, scene.camera.width),
          within(std::floor(box.min().y()) - 1.0, scene.camera.height),
          within(std::ceil(box.max().x()) + 1.0, scene.camera.width),
          within(std::ceil(box.max().y()) + 1.0, scene.camera.height)};
}

// Returns the vertices to test: first those at discontinuities (largest mask gradient, every n-th),
// then others.
inline std::vector<int> ChosenVertices(const SceneGradients& of_mask, int count) {
  const std::vector<Eigen::Vector3d>& gradient = of_mask.objects[0].vertices;
  std::vector<int> steps, others, chosen;
  for (std::size_t i = 0; i < gradient.size(); ++i) {
    (gradient[i].squaredNorm() > 0.0 ? steps : others).push_back(static_cast<int>(i));
  }
  const auto pick = [&](const std::vector<int>& from, int most) {
    const int n = std::min(most, static_cast<int>(from.size()));
    for (int i = 0; i < n; ++i) {
      chosen.push_back(from[static_cast<std::size_t>(i) * from.size() / n]);
    }
  };
  pick(steps, count / 2);
  pick(others, count - static_cast<int>(chosen.size()));
  return chosen;
}

// Compares up to `vertices` single vertices of the first object, along each axis; half of them at
// discontinuities, if there are enough. Each image has about `rays` rays, all where the vertex
// matters.
inline Comparison CompareVertices(const GateScene& scene, int vertices, double step, int rays,
                                  const std::array<SceneGradients, kOutputs>& gradients) {
  const DifferentiableBuffers images = LossImages(scene);
  Comparison comparison;
  for (const int v : ChosenVertices(gradients[kMask], vertices)) {
    const Eigen::Vector4i r = Reach(scene, v);
    if (r[0] >= r[2] || r[1] >= r[3]) continue;
    DifferentiableOptions options = scene.options;
    options.samples_per_side = std::max(
        16, static_cast<int>(std::sqrt(rays / static_cast<double>((r[2] - r[0]) * (r[3] - r[1])))));
    DifferentiableRenderer renderer(scene.objects, options);
    std::vector<Eigen::Vector3d> moved = scene.objects[0].mesh.vertices;
    for (int axis = 0; axis < 3; ++axis) {
      const auto apply = [&](double by, core::Camera*) {
        moved[v] = scene.objects[0].mesh.vertices[v] + by * Eigen::Vector3d::Unit(axis);
        renderer.SetVertices(0, moved);
      };
      Losses prediction{};
      for (int k = 0; k < kOutputs; ++k) prediction[k] = gradients[k].objects[0].vertices[v][axis];
      comparison.Add(CentralDifference(&renderer, Window(scene.camera, r[0], r[1], r[2], r[3]),
                                       Window(images, r[0], r[1], r[2], r[3]), step, 1, apply),
                     prediction);
    }
  }
  return comparison;
}

inline Eigen::Isometry3d Turned(const Eigen::Isometry3d& pose, int axis, double angle) {
  Eigen::Isometry3d turned = pose;
  turned.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)) * pose.linear();
  return turned;
}

// Compares the camera's translation (axes 0-2) and rotation (3-5), or the first object's (6-11).
// Rotations are scaled by the displacement of points about 0.3 m from the object's origin.
inline Comparison ComparePose(const GateScene& scene, int first_axis, int last_axis,
                              int samples_per_side, int seeds,
                              const std::array<SceneGradients, kOutputs>& gradients) {
  DifferentiableOptions options = scene.options;
  options.samples_per_side = samples_per_side;
  DifferentiableRenderer renderer(scene.objects, options);
  const DifferentiableBuffers images = LossImages(scene);
  Comparison comparison;
  for (int axis = first_axis; axis <= last_axis; ++axis) {
    const bool camera_moves = axis < 6, turns = axis % 6 >= 3;
    const double unit = turns && !camera_moves ? 1.0 / 0.3 : 1.0;
    const auto changed = [&](const Eigen::Isometry3d& pose, double step) {
      Eigen::Isometry3d moved = pose;
      const Eigen::Vector3d along = Eigen::Vector3d::Unit(axis % 3);
      if (turns) {
        moved.linear() = Eigen::AngleAxisd(unit * step, along) * pose.linear();
      } else {
        moved.translation() += step * along;
      }
      return moved;
    };
    const auto apply = [&](double step, core::Camera* camera) {
      if (camera_moves) {
        camera->world_from_camera = changed(scene.camera.world_from_camera, step);
      } else {
        renderer.SetPose(0, changed(scene.objects[0].world_from_object, step));
      }
    };
    Losses prediction{};
    for (int k = 0; k < kOutputs; ++k) {
      const PoseGradient& pose =
          camera_moves ? gradients[k].camera.pose : gradients[k].objects[0].pose;
      prediction[k] = unit * (turns ? pose.rotation : pose.translation)[axis % 3];
    }
    comparison.Add(CentralDifference(&renderer, scene.camera, images, kStep, seeds, apply),
                   prediction);
  }
  return comparison;
}

// Compares focal lengths and principal point with relative steps (of the width for the point).
inline Comparison CompareLens(const GateScene& scene, int samples_per_side, int seeds,
                              const std::array<SceneGradients, kOutputs>& gradients) {
  DifferentiableOptions options = scene.options;
  options.samples_per_side = samples_per_side;
  DifferentiableRenderer renderer(scene.objects, options);
  const DifferentiableBuffers images = LossImages(scene);
  Comparison comparison;
  for (int which = 0; which < 4; ++which) {
    const double unit = which == 0   ? scene.camera.fx
                        : which == 1 ? scene.camera.fy
                                     : scene.camera.width;
    const auto apply = [&](double step, core::Camera* camera) {
      double* values[] = {&camera->fx, &camera->fy, &camera->cx, &camera->cy};
      *values[which] += unit * step;
    };
    Losses prediction{};
    for (int k = 0; k < kOutputs; ++k) {
      const CameraGradients& camera = gradients[k].camera;
      const double values[] = {camera.fx, camera.fy, camera.cx, camera.cy};
      prediction[k] = unit * values[which];
    }
    comparison.Add(CentralDifference(&renderer, scene.camera, images, kStep, seeds, apply),
                   prediction);
  }
  return comparison;
}

// The gates: 2% and a cosine of 0.99. For single vertices, whose differences are noisy, the cosine.
inline void ExpectGate(const Comparison& comparison, const char* what, double most = 0.02) {
  static const char* const kNames[] = {"color", "mask", "depth", "normal"};
  for (int k = 0; k < kOutputs; ++k) {
    const Agreement a = comparison.Of(k);
    if (a.size < 1e-9) continue;
    std::printf("    %-16s %-7s size %9.3f  error %6.3f%%  cosine %.5f\n", what, kNames[k], a.size,
                100.0 * a.error, a.cosine);
    EXPECT_LE(a.error, most) << what << ", " << kNames[k];
    EXPECT_GE(a.cosine, 0.99) << what << ", " << kNames[k];
  }
}

}  // namespace simwright::render
