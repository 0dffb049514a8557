// The tables of measured objects and of names, for tests and for bench_interval_table.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/files.h"
#include "physics_params/category_resolution.h"
#include "physics_params/interval_score.h"
#include "physics_params/stated_interval.h"
#include "physics_params/variant_choice.h"

namespace simwright::physics_params {

struct MeasuredObject {
  std::string name, kind;
  std::string material;                // empty: unknown
  std::optional<double> longest_side;  // m
  double mass = 0.0;                   // kg
  bool checked = false;                // the mass was found in a second public copy
  bool tuning = false;                 // belongs to the tuning half
};

struct NameAnswer {
  std::string name;
  std::vector<std::string> accepted;  // rows, or "refuse"
  bool tuning = false;
};

// Returns true if the 64-bit FNV-1a hash of `name` is even.
inline bool IsTuningName(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  return hash % 2 == 0;
}

inline std::vector<std::string> Cells(const std::string& line, char separator) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == separator) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

inline std::vector<std::vector<std::string>> MeasuredRows(const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  const std::string path = SIMWRIGHT_SOURCE_DIR "/tests/physics_params/measured/" + file;
  for (const std::string& line : Cells(core::ReadFile(path), '\n')) {
    if (!line.empty() && line[0] != '#') rows.push_back(Cells(line, '|'));
  }
  return rows;
}

inline std::vector<MeasuredObject> MeasuredObjects() {
  std::vector<MeasuredObject> objects;
  for (const std::vector<std::string>& row : MeasuredRows("objects.txt")) {
    MeasuredObject object;
    object.name = row.at(0);
    object.kind = row.at(1);
    if (row.at(2) != "-") object.material = row[2];
    if (row.at(3) != "-") object.longest_side = 0.01 * std::stod(row[3]);
    object.mass = 0.001 * std::stod(row.at(4));
    object.checked = row.at(6) == "yes";
    object.tuning = IsTuningName(object.kind);
    objects.push_back(object);
  }
  return objects;
}

inline std::vector<NameAnswer> NameAnswers() {
  std::vector<NameAnswer> answers;
  for (const std::vector<std::string>& row : MeasuredRows("names.txt")) {
    answers.push_back({row.at(0), Cells(row.at(1), ','), IsTuningName(row[0])});
  }
  return answers;
}

// One object's truth with the row that its kind led to.
struct ResolvedObject {
  const MeasuredObject* object = nullptr;
  Category row;
  bool exact = false;  // the kind is a row's own name
};

// Resolves each object's kind, and drops those that are refused. `with_material` also states the
// material, where the row or a variant is made of it.
inline std::vector<ResolvedObject> ResolvedObjects(const std::vector<MeasuredObject>& objects,
                                                   bool with_material) {
  const KnowledgeBase& base = KnowledgeBase::Shipped();
  std::vector<ResolvedObject> resolved;
  for (const MeasuredObject& object : objects) {
    const Resolution found = ResolveCategory(object.kind, base, WordNet::Installed());
    if (found.category == nullptr) continue;
    Category row = *found.category;
    VariantChoice choice;
    if (!found.material.empty()) choice.material = found.material;
    if (with_material && !object.material.empty()) choice.material = object.material;
    try {
      row = ChosenVariant(*found.category, base, choice);
    } catch (const core::Error&) {
      // The row keeps its own materials.
    }
    resolved.push_back({&object, row, found.exact});
  }
  return resolved;
}

inline std::optional<double> TruthOf(const MeasuredObject& object, Quantity quantity) {
  return quantity == Quantity::kMass ? std::optional<double>(object.mass) : object.longest_side;
}

// The interval that is scored: the row's own range, the mixture with its variants, or that with the
// fitted inflation.
enum class Statement { kRow, kMixture, kCalibrated };

inline Interval IntervalOf(const ResolvedObject& one, Quantity quantity, Statement statement) {
  const KnowledgeBase& base = KnowledgeBase::Shipped();
  if (statement == Statement::kCalibrated) {
    return StatedInterval(one.row, base, quantity);
  }
  Category row = one.row;
  if (statement == Statement::kRow) row.variants.clear();
  return MixtureInterval(row, base, quantity, kStatedProbability);
}

inline std::vector<ScoredInterval> IntervalsOf(const std::vector<ResolvedObject>& objects,
                                               Quantity quantity, bool tuning,
                                               Statement statement) {
  std::vector<ScoredInterval> intervals;
  for (const ResolvedObject& one : objects) {
    const std::optional<double> truth = TruthOf(*one.object, quantity);
    if (one.object->tuning != tuning || !truth) continue;
    intervals.push_back({IntervalOf(one, quantity, statement), *truth});
  }
  return intervals;
}

// Returns the mean over kinds of each kind's coverage, in which a kind of many objects counts once.
inline double CoverageByKind(const std::vector<ResolvedObject>& objects, Quantity quantity,
                             bool tuning, Statement statement) {
  std::map<std::string, std::pair<int, int>> covered_of_all;
  for (const ResolvedObject& one : objects) {
    const std::optional<double> truth = TruthOf(*one.object, quantity);
    if (one.object->tuning != tuning || !truth) continue;
    auto& [covered, all] = covered_of_all[one.object->kind];
    covered += IntervalOf(one, quantity, statement).Contains(*truth) ? 1 : 0;
    ++all;
  }
  double sum = 0.0;
  for (const auto& [kind, counts] : covered_of_all) {
    sum += static_cast<double>(counts.first) / counts.second;
  }
  return sum / static_cast<double>(covered_of_all.size());
}

// Rows that were written because a kind of the tuning half was refused or far off.
inline bool IsWrittenForObjects(std::string_view row) {
  static constexpr std::string_view kRows[] = {
      "clamp",       "timer",        "pocket knife", "puzzle cube",      "spork",   "lid",
      "rubber ball", "plastic ball", "toy brick",    "mini soccer ball", "iron pot"};
  return std::find(std::begin(kRows), std::end(kRows), row) != std::end(kRows);
}

// Returns the conformity scores of the tuning half that an inflation is fitted to. Variants and
// rows that were written for these very objects are left out: they would make the base look better
// than it is for objects that nobody has looked at.
inline std::vector<double> MissesOf(const std::vector<ResolvedObject>& objects, Quantity quantity,
                                    double probability) {
  std::vector<double> misses;
  for (const ResolvedObject& one : objects) {
    const std::optional<double> truth = TruthOf(*one.object, quantity);
    if (!one.object->tuning || !truth) continue;
    if (IsWrittenForObjects(one.row.name)) continue;
    Category row = one.row;
    std::erase_if(row.variants, [](const Variant& variant) { return variant.from_objects; });
    misses.push_back(RelativeMiss(
        MixtureInterval(row, KnowledgeBase::Shipped(), quantity, probability), *truth));
  }
  return misses;
}

// Returns true if the resolution of a name is one of its accepted answers.
inline bool IsAccepted(const NameAnswer& answer, int most_steps = kMostSteps) {
  const Resolution found =
      ResolveCategory(answer.name, KnowledgeBase::Shipped(), WordNet::Installed(), most_steps);
  const std::string given = found.category == nullptr ? "refuse" : found.category->name;
  for (const std::string& one : answer.accepted) {
    if (one == given) return true;
  }
  return false;
}

}  // namespace simwright::physics_params
