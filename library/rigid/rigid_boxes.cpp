#include <algorithm>
#include <cmath>

#include "library/convex_shapes.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Boxes, closed or open at the top, and slabs.
namespace simwright::library {
namespace {

core::TexturedMesh Plain(RigidDraft* d, const core::Material& look, double bevel_share) {
  return PaintedBox(d->size, bevel_share * d->size.minCoeff(), {look},
                    [](const Eigen::Vector3d&) { return 0; });
}

// Returns a package printed around its sides, plain above and below.
core::TexturedMesh Package(RigidDraft* d) {
  return PaintedBox(d->size, 0.02 * d->size.minCoeff(), {Print(d), Look("board", .86f, .80f, .68f)},
                    [](const Eigen::Vector3d& n) { return std::abs(n.z()) > 0.8 ? 1 : 0; });
}

// Returns a book lying flat, covered above, below and along its spine.
core::TexturedMesh Book(RigidDraft* d) {
  return PaintedBox(
      d->size, 0.03 * d->size.minCoeff(), {Print(d), Look("pages", .94f, .92f, .85f)},
      [](const Eigen::Vector3d& n) { return std::abs(n.z()) > 0.5 || n.y() > 0.5 ? 0 : 1; });
}

core::TexturedMesh TissueBox(RigidDraft* d) {
  return PaintedBox(d->size, 0.02 * d->size.minCoeff(), {Print(d), Look("slot", .95f, .95f, .96f)},
                    [](const Eigen::Vector3d& n) { return n.z() > 0.8 ? 1 : 0; });
}

core::TexturedMesh Brick(RigidDraft* d) {
  return Plain(d, Look("clay", .62f, .29f, .20f), 0.03);
}

core::TexturedMesh ToyBlock(RigidDraft* d) {
  return Plain(d, Print(d), 0.1);
}

core::TexturedMesh Butter(RigidDraft* d) {
  return Plain(d, Look("butter", .95f, .86f, .52f), 0.05);
}

core::TexturedMesh Die(RigidDraft* d) {
  return Plain(d, Look("ivory", .94f, .92f, .86f), 0.12);
}

core::TexturedMesh Eraser(RigidDraft* d) {
  return PaintedBox(d->size, 0.12 * d->size.minCoeff(),
                    {Look("sleeve", .22f, .36f, .62f), Look("rubber", .94f, .93f, .92f)},
                    [](const Eigen::Vector3d& n) { return std::abs(n.x()) > 0.3 ? 1 : 0; });
}

core::TexturedMesh Sponge(RigidDraft* d) {
  return PaintedBox(d->size, 0.08 * d->size.minCoeff(),
                    {Look("foam", .94f, .80f, .30f), Look("scourer", .24f, .46f, .30f)},
                    [](const Eigen::Vector3d& n) { return n.z() > 0.5 ? 1 : 0; });
}

core::TexturedMesh CuttingBoard(RigidDraft* d) {
  return Plain(d, Look("board", .70f, .52f, .32f), 0.15);
}

core::TexturedMesh Phone(RigidDraft* d) {
  return PaintedBox(d->size, 0.2 * d->size.minCoeff(),
                    {Look("case", .20f, .21f, .23f), Look("screen", .08f, .10f, .14f)},
                    [](const Eigen::Vector3d& n) { return n.z() > 0.8 ? 1 : 0; });
}

core::TexturedMesh ChocolateBar(RigidDraft* d) {
  return Plain(d, Look("wrapper", .36f, .20f, .14f), 0.2);
}

core::TexturedMesh Soap(RigidDraft* d) {
  return Plain(d, Look("soap", .90f, .84f, .78f), 0.24);
}

// Returns a box open at the top: walls and a floor of `wall` (m), with sides leaning outwards by
// `lean` of the half width.
core::TexturedMesh OpenBox(RigidDraft* d, double wall, double lean, double corner,
                           const core::Material& look) {
  const double x = 0.5 * d->size.x(), y = 0.5 * d->size.y(), h = d->size.z();
  const double fx = (1.0 - lean) * x, fy = y - lean * x;
  return Loft({{0, 0, 0},
               {fx, fy, 0},
               {x, y, h},
               {x - wall, y - wall, h},
               {fx - wall, fy - wall, wall},
               {0, 0, wall}},
              RoundedSquareOutline(corner, 4), {look});
}

core::TexturedMesh OpenCarton(RigidDraft* d) {
  return OpenBox(d, std::max(0.004, 0.012 * d->size.x()), 0.0, 0.02, d->look);
}

core::TexturedMesh Tray(RigidDraft* d) {
  return OpenBox(d, 0.006, 0.05, 0.15, d->look);
}

// Returns a carton with a gable top.
core::TexturedMesh MilkCarton(RigidDraft* d) {
  const double x = 0.5 * d->size.x(), y = 0.5 * d->size.y(), h = d->size.z();
  const std::vector<core::Material> looks{Look("carton", .93f, .94f, .95f), Print(d)};
  return Loft({{0, 0, 0},
               {x, y, 0},
               {x, y, 0.5 * h, 1},
               {x, y, 0.78 * h},
               {x, 0.06 * y, 0.94 * h, 1},
               {x, 0.06 * y, h},
               {0, 0, h}},
              RoundedSquareOutline(0.03, 3), looks);
}

// Returns a carton whose lid overlaps its lower part, with a picture on top.
core::TexturedMesh BoardGame(RigidDraft* d) {
  const double x = 0.5 * d->size.x(), y = 0.5 * d->size.y(), h = d->size.z(), board = 0.0015;
  const core::Material side = Print(d);
  return Loft({{0, 0, 0},
               {x - board, y - board, 0},
               {x - board, y - board, 0.2 * h},
               {x, y, 0.2 * h},
               {x, y, h - 0.5 * board, 1},
               {x - 0.5 * board, y - 0.5 * board, h, 1},
               {0.82 * x, 0.82 * y, h, 1},
               {0, 0, h, 2}},
              RoundedSquareOutline(0.02, 3), {Look("board", .86f, .80f, .68f), side, Print(d)});
}

// Returns the convex hull of rectangular rings: four corners stand more stably than a chamfered
// outline's many.
core::TriangleMesh SquarePart(const std::vector<Ring>& rings) {
  std::vector<Eigen::Vector3d> points;
  for (const Ring& ring : rings) {
    for (const double x : {-ring.x, ring.x}) {
      for (const double y : {-ring.y, ring.y}) points.emplace_back(x, y, ring.z);
    }
  }
  return Hull(points);
}

// Returns a case for a small cartridge, lying with its printed sheet up.
core::TexturedMesh ConsoleGame(RigidDraft* d) {
  const double x = 0.5 * d->size.x(), y = 0.5 * d->size.y(), h = d->size.z(), edge = 0.0012;
  const Ring foot{x - edge, y - edge, 0}, low{x, y, edge}, high{x, y, h - edge},
      top{x - edge, y - edge, h};
  d->parts = {SquarePart({foot, low, high, top})};
  return Loft({{0, 0, 0}, foot, low, high, top, {x - 0.005, y - 0.004, h}, {0, 0, h, 1}},
              RoundedSquareOutline(0.05, 4), {Look("case", .20f, .21f, .24f), Print(d)});
}

// Returns a loudspeaker driver that faces x: the surround of a cone protrudes, with the cone and
// its cap inside.
core::TexturedMesh Driver(double radius, const Eigen::Vector3d& at, RigidDraft* d) {
  constexpr double kInside = 0.004, kOut = 0.003;  // m, of the front
  const std::vector<core::Material> looks{Look("surround", .10f, .10f, .11f),
                                          Look("cone", .34f, .35f, .37f)};
  core::TexturedMesh mesh = AlongX(Revolved({{0, -kInside},
                                             {radius, -kInside},
                                             {radius, 0.6 * kOut},
                                             {0.94 * radius, kOut},
                                             {0.84 * radius, kOut},
                                             {0.78 * radius, 0.3 * kOut},
                                             {0.32 * radius, 0.2 * kOut, 1},
                                             {0.2 * radius, 0.7 * kOut},
                                             {0, kOut}},
                                            looks));
  Move(at, &mesh);
  d->parts.push_back(
      Rod(at - kInside * Eigen::Vector3d::UnitX(), at + kOut * Eigen::Vector3d::UnitX(), radius));
  return mesh;
}

core::TexturedMesh Speaker(RigidDraft* d) {
  constexpr double kOut = 0.003;  // m, protrusion of the drivers
  const Eigen::Vector3d box = d->size - Eigen::Vector3d(kOut, 0, 0);
  const core::Material veneer =
      d->Draw(0, 1) < 0.5 ? Look("veneer", .42f, .27f, .17f) : Look("black", .16f, .16f, .17f);
  core::TexturedMesh mesh =
      PaintedBox(box, 0.003, {veneer, Look("front", .22f, .22f, .23f)},
                 [](const Eigen::Vector3d& n) { return n.x() > 0.8 ? 1 : 0; });
  const double woofer = std::min(0.4 * box.y(), 0.25 * box.z());
  d->parts = {Box(-0.5 * box, 0.5 * box, 0.003)};
  const Eigen::Vector3d front(0.5 * box.x(), 0, 0);
  Join(Driver(woofer, front + Eigen::Vector3d(0, 0, -0.44 * box.z() + woofer), d), &mesh);
  Join(Driver(0.4 * woofer, front + Eigen::Vector3d(0, 0, 0.34 * box.z()), d), &mesh);
  return mesh;
}

// Returns a slice of a loaf, lying: two straight sides, a waist and a crown.
core::TexturedMesh Toast(RigidDraft* d) {
  const double x = 0.5 * d->size.x(), y = 0.5 * d->size.y(), h = d->size.z();
  const std::vector<ProfilePoint> half = Smooth({{0.8, -1.0},
                                                 {0.93, -0.9},
                                                 {0.95, -0.5},
                                                 {0.92, 0.1},
                                                 {0.92, 0.3},
                                                 {1.0, 0.55},
                                                 {0.94, 0.82},
                                                 {0.6, 0.98},
                                                 {0.2, 1.0}});
  std::vector<Eigen::Vector2d> outline;  // crown at x: a slice is slightly longer than wide
  for (const ProfilePoint& p : half) outline.emplace_back(p.z, -p.r);
  std::reverse(outline.begin(), outline.end());
  for (const ProfilePoint& p : half) outline.emplace_back(p.z, p.r);
  std::reverse(outline.begin(), outline.end());
  return Loft({{0, 0, 0},
               {0.97 * x, 0.97 * y, 0},
               {x, y, 0.12 * h, 1},
               {x, y, 0.88 * h, 1},
               {0.97 * x, 0.97 * y, h, 1},
               {0.93 * x, 0.93 * y, h, 1},
               {0, 0, h}},
              outline, {Look("crumb", .80f, .58f, .30f), Look("crust", .50f, .30f, .14f)});
}

}  // namespace

std::vector<RigidKind> BoxKinds() {
  using S = SizeSymmetry;
  return {{"book", "book", "closed, lying", S::kFree, Book},
          {"cereal_box", "cereal box", "printed, upright", S::kFree, Package},
          {"tissue_box", "tissue box", "printed", S::kFree, TissueBox},
          {"milk_carton", "milk carton", "with a gable", S::kFree, MilkCarton},
          {"brick", "brick", "of clay", S::kFree, Brick},
          {"soap", "soap", "a bar with rounded edges", S::kFree, Soap},
          {"toy_block", "toy block", "coloured", S::kFree, ToyBlock},
          {"die", "die", "a cube", S::kBall, Die},
          {"butter", "butter", "a block", S::kFree, Butter},
          {"eraser", "eraser", "in its sleeve", S::kFree, Eraser},
          {"sponge", "sponge", "with a scourer", S::kFree, Sponge},
          {"cutting_board", "cutting board", "a board", S::kFree, CuttingBoard},
          {"phone", "phone", "lying, its screen up", S::kFree, Phone},
          {"chocolate_bar", "chocolate bar", "wrapped", S::kFree, ChocolateBar},
          {"box", "box", "open above", S::kFree, OpenCarton},
          {"tray", "tray", "low, open above", S::kFree, Tray},
          {"board_game_large", "large board game", "a lid over its box", S::kFree, BoardGame},
          {"board_game_small", "small board game", "a lid over its box", S::kFree, BoardGame},
          {"console_game", "console game", "a flat case, lying", S::kFree, ConsoleGame},
          {"speaker", "bookshelf speaker", "two drivers in front", S::kFree, Speaker},
          {"toast", "toast", "a slice, lying", S::kFree, Toast}};
}

}  // namespace simwright::library
