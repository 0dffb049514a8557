#include <cmath>

#include "library/rigid/revolved_parts.h"
#include "library/rigid/rigid_kinds.h"
#include "library/rigid/rigid_shapes.h"

// Solids of revolution: containers for food and drink, and others.
namespace simwright::library {
namespace {

// Returns the true radius. All vessels are modelled at their true radius and height, so that walls
// have a thickness in metres.
double VesselRadius(const RigidDraft& d) {
  return 0.5 * d.size.y();
}

constexpr int kVesselWedges = 10;  // wedges of a wall, as parts

core::TexturedMesh Vessel(RigidDraft* d, const std::vector<ProfilePoint>& outer, double thickness,
                          double floor) {
  const bool handled = d->size.x() > d->size.y();
  d->parts = VesselParts(outer, thickness, floor, kVesselWedges, handled ? 4 : 8);
  return Revolved(VesselProfile(outer, thickness, floor), {d->look});
}

core::TexturedMesh Mug(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), wall = 0.0042;
  core::TexturedMesh mesh =
      Vessel(d, {{0.90 * r, 0}, {r, 0.06 * h}, {r, 0.35 * h}, {r, 0.7 * h}, {r, h}}, wall, 0.006);
  const double out = d->size.x() - d->size.y(), high = 0.30 * h;
  std::vector<Eigen::Vector2d> path;
  for (int k = 0; k <= 16; ++k) {
    const double angle = M_PI * (k / 16.0 - 0.5);
    path.emplace_back(r - 0.5 * wall + (out - 0.0035 + 0.5 * wall) * std::cos(angle),
                      0.52 * h + high * std::sin(angle));
  }
  const core::TexturedMesh handle = Tube(path, 0.006, 0.0035, d->look);
  Join(handle, &mesh);
  AddParts(TubeParts(handle, 4), d);
  return mesh;
}

core::TexturedMesh Cup(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  return Vessel(d, Smooth({{0.55 * r, 0}, {0.62 * r, 0.12 * h}, {0.86 * r, 0.5 * h}, {r, h}}),
                0.0035, 0.005);
}

core::TexturedMesh Glass(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), foot = d->Draw(0.74, 0.95) * r;
  return Vessel(d, {{foot, 0}, {foot + 0.5 * (r - foot), 0.5 * h}, {r, h}}, 0.0025, 0.008);
}

core::TexturedMesh Bowl(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  return Vessel(d, Smooth({{0.42 * r, 0}, {0.66 * r, 0.2 * h}, {0.9 * r, 0.58 * h}, {r, h}}),
                0.0045, 0.006);
}

core::TexturedMesh Plate(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  return Vessel(d, {{0.58 * r, 0}, {0.66 * r, 0.28 * h}, {0.78 * r, 0.6 * h}, {r, h}}, 0.009,
                0.004);
}

core::TexturedMesh Vase(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), neck = d->Draw(0.4, 0.6) * r;
  // Its parts come from convex decomposition: a wedge from base to rim would fill belly and neck.
  return Revolved(VesselProfile(Smooth({{0.6 * r, 0},
                                        {0.9 * r, 0.2 * h},
                                        {r, 0.42 * h},
                                        {0.75 * r, 0.68 * h},
                                        {neck, 0.86 * h},
                                        {1.25 * neck, h}}),
                                0.006, 0.010),
                  {d->look});
}

core::TexturedMesh Bucket(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  return Vessel(d, {{0.72 * r, 0}, {0.96 * r, 0.93 * h}, {r, 0.935 * h}, {r, h}}, 0.006, 0.006);
}

core::TexturedMesh Goblet(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  const std::vector<ProfilePoint> bowl =
      Smooth({{0.12 * r, 0.42 * h}, {0.75 * r, 0.52 * h}, {r, 0.72 * h}, {0.92 * r, h}});
  std::vector<ProfilePoint> profile{{0, 0}, {0.8 * r, 0}, {0.8 * r, 0.02 * h}, {0.2 * r, 0.06 * h}};
  profile.push_back({0.10 * r, 0.14 * h});
  profile.insert(profile.end(), bowl.begin(), bowl.end());
  const double wall = 0.003;
  for (auto p = bowl.rbegin(); p != bowl.rend() && p->z > 0.47 * h; ++p) {
    profile.push_back({std::max(p->r - wall, 0.1 * r), p->z});
  }
  profile.push_back({0, 0.47 * h});
  return Revolved(profile, {d->look});
}

core::TexturedMesh Bottle(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), neck = 0.34 * r;
  const std::vector<core::Material> looks{d->look, Look("label", .92f, .90f, .82f),
                                          Look("cap", .20f, .22f, .25f)};
  return Revolved({{0, 0},
                   {0.94 * r, 0},
                   {r, 0.02 * h},
                   {r, 0.16 * h},
                   {r, 0.46 * h, 1},
                   {r, 0.6 * h},
                   {0.9 * r, 0.67 * h},
                   {0.55 * r, 0.75 * h},
                   {neck, 0.82 * h},
                   {neck, 0.92 * h},
                   {1.15 * neck, 0.92 * h, 2},
                   {1.15 * neck, h, 2},
                   {0, h, 2}},
                  looks);
}

core::TexturedMesh Jar(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  const std::vector<core::Material> looks{d->look, Look("lid", .75f, .20f, .16f)};
  return Revolved({{0, 0},
                   {0.93 * r, 0},
                   {r, 0.04 * h},
                   {r, 0.72 * h},
                   {0.86 * r, 0.82 * h},
                   {0.9 * r, 0.83 * h, 1},
                   {0.9 * r, h, 1},
                   {0, h, 1}},
                  looks);
}

core::TexturedMesh Can(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  d->parts = {RevolvedHull({{0.93 * r, 0}, {r, 0.03 * h}, {r, h}}, 20, 8)};
  const std::vector<core::Material> looks{Look("tin", .76f, .77f, .79f), d->look,
                                          Look("label", .74f, .22f, .18f)};
  return Revolved({{0, 0},
                   {0.93 * r, 0},
                   {r, 0.03 * h},
                   {0.97 * r, 0.05 * h},
                   {0.97 * r, 0.95 * h, 2},
                   {r, 0.97 * h},
                   {r, h},
                   {0.94 * r, h},
                   {0.94 * r, 0.97 * h},
                   {0, 0.97 * h}},
                  looks);
}

core::TexturedMesh Candle(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), wick = std::min(0.012, 0.1 * h);
  const std::vector<core::Material> looks{Look("wax", .94f, .90f, .78f),
                                          Look("wick", .15f, .13f, .12f)};
  return Revolved({{0, 0},
                   {r, 0},
                   {r, h - wick},
                   {0.9 * r, h - 0.8 * wick},
                   {0.12 * r, h - 0.9 * wick},
                   {0.10 * r, h, 1},
                   {0, h, 1}},
                  looks);
}

core::TexturedMesh ToiletPaper(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z(), hole = 0.022;
  const std::vector<core::Material> looks{Look("tissue", .95f, .95f, .94f),
                                          Look("core", .70f, .58f, .44f)};
  return Revolved({{hole, 0, 1}, {r, 0}, {r, h}, {hole, h}}, looks);
}

// Returns a round pan with a horizontal handle along x, at the height `at`.
core::TexturedMesh Pan(RigidDraft* d, double foot, double at) {
  const double r = VesselRadius(*d), h = d->size.z(), wall = 0.003, rod = std::min(0.009, 0.12 * h);
  core::TexturedMesh mesh = Vessel(d, {{foot * r, 0}, {r, at * h + rod}, {r, h}}, wall, 0.004);
  const double out = d->size.x() - d->size.y();
  const core::TexturedMesh grip =
      Tube({{r - 0.5 * wall, at * h}, {r + 0.5 * out, at * h}, {r + out, at * h}}, 1.6 * rod, rod,
           Look("grip", .13f, .13f, .14f));
  Join(grip, &mesh);
  AddParts(TubeParts(grip, 1), d);
  return mesh;
}

core::TexturedMesh FryingPan(RigidDraft* d) {
  return Pan(d, 0.8, 0.72);
}

core::TexturedMesh Saucepan(RigidDraft* d) {
  return Pan(d, 0.97, 0.8);
}

core::TexturedMesh PepperMill(RigidDraft* d) {
  const double r = VesselRadius(*d), h = d->size.z();
  std::vector<ProfilePoint> profile{{0, 0}};
  for (const ProfilePoint& p : Smooth({{r, 0},
                                       {0.95 * r, 0.12 * h},
                                       {0.55 * r, 0.4 * h},
                                       {0.62 * r, 0.6 * h},
                                       {0.9 * r, 0.72 * h},
                                       {0.85 * r, 0.86 * h},
                                       {0.4 * r, 0.97 * h}})) {
    profile.push_back(p);
  }
  profile.push_back({0, h});
  return Revolved(profile, {d->look});
}

}  // namespace

std::vector<RigidKind> VesselKinds() {
  using S = SizeSymmetry;
  return {{"mug", "mug", "straight, with a handle to reach through", S::kHandled, Mug},
          {"cup", "cup", "widening, without a handle", S::kRound, Cup},
          {"glass", "glass", "straight or conic", S::kRound, Glass},
          {"tumbler", "tumbler", "tall, straight or conic", S::kRound, Glass},
          {"bowl", "bowl", "round, on a foot", S::kRound, Bowl},
          {"plate", "plate", "flat, with a raised rim", S::kRound, Plate},
          {"saucer", "saucer", "a small plate", S::kRound, Plate},
          {"vase", "vase", "bellied, with a neck", S::kRound, Vase},
          {"bucket", "bucket", "conic, with a rim", S::kRound, Bucket},
          {"goblet", "goblet", "a bowl on a stem", S::kRound, Goblet},
          {"bottle", "bottle", "with a neck, a label and a cap", S::kRound, Bottle},
          {"jar", "jar", "with a lid", S::kRound, Jar},
          {"can", "can", "with rims and a label", S::kRound, Can},
          {"frying_pan", "frying pan", "low, with a long handle", S::kHandled, FryingPan},
          {"saucepan", "saucepan", "deep, with a long handle", S::kHandled, Saucepan},
          {"candle", "candle", "with a wick", S::kRound, Candle},
          {"pepper_mill", "pepper mill", "turned", S::kRound, PepperMill},
          {"toilet_paper", "toilet paper", "a roll with its hole", S::kRound, ToiletPaper}};
}

}  // namespace simwright::library
