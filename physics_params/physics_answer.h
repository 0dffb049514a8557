#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/finding.h"
#include "physics_params/knowledge_base.h"

namespace simwright::physics_params {

// An answer's data on one object. A quantity that is missing or invalid is unset.
struct ObjectAnswer {
  std::string name;              // normalised (NormaliseName); empty if the answer gives none
  std::optional<Interval> mass;  // kg
  std::optional<Interval> length, width, height;  // m; a single value has min == max
  std::string material;                           // the answer's words; may be empty
};

struct PhysicsAnswer {
  std::vector<ObjectAnswer> objects;  // in order; objects without data are left out
  core::Findings findings;            // "answer-negative", "answer-swapped", "answer-unclear"
};

// Reads masses and sizes from a language model's answer: ranges with any dash or words, single
// values, metric or other units (default grams and centimetres, as asked), lists, tables, JSON,
// prose. A reversed range is swapped; values that are not positive are dropped; both are reported.
// Never throws, whatever `answer` contains.
PhysicsAnswer ReadPhysicsAnswer(std::string_view answer);

// Returns the object with `name`, else one whose name contains or is contained in it, else the only
// one. Null if there is none.
const ObjectAnswer* FindObject(const PhysicsAnswer& answer, std::string_view name);

}  // namespace simwright::physics_params
