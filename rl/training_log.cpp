#include "rl/training_log.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/error.h"
#include "core/files.h"
#include "rl/event_file.h"

namespace simwright::rl {
namespace {

// Returns the shortest text that reads back as the same number; empty for NaN.
std::string Cell(double value) {
  if (!std::isfinite(value)) return "";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  return {buffer, end};
}

std::string Header() {
  std::string line;
  for (const TrainingColumn& column : kTrainingColumns) {
    line += (line.empty() ? "" : ",") + std::string(column.name);
  }
  return line;
}

std::string Row(const TrainingRecord& record) {
  std::string line;
  for (const TrainingColumn& column : kTrainingColumns) {
    line += (line.empty() ? "" : ",") + Cell(record.*column.value);
  }
  return line + "\n";
}

// Returns false for an incomplete row.
bool ParseRow(const std::string& line, TrainingRecord* record) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < kTrainingColumns.size(); ++i) {
    const std::size_t comma = line.find(',', first);
    const bool last = i + 1 == kTrainingColumns.size();
    if ((comma == std::string::npos) != last) return false;
    const std::size_t end = last ? line.size() : comma;
    double value = std::numeric_limits<double>::quiet_NaN();
    if (end > first) {
      const auto parsed = std::from_chars(line.data() + first, line.data() + end, value);
      if (parsed.ec != std::errc() || parsed.ptr != line.data() + end) return false;
    }
    record->*kTrainingColumns[i].value = value;
    first = end + 1;
  }
  return true;
}

void AppendBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out << bytes << std::flush;
  if (!out) {
    throw core::Error("cannot write", path.string(),
                      "free some space, then continue with --resume");
  }
}

double WallTime() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

std::vector<TrainingRecord> ReadTrainingTable(const std::filesystem::path& path,
                                              std::int64_t last_iteration) {
  const std::string text = core::ReadFile(path);
  // A row without its newline is incomplete.
  std::istringstream lines(text.substr(0, text.rfind('\n') + 1));
  std::string line;
  if (!std::getline(lines, line) || line != Header()) {
    throw core::Error("is not a training log of this version", path.string(),
                      "train in another folder");
  }
  std::vector<TrainingRecord> records;
  TrainingRecord record;
  while (std::getline(lines, line) && ParseRow(line, &record) &&
         record.iteration <= static_cast<double>(last_iteration)) {
    records.push_back(record);
  }
  return records;
}

TrainingLog::TrainingLog(const std::filesystem::path& folder, std::int64_t last_iteration)
    : table_(folder / "training.csv"), events_(folder / "events.out.tfevents.0.simwright") {
  std::string events;
  if (last_iteration > 0 && std::filesystem::exists(table_)) {
    records_ = ReadTrainingTable(table_, last_iteration);
  }
  if (last_iteration > 0 && std::filesystem::exists(events_)) {
    events = core::ReadFile(events_);
    events.resize(EventsUpTo(events, last_iteration));
  }
  if (events.empty()) events = EventFileStart(WallTime());
  core::WriteFile(events_, events);
  std::string table = Header() + "\n";
  for (const TrainingRecord& record : records_) table += Row(record);
  core::WriteFile(table_, table);
}

void TrainingLog::Append(const TrainingRecord& record) {
  records_.push_back(record);
  AppendBytes(table_, Row(record));
  std::vector<std::pair<std::string, float>> scalars;
  for (const TrainingColumn& column : kTrainingColumns) {
    const double value = record.*column.value;
    if (std::isfinite(value)) scalars.emplace_back(column.name, static_cast<float>(value));
  }
  AppendBytes(events_,
              EventRecord(WallTime(), static_cast<std::int64_t>(record.iteration), scalars));
}

}  // namespace simwright::rl
