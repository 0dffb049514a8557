#pragma once

#include <string>
#include <vector>

#include "geometry/simplify.h"
#include "tests/geometry/solid_shapes.h"

// Household and workshop shapes with hollows, holes and limbs, each one closed solid (m).
namespace simwright::bench {

struct NamedSolid {
  std::string name;
  core::TriangleMesh mesh;
};

// Returns the solid where `distance` is negative, simplified to 4000 faces: the input of all
// methods.
inline core::TriangleMesh Smooth(const Eigen::AlignedBox3d& box, double cell,
                                 const std::function<double(const Eigen::Vector3d&)>& distance) {
  geometry::SimplifyOptions options;
  options.face_budget = 4000;
  return geometry::Simplify(shapes::Implicit(box, cell, distance), options);
}

inline double CapsuleDistance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                              const Eigen::Vector3d& b, double radius) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - radius;
}

inline core::TriangleMesh Gear(int teeth, double inner, double outer, double height) {
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < 4 * teeth; ++i) {
    const double angle = 2.0 * shapes::kPi * (i + 0.5) / (4 * teeth);
    const double r = i % 4 < 2 ? outer : inner;
    polygon.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return shapes::Prism(polygon, height);
}

inline core::TriangleMesh Star(int points, double inner, double outer, double height) {
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = shapes::kPi * i / points;
    const double r = i % 2 ? inner : outer;
    polygon.emplace_back(r * std::cos(angle), r * std::sin(angle));
  }
  return shapes::Prism(polygon, height);
}

inline std::vector<NamedSolid> BoxSolids() {
  using shapes::BoxAt;
  using shapes::BoxUnion;
  return {
      {"L", BoxUnion({BoxAt(0, 0, 0, .3, .1, .05), BoxAt(0, 0, 0, .05, .1, .2)})},
      {"U", BoxUnion({BoxAt(0, 0, 0, .3, .1, .05), BoxAt(0, 0, 0, .05, .1, .2),
                      BoxAt(.25, 0, 0, .3, .1, .2)})},
      {"cross",
       BoxUnion({BoxAt(-.15, -.03, -.03, .15, .03, .03), BoxAt(-.03, -.15, -.03, .03, .15, .03),
                 BoxAt(-.03, -.03, -.15, .03, .03, .15)})},
      {"open box", BoxUnion({BoxAt(0, 0, 0, .3, .2, .01), BoxAt(0, 0, 0, .01, .2, .15),
                             BoxAt(.29, 0, 0, .3, .2, .15), BoxAt(0, 0, 0, .3, .01, .15),
                             BoxAt(0, .19, 0, .3, .2, .15)})},
      {"table", BoxUnion({BoxAt(0, 0, .7, 1.2, .7, .74), BoxAt(.03, .03, 0, .09, .09, .72),
                          BoxAt(1.11, .03, 0, 1.17, .09, .72), BoxAt(.03, .61, 0, .09, .67, .72),
                          BoxAt(1.11, .61, 0, 1.17, .67, .72)})},
      {"chair", BoxUnion({BoxAt(0, 0, .42, .42, .42, .46), BoxAt(0, 0, 0, .04, .04, .44),
                          BoxAt(.38, 0, 0, .42, .04, .44), BoxAt(0, .38, 0, .04, .42, .9),
                          BoxAt(.38, .38, 0, .42, .42, .9), BoxAt(0, .38, .7, .42, .42, .85)})},
      {"shelf", BoxUnion({BoxAt(0, 0, 0, .02, .3, 1.2), BoxAt(.78, 0, 0, .8, .3, 1.2),
                          BoxAt(0, 0, .1, .8, .3, .12), BoxAt(0, 0, .45, .8, .3, .47),
                          BoxAt(0, 0, .8, .8, .3, .82), BoxAt(0, 0, 1.18, .8, .3, 1.2)})},
      {"stairs", BoxUnion({BoxAt(0, 0, 0, .8, .5, .1), BoxAt(.2, 0, 0, .8, .5, .2),
                           BoxAt(.4, 0, 0, .8, .5, .3), BoxAt(.6, 0, 0, .8, .5, .4)})},
  };
}

inline std::vector<NamedSolid> TurnedSolids() {
  using shapes::Revolved;
  return {
      {"torus", shapes::Torus(.1, .03, 48, 20)},
      {"washer", Revolved({{.03, 0}, {.06, 0}, {.06, .01}, {.03, .01}}, 48)},
      {"cup", shapes::Cup(.04, .1, .003, 48)},
      {"bowl", shapes::Bowl(.08, .005, 48)},
      {"plate",
       Revolved({{0, 0}, {.08, 0}, {.13, .02}, {.127, .024}, {.078, .005}, {0, .005}}, 48)},
      {"bottle", Revolved({{0, 0},
                           {.035, 0},
                           {.035, .15},
                           {.012, .2},
                           {.012, .24},
                           {.009, .24},
                           {.009, .199},
                           {.031, .148},
                           {.031, .004},
                           {0, .004}},
                          48)},
      {"funnel",
       Revolved({{.01, 0}, {.01, .05}, {.07, .12}, {.066, .12}, {.007, .052}, {.007, 0}}, 48)},
      {"wine glass", Revolved({{0, 0},
                               {.035, 0},
                               {.035, .003},
                               {.004, .008},
                               {.004, .09},
                               {.035, .12},
                               {.03, .2},
                               {.028, .2},
                               {.032, .121},
                               {0, .095}},
                              48)},
      {"dumbbell",
       Revolved(
           {{0, 0}, {.06, 0}, {.06, .05}, {.015, .05}, {.015, .2}, {.06, .2}, {.06, .25}, {0, .25}},
           48)},
      {"star", Star(5, .04, .1, .03)},
      {"gear", Gear(12, .08, .1, .02)},
  };
}

inline std::vector<NamedSolid> SmoothSolids() {
  using Eigen::Vector3d;
  geometry::SimplifyOptions thin;
  thin.face_budget = 4000;
  std::vector<NamedSolid> solids{{"mug", geometry::Simplify(shapes::Mug(.0015), thin)}};
  const auto pan = [](const Vector3d& p) {
    const double r = std::hypot(p.x(), p.y());
    const double body =
        std::max(std::max({r - .12, p.z() - .05, -p.z()}), -std::max(r - .114, .005 - p.z()));
    return std::min(body, CapsuleDistance(p, {.122, 0, .04}, {.3, 0, .06}, .01));
  };
  solids.push_back(
      {"pan", Smooth({Vector3d(-.13, -.13, -.01), Vector3d(.32, .13, .08)}, .002, pan)});
  const auto hook = [](const Vector3d& p) {
    const double shank = CapsuleDistance(p, {0, 0, .05}, {0, 0, .15}, .01);
    const double along = std::hypot(p.x() - .03, p.z() - .05) - .03;
    const bool lower = p.z() < .05;
    const double bow =
        lower ? std::hypot(along, p.y()) - .01 : (p - Vector3d(.06, 0, .05)).norm() - .01;
    return std::min(shank, bow);
  };
  solids.push_back(
      {"hook", Smooth({Vector3d(-.02, -.02, .0), Vector3d(.08, .02, .17)}, .0015, hook)});
  const auto basket = [](const Vector3d& p) {
    const double r = std::hypot(p.x(), p.y());
    const double wall = .1 + .2 * p.z();
    const double body = std::max(std::max({r - wall, p.z() - .2, -p.z()}),
                                 -std::max(r - wall + .006, .006 - p.z()));
    const double bow = std::hypot(std::hypot(p.x(), p.z() - .19) - .138, p.y()) - .006;
    return std::min(body, std::max(bow, .19 - p.z()));
  };
  solids.push_back(
      {"bucket", Smooth({Vector3d(-.15, -.15, -.01), Vector3d(.15, .15, .34)}, .0025, basket)});
  const auto spoon = [](const Vector3d& p) {
    const double bowl = std::max({(p - Vector3d(0, 0, .02)).norm() - .03,
                                  .027 - (p - Vector3d(0, 0, .02)).norm(), p.z() - .01});
    return std::min(bowl, CapsuleDistance(p, {.027, 0, .007}, {.16, 0, .03}, .004));
  };
  solids.push_back(
      {"ladle", Smooth({Vector3d(-.04, -.04, -.015), Vector3d(.17, .04, .04)}, .001, spoon)});
  return solids;
}

inline std::vector<NamedSolid> AllSolids() {
  std::vector<NamedSolid> all = BoxSolids();
  for (auto&& group : {TurnedSolids(), SmoothSolids()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

}  // namespace simwright::bench
