#pragma once

#include <cstdint>
#include <string>

#include "core/finding.h"
#include "physics_params/category_resolution.h"
#include "physics_params/knowledge_base.h"
#include "physics_params/physical_parameters.h"
#include "physics_params/physics_answer.h"

namespace simwright::physics_params {

// A category combined with a language model's answer, with the source of each part.
struct EstimatedCategory {
  Category category;
  std::string resolution;  // how the name was resolved
  std::string length_source, width_source, height_source, mass_source;
  core::Findings findings;
};

// Combines an answer with the knowledge base's category. For each quantity:
//  - the ranges overlap: the intersection; the model narrows the knowledge base;
//  - they do not, and the name itself is in the base: the base wins ("llm-disagrees", a warning if
//    they differ by more than a factor of 1.5 in size, 2.5 in mass);
//  - they do not, and the base has only a related category: the model, which was asked for the
//    exact name, wins up to a factor of 2 in size and 4 in mass; beyond that the base
//    ("llm-disagrees", a warning).
// Single values count as means with 10 % to either side. Sizes that name the same three sides in
// another order are permuted to the base's ("llm-turned"). An answer whose mass does not fit its
// own sizes loses its mass. A material of the category that the model names is moved to the front.
// `model` names the answer's source.
EstimatedCategory ReconcileAnswer(const Resolution& known, const ObjectAnswer& answer,
                                  const KnowledgeBase& base, const std::string& model);

// Builds the category of a name without a related category from the answer alone. It must give mass
// and the three sizes, between a millimetre and 20 m, and 5 to 12000 kg/m^3 over its bounding box,
// no more than its material. Throws core::Error, with the reason, if it does not.
EstimatedCategory CategoryFromAnswer(const std::string& name, const ObjectAnswer& answer,
                                     const KnowledgeBase& base, const std::string& model);

// Calls SampleParameters for the estimated category, with each quantity's own source.
PhysicalParameters SampleEstimate(const EstimatedCategory& estimate, const KnowledgeBase& base,
                                  std::uint64_t seed);

}  // namespace simwright::physics_params
