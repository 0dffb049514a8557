#include "library/rigid/rigid_kinds.h"

#include <algorithm>

#include "core/error.h"
#include "library/rigid/rigid_shapes.h"

namespace simwright::library {
namespace {

constexpr double kLeastHandle = 0.025;  // m: two fingers
constexpr std::uint64_t kStream = 20;   // first random stream of shapes and colours

// Returns the usual appearance of a material; glazes and plastics come in several colours.
core::Material LookOf(const std::string& material, Draws& draws) {
  struct Paint {
    const char* material;
    float r, g, b;
  };
  constexpr Paint kPaints[] = {{"glass", .72f, .84f, .88f},       {"steel", .72f, .73f, .75f},
                               {"aluminium", .78f, .79f, .81f},   {"cast iron", .17f, .17f, .18f},
                               {"brass", .78f, .63f, .30f},       {"silver", .82f, .82f, .84f},
                               {"copper", .72f, .45f, .30f},      {"wood", .68f, .49f, .30f},
                               {"plywood", .76f, .60f, .40f},     {"bamboo", .80f, .68f, .44f},
                               {"cardboard", .72f, .56f, .38f},   {"cork", .70f, .52f, .34f},
                               {"earthenware", .66f, .32f, .22f}, {"rubber", .25f, .25f, .27f},
                               {"leather", .93f, .91f, .86f},     {"paper", .93f, .93f, .90f}};
  for (const Paint& p : kPaints) {
    if (material == p.material) return Look(material, p.r, p.g, p.b);
  }
  constexpr Paint kGlazes[] = {{"white", .93f, .93f, .91f}, {"cream", .90f, .84f, .70f},
                               {"blue", .24f, .40f, .62f},  {"green", .36f, .56f, .42f},
                               {"red", .72f, .22f, .20f},   {"grey", .55f, .57f, .60f}};
  const Paint& p = kGlazes[UniformIndex(draws, std::size(kGlazes))];
  return Look(p.material, p.r, p.g, p.b);
}

// Returns `value` clamped to the intersection of the ranges, or the nearest value.
double Shared(double value, std::initializer_list<const physics_params::Estimate*> ranges) {
  double low = 0.0, high = 1e9;
  for (const physics_params::Estimate* range : ranges) {
    low = std::max(low, range->min);
    high = std::min(high, range->max);
  }
  return std::clamp(value, std::min(low, high), high);
}

Eigen::Vector3d SizeOf(const RigidKind& kind, const physics_params::PhysicalParameters& p) {
  if (!kind.size.isZero()) return kind.size;
  const double l = p.length.sample, w = p.width.sample, h = p.height.sample;
  switch (kind.sides) {
    case SizeSymmetry::kRound: {
      const double across = Shared(w, {&p.length, &p.width});
      return {across, across, h};
    }
    case SizeSymmetry::kSquat: {
      const double across = Shared(std::max(w, h), {&p.length, &p.width});
      return {across, across, std::clamp(0.92 * across, p.height.min, p.height.max)};
    }
    case SizeSymmetry::kBall: {
      const double across = Shared(l, {&p.length, &p.width, &p.height});
      return {across, across, across};
    }
    case SizeSymmetry::kLying: {
      const double across = Shared(w, {&p.width, &p.height});
      return {l, across, across};
    }
    case SizeSymmetry::kHandled:
      return {std::max(l, w + kLeastHandle), w, h};
    case SizeSymmetry::kFree:
      break;
  }
  return {l, w, h};
}

}  // namespace

void AddParts(const std::vector<core::TriangleMesh>& parts, RigidDraft* draft) {
  draft->parts.insert(draft->parts.end(), parts.begin(), parts.end());
}

core::Material Look(const std::string& name, float r, float g, float b) {
  return {name, {r, g, b, 1.0f}, -1};
}

core::Material Print(RigidDraft* draft) {
  constexpr float kColors[][3] = {{.80f, .24f, .18f},
                                  {.20f, .42f, .68f},
                                  {.92f, .72f, .22f},
                                  {.28f, .58f, .36f},
                                  {.55f, .30f, .56f}};
  const auto& c = kColors[UniformIndex(draft->draws, std::size(kColors))];
  return Look("print", c[0], c[1], c[2]);
}

const std::vector<RigidKind>& RigidKinds() {
  static const std::vector<RigidKind> kKinds = [] {
    std::vector<RigidKind> all;
    for (const auto& family : {VesselKinds(), TablewareKinds(), BoxKinds(), RoundKinds(),
                               LongObjectKinds(), ToyKinds()}) {
      all.insert(all.end(), family.begin(), family.end());
    }
    return all;
  }();
  return kKinds;
}

const RigidKind* FindRigidKind(const std::string& name) {
  for (const std::vector<RigidKind>* kinds : {&RigidKinds(), &FurnitureKinds()}) {
    for (const RigidKind& kind : *kinds) {
      if (kind.name == name) return &kind;
    }
  }
  return nullptr;
}

RigidObject MakeRigidObject(const RigidKind& kind, std::uint64_t seed) {
  Options options;
  options.seed = seed;
  return MakeRigidObject(kind, options);
}

RigidObject MakeRigidObject(const RigidKind& kind, const Options& options) {
  const auto& base = physics_params::KnowledgeBase::Shipped();
  const physics_params::Category* row = base.FindCategory(kind.category);
  if (row == nullptr) throw core::Error("no such category in the knowledge base", kind.category);
  RigidObject object;
  object.parameters = physics_params::SampleParameters(*row, base, options.seed);
  RigidDraft draft;
  std::uint64_t stream = kStream;  // per kind: objects of one seed differ in colour
  for (const char c : kind.name) stream = 31 * stream + static_cast<unsigned char>(c);
  draft.draws = Draws(core::StreamRng(options.seed, stream), options.draws);
  draft.look = LookOf(object.parameters.material, draft.draws);
  draft.size = object.size = SizeOf(kind, object.parameters);
  if (options.size) draft.size = object.size = *options.size;
  object.visual = kind.make(&draft);
  if (options.record != nullptr) *options.record = draft.draws.record();
  object.parts = std::move(draft.parts);
  const Eigen::Affine3d fit = FitOf(object.size, core::Bounds(object.visual.mesh));
  core::Transform(fit, &object.visual.mesh);
  for (core::TriangleMesh& part : object.parts) core::Transform(fit, &part);
  return object;
}

}  // namespace simwright::library
