#include <algorithm>
#include <cmath>

#include "library/rigid_kinds.h"
#include "library/rigid_shapes.h"

// Toys put together from several pieces, each one solid.
namespace simwright::library {
namespace {

// Rings of falling size on a foot, a ball on top; the rod between them is hidden.
core::TexturedMesh StackingRing(RigidDraft* d) {
  constexpr int kRings = 5, kSteps = 10;
  const double r = 0.5 * d->size.y(), h = d->size.z();
  const double foot = 0.06 * h, thick = 0.15 * h;
  std::vector<ProfilePoint> profile{{0, 0}, {0.82 * r, 0}, {0.82 * r, foot}};
  const auto arc = [&](double middle, double z, double across, double up, double end, int look) {
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = end * (2.0 * k / kSteps - 1.0);
      profile.push_back({middle + across * std::cos(angle), z + up * std::sin(angle), look});
    }
  };
  for (int ring = 0; ring < kRings; ++ring) {
    const double radius = r * (1.0 - 0.11 * ring), half = 0.5 * thick;
    const double round = std::min(half, 0.5 * radius);
    arc(radius - round, foot + thick * (ring + 0.5), round, half, 1.4, ring + 1);
  }
  const double top = foot + kRings * thick, ball = 0.5 * (h - top);
  arc(0.0, top + ball, 0.24 * r, ball, 1.35, 6);
  profile.push_back({0, h, 6});
  return Revolved(profile, {Look("wood", .80f, .64f, .42f), Look("red", .80f, .20f, .17f),
                            Look("orange", .92f, .54f, .16f), Look("yellow", .93f, .80f, .25f),
                            Look("green", .30f, .60f, .34f), Look("blue", .22f, .42f, .70f),
                            Look("red", .80f, .20f, .17f)});
}

core::TexturedMesh Block(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                         const core::Material& look) {
  const Eigen::Vector3d size = high - low;
  core::TexturedMesh mesh =
      PaintedBox(size, 0.08 * size.minCoeff(), {look}, [](const Eigen::Vector3d&) { return 0; });
  Move(0.5 * (low + high), &mesh);
  return mesh;
}

// A turned piece between two ends of its axis, with rounded edges.
core::TexturedMesh Wheel(double radius, double width, const core::Material& tread,
                         const core::Material& hub) {
  return AlongY(Revolved({{0, 0, 1},
                          {0.5 * radius, 0, 1},
                          {0.92 * radius, 0},
                          {radius, 0.15 * width},
                          {radius, 0.85 * width},
                          {0.92 * radius, width},
                          {0.5 * radius, width},
                          {0, width, 1}},
                         {tread, hub}));
}

// An engine of wood, its front at x; wheels that do not turn reach a little into the frame.
core::TexturedMesh ToyTrain(RigidDraft* d) {
  const double l = d->size.x(), w = d->size.y(), h = d->size.z(), wheel = 0.17 * h;
  const core::Material wood = Look("wood", .78f, .60f, .38f), paint = Print(d), roof = Print(d),
                       black = Look("black", .17f, .17f, .18f);
  core::TexturedMesh mesh =
      Block({-0.5 * l, -0.39 * w, 0.22 * h}, {0.5 * l, 0.39 * w, 0.38 * h}, wood);
  const double boiler = std::min(0.2 * h, 0.36 * w), axis = 0.36 * h + 0.92 * boiler;
  core::TexturedMesh tank = AlongX(Revolved({{0, -0.16 * l},
                                             {boiler, -0.16 * l},
                                             {boiler, 0.38 * l},
                                             {0.97 * boiler, 0.40 * l},
                                             {0.88 * boiler, 0.43 * l, 1},
                                             {0, 0.43 * l, 1}},
                                            {paint, black}));
  Move({0, 0, axis}, &tank);
  Join(tank, &mesh);
  Join(Block({-0.45 * l, -0.37 * w, 0.36 * h}, {-0.13 * l, 0.37 * w, 0.87 * h}, paint), &mesh);
  Join(Block({-0.49 * l, -0.44 * w, 0.85 * h}, {-0.09 * l, 0.44 * w, 0.93 * h}, roof), &mesh);
  const double pipe = 0.4 * boiler;
  core::TexturedMesh chimney = Revolved({{0, axis},
                                         {pipe, axis},
                                         {pipe, 0.88 * h},
                                         {1.45 * pipe, 0.91 * h},
                                         {1.45 * pipe, h},
                                         {0, h}},
                                        {black});
  Move({0.29 * l, 0, 0}, &chimney);
  Join(chimney, &mesh);
  for (const double along : {-0.33, 0.0, 0.33}) {
    for (const double side : {-0.36, 0.5}) {
      core::TexturedMesh one = Wheel(wheel, 0.14 * w, roof, wood);
      Move({along * l, side * w, wheel}, &one);
      Join(one, &mesh);
    }
  }
  return mesh;
}

}  // namespace

std::vector<RigidKind> ToyKinds() {
  using S = RigidSides;
  return {{"stacking_ring", "stacking ring", "five rings on a foot", S::kRound, StackingRing},
          {"toy_train", "toy locomotive", "an engine of wood", S::kFree, ToyTrain}};
}

}  // namespace simwright::library
