#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lift_quality_measures.h"

namespace simwright::bench {

// A variant's result on one object. Where the lift failed: `failure` says why, the Chamfer distance
// is infinite, F and IoU are 0, the signal to noise is NaN.
struct QualityRow {
  std::string object, variant;
  bool revolved = false;        // the truth is a body of revolution about its vertical
  double turning_defect = 0.0;  // of the truth
  double elevation = 0.0;       // degrees, true
  double elevation_used = 0.0;  // degrees, by the lift
  ShapeScores scores;
  double psnr = 0.0;     // dB, mean of the novel views
  double seconds = 0.0;  // of the lift
  std::string start;     // what it started from
  std::string failure;

  static QualityRow Failed(const std::string& why);
};

// A table on disk that grows a row at a time, tab-separated under a line of names.
class QualityTable {
 public:
  // `file` empty: kept in memory alone. `resume`: what the file holds is kept and goes on, else it
  // is begun anew. Throws core::Error where the file is of another form or cannot be written.
  QualityTable(const std::filesystem::path& file, bool resume);

  bool Has(const std::string& object, const std::string& variant) const;
  void Add(const QualityRow& row);  // also to the file, at once
  const std::vector<QualityRow>& rows() const { return rows_; }

 private:
  std::filesystem::path file_;
  std::vector<QualityRow> rows_;
};

// A line of the table for the screen, and the line of names above it.
void PrintRow(const QualityRow& row);
void PrintRowNames();

// For all objects, those turned about the vertical and those that are not: medians and means a
// variant, and how "both" compares with the ellipsoid and the outline object by object.
void PrintSummary(const std::vector<QualityRow>& rows);

}  // namespace simwright::bench
