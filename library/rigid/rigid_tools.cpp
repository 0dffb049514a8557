#include <algorithm>

#include "library/convex_shapes.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Long objects lying along x: cutlery, pens, tools.
namespace simwright::library {
namespace {

const core::Material kSteel{"steel", {.74f, .75f, .77f, 1.0f}, -1};
const core::Material kWood{"wood", {.70f, .50f, .30f, 1.0f}, -1};
const core::Material kDark{"dark", {.14f, .14f, .15f, 1.0f}, -1};

core::TexturedMesh Revolve(const std::vector<ProfilePoint>& profile,
                           const std::vector<core::Material>& looks) {
  core::TexturedMesh mesh = AlongX(Revolved(profile, looks));
  Flatten(0.02, &mesh);  // prevents rolling
  return mesh;
}

// Returns a spoon with its bowl at x = 0.72 ... 1 of its length, hollow above; in metres.
core::TexturedMesh SpoonOf(RigidDraft* d, double thickness, const core::Material& look) {
  const double l = d->size.x(), w = 0.5 * d->size.y(), dip = 0.65 * d->size.z();
  return Sheet({{0.00 * l, 0.30 * w, dip},
                {0.03 * l, 0.42 * w, dip},
                {0.30 * l, 0.30 * w, dip},
                {0.62 * l, 0.20 * w, 0.8 * dip},
                {0.70 * l, 0.35 * w, 0.45 * dip, 0.1 * dip},
                {0.76 * l, 0.75 * w, 0.15 * dip, 0.5 * dip},
                {0.84 * l, w, 0.0, 0.7 * dip},
                {0.92 * l, 0.85 * w, 0.1 * dip, 0.55 * dip},
                {0.97 * l, 0.5 * w, 0.35 * dip, 0.25 * dip},
                {1.00 * l, 0.12 * w, 0.6 * dip}},
               thickness, {look});
}

core::TexturedMesh Spoon(RigidDraft* d) {
  return SpoonOf(d, 0.0018, kSteel);
}

// Returns a fork, lying on its handle's end and on the belly of its head, from which four tines
// rise.
core::TexturedMesh Fork(RigidDraft* d) {
  const double l = d->size.x(), w = 0.5 * d->size.y(), thick = 0.0024, up = d->size.z() - thick;
  core::TexturedMesh mesh = Sheet({{0.00 * l, 0.36 * w, 0.02 * up},
                                   {0.03 * l, 0.48 * w, 0},
                                   {0.30 * l, 0.36 * w, 0.30 * up},
                                   {0.58 * l, 0.22 * w, 0.52 * up},
                                   {0.66 * l, 0.30 * w, 0.40 * up},
                                   {0.71 * l, 0.70 * w, 0.20 * up},
                                   {0.76 * l, 0.94 * w, 0.04 * up},
                                   {0.81 * l, 0.97 * w, 0}},
                                  thick, {kSteel});
  // The tines are thinner than the head, so that none of their faces is coplanar with one of its
  // faces.
  const double half = 0.15 * w;
  for (int k = 0; k < 4; ++k) {
    core::TexturedMesh tine = Sheet({{0.79 * l, half, 0.02 * up + 0.06 * thick},
                                     {0.87 * l, half, 0.12 * up},
                                     {0.94 * l, 0.9 * half, 0.45 * up},
                                     {1.00 * l, 0.4 * half, up + 0.12 * thick}},
                                    0.88 * thick, {kSteel});
    Move({0, (w - half) * (2.0 * k / 3.0 - 1.0), 0}, &tine);
    Join(tine, &mesh);
  }
  return mesh;
}

// Returns the convex hull of a bar's corners, flat below if the bar is.
core::TriangleMesh BarPart(const std::vector<BarSection>& bar) {
  std::vector<Eigen::Vector3d> points;
  for (const BarSection& s : bar) {
    for (const double y : {s.y_low, s.y_high}) {
      points.emplace_back(s.x, y, s.z_low);
      points.emplace_back(s.x, y, s.z_high);
    }
  }
  return Hull(points);
}

// Returns a knife: a handle and a thin blade with its tip at x. It lies on the ends of the handle
// and of the blade, which are separate parts: engines discard contacts that are close to each other
// relative to a part's length, and keep those of only one side of a long narrow part.
core::TexturedMesh Knife(RigidDraft* d) {
  const double l = d->size.x(), w = 0.5 * d->size.y(), h = d->size.z();
  const double up = 0.0006, thin = 0.0026;
  const std::vector<BarSection> handle{{0.00 * l, -0.8 * w, 0.8 * w, 0, h},
                                       {0.12 * l, -0.8 * w, 0.8 * w, 0, h},
                                       {0.30 * l, -0.7 * w, 0.7 * w, up, h},
                                       {0.43 * l, -0.55 * w, 0.55 * w, up, 0.8 * h},
                                       {0.46 * l, -0.5 * w, 0.5 * w, up, thin}};
  const std::vector<BarSection> blade{
      {0.45 * l, -0.7 * w, 0.45 * w, up, thin}, {0.50 * l, -0.95 * w, 0.55 * w, up, thin},
      {0.70 * l, -w, 0.65 * w, up, thin},       {0.84 * l, -0.9 * w, 0.8 * w, 0, thin - up},
      {0.95 * l, -0.5 * w, w, 0, thin - up},    {l, 0.5 * w, w, 0.3 * up, 0.7 * thin}};
  const std::vector<Eigen::Vector2d> outline = RoundedSquareOutline(0.3, 3);
  core::TexturedMesh mesh = Bar(handle, outline, {kSteel});
  Join(Bar(blade, outline, {kSteel}), &mesh);
  const auto first = [](const std::vector<BarSection>& bar, size_t count) {
    return std::vector<BarSection>(bar.begin(), bar.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const auto rest = [](const std::vector<BarSection>& bar, size_t from) {
    return std::vector<BarSection>(bar.begin() + static_cast<std::ptrdiff_t>(from), bar.end());
  };
  d->parts = {BarPart(first(handle, 2)), BarPart(rest(handle, 1)), BarPart(first(blade, 4)),
              BarPart(rest(blade, 3))};
  return mesh;
}

core::TexturedMesh WoodenSpoon(RigidDraft* d) {
  return SpoonOf(d, 0.006, kWood);
}

core::TexturedMesh Ruler(RigidDraft* d) {
  return PaintedBox(d->size, 0.1 * d->size.z(), {Look("ruler", .88f, .76f, .40f)},
                    [](const Eigen::Vector3d&) { return 0; });
}

core::TexturedMesh Pen(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  return Revolve({{0, 0},
                  {0.8 * r, 0},
                  {r, 0.03 * l},
                  {r, 0.82 * l},
                  {0.75 * r, 0.84 * l, 1},
                  {0.3 * r, 0.98 * l, 1},
                  {0.12 * r, l, 1},
                  {0, l, 1}},
                 {d->look, kSteel});
}

core::TexturedMesh Pencil(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  const std::vector<core::Material> looks{Look("paint", .92f, .70f, .16f), kWood, kDark};
  return AlongX(Loft({{0, 0, 0},
                      {r, r, 0},
                      {r, r, l - 0.022},
                      {0.3 * r, 0.3 * r, l - 0.006, 1},
                      {0.06 * r, 0.06 * r, l, 2},
                      {0, 0, l, 2}},
                     CircleOutline(12), looks));
}

core::TexturedMesh Marker(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  const std::vector<core::Material> looks{Look("barrel", .92f, .92f, .92f),
                                          Look("cap", .16f, .30f, .62f)};
  return Revolve({{0, 0},
                  {0.9 * r, 0},
                  {0.94 * r, 0.02 * l},
                  {0.94 * r, 0.64 * l},
                  {r, 0.65 * l, 1},
                  {r, 0.95 * l, 1},
                  {0.7 * r, l, 1},
                  {0, l, 1}},
                 looks);
}

core::TexturedMesh Screwdriver(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y(), grip = 0.42 * l;
  const std::vector<core::Material> looks{Look("grip", .78f, .20f, .14f), kSteel};
  return Revolve({{0, 0},
                  {0.75 * r, 0},
                  {r, 0.12 * grip},
                  {0.88 * r, 0.6 * grip},
                  {r, 0.9 * grip},
                  {0.5 * r, grip},
                  {0.24 * r, grip, 1},
                  {0.24 * r, 0.95 * l, 1},
                  {0.16 * r, l, 1},
                  {0, l, 1}},
                 looks);
}

core::TexturedMesh Hammer(RigidDraft* d) {
  const double l = d->size.x(), w = d->size.y(), h = d->size.z(), r = 0.36 * h;
  core::TexturedMesh mesh = Revolve({{0, 0},
                                     {0.9 * r, 0},
                                     {1.1 * r, 0.05 * l},
                                     {r, 0.3 * l},
                                     {0.8 * r, 0.6 * l},
                                     {0.8 * r, l - 0.3 * h},
                                     {0, l - 0.3 * h}},
                                    {kWood});
  // The head lies along y: a face, a neck and a wedge.
  core::TexturedMesh head = Loft({{0, 0, 0},
                                  {0.46 * h, 0.46 * h, 0},
                                  {0.5 * h, 0.5 * h, 0.03 * w},
                                  {0.5 * h, 0.5 * h, 0.2 * w},
                                  {0.38 * h, 0.38 * h, 0.28 * w},
                                  {0.46 * h, 0.46 * h, 0.4 * w},
                                  {0.46 * h, 0.46 * h, 0.62 * w},
                                  {0.08 * h, 0.42 * h, w},
                                  {0, 0, w}},
                                 RoundedSquareOutline(0.4, 6), {kSteel});
  head = AlongY(head);
  Move({l - 0.5 * h, 0.5 * w, 0}, &head);
  Join(head, &mesh);
  return mesh;
}

// Returns a brush: a handle with a block of bristles on its end; it rests on both ends of the
// handle.
core::TexturedMesh Brush(RigidDraft* d) {
  const double l = d->size.x(), w = d->size.y(), h = d->size.z(), thick = 0.4 * h;
  const double head = 0.42 * l, grip = 0.22 * w, up = 0.1 * thick;
  core::TexturedMesh mesh = Sheet({{0, 0.7 * grip, up},
                                   {0.04 * l, grip, 0},
                                   {0.3 * l, grip, up},
                                   {l - head - 0.03 * l, 0.7 * grip, up},
                                   {l - head, 0.5 * w, up},
                                   {l - 0.02 * l, 0.5 * w, 0},
                                   {l, 0.42 * w, up}},
                                  thick, {kWood});
  const Eigen::Vector3d block(0.9 * head, 0.86 * w, h - 0.5 * thick);
  core::TexturedMesh tuft =
      PaintedBox(block, 0.05 * block.minCoeff(), {Look("bristles", .86f, .80f, .64f)},
                 [](const Eigen::Vector3d&) { return 0; });
  Move({l - 0.5 * head, 0, h - 0.5 * block.z()}, &tuft);
  Join(tuft, &mesh);
  return mesh;
}

core::TexturedMesh RollingPin(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  return Revolve({{0, 0},
                  {0.3 * r, 0},
                  {0.45 * r, 0.03 * l},
                  {0.4 * r, 0.18 * l},
                  {0.96 * r, 0.19 * l},
                  {r, 0.21 * l},
                  {r, 0.79 * l},
                  {0.96 * r, 0.81 * l},
                  {0.4 * r, 0.82 * l},
                  {0.45 * r, 0.97 * l},
                  {0.3 * r, l},
                  {0, l}},
                 {kWood});
}

core::TexturedMesh Battery(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  const std::vector<core::Material> looks{kDark, Look("copper", .76f, .48f, .26f), kSteel};
  core::TexturedMesh mesh = Revolve({{0, 0, 2},
                                     {r, 0, 2},
                                     {r, 0.66 * l},
                                     {r, 0.97 * l, 1},
                                     {0.4 * r, 0.97 * l, 2},
                                     {0.4 * r, l, 2},
                                     {0, l, 2}},
                                    looks);
  Flatten(0.04, &mesh);
  return mesh;
}

core::TexturedMesh Flashlight(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  const std::vector<core::Material> looks{kDark, Look("lens", .85f, .90f, .92f)};
  return Revolve({{0, 0},
                  {0.62 * r, 0},
                  {0.68 * r, 0.03 * l},
                  {0.68 * r, 0.64 * l},
                  {r, 0.78 * l},
                  {r, l},
                  {0.88 * r, l},
                  {0.88 * r, 0.985 * l, 1},
                  {0, 0.985 * l, 1}},
                 looks);
}

core::TexturedMesh BaseballBat(RigidDraft* d) {
  const double l = d->size.x(), r = 0.5 * d->size.y();
  std::vector<ProfilePoint> profile{{0, 0}, {0.72 * r, 0}, {0.75 * r, 0.02 * l}};
  for (const ProfilePoint& p : Smooth({{0.42 * r, 0.04 * l},
                                       {0.42 * r, 0.3 * l},
                                       {0.75 * r, 0.6 * l},
                                       {r, 0.8 * l},
                                       {r, 0.96 * l},
                                       {0.6 * r, l}})) {
    profile.push_back(p);
  }
  profile.push_back({0, l});
  return Revolve(profile, {kWood});
}

}  // namespace

std::vector<RigidKind> LongObjectKinds() {
  using S = SizeSymmetry;
  return {{"spoon", "spoon", "with a hollow bowl", S::kFree, Spoon},
          {"teaspoon", "teaspoon", "with a hollow bowl", S::kFree, Spoon},
          {"fork", "fork", "four tines, lying", S::kFree, Fork},
          {"knife", "table knife", "a handle and a blade, lying flat", S::kFree, Knife},
          {"wooden_spoon", "wooden spoon", "with a hollow bowl", S::kFree, WoodenSpoon},
          {"ruler", "ruler", "flat", S::kFree, Ruler},
          {"pen", "pen", "turned, with a tip", S::kLying, Pen},
          {"pencil", "pencil", "sharpened", S::kLying, Pencil},
          {"marker", "marker", "with its cap", S::kLying, Marker},
          {"screwdriver", "screwdriver", "a grip and a blade", S::kLying, Screwdriver},
          {"hammer", "hammer", "a head across its handle", S::kFree, Hammer},
          {"brush", "brush", "a handle and bristles", S::kFree, Brush},
          {"rolling_pin", "rolling pin", "turned", S::kLying, RollingPin},
          {"battery", "battery", "with its pole", S::kLying, Battery},
          {"flashlight", "flashlight", "with a wide head", S::kLying, Flashlight},
          {"baseball_bat", "baseball bat", "turned", S::kLying, BaseballBat}};
}

}  // namespace simwright::library
