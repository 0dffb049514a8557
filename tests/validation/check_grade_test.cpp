#include "validation/check_grade.h"

#include <cmath>

#include <gtest/gtest.h>

#include "assets/asset_folder.h"
#include "core/error.h"
#include "core/files.h"
#include "validation/check.h"
#include "validation/check_results.h"
#include "validation/shared_results.h"

namespace simwright::validation {
namespace {

using core::Severity;

const core::Finding& RowNamed(const core::Findings& rows, const std::string& code) {
  for (const core::Finding& row : rows) {
    if (row.code == code) return row;
  }
  throw core::Error("no such row", code);
}

core::Findings RestRows(const sim::DropResult& drop, bool rolls, double size) {
  CheckResults rows("thing");
  AddRestResults(drop, "bullet", rolls, size, CheckLimits(), &rows);
  return rows.Take();
}

sim::DropResult Still() {
  sim::DropResult drop;
  drop.rests = true;
  drop.rest_time = 0.2;
  return drop;
}

TEST(Grade, IsTheWorstRowsAndBoundsBelongToTheBetterSide) {
  const GradedLimit small{1.0, 5.0}, large{0.99, 0.9};
  EXPECT_EQ(SeverityAtMost(1.0, small), Severity::kInfo);
  EXPECT_EQ(SeverityAtMost(1.083, small), Severity::kWarning);
  EXPECT_EQ(SeverityAtMost(5.0, small), Severity::kWarning);
  EXPECT_EQ(SeverityAtMost(5.001, small), Severity::kError);
  EXPECT_EQ(SeverityAtMost(NAN, small), Severity::kError);
  EXPECT_EQ(SeverityAtLeast(0.99, large), Severity::kInfo);
  EXPECT_EQ(SeverityAtLeast(0.95, large), Severity::kWarning);
  EXPECT_EQ(SeverityAtLeast(0.89, large), Severity::kError);
  EXPECT_EQ(SeverityAtLeast(NAN, large), Severity::kError);
  CheckResults rows("thing");
  rows.AtMost("a", 0.5, small, "mm");
  EXPECT_EQ(GradeOf(core::Findings()), Grade::kPass);
  rows.AtMost("b", 1.083, small, "mm");
  core::Findings found = rows.Take();
  EXPECT_EQ(GradeOf(found), Grade::kWarnings);
  EXPECT_EQ(found[1].sentence, "mm, at most 1");
  found.push_back({"c", Severity::kError, "", "", 0.0});
  EXPECT_EQ(GradeOf(found), Grade::kFail);
  const CheckReport report{"thing", found};
  EXPECT_FALSE(report.passed());
  ASSERT_EQ(report.Warnings().size(), 1u);
  EXPECT_EQ(report.Warnings()[0].code, "b");
}

TEST(Grade, OfADropFollowsHowFarItIsFromRest) {
  sim::DropResult drop = Still();
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kPass);
  drop.drift = 1.083e-3;
  EXPECT_EQ(RowNamed(RestRows(drop, false, 0.3), "drift-bullet").severity, Severity::kWarning);
  drop.drift = 8e-3;
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kWarnings);
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.03)), Grade::kFail);  // 8 mm is a large part of 3 cm
  drop.drift = 20e-3;
  EXPECT_EQ(GradeOf(RestRows(drop, false, 3.0)), Grade::kFail);
  drop = Still();
  drop.tilt = 4.0 / kDegrees;
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kWarnings);
  drop.tilt = 6.0 / kDegrees;
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kFail);
  drop = Still();
  drop.rests = false;
  EXPECT_EQ(RowNamed(RestRows(drop, false, 0.3), "settles-bullet").severity, Severity::kWarning);
  drop.drift = 0.1;
  EXPECT_EQ(RowNamed(RestRows(drop, false, 0.3), "settles-bullet").severity, Severity::kError);
}

TEST(Grade, OfWhatRollsAllowsRollingButNoSinkingAndNoSpeedingUp) {
  sim::DropResult drop = Still();
  drop.rests = false;
  drop.tilt = 1.0;
  drop.drift = 0.02;
  drop.early_drift = 0.013;
  drop.late_drift = 0.007;
  EXPECT_EQ(GradeOf(RestRows(drop, true, 0.3)), Grade::kPass);
  EXPECT_EQ(GradeOf(RestRows(drop, true, 0.1)), Grade::kWarnings);
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kFail);
  drop.late_drift = 0.05;
  EXPECT_EQ(GradeOf(RestRows(drop, true, 0.3)), Grade::kFail);
  drop = Still();
  drop.lowest_point = -2e-3;
  EXPECT_EQ(GradeOf(RestRows(drop, true, 0.3)), Grade::kWarnings);
  drop.lowest_point = -4e-3;
  EXPECT_EQ(GradeOf(RestRows(drop, true, 0.3)), Grade::kFail);
  EXPECT_EQ(GradeOf(RestRows(drop, false, 0.3)), Grade::kFail);
}

TEST(AddFindings, JoinThoseInAssetJsonOnce) {
  const core::TemporaryFolder folder;
  core::WriteFile(folder.path() / "asset.json", "{\"name\": \"ball\", \"findings\": []}\n");
  const core::Findings warnings{{"drift-bullet", Severity::kWarning, "ball", "mm", 1.083}};
  assets::AddFindings(folder.path(), warnings);
  assets::AddFindings(folder.path(), warnings);
  const std::string json = core::ReadFile(folder.path() / "asset.json", 1 << 16);
  EXPECT_NE(json.find("\"drift-bullet\""), std::string::npos);
  EXPECT_EQ(json.find("drift-bullet"), json.rfind("drift-bullet"));
  EXPECT_NE(json.find("\"warning\""), std::string::npos);
  EXPECT_NE(json.find("\"name\": \"ball\""), std::string::npos);
}

}  // namespace
}  // namespace simwright::validation
