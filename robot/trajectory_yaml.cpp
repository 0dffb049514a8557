#include <optional>
#include <utility>

#include "core/error.h"
#include "robot/number_text.h"
#include "robot/trajectory_formats.h"
#include "robot/trajectory_points.h"

namespace simwright::robot {
namespace {

void AppendYamlRow(const char* name, const Eigen::MatrixXd& matrix, Eigen::Index row,
                   std::string* text) {
  *text += name;
  *text += ": [";
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    if (j > 0) *text += ", ";
    AppendNumber(matrix(row, j), text);
  }
  *text += "]\n  ";
}

// Reads the subset of YAML that a JointTrajectory needs, line by line: the lists of a point in
// brackets on one line, or one entry per line after "- ".
class YamlReader {
 public:
  explicit YamlReader(const std::string& where) : where_(where) {}

  JointTrajectory Read(std::string_view text);

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw core::Error(what, where_ + ": line " + std::to_string(line_));
  }
  void ReadLine(std::string_view line);
  void ReadSection(std::string_view line);
  void ReadPointLine(std::string_view line);
  void ReadMember(std::string_view line);
  void ReadComment(std::string_view comment);
  void EndPoint();
  double Number(std::string_view text) const;
  std::string Name(std::string_view text) const;
  std::vector<std::string_view> Flow(std::string_view list) const;
  std::vector<double>* ListNamed(std::string_view name);

  enum class Section { kNone, kHeader, kNames, kPoints };
  std::string where_;
  std::size_t line_ = 0, point_line_ = 0;
  Section section_ = Section::kNone;
  bool ended_ = false;
  std::vector<std::string> joints_;
  std::optional<TrajectoryPoints> points_;
  std::optional<TrajectoryPoint> point_;
  std::vector<double>* list_ = nullptr;  // of point_, receives entries on separate lines
  int times_given_ = 0;                  // bits: sec 1, nanosec 2
  std::map<std::string, std::string> notes_;
};

double YamlReader::Number(std::string_view text) const {
  const std::optional<double> number = NumberFrom(text);
  if (!number) Fail("'" + std::string(text.substr(0, 40)) + "' is not a finite number");
  return *number;
}

std::string YamlReader::Name(std::string_view text) const {
  if (text.size() >= 2 && (text.front() == '\'' || text.front() == '"') &&
      text.back() == text.front()) {
    text = text.substr(1, text.size() - 2);
  }
  if (text.empty() || text.size() > 200) Fail("a joint has no name or a very long one");
  return std::string(text);
}

// Splits "[a, b]" into its entries.
std::vector<std::string_view> YamlReader::Flow(std::string_view list) const {
  if (list.size() < 2 || list.front() != '[' || list.back() != ']') {
    Fail("must be a list in brackets");
  }
  list = Trimmed(list.substr(1, list.size() - 2));
  std::vector<std::string_view> entries;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    entries.push_back(Trimmed(list.substr(0, comma)));
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
    if (Trimmed(list).empty()) Fail("the list ends with a comma");
  }
  return entries;
}

std::vector<double>* YamlReader::ListNamed(std::string_view name) {
  if (name == "positions") return &point_->positions;
  if (name == "velocities") return &point_->velocities;
  if (name == "accelerations") return &point_->accelerations;
  if (name == "effort") return &point_->effort;
  return nullptr;
}

void YamlReader::EndPoint() {
  if (!point_) return;
  const std::string place = "the point of line " + std::to_string(point_line_);
  if (times_given_ != 3) Fail(place + " has an incomplete time_from_start");
  points_->Add(*point_, place);
  point_.reset();
  list_ = nullptr;
}

void YamlReader::ReadSection(std::string_view line) {
  const std::size_t colon = line.find(':');
  const std::string_view key = line.substr(0, colon);
  if (colon == std::string_view::npos) Fail("must be a member and a colon");
  const std::string_view value = Trimmed(line.substr(colon + 1));
  if (key == "header") {
    section_ = Section::kHeader;
  } else if (key == "joint_names") {
    if (!joints_.empty()) Fail("'joint_names' is given twice");
    section_ = Section::kNames;
    if (value.empty()) return;
    for (const std::string_view entry : Flow(value)) joints_.push_back(Name(entry));
  } else if (key == "points") {
    if (points_) Fail("'points' is given twice");
    section_ = Section::kPoints;
    points_.emplace(joints_, where_);
  } else {
    Fail("'" + std::string(key.substr(0, 40)) + "' is not a member of a trajectory");
  }
}

// Reads a member of a point, "key: value".
void YamlReader::ReadMember(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) Fail("must be a member and a colon");
  const std::string_view key = line.substr(0, colon), value = Trimmed(line.substr(colon + 1));
  list_ = nullptr;
  if (std::vector<double>* list = ListNamed(key)) {
    if (!list->empty()) Fail("'" + std::string(key) + "' is given twice");
    if (value.empty()) {
      list_ = list;
      return;
    }
    for (const std::string_view entry : Flow(value)) list->push_back(Number(entry));
  } else if (key == "time_from_start") {
    if (!value.empty()) Fail("time_from_start must hold sec and nanosec on separate lines");
  } else if (key == "sec" || key == "nanosec") {
    const std::optional<std::int64_t> number = IntegerFrom(value);
    if (!number) Fail("'" + std::string(key) + "' must be an integer");
    const int bit = key == "sec" ? 1 : 2;
    if (times_given_ & bit) Fail("'" + std::string(key) + "' is given twice");
    times_given_ |= bit;
    (key == "sec" ? point_->sec : point_->nanosec) = *number;
  } else {
    Fail("'" + std::string(key.substr(0, 40)) + "' is not a member of a point");
  }
}

void YamlReader::ReadPointLine(std::string_view line) {
  if (!line.starts_with("- ")) {
    if (!point_) Fail("a point must begin with '- '");
    ReadMember(line);
    return;
  }
  const std::string_view entry = Trimmed(line.substr(2));
  if (entry.find(':') == std::string_view::npos) {
    if (list_ == nullptr) Fail("an entry belongs to no list");
    if (list_->size() >= kMostTrajectoryJoints) Fail("the list is too long");
    list_->push_back(Number(entry));
    return;
  }
  EndPoint();
  point_.emplace();
  point_line_ = line_;
  times_given_ = 0;
  ReadMember(entry);
}

void YamlReader::ReadComment(std::string_view comment) {
  const std::size_t colon = comment.find(": ");
  if (colon == std::string_view::npos) return;
  notes_[std::string(Trimmed(comment.substr(0, colon)))] = Trimmed(comment.substr(colon + 2));
}

void YamlReader::ReadLine(std::string_view line) {
  const std::string_view content = Trimmed(line);
  if (content.empty()) return;
  if (content.front() == '#') {
    ReadComment(content.substr(1));
    return;
  }
  if (ended_) Fail("unexpected text after the end of the document");
  if (content == "---" && section_ == Section::kNone) return;
  if (content == "---" || content == "...") {
    ended_ = true;
    return;
  }
  if (line.front() != ' ' && line.front() != '-') {
    EndPoint();
    ReadSection(content);
    return;
  }
  switch (section_) {
    case Section::kNone:
      Fail("expected a member of the trajectory");
    case Section::kHeader:
      return;  // unrelated to the motion
    case Section::kNames:
      if (!content.starts_with("- ")) Fail("expected a joint name after '- '");
      if (joints_.size() >= kMostTrajectoryJoints) Fail("there are too many joints");
      joints_.push_back(Name(Trimmed(content.substr(2))));
      return;
    case Section::kPoints:
      ReadPointLine(content);
      return;
  }
}

JointTrajectory YamlReader::Read(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    ++line_;
    ReadLine(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  if (!ended_) Fail("the end of the document, '...' or '---', is missing: the file is truncated");
  EndPoint();
  if (!points_) Fail("there are no points");
  JointTrajectory trajectory = points_->Finish();
  trajectory.metadata = std::move(notes_);
  return trajectory;
}

}  // namespace

std::string RosYamlText(const JointTrajectory& trajectory) {
  RequireRosTimes(trajectory);
  std::string text;
  for (const auto& [key, value] : trajectory.metadata) text += "# " + key + ": " + value + "\n";
  text += "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: ''\njoint_names:\n";
  for (const std::string& joint : trajectory.joints) text += "- " + joint + "\n";
  text += "points:\n";
  for (Eigen::Index i = 0; i < trajectory.size(); ++i) {
    text += "- ";
    AppendYamlRow("positions", trajectory.positions, i, &text);
    AppendYamlRow("velocities", trajectory.velocities, i, &text);
    AppendYamlRow("accelerations", trajectory.accelerations, i, &text);
    AppendYamlRow("effort", trajectory.efforts, i, &text);
    const TrajectoryPoint point = PointAt(trajectory.times[static_cast<std::size_t>(i)]);
    text += "time_from_start:\n    sec: " + std::to_string(point.sec) +
            "\n    nanosec: " + std::to_string(point.nanosec) + "\n";
  }
  return text + "...\n";
}

JointTrajectory ParseRosYaml(std::string_view text, const std::string& where) {
  return YamlReader(where).Read(text);
}

}  // namespace simwright::robot
