#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lift_quality_measures.h"

namespace simwright::bench {

// A variant's result on one object. If the reconstruction failed, `failure` says why, the Chamfer
// distance is infinite, F and IoU are 0, the signal to noise is NaN.
struct QualityRow {
  std::string object, variant;
  bool revolved = false;        // the ground truth is a solid of revolution about its vertical
  double turning_defect = 0.0;  // of the ground truth
  double elevation = 0.0;       // degrees, true
  double elevation_used = 0.0;  // degrees, estimated
  ShapeScores scores;
  double psnr = 0.0;     // dB, mean of the novel views
  double seconds = 0.0;  // of the reconstruction
  std::string start;     // initial shape
  std::string failure;

  static QualityRow Failed(const std::string& why);
};

// A table on disk that grows by one row at a time, tab-separated below a line of names.
class QualityTable {
 public:
  // `file` empty: in memory only. `resume`: keeps the rows of the file, else starts a new one.
  // Throws core::Error if the file has another form or cannot be written.
  QualityTable(const std::filesystem::path& file, bool resume);

  bool Has(const std::string& object, const std::string& variant) const;
  void Add(const QualityRow& row);  // also to the file, immediately
  const std::vector<QualityRow>& rows() const { return rows_; }

 private:
  std::filesystem::path file_;
  std::vector<QualityRow> rows_;
};

// Prints one row of the table, or the line of names above it.
void PrintRow(const QualityRow& row);
void PrintRowNames();

// Prints medians and means per variant for all objects, the solids of revolution about the vertical
// and the others, and how "both" compares with the ellipsoid and the silhouette object by object.
void PrintSummary(const std::vector<QualityRow>& rows);

}  // namespace simwright::bench
