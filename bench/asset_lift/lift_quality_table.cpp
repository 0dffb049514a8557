#include "lift_quality_table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "lift_quality_variants.h"

namespace simwright::bench {
namespace {

constexpr const char* kNames =
    "object\tvariant\trevolved\tturning_defect\televation\televation_used\tchamfer\tf_score_0.1\t"
    "volume_iou\tnormal_consistency\troughness\tpsnr\tseconds\tstart\tfailure";
constexpr size_t kColumns = 15;

std::string OneCell(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n'; }, ' ');
  return text;
}

std::string Line(const QualityRow& row) {
  char numbers[256];
  std::snprintf(numbers, sizeof(numbers),
                "%d\t%.4f\t%.2f\t%.2f\t%.5f\t%.4f\t%.4f\t%.4f\t%.3f\t%.3f\t%.2f",
                row.revolved ? 1 : 0, row.turning_defect, row.elevation, row.elevation_used,
                row.scores.chamfer, row.scores.f_score, row.scores.volume_iou,
                row.scores.normal_consistency, row.scores.roughness, row.psnr, row.seconds);
  return OneCell(row.object) + '\t' + row.variant + '\t' + numbers + '\t' + OneCell(row.start) +
         '\t' + OneCell(row.failure);
}

QualityRow Parsed(const std::string& line, const std::string& where) {
  std::vector<std::string> cells;
  size_t from = 0;
  for (size_t tab; (tab = line.find('\t', from)) != std::string::npos; from = tab + 1) {
    cells.push_back(line.substr(from, tab - from));
  }
  cells.push_back(line.substr(from));
  if (cells.size() != kColumns) {
    throw core::Error("not a table of this program: " + line, where, "run without --resume");
  }
  const auto number = [&](size_t i) { return std::strtod(cells[i].c_str(), nullptr); };
  QualityRow row;
  row.object = cells[0];
  row.variant = cells[1];
  row.revolved = cells[2] == "1";
  row.turning_defect = number(3);
  row.elevation = number(4);
  row.elevation_used = number(5);
  row.scores = {number(6), number(7), number(8), number(9), number(10)};
  row.psnr = number(11);
  row.seconds = number(12);
  row.start = cells[13];
  row.failure = cells[14];
  return row;
}

using Rows = std::vector<const QualityRow*>;
using Value = std::function<double(const QualityRow&)>;

std::vector<double> Values(const Rows& rows, const Value& value) {
  std::vector<double> values;
  for (const QualityRow* row : rows) {
    if (const double v = value(*row); !std::isnan(v)) values.push_back(v);
  }
  return values;
}

double Median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

// A mean with the half width of its 95% interval, 1.96 standard errors.
struct Spread {
  double mean = NAN, half_width = NAN;
};

Spread MeanOf(const std::vector<double>& values) {
  if (values.empty()) return {};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, n > 1 ? 1.96 * std::sqrt(squares / (n - 1) / n) : NAN};
}

Rows OfVariant(const Rows& rows, const std::string& variant) {
  Rows chosen;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(chosen),
               [&](const QualityRow* row) { return row->variant == variant; });
  return chosen;
}

void PrintVariant(const Rows& rows, const std::string& variant) {
  const auto median = [&](const Value& value) { return Median(Values(rows, value)); };
  const auto f = [](const QualityRow& r) { return r.scores.f_score; };
  const auto iou = [](const QualityRow& r) { return r.scores.volume_iou; };
  const Spread f_mean = MeanOf(Values(rows, f)), iou_mean = MeanOf(Values(rows, iou));
  const auto failed = std::count_if(rows.begin(), rows.end(),
                                    [](const QualityRow* row) { return !row->failure.empty(); });
  std::printf(
      "%-10s %4zu %5ld %8.4f %6.3f %6.3f %7.3f %6.2f %6.2f %7.1f   %.3f +- %.3f  %.3f +- %.3f\n",
      variant.c_str(), rows.size(), static_cast<long>(failed),
      median([](const QualityRow& r) { return r.scores.chamfer; }), median(f), median(iou),
      median([](const QualityRow& r) { return r.scores.normal_consistency; }),
      median([](const QualityRow& r) { return r.scores.roughness; }),
      median([](const QualityRow& r) { return r.psnr; }),
      median([](const QualityRow& r) { return r.seconds; }), f_mean.mean, f_mean.half_width,
      iou_mean.mean, iou_mean.half_width);
}

// Prints how often `variant` has the smaller Chamfer distance of the two, on the objects that have
// both.
void PrintDuel(const Rows& rows, const std::string& variant, const std::string& rival) {
  std::vector<double> ours, theirs, ratios;
  int wins = 0;
  for (const QualityRow* row : OfVariant(rows, variant)) {
    for (const QualityRow* other : OfVariant(rows, rival)) {
      if (other->object != row->object) continue;
      ours.push_back(row->scores.chamfer);
      theirs.push_back(other->scores.chamfer);
      const bool both_failed = std::isinf(ours.back()) && std::isinf(theirs.back());
      ratios.push_back(both_failed ? 1.0 : ours.back() / theirs.back());
      wins += row->scores.chamfer < other->scores.chamfer ? 1 : 0;
    }
  }
  if (ours.empty()) return;
  std::printf(
      "%s against %s: smaller Chamfer on %d of %zu (%.0f%%); "
      "ratio of medians %.3f, median ratio per object %.3f\n",
      variant.c_str(), rival.c_str(), wins, ours.size(),
      100.0 * wins / static_cast<double>(ours.size()), Median(ours) / Median(theirs),
      Median(ratios));
}

void PrintGroup(const char* title, const Rows& rows) {
  if (rows.empty()) return;
  std::printf("\n%s\n%-10s %4s %5s %8s %6s %6s %7s %6s %6s %7s   %-15s  %s\n", title, "medians",
              "n", "fail", "Chamfer", "F@0.1", "IoU", "normals", "rough", "PSNR", "s", "F@0.1 mean",
              "IoU mean (95%)");
  for (const std::string& variant : LiftVariants()) {
    const Rows chosen = OfVariant(rows, variant);
    if (!chosen.empty()) PrintVariant(chosen, variant);
  }
  for (const char* rival : {"ellipsoid", "outline", "no_prior"}) PrintDuel(rows, "both", rival);
}

}  // namespace

QualityRow QualityRow::Failed(const std::string& why) {
  QualityRow row;
  row.scores = {std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0, NAN};
  row.psnr = NAN;
  row.seconds = NAN;
  row.failure = why.empty() ? "failed" : why;
  return row;
}

QualityTable::QualityTable(const std::filesystem::path& file, bool resume) : file_(file) {
  if (file.empty()) return;
  if (!resume || !std::filesystem::exists(file)) {
    core::WriteFile(file, std::string(kNames) + '\n');
    return;
  }
  const std::string text = core::ReadFile(file, 64 << 20);
  // A run that was killed while writing leaves an incomplete line.
  const std::string whole = text.substr(0, text.rfind('\n') + 1);
  if (whole.size() != text.size()) core::WriteFile(file, whole);
  std::istringstream lines(whole);
  std::string line;
  if (!std::getline(lines, line) || line != kNames) {
    throw core::Error("not a table of this program", file.string(), "run without --resume");
  }
  while (std::getline(lines, line)) rows_.push_back(Parsed(line, file.string()));
}

bool QualityTable::Has(const std::string& object, const std::string& variant) const {
  return std::any_of(rows_.begin(), rows_.end(), [&](const QualityRow& row) {
    return row.object == object && row.variant == variant;
  });
}

void QualityTable::Add(const QualityRow& row) {
  rows_.push_back(row);
  if (file_.empty()) return;
  std::ofstream out(file_, std::ios::app);
  out << Line(row) << '\n';
  if (!out.flush()) throw core::Error("cannot write", file_.string());
}

void PrintRowNames() {
  std::printf("%-34s %-10s %3s %5s %5s %8s %6s %6s %7s %6s %6s %7s  %s\n", "object", "variant",
              "rev", "elev", "used", "Chamfer", "F@0.1", "IoU", "normals", "rough", "PSNR", "s",
              "start");
}

void PrintRow(const QualityRow& row) {
  std::printf("%-34.34s %-10s %3s %5.1f %5.1f %8.4f %6.3f %6.3f %7.3f %6.2f %6.2f %7.1f  %s\n",
              row.object.c_str(), row.variant.c_str(), row.revolved ? "yes" : "no", row.elevation,
              row.elevation_used, row.scores.chamfer, row.scores.f_score, row.scores.volume_iou,
              row.scores.normal_consistency, row.scores.roughness, row.psnr, row.seconds,
              row.failure.empty() ? row.start.c_str() : row.failure.c_str());
  std::fflush(stdout);
}

void PrintSummary(const std::vector<QualityRow>& rows) {
  Rows all, revolved, other;
  for (const QualityRow& row : rows) {
    all.push_back(&row);
    (row.revolved ? revolved : other).push_back(&row);
  }
  PrintGroup("all objects", all);
  PrintGroup("solids of revolution about the vertical", revolved);
  PrintGroup("no solids of revolution", other);
}

}  // namespace simwright::bench
