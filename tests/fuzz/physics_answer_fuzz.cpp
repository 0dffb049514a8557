// What language models say of masses and sizes: positive ranges, and estimates that can be drawn
// from or core::Error, nothing else.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "physics_params/answer_reconciliation.h"
#include "physics_params/physics_answer.h"

namespace {

using namespace simwright::physics_params;

void RequirePositive(const std::optional<Interval>& range) {
  if (range && !(range->min > 0.0 && range->min <= range->max && range->max < 1e300)) std::abort();
}

void RequireDrawable(const EstimatedCategory& estimate, const KnowledgeBase& base) {
  const PhysicalParameters p = SampleEstimate(estimate, base, 1);
  for (const Estimate& e : {p.length, p.width, p.height, p.mass}) {
    if (!(e.min > 0.0 && e.min <= e.sample && e.sample <= e.max)) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const KnowledgeBase& base = KnowledgeBase::Shipped();
  static const Resolution mug{base.FindCategory("mug"), true, "", {}};
  static const Resolution near_bottle{base.FindCategory("wine bottle"), false, "", {}};
  const PhysicsAnswer answer = ReadPhysicsAnswer({reinterpret_cast<const char*>(data), size});
  for (const ObjectAnswer& object : answer.objects) {
    for (const auto& range : {object.mass, object.length, object.width, object.height}) {
      RequirePositive(range);
    }
    RequireDrawable(ReconcileAnswer(mug, object, base, "m"), base);
    RequireDrawable(ReconcileAnswer(near_bottle, object, base, "m"), base);
    try {
      RequireDrawable(CategoryFromAnswer("thing", object, base, "m"), base);
    } catch (const simwright::core::Error&) {
    }
  }
  return 0;
}
