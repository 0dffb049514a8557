#include <cmath>

#include "library/rigid/revolved_parts.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Fruit, eggs and balls. Fruit is flattened at its base, like soft fruit, so that it does not roll.
namespace simwright::library {
namespace {

constexpr int kSteps = 24;  // from pole to pole

// Returns a ball of modified radius and height: `bend` maps the angle from the lower pole (0 to pi)
// to a factor of the radius and a shift of the height, in radii.
core::TexturedMesh Bent(const core::Material& look, Eigen::Vector2d (*bend)(double)) {
  std::vector<ProfilePoint> profile;
  for (int k = 0; k <= kSteps; ++k) {
    const double angle = M_PI * k / kSteps;
    const Eigen::Vector2d by = bend(angle);
    const bool pole = k == 0 || k == kSteps;
    profile.push_back({pole ? 0.0 : by.x() * std::sin(angle), by.y() - std::cos(angle)});
  }
  return Revolved(profile, {look});
}

// Flattens fruit that lies on its lower pole or on its side.
core::TexturedMesh Fruit(core::TexturedMesh mesh) {
  Flatten(0.02, &mesh);
  return mesh;
}

// Returns upright fruit with dimples as one hull: no object enters the dimples.
core::TexturedMesh DimpledFruit(RigidDraft* d, core::TexturedMesh mesh) {
  constexpr int kRound = 48, kCorners = 10;  // per ring of Revolved; per ring of the part
  mesh = Fruit(std::move(mesh));
  const std::vector<Eigen::Vector3d>& vertices = mesh.mesh.vertices;
  const double ground = core::Bounds(mesh.mesh).min().z();
  // Vertices start with the pole, then ring after ring, each with a corner at x first.
  std::vector<ProfilePoint> rings;
  for (size_t first = 1; first + kRound < vertices.size(); first += kRound) {
    const ProfilePoint ring{vertices[first].x(), vertices[first].z()};
    if (ring.z <= ground + 1e-12 && !rings.empty()) rings.clear();
    rings.push_back(ring);
  }
  std::vector<ProfilePoint> few;  // the base and five more
  for (size_t i = 0; i < 6; ++i) few.push_back(rings[i * (rings.size() - 1) / 5]);
  d->parts = {RevolvedHull(few, kCorners, 8)};
  return mesh;
}

Eigen::Vector2d Ball(double) {
  return {1.0, 0.0};
}

// Returns a bend with dimples at the stalk and, shallower, at the bottom.
Eigen::Vector2d Dimpled(double angle) {
  const double top = std::exp(-std::pow((M_PI - angle) / 0.42, 2));
  const double bottom = std::exp(-std::pow(angle / 0.35, 2));
  return {1.0, -0.36 * top + 0.14 * bottom};
}

// Returns a bend that is slimmer towards one end.
Eigen::Vector2d Egg(double angle) {
  return {1.0 + 0.12 * std::cos(angle), 0.0};
}

// Returns a bend with a neck at the top.
Eigen::Vector2d Pear(double angle) {
  const double up = -std::cos(angle);
  return {1.0 - 0.32 / (1.0 + std::exp(-6.0 * (up - 0.25))), 0.0};
}

// Returns a bend that is slimmer at the top, without a neck.
Eigen::Vector2d Avocado(double angle) {
  const double up = -std::cos(angle);
  return {1.0 - 0.30 / (1.0 + std::exp(-4.0 * (up - 0.35))), 0.0};
}

// Returns a bend that is pointed at both ends.
Eigen::Vector2d Lemon(double angle) {
  const double up = -std::cos(angle);
  return {1.0 - 0.16 * std::pow(up, 4), 0.18 * std::pow(up, 9)};
}

core::TexturedMesh Apple(RigidDraft* d) {
  return DimpledFruit(
      d, Bent(d->Draw(0, 1) < 0.5 ? Look("red", .70f, .14f, .13f) : Look("green", .55f, .68f, .22f),
              Dimpled));
}
core::TexturedMesh Tomato(RigidDraft* d) {
  return DimpledFruit(d, Bent(Look("tomato", .82f, .18f, .12f), Dimpled));
}
core::TexturedMesh Orange(RigidDraft*) {
  return Fruit(Bent(Look("orange", .93f, .54f, .13f), Ball));
}
core::TexturedMesh Peach(RigidDraft* d) {
  return DimpledFruit(d, Bent(Look("peach", .93f, .62f, .42f), Dimpled));
}
core::TexturedMesh PearShape(RigidDraft*) {
  return Fruit(Bent(Look("pear", .74f, .74f, .30f), Pear));
}
core::TexturedMesh LemonShape(RigidDraft*) {
  return Fruit(AlongX(Bent(Look("lemon", .95f, .84f, .22f), Lemon)));
}
core::TexturedMesh Lime(RigidDraft*) {
  return Fruit(AlongX(Bent(Look("lime", .42f, .62f, .20f), Lemon)));
}
core::TexturedMesh AvocadoShape(RigidDraft* d) {
  return Fruit(AlongX(
      Bent(d->Draw(0, 1) < 0.5 ? Look("ripe", .20f, .20f, .15f) : Look("green", .25f, .36f, .16f),
           Avocado)));
}
core::TexturedMesh EggShape(RigidDraft*) {
  return Fruit(AlongX(Bent(Look("shell", .90f, .78f, .64f), Egg)));
}
core::TexturedMesh Potato(RigidDraft*) {
  return Fruit(AlongX(Bent(Look("potato", .70f, .56f, .36f), Egg)));
}
core::TexturedMesh TennisBall(RigidDraft*) {
  return Bent(Look("felt", .80f, .88f, .24f), Ball);
}
core::TexturedMesh Baseball(RigidDraft*) {
  return Bent(Look("leather", .93f, .91f, .86f), Ball);
}
core::TexturedMesh GolfBall(RigidDraft*) {
  return Bent(Look("white", .95f, .95f, .94f), Ball);
}
core::TexturedMesh PlayBall(RigidDraft* d) {
  return Bent(d->look, Ball);
}

}  // namespace

std::vector<RigidKind> RoundKinds() {
  using S = SizeSymmetry;
  return {{"apple", "apple", "dimpled, red or green", S::kSquat, Apple},
          {"orange", "orange", "round", S::kSquat, Orange},
          {"peach", "peach", "dimpled", S::kSquat, Peach},
          {"pear", "pear", "with a neck", S::kRound, PearShape},
          {"lemon", "lemon", "pointed at both ends", S::kLying, LemonShape},
          {"lime", "lime", "pointed at both ends", S::kLying, Lime},
          {"avocado", "avocado", "lying, slimmer at one end", S::kLying, AvocadoShape},
          {"tomato", "tomato", "dimpled", S::kSquat, Tomato},
          {"potato", "potato", "longish", S::kFree, Potato},
          {"egg", "egg", "lying", S::kLying, EggShape},
          {"ball", "ball", "to play with", S::kBall, PlayBall},
          {"tennis_ball", "tennis ball", "of felt", S::kBall, TennisBall},
          {"baseball", "baseball", "of leather", S::kBall, Baseball},
          {"golf_ball", "golf ball", "smooth", S::kBall, GolfBall}};
}

}  // namespace simwright::library
