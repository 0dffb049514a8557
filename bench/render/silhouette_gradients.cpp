// Measures the gradients of a silhouette loss against finite differences: their errors and the
// milliseconds of a step (moved vertices, refit, forward and backward), per number of edge samples.
//   bench_silhouette_gradients --triangles 10000 --edges 1000 4000 16000 64000 --reference
// The loss is the mean over the pixels of w mask with w = 1 + 0.6 sin(7 x + 2 y), x and y from 0 to
// 1 over the image. Its gradients with respect to the vertices are projected onto 24 displacement
// fields d_k(p) = e_(k mod 3) cos(a_k . p + k), the first three with a_k = 0 and without the k, and
// compared by bench/peers/silhouette_gradients.py, which reads the JSON that this prints.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <string>

#include <CLI/CLI.hpp>

#include "bench/render/bumpy_ball.h"
#include "core/camera.h"
#include "core/parallel.h"
#include "render/differentiable.h"

namespace simwright {
namespace {

constexpr int kFields = 24;
constexpr double kStep = 0.002;        // m, of the finite differences
constexpr int kReferenceSamples = 40;  // per pixel side

using Vectors = std::vector<Eigen::Vector3d>;

struct Arguments {
  int triangles = 10000, pixels = 128, side = 2, repeats = 40;
  std::vector<int> edges = {1000, 4000, 16000, 64000};
  bool reference = false;
};

// Returns the displacement field `k` at the vertices.
Vectors FieldAt(const Vectors& vertices, int k) {
  const double turn = k;
  const Eigen::Vector3d direction(std::sin(turn), std::cos(2.0 * turn), std::sin(3.0 * turn + 1.0));
  const Eigen::Vector3d frequency = 3.0 * (k / 3) * direction.normalized();
  Vectors field;
  for (const Eigen::Vector3d& v : vertices) {
    field.push_back(std::cos(frequency.dot(v) + (k < 3 ? 0.0 : turn)) *
                    Eigen::Vector3d::Unit(k % 3));
  }
  return field;
}

core::FloatImage PixelWeights(int pixels) {
  core::FloatImage weights(pixels, pixels, 1, 0.0f);
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      const double u = (x + 0.5) / pixels, v = (y + 0.5) / pixels;
      const double weight = 1.0 + 0.6 * std::sin(7.0 * u + 2.0 * v);
      weights.values[static_cast<size_t>(y) * pixels + x] =
          static_cast<float>(weight / (static_cast<double>(pixels) * pixels));
    }
  }
  return weights;
}

double LossOf(const core::FloatImage& mask, const core::FloatImage& weights) {
  double sum = 0.0;
  for (size_t i = 0; i < mask.values.size(); ++i) sum += 1.0 * mask.values[i] * weights.values[i];
  return sum;
}

double Seconds(clockid_t clock) {
  timespec time;
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double LowerQuartile(std::vector<double> values) {
  const auto quartile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::nth_element(values.begin(), quartile, values.end());
  return *quartile;
}

class Bench {
 public:
  explicit Bench(const Arguments& arguments)
      : arguments_(arguments),
        camera_(core::OrbitCamera(Eigen::Vector3d::Zero(), 1.8, 0.4, 0.7, 0.61, arguments.pixels,
                                  arguments.pixels)),
        weights_(PixelWeights(arguments.pixels)) {
    object_.mesh = BumpyBall(static_cast<int>(std::lround(std::sqrt(arguments.triangles / 4.0))));
    CloseAtPoles(&object_.mesh);
    for (int k = 0; k < kFields; ++k) fields_.push_back(FieldAt(object_.mesh.vertices, k));
  }

  // Prints the loss and its central differences along the fields, with two seeds.
  void PrintReference() const {
    render::DifferentiableOptions options;
    options.samples_per_side = kReferenceSamples;
    options.edge_samples = 0;
    render::DifferentiableRenderer renderer({object_}, options);
    std::printf("\"loss\": %.9g, \"reference\": [",
                LossOf(renderer.Render(camera_, 1).mask, weights_));
    for (int seed = 1; seed <= 2; ++seed) {
      std::printf("%s[", seed == 1 ? "" : ", ");
      for (int k = 0; k < kFields; ++k) {
        double losses[2];
        for (const int sign : {0, 1}) {
          Vectors moved = object_.mesh.vertices;
          for (size_t i = 0; i < moved.size(); ++i) {
            moved[i] += (2 * sign - 1) * kStep * fields_[static_cast<size_t>(k)][i];
          }
          renderer.SetVertices(0, moved);
          losses[sign] =
              LossOf(renderer.Render(camera_, static_cast<std::uint64_t>(seed)).mask, weights_);
        }
        std::printf("%s%.9g", k == 0 ? "" : ", ", (losses[1] - losses[0]) / (2.0 * kStep));
      }
      std::printf("]");
    }
    std::printf("], ");
  }

  // Prints the lower quartiles of the steps' ms, of the clock and of the processor, and the
  // projected gradients of each step.
  void PrintSteps(int edges) const {
    render::DifferentiableOptions options;
    options.samples_per_side = arguments_.side;
    options.edge_samples = edges;
    render::DifferentiableRenderer renderer({object_}, options);
    render::DifferentiableBuffers gradient;
    gradient.mask = weights_;
    render::SceneGradients gradients;
    std::vector<double> milliseconds, processor;
    std::string rows;
    for (int step = -3; step < arguments_.repeats; ++step) {  // three to warm up
      const double start = 1e3 * Seconds(CLOCK_MONOTONIC);
      const double processor_start = 1e3 * Seconds(CLOCK_PROCESS_CPUTIME_ID);
      renderer.SetVertices(0, object_.mesh.vertices);
      renderer.Render(camera_, static_cast<std::uint64_t>(step + 100));
      gradients.SetZero();
      renderer.Backward(gradient, &gradients);
      if (step < 0) continue;
      milliseconds.push_back(1e3 * Seconds(CLOCK_MONOTONIC) - start);
      processor.push_back(1e3 * Seconds(CLOCK_PROCESS_CPUTIME_ID) - processor_start);
      rows += (step == 0 ? "[" : ", [") + Projected(gradients.objects[0].vertices) + "]";
    }
    std::printf("{\"edges\": %d, \"ms\": %.4f, \"processor_ms\": %.4f, \"gradients\": [%s]}", edges,
                LowerQuartile(milliseconds), LowerQuartile(processor), rows.c_str());
  }

 private:
  std::string Projected(const Vectors& gradient) const {
    std::string text;
    for (const Vectors& field : fields_) {
      double sum = 0.0;
      for (size_t i = 0; i < field.size(); ++i) sum += field[i].dot(gradient[i]);
      char number[32];
      std::snprintf(number, sizeof number, "%s%.9g", text.empty() ? "" : ", ", sum);
      text += number;
    }
    return text;
  }

  Arguments arguments_;
  core::Camera camera_;
  core::FloatImage weights_;
  render::DifferentiableObject object_;
  std::vector<Vectors> fields_;
};

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Gradients of a silhouette loss against finite differences");
  simwright::Arguments arguments;
  app.add_option("--triangles", arguments.triangles, "Triangles, about")->capture_default_str();
  app.add_option("--pixels", arguments.pixels, "Pixels per image side")->capture_default_str();
  app.add_option("--side", arguments.side, "Samples per pixel side")->capture_default_str();
  app.add_option("--repeats", arguments.repeats, "Timed steps")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--edges", arguments.edges, "Edge samples per image")->capture_default_str();
  app.add_flag("--reference", arguments.reference, "Print finite differences too");
  CLI11_PARSE(app, argc, argv);
  try {
    simwright::core::SetThreadCount(0);
    const simwright::Bench bench(arguments);
    std::printf("{");
    if (arguments.reference) bench.PrintReference();
    std::printf("\"threads\": %d, \"settings\": [", simwright::core::ThreadCount());
    for (size_t i = 0; i < arguments.edges.size(); ++i) {
      if (i > 0) std::printf(", ");
      bench.PrintSteps(arguments.edges[i]);
    }
    std::printf("]}\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
