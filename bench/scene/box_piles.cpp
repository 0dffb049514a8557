// Measures the projection of heaps of boxes onto scenes without penetration, and prints the scenes
// and displacements as JSON for bench/peers/projection.py, which solves the same ones in Drake.
//   bench_box_piles --boxes 34 --count 5
// A heap has boxes with edges of 4 to 12 cm, half of them tilted, at random places up to 25 cm
// above a fixed table whose top is z = 0.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <CLI/CLI.hpp>

#include "core/random.h"
#include "scene/feasibility/depenetration.h"

namespace simwright {
namespace {

constexpr double kHeight = 0.25, kTableSide = 2.0;  // m
constexpr double kSpacePerBox = 0.36 / 34.0;        // m^2 of the table

struct Arguments {
  int boxes = 34, count = 5, repeats = 9;
  std::uint64_t seed = 1;
};

struct Box {
  Eigen::Vector3d half;  // m
  std::vector<geometry::ConvexShape> parts;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
};

geometry::ConvexShape ShapeOf(const Eigen::Vector3d& half) {
  geometry::ConvexShape shape;
  for (int i = 0; i < 8; ++i) {
    shape.vertices.emplace_back((i & 1 ? 1 : -1) * half.x(), (i & 2 ? 1 : -1) * half.y(),
                                (i & 4 ? 1 : -1) * half.z());
  }
  return shape;
}

std::vector<Box> Heap(const Arguments& arguments, core::Rng& rng) {
  const double reach = 0.5 * std::sqrt(arguments.boxes * kSpacePerBox);
  std::vector<Box> heap(static_cast<size_t>(arguments.boxes) + 1);
  heap[0].half = Eigen::Vector3d(0.5 * kTableSide, 0.5 * kTableSide, 0.05);
  heap[0].pose.translation().z() = -0.05;
  for (size_t i = 1; i < heap.size(); ++i) {
    const auto between = [&](double low, double high) { return core::Uniform(rng, low, high); };
    heap[i].half = {between(0.02, 0.06), between(0.02, 0.06), between(0.02, 0.06)};
    heap[i].pose.translation() =
        Eigen::Vector3d{between(-reach, reach), between(-reach, reach), between(0.02, kHeight)};
    heap[i].pose.rotate(Eigen::AngleAxisd(between(-M_PI, M_PI), Eigen::Vector3d::UnitZ()));
    if (i % 2 == 0) {
      heap[i].pose.rotate(Eigen::AngleAxisd(between(-1.0, 1.0), Eigen::Vector3d::UnitX()));
    }
  }
  for (Box& box : heap) box.parts = {ShapeOf(box.half)};
  return heap;
}

void Print(const char* name, const Eigen::Ref<const Eigen::VectorXd>& numbers, const char* end) {
  std::printf("\"%s\": [", name);
  for (Eigen::Index i = 0; i < numbers.size(); ++i) {
    std::printf("%s%.17g", i == 0 ? "" : ", ", numbers[i]);
  }
  std::printf("]%s", end);
}

void Measure(const Arguments& arguments, int number) {
  core::Rng rng = core::StreamRng(arguments.seed, static_cast<std::uint64_t>(number));
  const std::vector<Box> heap = Heap(arguments, rng);
  std::vector<scene::ProjectedBody> bodies;
  for (const Box& box : heap) bodies.push_back({&box.parts, box.pose, &box == heap.data()});
  std::vector<double> milliseconds;
  scene::Projection projection;
  for (int i = 0; i < arguments.repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    projection = scene::ResolvePenetrations(bodies);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    milliseconds.push_back(took.count());
  }
  const auto middle = milliseconds.begin() + arguments.repeats / 2;
  std::nth_element(milliseconds.begin(), middle, milliseconds.end());
  std::printf("%s{\"ms\": %.4f, \"feasible\": %s, \"boxes\": [", number == 0 ? "" : ",\n", *middle,
              projection.feasible ? "true" : "false");
  for (size_t i = 0; i < heap.size(); ++i) {
    std::printf("%s{", i == 0 ? "" : ", ");
    Print("size", 2.0 * heap[i].half, ", ");
    Print("translation", heap[i].pose.translation(), ", ");
    Print("rotation_xyzw", Eigen::Quaterniond(heap[i].pose.linear()).coeffs(), ", ");
    Print("shift", projection.shifts[i], "}");
  }
  std::printf("]}");
}

}  // namespace
}  // namespace simwright

int main(int argc, char** argv) {
  CLI::App app("Heaps of boxes: time to make them feasible");
  simwright::Arguments arguments;
  app.add_option("--boxes", arguments.boxes, "Boxes per heap")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--count", arguments.count, "Number of heaps")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--repeats", arguments.repeats, "Timed projections of each")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seed", arguments.seed, "Seed of the heaps")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("[");
    for (int i = 0; i < arguments.count; ++i) simwright::Measure(arguments, i);
    std::printf("]\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
