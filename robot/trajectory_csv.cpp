#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "robot/number_text.h"
#include "robot/trajectory_formats.h"
#include "robot/trajectory_points.h"

namespace simwright::robot {
namespace {

constexpr const char* kQuantities[] = {"position", "velocity", "acceleration", "effort"};

std::vector<std::string_view> Cells(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(Trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

class CsvReader {
 public:
  explicit CsvReader(const std::string& where) : where_(where) {}

  JointTrajectory Read(std::string_view text);

 private:
  [[noreturn]] void Fail(const std::string& what, const std::string& remedy = "") const {
    throw core::Error(what, where_ + ": line " + std::to_string(line_), remedy);
  }
  void ReadComment(std::string_view comment);
  void ReadHeader(std::string_view line);
  void ReadRow(std::string_view line);
  Eigen::MatrixXd Columns(std::size_t quantity) const;

  std::string where_;
  std::size_t line_ = 0;
  std::size_t columns_ = 0;     // of a row, including the time
  std::size_t quantities_ = 0;  // number of kQuantities in the file
  std::vector<double> cells_;
  std::int64_t announced_ = -1;
  JointTrajectory trajectory_;
};

void CsvReader::ReadComment(std::string_view comment) {
  const std::size_t colon = comment.find(": ");
  if (colon == std::string_view::npos) return;
  const std::string key(Trimmed(comment.substr(0, colon)));
  const std::string value(Trimmed(comment.substr(colon + 2)));
  if (key == "samples") {
    announced_ = IntegerFrom(value).value_or(-1);
    if (announced_ < 0) Fail("'samples' is not a count");
  } else {
    trajectory_.metadata[key] = value;
  }
}

// Reads the header: time, then position.JOINT of each joint, then velocity.JOINT of each, and so
// on.
void CsvReader::ReadHeader(std::string_view line) {
  const std::vector<std::string_view> cells = Cells(line);
  if (cells[0] != "time") Fail("the first column must be 'time'");
  const auto begins = [](std::string_view cell, const char* quantity) {
    return cell.starts_with(std::string(quantity) + ".");
  };
  for (std::size_t c = 1; c < cells.size() && begins(cells[c], "position"); ++c) {
    trajectory_.joints.emplace_back(cells[c].substr(9));
  }
  const std::size_t joints = trajectory_.joints.size();
  if (joints == 0) Fail("there is no column 'position.JOINT'");
  if (joints > kMostTrajectoryJoints) Fail("there are too many joints");
  quantities_ = (cells.size() - 1) / joints;
  if (quantities_ > std::size(kQuantities) || cells.size() != 1 + joints * quantities_) {
    Fail("the columns are not 'time', then each joint's position, velocity, acceleration, effort");
  }
  for (std::size_t c = 1; c < cells.size(); ++c) {
    const std::string expected =
        std::string(kQuantities[(c - 1) / joints]) + "." + trajectory_.joints[(c - 1) % joints];
    if (cells[c] != expected) Fail("column " + std::to_string(c) + " must be '" + expected + "'");
  }
  columns_ = cells.size();
}

void CsvReader::ReadRow(std::string_view line) {
  const std::vector<std::string_view> cells = Cells(line);
  if (cells.size() != columns_) {
    Fail("there are " + std::to_string(cells.size()) + " cells for " + std::to_string(columns_) +
         " columns");
  }
  if (trajectory_.times.size() == kMostTrajectorySamples) Fail("there are too many samples");
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::optional<double> number = NumberFrom(cells[c]);
    if (!number) {
      Fail("'" + std::string(cells[c].substr(0, 40)) + "' in column " + std::to_string(c) +
           " is not a finite number");
    }
    if (c == 0) {
      trajectory_.times.push_back(*number);
    } else {
      cells_.push_back(*number);
    }
  }
}

Eigen::MatrixXd CsvReader::Columns(std::size_t quantity) const {
  if (quantity >= quantities_) return {};
  const auto joints = static_cast<Eigen::Index>(trajectory_.joints.size());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(cells_.data(), trajectory_.size(),
                                    static_cast<Eigen::Index>(columns_ - 1))
      .middleCols(static_cast<Eigen::Index>(quantity) * joints, joints);
}

JointTrajectory CsvReader::Read(std::string_view text) {
  if (!text.empty() && text.back() != '\n') {
    throw core::Error("the last line has no newline: the file is truncated", where_);
  }
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = Trimmed(text.substr(0, end));
    text.remove_prefix(end + 1);
    ++line_;
    if (line.empty()) continue;
    if (line.front() == '#') {
      ReadComment(line.substr(1));
    } else if (columns_ == 0) {
      ReadHeader(line);
    } else {
      ReadRow(line);
    }
  }
  if (columns_ == 0) throw core::Error("the table has no header", where_);
  if (trajectory_.times.empty()) throw core::Error("the table has no rows", where_);
  if (announced_ >= 0 && announced_ != trajectory_.size()) {
    throw core::Error("the table announces " + std::to_string(announced_) + " samples and has " +
                          std::to_string(trajectory_.size()),
                      where_, "the file is truncated: write it again");
  }
  trajectory_.positions = Columns(0);
  trajectory_.velocities = Columns(1);
  trajectory_.accelerations = Columns(2);
  trajectory_.efforts = Columns(3);
  RequireWellFormed(trajectory_, where_);
  return std::move(trajectory_);
}

}  // namespace

std::string CsvText(const JointTrajectory& trajectory) {
  const Eigen::MatrixXd* matrices[] = {&trajectory.positions, &trajectory.velocities,
                                       &trajectory.accelerations, &trajectory.efforts};
  std::size_t quantities = 1;
  for (std::size_t m = 1; m < std::size(matrices); ++m) {
    if (matrices[m]->size() == 0) continue;
    if (quantities != m) {
      throw core::Error(std::string("a table with the column '") + kQuantities[m] + "' needs '" +
                            kQuantities[m - 1] + "' too",
                        "trajectory");
    }
    quantities = m + 1;
  }
  std::string text;
  for (const auto& [key, value] : trajectory.metadata) text += "# " + key + ": " + value + "\n";
  text += "# samples: " + std::to_string(trajectory.size()) + "\ntime";
  for (std::size_t m = 0; m < quantities; ++m) {
    for (const std::string& joint : trajectory.joints) {
      text += std::string(",") + kQuantities[m] + "." + joint;
    }
  }
  text += '\n';
  for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
    AppendNumber(trajectory.times[static_cast<std::size_t>(i)], &text);
    for (std::size_t m = 0; m < quantities; ++m) {
      for (Eigen::Index j = 0; j < matrices[m]->cols(); ++j) {
        text += ',';
        AppendNumber((*matrices[m])(i, j), &text);
      }
    }
    text += '\n';
  }
  return text;
}

JointTrajectory ParseCsv(std::string_view text, const std::string& where) {
  return CsvReader(where).Read(text);
}

}  // namespace simwright::robot
