#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// What an answer says of one object. A quantity that it does not give, or gives as nonsense, is
// unset.
struct ObjectAnswer {
  std::string name;              // normalised (NormaliseName); empty where the answer names none
  std::optional<Interval> mass;  // kg
  std::optional<Interval> length, width, height;  // m; a single value has min == max
  std::string material;                           // the answer's words; may be empty
};

struct PhysicsAnswer {
  std::vector<ObjectAnswer> objects;  // in order; those of which nothing was said are left out
  core::Findings findings;            // "answer-negative", "answer-swapped", "answer-unclear"
};

// Reads masses and sizes out of a language model's answer: ranges with any dash or words, single
// values, units metric or not (else grams and centimetres, as asked), lists, tables, JSON, prose.
// A range the wrong way round is turned; what is not positive is dropped; both are reported.
// Never throws for what is in `answer`.
PhysicsAnswer ReadPhysicsAnswer(std::string_view answer);

// The object meant by `name`: the same name, else one whose name holds it or is held by it, else
// the only one. Null: none of them.
const ObjectAnswer* FindObject(const PhysicsAnswer& answer, std::string_view name);

}  // namespace simwright::physics_params
