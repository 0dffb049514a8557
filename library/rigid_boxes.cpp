#include <algorithm>
#include <cmath>

#include "library/rigid_kinds.h"
#include "library/rigid_shapes.h"

// Boxes, closed and open above.
namespace simwright::library {
namespace {

// A label's colour; packages come in several.
core::Material Print(RigidDraft* d) {
  constexpr float kColors[][3] = {{.80f, .24f, .18f},
                                  {.20f, .42f, .68f},
                                  {.92f, .72f, .22f},
                                  {.28f, .58f, .36f},
                                  {.55f, .30f, .56f}};
  const auto& c = kColors[core::UniformIndex(d->rng, std::size(kColors))];
  return Look("print", c[0], c[1], c[2]);
}

core::TexturedMesh Plain(RigidDraft* d, const core::Material& look, double bevel_share) {
  return PaintedBox(d->size, bevel_share * d->size.minCoeff(), {look},
                    [](const Eigen::Vector3d&) { return 0; });
}

// Printed round its sides, plain above and below.
core::TexturedMesh Package(RigidDraft* d) {
  return PaintedBox(d->size, 0.02 * d->size.minCoeff(), {Print(d), Look("board", .86f, .80f, .68f)},
                    [](const Eigen::Vector3d& n) { return std::abs(n.z()) > 0.8 ? 1 : 0; });
}

// Lies flat; covered above, below and along its spine.
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

// Open above: walls and a floor of `wall` (m), sides leaning out by `lean` of the half width.
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

core::TexturedMesh Box(RigidDraft* d) {
  return OpenBox(d, std::max(0.004, 0.012 * d->size.x()), 0.0, 0.02, d->look);
}

core::TexturedMesh Tray(RigidDraft* d) {
  return OpenBox(d, 0.006, 0.05, 0.15, d->look);
}

// A carton with a gable on top.
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

}  // namespace

std::vector<RigidKind> BoxKinds() {
  using S = RigidSides;
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
          {"box", "box", "open above", S::kFree, Box},
          {"tray", "tray", "low, open above", S::kFree, Tray}};
}

}  // namespace simwright::library
