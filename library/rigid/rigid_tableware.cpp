#include <algorithm>
#include <cmath>

#include "library/convex_shapes.h"
#include "library/rigid/revolved_parts.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Solids of revolution of a laid table, other than cups and plates.
namespace simwright::library {
namespace {

double TablewareRadius(const RigidDraft& d) {
  return 0.5 * d.size.y();
}

constexpr int kTablewareWedges = 10;  // wedges of a wall, as parts
constexpr int kTablewareFoot = 8;     // base corners of objects that stand on one part

// Adds three small feet, which are stable in every engine, whereas a round base rocks from corner
// to corner.
void AddTablewareFeet(double out, double radius, double height, double into, RigidDraft* d,
                      core::TexturedMesh* mesh) {
  for (int k = 0; k < 3; ++k) {
    const double angle = M_PI * (2.0 * k / 3.0 + 1.0 / 3.0);
    const Eigen::Vector3d at(out * std::cos(angle), out * std::sin(angle), 0.0);
    core::TexturedMesh foot = Revolved(
        {{0, 0}, {0.8 * radius, 0}, {radius, height}, {radius, into}, {0, into}}, {d->look});
    Move(at, &foot);
    Join(foot, mesh);
    core::TriangleMesh part =
        RevolvedHull({{0.8 * radius, 0}, {radius, height}}, kTablewareFoot, 3);
    core::Transform(Eigen::Affine3d(Eigen::Translation3d(at)), &part);
    d->parts.push_back(part);
  }
}

// Returns the body, above feet of height `under`, and its lid.
core::TexturedMesh TeapotBody(RigidDraft* d, double r, double h, double under) {
  const ProfilePoint bottom{0.54 * r, under}, low{0.92 * r, 0.20 * h}, belly{r, 0.38 * h},
      shoulder{0.86 * r, 0.60 * h}, neck{0.52 * r, 0.75 * h};
  const ProfilePoint lid{0.34 * r, 0.83 * h, 1}, stem{0.13 * r, 0.86 * h, 1},
      knob{0.19 * r, 0.93 * h, 1}, top{0.07 * r, h, 1};
  AddParts(
      {RevolvedHull({bottom, low, belly}), RevolvedHull({belly, shoulder, neck, lid, stem}, 12),
       RevolvedHull({stem, knob, top}, 12)},
      d);
  std::vector<ProfilePoint> profile{{0, under}, bottom};
  for (const ProfilePoint& p : Smooth({{0.60 * r, under + 0.02 * h}, low, belly, shoulder, neck})) {
    profile.push_back(p);
  }
  const std::vector<ProfilePoint> above{{0.48 * r, 0.755 * h, 1},
                                        {0.49 * r, 0.78 * h, 1},
                                        lid,
                                        stem,
                                        {0.12 * r, 0.88 * h, 1},
                                        knob,
                                        {0.16 * r, 0.97 * h, 1},
                                        top,
                                        {0, h, 1}};
  profile.insert(profile.end(), above.begin(), above.end());
  return Revolved(profile, {d->look, {"lid", 0.86f * d->look.base_color, -1}});
}

// Returns a teapot: body and lid in one, a spout at x and a handle loop on the opposite side.
core::TexturedMesh Teapot(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), beyond = d->size.x() - d->size.y();
  const double spout = 0.5 * beyond, loop = 0.5 * beyond, under = 0.03 * h;
  core::TexturedMesh mesh = TeapotBody(d, r, h, under);
  const core::TexturedMesh snout = TaperedTube({{0.70 * r, 0.26 * h, 0.24 * r, 0.13 * h},
                                                {r, 0.38 * h, 0.20 * r, 0.10 * h},
                                                {r + 0.40 * spout, 0.52 * h, 0.14 * r, 0.07 * h},
                                                {r + 0.70 * spout, 0.66 * h, 0.11 * r, 0.055 * h},
                                                {r + 0.92 * spout, 0.76 * h, 0.10 * r, 0.05 * h}},
                                               d->look);
  std::vector<Eigen::Vector2d> path;
  for (int k = 0; k <= 16; ++k) {
    const double angle = M_PI * (k / 16.0 + 0.5);
    path.emplace_back(-0.62 * r + (0.38 * r + loop - 0.0045) * std::cos(angle),
                      0.44 * h + 0.23 * h * std::sin(angle));
  }
  const core::TexturedMesh handle = Tube(path, 0.007, 0.0045, d->look);
  Join(snout, &mesh);
  Join(handle, &mesh);
  AddParts(TubeParts(snout, 2), d);
  AddParts(TubeParts(handle, 4), d);
  AddTablewareFeet(0.44 * r, 0.09 * r, under, 2.0 * under, d, &mesh);
  return mesh;
}

core::TexturedMesh ServingDish(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z();
  const auto wall = Smooth({{0.56 * r, 0}, {0.72 * r, 0.18 * h}, {0.90 * r, 0.56 * h}, {r, h}});
  d->parts = VesselParts(wall, 0.009, 0.006, kTablewareWedges);
  return Revolved(VesselProfile(wall, 0.009, 0.006), {d->look});
}

const core::Material kBamboo{"bamboo", {.84f, .70f, .45f, 1.0f}, -1};
const core::Material kHoop{"hoop", {.66f, .49f, .28f, 1.0f}, -1};

constexpr int kBasketWedges = 8;
constexpr double kClear = 5e-4;      // m
constexpr double kHoopOut = 0.0006;  // m: protrusion of a hoop from the wall

// Returns a stackable basket: the hoops at base and rim have the same radius, and rim and base are
// level. The floor is raised inside the wall, so that only the wall bears the load, rim on base.
core::TexturedMesh Steamer(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), wall = 0.0065, under = 0.012,
               floor = 0.017;
  // Only every other wedge bears the load, because the solver's time depends on the number of part
  // pairs in contact.
  const std::vector<core::TriangleMesh> bearing =
      WallParts({{r, 0}, {r, h}}, {{r - wall, 0}, {r - wall, h}}, kBasketWedges);
  const std::vector<core::TriangleMesh> hanging =
      WallParts({{r, kClear}, {r, h}}, {{r - wall, kClear}, {r - wall, h}}, kBasketWedges);
  for (size_t k = 0; k < bearing.size(); ++k) {
    d->parts.push_back(k % 2 == 0 ? bearing[k] : hanging[k]);
  }
  d->parts.push_back(RevolvedHull({{r - wall, under}, {r - wall, floor}}, 2 * kBasketWedges));
  return Revolved({{0, under},
                   {r - wall, under},
                   {r - wall, 0, 1},
                   {r, 0, 1},
                   {r, 0.24 * h, 1},
                   {r - kHoopOut, 0.24 * h, 1},
                   {r - kHoopOut, 0.72 * h},
                   {r, 0.72 * h, 1},
                   {r, h, 1},
                   {r - wall, h, 1},
                   {r - wall, floor},
                   {0, floor}},
                  {kBamboo, kHoop});
}

// Returns the lid for the basket of the same seed, with its diameter: both rows of the knowledge
// base have the same range, and a seed samples the same position in it. A woven sheet in a hoop,
// flat on the underside out to where it rests on the rim.
core::TexturedMesh SteamerLid(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), slant = 0.003;
  d->parts = {RevolvedHull({{0.98 * r, 0}, {r, slant}, {r, h}}, 20, kTablewareFoot)};
  return Revolved({{0, 0, 1}, {0.98 * r, 0, 1}, {r, slant, 1}, {r, h, 1}, {0.94 * r, h, 1}, {0, h}},
                  {kBamboo, kHoop});
}

core::TexturedMesh UtensilCrock(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z();
  const std::vector<ProfilePoint> wall{{0.92 * r, 0}, {0.97 * r, 0.03 * h}, {0.97 * r, 0.90 * h},
                                       {r, 0.92 * h}, {r, 0.98 * h},        {0.98 * r, h}};
  d->parts = VesselParts(wall, 0.006, 0.008, kTablewareWedges);
  return Revolved(VesselProfile(wall, 0.006, 0.008), {d->look});
}

constexpr int kJugWedges = 8;

// Forms a lip towards -x, on the inside and the outside of the wall alike.
void PullLip(double r, double h, core::TriangleMesh* mesh) {
  for (Eigen::Vector3d& v : mesh->vertices) {
    const double up = (v.z() / h - 0.8) / 0.2, away = v.head<2>().norm();
    if (up <= 0.0 || v.x() >= 0.0) continue;
    v.x() -= 0.2 * r * up * up * std::pow(-v.x() / away, 6);
  }
}

// Returns a bellied jug, open at the top, with a lip opposite its handle.
core::TexturedMesh Jug(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), wall = 0.005;
  const double neck = 0.66 * r, out = d->size.x() - d->size.y();
  const std::vector<ProfilePoint> outer = Smooth({{0.70 * r, 0},
                                                  {0.90 * r, 0.12 * h},
                                                  {r, 0.36 * h},
                                                  {0.84 * r, 0.64 * h},
                                                  {neck, 0.84 * h},
                                                  {0.76 * r, h}});
  core::TexturedMesh mesh = Revolved(VesselProfile(outer, wall, 0.007), {d->look});
  PullLip(r, h, &mesh.mesh);
  // The inside of the parts is as wide as the neck.
  d->parts = VesselParts(outer, wall, 0.007, kJugWedges, 4);
  for (core::TriangleMesh& part : d->parts) {
    PullLip(r, h, &part);
    part = Hull(part.vertices);
  }
  // The handle meets the wall horizontally, at the neck and at the belly, where the wall is
  // vertical.
  std::vector<Eigen::Vector2d> path;
  for (const ProfilePoint& p : Smooth({{neck - 0.4 * wall, 0.84 * h},
                                       {neck + 0.3 * (r - neck), 0.845 * h},
                                       {r + 0.8 * out - 0.005, 0.80 * h},
                                       {r + out - 0.005, 0.66 * h},
                                       {r + 0.7 * out - 0.005, 0.47 * h},
                                       {r + 0.15 * out, 0.37 * h},
                                       {r - 0.4 * wall, 0.36 * h}})) {
    path.emplace_back(p.r, p.z);
  }
  const core::TexturedMesh handle = Tube(path, 0.008, 0.005, d->look);
  Join(handle, &mesh);
  AddParts(TubeParts(handle, 4), d);
  return mesh;
}

// Returns a full bottle of clear plastic: the visible surface is the tea.
core::TexturedMesh TeaBottle(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), neck = 0.40 * r;
  const core::Material tea =
      d->Draw(0, 1) < 0.5 ? Look("tea", .60f, .36f, .14f) : Look("green tea", .66f, .62f, .26f);
  return Revolved({{0, 0},
                   {0.80 * r, 0},
                   {0.96 * r, 0.02 * h},
                   {r, 0.06 * h},
                   {r, 0.22 * h},
                   {0.95 * r, 0.24 * h},
                   {0.95 * r, 0.58 * h, 1},
                   {r, 0.60 * h},
                   {r, 0.66 * h},
                   {0.92 * r, 0.72 * h},
                   {0.66 * r, 0.80 * h},
                   {neck, 0.87 * h},
                   {neck, 0.91 * h},
                   {1.15 * neck, 0.91 * h, 2},
                   {1.15 * neck, 0.995 * h, 2},
                   {1.05 * neck, h, 2},
                   {0, h, 2}},
                  {tea, Print(d), Look("cap", .93f, .93f, .92f)});
}

// Returns a thin-walled can, necked in at the bottom and the top.
core::TexturedMesh SodaCan(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z(), end = 0.82 * r;
  d->parts = {RevolvedHull({{0.76 * r, 0}, {r, 0.06 * h}, {r, 0.9 * h}}, 20, kTablewareFoot),
              RevolvedHull({{r, 0.9 * h}, {1.03 * end, 0.98 * h}, {1.03 * end, h}})};
  return Revolved({{0, 0},
                   {0.76 * r, 0},
                   {0.82 * r, 0.012 * h},
                   {r, 0.06 * h},
                   {r, 0.90 * h, 1},
                   {end, 0.965 * h},
                   {1.03 * end, 0.98 * h},
                   {1.03 * end, h},
                   {0.95 * end, h},
                   {0.93 * end, 0.975 * h},
                   {0, 0.975 * h}},
                  {Look("aluminium", .78f, .79f, .81f), Print(d)});
}

// Returns a lamp: a revolved foot and, on a rod, a shade that is closed at the bottom.
core::TexturedMesh Lamp(RigidDraft* d) {
  const double r = TablewareRadius(*d), h = d->size.z();
  std::vector<ProfilePoint> profile{
      {0, 0}, {0.64 * r, 0}, {0.64 * r, 0.025 * h}, {0.40 * r, 0.05 * h}};
  for (const ProfilePoint& p : Smooth({{0.26 * r, 0.07 * h},
                                       {0.44 * r, 0.20 * h},
                                       {0.34 * r, 0.34 * h},
                                       {0.12 * r, 0.44 * h}})) {
    profile.push_back(p);
  }
  const std::vector<ProfilePoint> shade{
      {0.07 * r, 0.45 * h, 2}, {0.07 * r, 0.54 * h, 2}, {0.97 * r, 0.54 * h, 1}, {r, 0.54 * h, 1},
      {0.66 * r, h, 1},        {0.63 * r, h, 1},        {0.63 * r, 0.97 * h, 1}, {0, 0.97 * h, 1}};
  profile.insert(profile.end(), shade.begin(), shade.end());
  const ProfilePoint foot{0.64 * r, 0}, low{0.26 * r, 0.07 * h}, belly{0.44 * r, 0.20 * h},
      waist{0.12 * r, 0.44 * h};
  d->parts = {
      RevolvedHull({foot, {0.64 * r, 0.025 * h}, {0.40 * r, 0.05 * h}, low}, 16, kTablewareFoot),
      RevolvedHull({low, belly}), RevolvedHull({belly, {0.34 * r, 0.34 * h}, waist}),
      RevolvedHull({waist, {0.07 * r, 0.54 * h}}, 8), RevolvedHull({{r, 0.54 * h}, {0.66 * r, h}})};
  return Revolved(profile,
                  {d->look, Look("shade", .94f, .88f, .74f), Look("rod", .66f, .58f, .42f)});
}

}  // namespace

std::vector<RigidKind> TablewareKinds() {
  using S = SizeSymmetry;
  return {
      {"teapot", "small teapot", "with a spout, a handle and its lid", S::kHandled, Teapot},
      {"serving_dish", "serving dish", "wide and low", S::kRound, ServingDish},
      {"steamer", "steamer basket", "of bamboo, open above, to stack", S::kRound, Steamer},
      {"steamer_lid", "steamer lid", "for a steamer of its seed", S::kRound, SteamerLid},
      {"utensil_crock", "utensil crock", "a tall cylinder, open above", S::kRound, UtensilCrock},
      {"jug", "jug", "open above, with a handle and a lip", S::kHandled, Jug},
      {"tea_bottle", "tea bottle", "half a litre, full", S::kRound, TeaBottle},
      {"soda_can", "soda can", "for a drink", S::kRound, SodaCan},
      {"lamp", "bedside lamp", "a turned foot and a shade", S::kRound, Lamp}};
}

}  // namespace simwright::library
