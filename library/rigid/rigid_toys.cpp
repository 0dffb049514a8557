#include <algorithm>
#include <cmath>

#include "library/convex_shapes.h"
#include "library/rigid/revolved_parts.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Toys assembled from several solid pieces.
namespace simwright::library {
namespace {

// Returns rings of decreasing size on a base with a ball on top; the rod between them is hidden.
core::TexturedMesh StackingRing(RigidDraft* d) {
  constexpr int kRings = 5, kSteps = 10;
  const double r = 0.5 * d->size.y(), h = d->size.z();
  const double foot = 0.06 * h, thick = 0.15 * h;
  std::vector<ProfilePoint> profile{{0, 0}, {0.82 * r, 0}, {0.82 * r, foot}};
  d->parts = {RevolvedHull({profile[1], profile[2]}, 20, 8)};
  const auto arc = [&](double middle, double z, double across, double up, double end, int look) {
    std::vector<ProfilePoint> rings;  // every other ring of a part
    for (int k = 0; k <= kSteps; ++k) {
      const double angle = end * (2.0 * k / kSteps - 1.0);
      profile.push_back({middle + across * std::cos(angle), z + up * std::sin(angle), look});
      if (k % 2 == 0) rings.push_back(profile.back());
    }
    rings.front().z = z - up;  // on the rings below and above it
    rings.back().z = z + up;
    d->parts.push_back(RevolvedHull(rings, 10));
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

// Returns a wheel with rounded edges between two ends of its axis, and its part.
core::TexturedMesh Wheel(double radius, double width, const core::Material& tread,
                         const core::Material& hub, core::TriangleMesh* part) {
  *part = RevolvedHull(
      {{0.92 * radius, 0}, {radius, 0.15 * width}, {radius, 0.85 * width}, {0.92 * radius, width}},
      12);
  for (Eigen::Vector3d& v : part->vertices) v = Eigen::Vector3d(v.x(), -v.z(), v.y());
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

// The pieces of an engine and their parts.
class Engine {
 public:
  explicit Engine(RigidDraft* draft) : draft_(draft) {}
  void AddBlock(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                const core::Material& look) {
    Join(Block(low, high, look), &mesh_);
    draft_->parts.push_back(Box(low, high, 0.0));
  }
  void Add(core::TexturedMesh piece, core::TriangleMesh part, const Eigen::Vector3d& at) {
    Move(at, &piece);
    Join(piece, &mesh_);
    for (Eigen::Vector3d& v : part.vertices) v += at;
    draft_->parts.push_back(std::move(part));
  }
  const core::TexturedMesh& mesh() const { return mesh_; }

 private:
  RigidDraft* draft_;
  core::TexturedMesh mesh_;
};

// Adds the boiler, behind its cap, along x.
void AddBoiler(double radius, double length, double height, const core::Material& paint,
               const core::Material& cap, Engine* engine) {
  const ProfilePoint rear{radius, -0.16 * length}, front{radius, 0.38 * length},
      face{0.88 * radius, 0.43 * length, 1};
  core::TriangleMesh part = RevolvedHull({rear, front, face}, 16);
  for (Eigen::Vector3d& v : part.vertices) v = Eigen::Vector3d(v.z(), v.x(), v.y());
  engine->Add(AlongX(Revolved(
                  {{0, rear.z}, rear, front, {0.97 * radius, 0.40 * length}, face, {0, face.z, 1}},
                  {paint, cap})),
              part, {0, 0, height});
}

// Returns a wooden engine with its front at x; the fixed wheels extend slightly into the frame.
core::TexturedMesh ToyTrain(RigidDraft* d) {
  const double l = d->size.x(), w = d->size.y(), h = d->size.z(), wheel = 0.17 * h;
  const core::Material wood = Look("wood", .78f, .60f, .38f), paint = Print(d), roof = Print(d),
                       black = Look("black", .17f, .17f, .18f);
  Engine engine(d);
  engine.AddBlock({-0.5 * l, -0.39 * w, 0.22 * h}, {0.5 * l, 0.39 * w, 0.38 * h}, wood);
  const double boiler = std::min(0.2 * h, 0.36 * w), axis = 0.36 * h + 0.92 * boiler;
  AddBoiler(boiler, l, axis, paint, black, &engine);
  engine.AddBlock({-0.45 * l, -0.37 * w, 0.36 * h}, {-0.13 * l, 0.37 * w, 0.87 * h}, paint);
  engine.AddBlock({-0.49 * l, -0.44 * w, 0.85 * h}, {-0.09 * l, 0.44 * w, 0.93 * h}, roof);
  const double pipe = 0.4 * boiler;
  const ProfilePoint base{pipe, axis}, waist{pipe, 0.88 * h}, rim{1.45 * pipe, 0.91 * h},
      top{1.45 * pipe, h};
  engine.Add(Revolved({{0, axis}, base, waist, rim, top, {0, h}}, {black}),
             RevolvedHull({base, waist, rim, top}, 12), {0.29 * l, 0, 0});
  for (const double along : {-0.33, 0.0, 0.33}) {
    for (const double side : {-0.36, 0.5}) {
      core::TriangleMesh part;
      const core::TexturedMesh one = Wheel(wheel, 0.14 * w, roof, wood, &part);
      engine.Add(one, part, {along * l, side * w, wheel});
    }
  }
  return engine.mesh();
}

}  // namespace

std::vector<RigidKind> ToyKinds() {
  using S = SizeSymmetry;
  return {{"stacking_ring", "stacking ring", "five rings on a foot", S::kRound, StackingRing},
          {"toy_train", "toy locomotive", "an engine of wood", S::kFree, ToyTrain}};
}

}  // namespace simwright::library
