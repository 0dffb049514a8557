#include "library/articulated/piece_material.h"

#include "core/error.h"
#include "physics_params/knowledge_base.h"

namespace simwright::library {
namespace {

struct Paint {
  const char* look;
  float r, g, b;
};

template <size_t Count>
Matter SamplePaint(Draws& draws, const char* material, const Paint (&paints)[Count]) {
  const Paint& p = paints[UniformIndex(draws, Count)];
  return MatterOf(material, p.look, p.r, p.g, p.b);
}

}  // namespace

Matter MatterOf(const std::string& material, const std::string& look, float r, float g, float b) {
  const physics_params::Material* known =
      physics_params::KnowledgeBase::Shipped().FindMaterial(material);
  if (known == nullptr) throw core::Error("no such material", material);
  return {look, material, 0.5 * (known->density.min + known->density.max), {r, g, b, 1.0f}};
}

Matter Casing(Draws& draws) {
  constexpr Paint kPaints[] = {{"white_enamel", 0.92f, 0.92f, 0.91f},
                               {"cream_enamel", 0.90f, 0.86f, 0.76f},
                               {"black_enamel", 0.16f, 0.16f, 0.17f},
                               {"grey_enamel", 0.62f, 0.64f, 0.66f}};
  return SamplePaint(draws, "appliance", kPaints);
}

Matter BrushedSteel() {
  return MatterOf("steel", "brushed_steel", 0.74f, 0.75f, 0.77f);
}

Matter BlackPlastic() {
  return MatterOf("plastic", "black_plastic", 0.11f, 0.11f, 0.12f);
}

Matter DarkGlass() {
  return MatterOf("glass", "dark_glass", 0.07f, 0.08f, 0.10f);
}

Matter ClearGlass() {
  return MatterOf("glass", "clear_glass", 0.70f, 0.83f, 0.90f);
}

Matter Board(Draws& draws) {
  constexpr Paint kPaints[] = {{"oak", 0.76f, 0.58f, 0.38f},
                               {"walnut", 0.45f, 0.30f, 0.20f},
                               {"white_paint", 0.93f, 0.93f, 0.90f},
                               {"grey_paint", 0.58f, 0.61f, 0.63f},
                               {"green_paint", 0.48f, 0.58f, 0.50f}};
  return SamplePaint(draws, "plywood", kPaints);
}

Matter FurnitureMetal(Draws& draws) {
  return Uniform(draws) < 0.7 ? BrushedSteel() : MatterOf("brass", "brass", 0.80f, 0.65f, 0.35f);
}

}  // namespace simwright::library
