// Prints the tables of docs/physics.md: coverage and score of stated intervals on measured objects,
// and the accuracy of name resolution by the limit of steps.
//   bench_interval_table              the tables
//   bench_interval_table --fit        the lines of physics_params/data/calibration.txt
//   bench_interval_table --misses     the objects of the tuning half that lie outside
#include <cstdio>
#include <cstring>
#include <map>

#include "core/error.h"
#include "tests/physics_params/measured/measured_objects.h"

namespace {

using namespace simwright::physics_params;

constexpr Quantity kQuantities[] = {Quantity::kMass, Quantity::kLongestSide};

const char* TableName(Quantity quantity) {
  return quantity == Quantity::kMass ? "mass" : "longest_side";
}

void PrintFit(const std::vector<ResolvedObject>& objects) {
  for (const Quantity quantity : kQuantities) {
    for (const double probability : {0.9, 0.95}) {
      std::printf("%s %g %.4f\n", TableName(quantity), probability,
                  ConformalQuantile(MissesOf(objects, quantity, probability), probability));
    }
  }
}

void PrintMisses(const std::vector<ResolvedObject>& objects) {
  for (const ResolvedObject& one : objects) {
    for (const Quantity quantity : kQuantities) {
      const std::optional<double> truth = TruthOf(*one.object, quantity);
      if (!one.object->tuning || !truth) continue;
      const Interval range = MixtureInterval(one.row, KnowledgeBase::Shipped(), quantity, 0.9);
      if (range.Contains(*truth)) continue;
      std::printf("%-24s %-20s -> %-18s %-12s %8.4g [%.4g, %.4g] miss %.2f\n",
                  one.object->name.c_str(), one.object->kind.c_str(), one.row.name.c_str(),
                  TableName(quantity), *truth, range.min, range.max, RelativeMiss(range, *truth));
    }
  }
}

// One line of the interval table.
void PrintRow(const char* label, const std::vector<ResolvedObject>& objects, Quantity quantity,
              bool tuning, Statement statement) {
  const std::vector<ScoredInterval> intervals = IntervalsOf(objects, quantity, tuning, statement);
  const IntervalScores scores = ScoreIntervals(intervals, kStatedProbability);
  std::printf("| %s | %s | %s | %d of %d | %.2f (%.2f to %.2f) | %.2f | %.2f | %.2f |\n",
              quantity == Quantity::kMass ? "mass" : "longest side", tuning ? "tuning" : "held-out",
              label, scores.covered, scores.count, scores.coverage, scores.coverage_range.min,
              scores.coverage_range.max, CoverageByKind(objects, quantity, tuning, statement),
              scores.median_factor, scores.mean_score);
}

void PrintIntervals(const std::vector<MeasuredObject>& measured) {
  const std::vector<ResolvedObject> named = ResolvedObjects(measured, false);
  const std::vector<ResolvedObject> with_material = ResolvedObjects(measured, true);
  int refused[2] = {0, 0}, all[2] = {0, 0};
  for (const MeasuredObject& object : measured) ++all[object.tuning];
  refused[0] = all[0];
  refused[1] = all[1];
  for (const ResolvedObject& one : named) --refused[one.object->tuning];
  std::printf("objects: %d tuning (%d refused), %d held-out (%d refused)\n\n", all[1], refused[1],
              all[0], refused[0]);
  std::printf(
      "| quantity | half | intervals | covered | coverage (95 %% range) | mean over kinds | "
      "median max / min | score |\n|---|---|---|---|---|---|---|---|\n");
  for (const bool tuning : {true, false}) {
    for (const Quantity quantity : kQuantities) {
      PrintRow("the row's range", named, quantity, tuning, Statement::kRow);
      PrintRow("row and variants", named, quantity, tuning, Statement::kMixture);
      PrintRow("calibrated", named, quantity, tuning, Statement::kCalibrated);
      PrintRow("calibrated, material stated", with_material, quantity, tuning,
               Statement::kCalibrated);
    }
  }
}

// Prints the share of right answers of a half and, of the others, the wrong rows.
void PrintHalfOfNames(const std::vector<NameAnswer>& answers, bool tuning, int steps) {
  int right = 0, wrong_row = 0, all = 0;
  for (const NameAnswer& answer : answers) {
    if (answer.tuning != tuning) continue;
    const bool accepted = IsAccepted(answer, steps);
    const Resolution found =
        ResolveCategory(answer.name, KnowledgeBase::Shipped(), WordNet::Installed(), steps);
    right += accepted ? 1 : 0;
    wrong_row += !accepted && found.category != nullptr ? 1 : 0;
    ++all;
  }
  std::printf(" %d of %d | %d | %d |", right, all, wrong_row, all - right - wrong_row);
}

void PrintNames() {
  const std::vector<NameAnswer> answers = NameAnswers();
  std::printf(
      "\n| most steps | tuning: right | wrong row | refused | held-out: right | wrong row | "
      "refused |\n|---|---|---|---|---|---|---|\n");
  for (int steps = 0; steps <= 5; ++steps) {
    std::printf("| %d |", steps);
    PrintHalfOfNames(answers, true, steps);
    PrintHalfOfNames(answers, false, steps);
    std::printf("\n");
  }
}

void PrintWrongNames() {
  for (const NameAnswer& answer : NameAnswers()) {
    if (!answer.tuning || IsAccepted(answer)) continue;
    std::printf("%s: %s\n", answer.name.c_str(),
                ResolveCategory(answer.name, KnowledgeBase::Shipped(), WordNet::Installed())
                    .sentence.c_str());
  }
}

int Main(int argc, char** argv) {
  const std::vector<MeasuredObject> measured = MeasuredObjects();
  const bool fit = argc > 1 && std::strcmp(argv[1], "--fit") == 0;
  const bool misses = argc > 1 && std::strcmp(argv[1], "--misses") == 0;
  if (fit) {
    PrintFit(ResolvedObjects(measured, false));
  } else if (misses) {
    PrintMisses(ResolvedObjects(measured, false));
    PrintWrongNames();
  } else {
    PrintIntervals(measured);
    PrintNames();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return Main(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
