#pragma once

#include <cstdint>
#include <string>

#include "core/finding.h"
#include "physics_params/category_resolution.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/physical_parameters.h"
#include "physics_params/physics_answer.h"

namespace simwright::physics_params {

// A category with what a language model said of it, and what each part rests on.
struct EstimatedCategory {
  Category category;
  std::string resolution;  // how the name led to it
  std::string length_source, width_source, height_source, mass_source;
  core::Findings findings;
};

// Joins an answer with what is known of its kind. Quantity by quantity:
//  - the ranges overlap: what both allow; the model narrows the knowledge base;
//  - they do not, and the name itself is in the base: the base wins ("llm-disagrees", a warning
//    where they are more than a factor of 1.5 apart in size, 2.5 in mass);
//  - they do not, and the base only knows a near kind: the model, asked by the very name, wins up
//    to a factor of 2 in size and 4 in mass; beyond that the base ("llm-disagrees", a warning).
// Single values are means, not ranges: they count for 10 % to either side. Sizes that name the
// same three sides in another order are turned to the base's ("llm-turned"). An answer whose mass
// does not fit its own sizes loses its mass. A material of the row that the model names is tried
// first. `model` names the answer's source.
EstimatedCategory ReconcileAnswer(const Resolution& known, const ObjectAnswer& answer,
                                  const KnowledgeBase& base, const std::string& model);

// The same for a name without a near kind: all rests on the answer, which must give mass and the
// three sizes, between a millimetre and 20 m, and 5 to 12000 kg/m^3 over its bounding box, no more
// than its material. Throws core::Error, saying what is wrong, where it does not.
EstimatedCategory CategoryFromAnswer(const std::string& name, const ObjectAnswer& answer,
                                     const KnowledgeBase& base, const std::string& model);

// SampleParameters of the estimated category, with each quantity's own source.
PhysicalParameters SampleEstimate(const EstimatedCategory& estimate, const KnowledgeBase& base,
                                  std::uint64_t seed);

}  // namespace simwright::physics_params
